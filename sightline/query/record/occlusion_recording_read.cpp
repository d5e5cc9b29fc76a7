// Reads a recording of a frame's occlusion calls, and believes nothing of it.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "sightline/query/record/occlusion_recording.h"
#include "sightline/base/bytes.h"
#include "sightline/buffer/screen.h"

namespace sightline {

using namespace recording_file;

namespace {

/// The sections of a file, and the first thing that is wrong with them: after that nothing is taken any more.
class RecordingReader {
public:
    RecordingReader(std::span<const char> bytes, std::string_view file, OcclusionRecording& out)
        : bytes_(bytes), file_(file), out_(out) {}

    Status read() {
        readHead();
        if (good()) readView();
        if (good()) readOccluders();
        if (good()) readInstances();
        if (good()) readCalls();
        if (good()) return success();
        return Error{Error::Kind::kInput, std::string(file_) + ": " + fault_ + " at byte " + std::to_string(fault_at_)};
    }

private:
    bool good() const { return fault_.empty(); }
    /// @return false, so that whoever finds a fault may return it
    bool wrong(std::string what, uint64_t at) {
        if (good()) {
            fault_ = std::move(what);
            fault_at_ = at;
        }
        return false;
    }
    uint64_t records(Section section) const { return sections_[section].left() / kRecordBytes[section]; }

    void readHead() {
        ByteCursor head(bytes_);
        for (const char letter : kMagic)
            if (head.take<char>() != letter) return (void)wrong("not a recording of occlusion calls", 0);
        constexpr size_t kSizesEnd = kHashedAt + 8 * kSectionCount;
        if (bytes_.size() < kHashedAt) return (void)wrong("the file ends within its head", bytes_.size());
        if (const uint32_t version = head.take<uint32_t>(); version != kVersion)
            return (void)wrong("a recording of version " + std::to_string(version) + ", where version " +
                                   std::to_string(kVersion) + " is read",
                               16);
        if (head.take<uint32_t>() != kSectionCount) return (void)wrong("not the sections of this version", 20);
        const uint64_t hash = head.take<uint64_t>();
        if (bytes_.size() < kSizesEnd) return (void)wrong("the file ends within its head", bytes_.size());
        uint64_t at = kSizesEnd;
        for (uint32_t section = 0; section < kSectionCount; ++section) {
            const uint64_t where = head.at(), size = head.take<uint64_t>();
            if (size > bytes_.size() - at) return (void)wrong("a section that is longer than the file", where);
            if (size % kRecordBytes[section] != 0) return (void)wrong("a section that ends within a record", where);
            sections_[section] = ByteCursor(bytes_.subspan(at, size), at);
            at += size;
        }
        if (at != bytes_.size()) return (void)wrong("bytes after the last section", at);
        if (contentHash(bytes_.subspan(kHashedAt)) != hash)
            wrong("the content does not have the hash that it says", kHashAt);
    }

    bool takeMatrix(ByteCursor& from, glm::dmat4& matrix) {
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                const uint64_t at = from.at();
                matrix[column][row] = from.take<double>();
                if (!std::isfinite(matrix[column][row])) return wrong("a number that is not finite", at);
            }
        return true;
    }

    bool takeFinite(ByteCursor& from, float& value) {
        const uint64_t at = from.at();
        value = from.take<float>();
        return std::isfinite(value) || wrong("a number that is not finite", at);
    }

    bool takeBox(ByteCursor& from, Box3f& box) {
        const uint64_t at = from.at();
        for (glm::vec3* corner : {&box.min, &box.max})
            for (int axis = 0; axis < 3; ++axis)
                if (!takeFinite(from, (*corner)[axis])) return false;
        for (int axis = 0; axis < 3; ++axis)
            if (!(box.min[axis] <= box.max[axis])) return wrong("bounds that are empty", at);
        return true;
    }

    static bool holds(const Box3f& box, const glm::vec3& p) {
        for (int axis = 0; axis < 3; ++axis)
            if (!(box.min[axis] <= p[axis] && p[axis] <= box.max[axis])) return false;
        return true;
    }

    void readView() {
        ByteCursor& from = sections_[kView];
        const uint64_t at = from.at();
        if (records(kView) != 1) return (void)wrong("not exactly one view", at);
        if (!takeMatrix(from, out_.view.view) || !takeMatrix(from, out_.view.projection)) return;
        out_.view.width = from.take<uint32_t>();
        out_.view.height = from.take<uint32_t>();
        out_.view.jitter = from.take<double>();
        if (!isUsable(out_.view)) return (void)wrong("a view that cannot be used", at);
        const uint64_t at_size = from.at();
        out_.settings.occlusion_size = from.take<uint32_t>();
        if (out_.settings.occlusion_size < 1 || out_.settings.occlusion_size > 8192)
            return (void)wrong("a buffer of no pixels, or of more than 8192 in a row", at_size);
        const uint64_t at_detail = from.at();
        const uint32_t how = from.take<uint32_t>(), detail = how & 255;
        if (detail > static_cast<uint32_t>(OcclusionDetail::kFull))
            return (void)wrong("a detail of the buffer that is not known", at_detail);
        out_.settings.close_gaps = (how >> 8) / kGapSteps;
        if (closedGap(out_.settings) != out_.settings.close_gaps)
            return (void)wrong("gaps that are too wide to be closed", at_detail);
        out_.settings.masked = static_cast<OcclusionDetail>(detail) == OcclusionDetail::kMasked;
    }

    void readOccluders() {
        ByteCursor& heads = sections_[kOccluders];
        out_.occluders.reserve(records(kOccluders));
        while (good() && heads.left() > 0) {
            Occluder& occluder = out_.occluders.emplace_back(out_.occluders.get_allocator().resource());
            if (!takeBox(heads, occluder.bounds)) return;
            const auto reserve = [&](Section section, auto... arrays) {
                const uint64_t at = heads.at(), count = heads.take<uint32_t>();
                if (count > records(section)) return wrong("an occluder that has more than the file", at);
                (arrays->reserve(count), ...);
                counts_[section] = count;
                return true;
            };
            const uint64_t at = heads.at();
            if (!reserve(kClusters, &occluder.clusters) || !reserve(kVertices, &occluder.x, &occluder.y, &occluder.z) ||
                !reserve(kPolygons, &occluder.polygons) || !reserve(kEdges, &occluder.edges))
                return;
            if (counts_[kClusters] == 0) return (void)wrong("an occluder without clusters", at);
            readParts(occluder);
        }
        for (const Section section : {kClusters, kVertices, kPolygons, kEdges})
            if (good() && sections_[section].left() > 0) wrong("more than the occluders have", sections_[section].at());
    }

    /// Vertices, polygons and edges first: the clusters are what holds them to each other.
    void readParts(Occluder& occluder) {
        for (uint64_t i = 0; i < counts_[kVertices]; ++i)
            for (Array<float>* axis : {&occluder.x, &occluder.y, &occluder.z}) {
                float value = 0;
                if (!takeFinite(sections_[kVertices], value)) return;
                axis->push_back(value);
            }
        polygons_at_ = sections_[kPolygons].at();
        for (uint64_t i = 0; i < counts_[kPolygons]; ++i) {
            OccluderPolygon& polygon = occluder.polygons.emplace_back();
            for (uint8_t& vertex : polygon.vertex) vertex = sections_[kPolygons].take<uint8_t>();
            const uint64_t at = sections_[kPolygons].at();
            const uint8_t sides = sections_[kPolygons].take<uint8_t>();
            if (sides > 1) return (void)wrong("a polygon with neither one side nor two", at);
            polygon.double_sided = sides == 1;
        }
        edges_at_ = sections_[kEdges].at();
        for (uint64_t i = 0; i < counts_[kEdges]; ++i) {
            OccluderEdge& edge = occluder.edges.emplace_back();
            for (uint8_t* value : {&edge.from, &edge.to, &edge.left, &edge.right})
                *value = sections_[kEdges].take<uint8_t>();
        }
        for (uint64_t i = 0; good() && i < counts_[kClusters]; ++i) readCluster(occluder);
    }

    void readCluster(Occluder& occluder) {
        ByteCursor& from = sections_[kClusters];
        const uint64_t at = from.at();
        OccluderCluster& c = occluder.clusters.emplace_back();
        if (!takeBox(from, c.bounds)) return;
        for (uint32_t* value : {&c.first_vertex, &c.vertex_count, &c.first_polygon, &c.polygon_count, &c.ring_count,
                                &c.first_edge, &c.edge_count})
            *value = from.take<uint32_t>();
        const auto within = [](uint64_t first, uint64_t count, uint64_t size) { return first + count <= size; };
        if (!holds(occluder.bounds, c.bounds.min) || !holds(occluder.bounds, c.bounds.max))
            return (void)wrong("a cluster that its occluder's bounds do not hold", at);
        if (c.first_vertex % 8 != 0 || c.vertex_count == 0 || c.vertex_count > OccluderCluster::kMaxVertices ||
            !within(c.first_vertex, (uint64_t{c.vertex_count} + 7) / 8 * 8, occluder.x.size()))
            return (void)wrong("a cluster with vertices that there are not", at);
        const uint64_t polygons = uint64_t{c.polygon_count} + c.ring_count;
        const uint64_t most = c.edge_count > 0 ? OccluderCluster::kMaxOwn : OccluderCluster::kMaxLoose;
        if (c.polygon_count == 0 || c.polygon_count > most || polygons > OccluderCluster::kMaxPolygons ||
            !within(c.first_polygon, polygons, occluder.polygons.size()))
            return (void)wrong("a cluster with polygons that there are not", at);
        if (c.edge_count > 4 * OccluderCluster::kMaxVertices * OccluderCluster::kMaxPolygons ||
            !within(c.first_edge, c.edge_count, occluder.edges.size()))
            return (void)wrong("a cluster with edges that there are not", at);
        checkPolygons(occluder, c, static_cast<uint32_t>(polygons));
        for (uint32_t i = c.first_edge; good() && i < c.first_edge + c.edge_count; ++i) {
            const OccluderEdge& edge = occluder.edges[i];
            if (edge.from >= c.vertex_count || edge.to >= c.vertex_count || edge.from == edge.to ||
                edge.left >= polygons || (edge.right >= polygons && edge.right != OccluderEdge::kNone))
                wrong("an edge between what there is not", edges_at_ + kRecordBytes[kEdges] * i);
        }
    }

    void checkPolygons(const Occluder& occluder, OccluderCluster& c, uint32_t polygons) {
        for (uint32_t i = 0; i < polygons; ++i) {
            const OccluderPolygon& polygon = occluder.polygons[c.first_polygon + i];
            const uint64_t at = polygons_at_ + kRecordBytes[kPolygons] * (c.first_polygon + i);
            if (i < c.polygon_count) c.triangle_count += static_cast<uint32_t>(polygon.corners() - 2);
            for (int k = 0; k < polygon.corners(); ++k) {
                if (polygon.vertex[k] >= c.vertex_count)
                    return (void)wrong("a polygon of a vertex that there is not", at);
                for (int j = 0; j < k; ++j)
                    if (polygon.vertex[j] == polygon.vertex[k])
                        return (void)wrong("a polygon that names a vertex twice", at);
                const uint32_t vertex = c.first_vertex + polygon.vertex[k];
                if (i < c.polygon_count &&
                    !holds(c.bounds, {occluder.x[vertex], occluder.y[vertex], occluder.z[vertex]}))
                    return (void)wrong("a polygon that its cluster's bounds do not hold", at);
            }
        }
    }

    void readInstances() {
        ByteCursor& from = sections_[kInstances];
        out_.instances.reserve(records(kInstances));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            auto& instance = out_.instances.emplace_back();
            instance.occluder = from.take<uint32_t>();
            if (instance.occluder >= out_.occluders.size())
                return (void)wrong("an instance of an occluder that there is not", at);
            if (!takeMatrix(from, instance.transform)) return;
        }
    }

    void readCalls() {
        uint64_t counts[3] = {};
        ByteCursor& from = sections_[kCalls];
        out_.asked.calls.reserve(records(kCalls));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            const uint8_t call = from.take<uint8_t>();
            if (call > 2) return (void)wrong("a call of a kind that is not known", at);
            ++counts[call];
            out_.asked.calls.push_back(static_cast<TileLog::Call>(call));
        }
        const Section kinds[3] = {kDraws, kRects, kTiles};
        for (int i = 0; i < 3; ++i)
            if (records(kinds[i]) != counts[i])
                return (void)wrong("not as many records as calls", sections_[kinds[i]].at());
        readDraws();
        const Screen screen = makeScreen(out_.view, out_.settings.occlusion_size);
        if (good()) readBoxes();
        if (good()) readRects(screen);
        if (good()) readTiles(screen);
    }

    void readDraws() {
        ByteCursor& from = sections_[kDraws];
        out_.draws.reserve(records(kDraws));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            auto& draw = out_.draws.emplace_back();
            draw.instance = from.take<uint32_t>();
            draw.cluster = from.take<uint32_t>();
            if (draw.instance >= out_.instances.size() ||
                draw.cluster >= out_.occluders[out_.instances[draw.instance].occluder].clusters.size())
                return (void)wrong("a draw of a cluster that there is not", at);
        }
    }

    void readBoxes() {
        ByteCursor& from = sections_[kBoxes];
        out_.asked.boxes.reserve(records(kBoxes));
        while (from.left() > 0) {
            OccludeeBox::Image& box = out_.asked.boxes.emplace_back();
            for (double(*row)[4] : {&box.row[0], &box.row[1], &box.row[2], &box.row[3], &box.error})
                for (double& value : *row) {
                    const uint64_t at = from.at();
                    value = from.take<double>();
                    if (!std::isfinite(value)) return (void)wrong("a number that is not finite", at);
                }
        }
    }

    bool takeBoxIndex(ByteCursor& from, uint32_t& index) {
        const uint64_t at = from.at();
        index = from.take<uint32_t>();
        return index == TileLog::kNoBox || index < out_.asked.boxes.size() ||
               wrong("a test of a box that there is not", at);
    }

    void readRects(const Screen& screen) {
        ByteCursor& from = sections_[kRects];
        out_.asked.rects.reserve(records(kRects));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            auto& test = out_.asked.rects.emplace_back();
            PixelRect& rect = test.rect;
            for (int32_t* value : {&rect.x0, &rect.y0, &rect.x1, &rect.y1}) *value = from.take<uint16_t>();
            rect.nearness = from.take<float>();
            if (!takeBoxIndex(from, test.box)) return;
            const uint8_t flags = from.take<uint8_t>();
            if (rect.x0 > rect.x1 || rect.y0 > rect.y1 || rect.x1 >= static_cast<int32_t>(screen.width) ||
                rect.y1 >= static_cast<int32_t>(screen.height) || std::isnan(rect.nearness) || flags > 3)
                return (void)wrong("a test of a rectangle outside of the buffer", at);
            test.seams = flags & 1 ? Seams::kLeave : Seams::kResolve;
            test.hidden = flags & 2;
        }
    }

    void readTiles(const Screen& screen) {
        ByteCursor &from = sections_[kTiles], &nearest = sections_[kNearest];
        out_.asked.tiles.reserve(records(kTiles));
        out_.asked.nearest.reserve(records(kNearest));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            auto& test = out_.asked.tiles.emplace_back();
            test.tile = from.take<uint32_t>();
            test.window = from.take<uint64_t>();
            test.open = from.take<uint64_t>();
            if (!takeBoxIndex(from, test.box)) return;
            const uint8_t flags = from.take<uint8_t>();
            test.seams = flags & 1 ? Seams::kLeave : Seams::kResolve;
            if (test.tile >= screen.width / 8 * (screen.height / 8) || flags > 1 || (test.open & ~test.window))
                return (void)wrong("a test of a tile outside of the buffer", at);
            for (uint64_t left = test.window; left; left &= left - 1) {
                const uint64_t at_value = nearest.at();
                if (nearest.left() == 0) return (void)wrong("fewer nearnesses than tests ask for", at_value);
                out_.asked.nearest.push_back(nearest.take<float>());
                if (std::isnan(out_.asked.nearest.back())) return (void)wrong("a number that is not one", at_value);
            }
        }
        if (nearest.left() > 0) wrong("more nearnesses than tests ask for", nearest.at());
    }

    std::span<const char> bytes_;
    std::string_view file_;
    OcclusionRecording& out_;
    std::string fault_;
    uint64_t fault_at_ = 0;
    ByteCursor sections_[kSectionCount];
    uint64_t counts_[kSectionCount] = {};  ///< of the occluder at hand
    uint64_t polygons_at_ = 0, edges_at_ = 0;
};

}  // namespace

Result<OcclusionRecording> parseRecording(std::span<const char> bytes, std::string_view file, Memory* memory) {
    OcclusionRecording out(memory);
    if (Status read = RecordingReader(bytes, file, out).read(); !read) return read.error();
    return out;
}

}  // namespace sightline
