// Reads the recording of a frame, and believes nothing of it.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "sightline/base/bytes.h"
#include "sightline/query/record/frame_recording.h"

namespace sightline {

using namespace recording_file;

namespace {

/// The sections of a file, and the first thing that is wrong with them: after that nothing is taken any more.
class RecordingReader {
public:
    RecordingReader(std::span<const char> bytes, std::string_view file, FrameRecording& out)
        : bytes_(bytes), file_(file), out_(out) {}

    Status read() {
        readHead();
        if (good()) readView();
        if (good()) readSettings();
        if (good()) readForms();
        if (good()) readChains();
        if (good()) readObjects();
        if (good()) readAnswers();
        if (good()) readCertificates();
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
        if (!isRecording(bytes_)) return (void)wrong("not a recording of a frame", 0);
        for (size_t i = 0; i < sizeof kMagic; ++i) head.take<char>();
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

    static void takeMatrix(ByteCursor& from, glm::dmat4& matrix) {
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) matrix[column][row] = from.take<double>();
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
        View& view = out_.view;
        takeMatrix(from, view.view);
        takeMatrix(from, view.projection);
        view.width = from.take<uint32_t>();
        view.height = from.take<uint32_t>();
        view.jitter = from.take<double>();
        view.layers = from.take<uint32_t>();
        view.eye_radius = from.take<double>();
        for (ViewPlanes* planes : {&view.sections, &view.window}) {
            planes->count = from.take<uint32_t>();
            for (glm::dvec4& plane : planes->planes)
                for (int k = 0; k < 4; ++k) plane[k] = from.take<double>();
        }
        view.through.count = from.take<uint32_t>();
        for (glm::dvec3& point : view.through.points)
            for (int axis = 0; axis < 3; ++axis) point[axis] = from.take<double>();
        if (!isUsable(view)) return (void)wrong("a view that cannot be used", at);
        const uint64_t at_flags = from.at();
        const uint32_t flags = from.take<uint32_t>();
        if (flags > 1) return (void)wrong("flags that are not known", at_flags);
        out_.volumes = flags == 1;
    }

    /// What is not in the file is as it is by default, so that settings may be added.
    void readSettings() {
        ByteCursor& from = sections_[kSettings];
        while (good() && from.left() > 0) {
            const uint64_t at = from.at();
            char name[kNameBytes + 1] = {};
            for (size_t i = 0; i < kNameBytes; ++i) name[i] = from.take<char>();
            const double value = from.take<double>();
            bool known = false;
            forEachSetting([&](const auto& row) {
                if (known || std::string_view(name) != row.name) return;
                known = true;
                auto& to = out_.settings.*row.member;
                using Value = std::remove_reference_t<decltype(to)>;
                const bool endless = row.most >= 1e300 && value > row.most;  // a NaN is not
                const bool whole = std::is_same_v<Value, double> || value == std::floor(value);
                if (!endless && !(value >= row.least && value <= row.most && whole))
                    return (void)wrong("a setting beyond its limits", at);
                to = static_cast<Value>(value);
            });
            if (!known) wrong("a setting that is not known", at);
        }
    }

    void readForms() {
        ByteCursor& from = sections_[kForms];
        Memory* const memory = out_.forms.get_allocator().resource();
        out_.forms.reserve(records(kForms));
        while (good() && from.left() > 0) {
            const uint64_t at = from.at(), count = from.take<uint32_t>();
            if (count > records(kInner)) return (void)wrong("more inner occluders than the file has", at);
            FrameRecording::Form& form = out_.forms.emplace_back(memory);
            form.inner.reserve(count);
            readOccluder(form.occluder);
            for (uint64_t i = 0; i < count && good(); ++i) {
                InnerOccluder& inner = form.inner.emplace_back(memory);
                if (!takeBox(sections_[kInner], inner.outside) || !takeFinite(sections_[kInner], inner.error)) return;
                readOccluder(inner.occluder);
            }
        }
        for (const Section section : {kInner, kOccluders, kClusters, kVertices, kPolygons, kEdges})
            if (good() && sections_[section].left() > 0) wrong("more than the occluders have", sections_[section].at());
    }

    void readOccluder(Occluder& occluder) {
        ByteCursor& heads = sections_[kOccluders];
        if (heads.left() == 0) return (void)wrong("fewer occluders than forms", heads.at());
        ByteCursor bounds = heads;
        for (int i = 0; i < 6; ++i) heads.take<float>();
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
        if (counts_[kClusters] > 0) {
            if (takeBox(bounds, occluder.bounds)) readParts(occluder);
        } else if (counts_[kVertices] + counts_[kPolygons] + counts_[kEdges] > 0) {
            wrong("an occluder without clusters that has parts", at);
        }
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

    void readChains() {
        ByteCursor& from = sections_[kChains];
        ByteCursor& levels = sections_[kLevels];
        out_.chains.reserve(records(kChains));
        while (from.left() > 0) {
            const uint64_t at = from.at(), count = from.take<uint32_t>();
            if (count == 0 || count > std::min<uint64_t>(kMostLods, records(kLevels)))
                return (void)wrong("more levels of detail than there are", at);
            Array<LodLevel>& chain = out_.chains.emplace_back();
            for (uint64_t i = 0; i < count; ++i) {
                LodLevel& level = chain.emplace_back();
                level.error = levels.take<double>();
                level.triangles = levels.take<uint32_t>();
                level.vertices = levels.take<uint32_t>();
            }
        }
        if (levels.left() > 0) wrong("more levels of detail than the chains have", levels.at());
    }

    /// Bounds, transforms and limits may be any numbers, as World::add() takes them.
    void readObjects() {
        ByteCursor& from = sections_[kObjects];
        out_.objects.reserve(records(kObjects));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            ObjectDef& object = out_.objects.emplace_back();
            for (glm::dvec3* corner : {&object.bounds.min, &object.bounds.max})
                for (int axis = 0; axis < 3; ++axis) (*corner)[axis] = from.take<double>();
            takeMatrix(from, object.transform);
            object.key = from.take<uint64_t>();
            for (uint32_t* value : {&object.layers, &object.occluder.index, &object.shape.index, &object.lods.index})
                *value = from.take<uint32_t>();
            object.limits.max_distance = from.take<double>();
            object.limits.factor = from.take<double>();
            const uint32_t flags = from.take<uint32_t>();
            object.limits.always = flags & 1;
            object.hides_in_lods = flags & 2;
            if (flags > 3) return (void)wrong("flags that are not known", at);
            if (std::max(object.occluder.index, object.shape.index) > out_.forms.size() ||
                object.lods.index > out_.chains.size())
                return (void)wrong("an object with what there is not", at);
        }
    }

    void readAnswers() {
        const std::pair<Section, Array<uint8_t>*> answers[] = {{kReasons, &out_.reasons}, {kAgain, &out_.again}};
        for (const auto& [section, to] : answers) {
            ByteCursor& from = sections_[section];
            if (records(section) != out_.objects.size()) return (void)wrong("not an answer for each object", from.at());
            to->reserve(out_.objects.size());
            while (from.left() > 0) {
                const uint64_t at = from.at();
                to->push_back(from.take<uint8_t>());
                if (to->back() > kStageCount && to->back() != 255) return (void)wrong("a stage that there is not", at);
            }
        }
    }

    void readCertificates() {
        ByteCursor& from = sections_[kCertificates];
        ByteCursor& named = sections_[kNamed];
        out_.certificates.reserve(records(kCertificates));
        out_.named.reserve(records(kNamed));
        for (uint32_t next = 0; from.left() > 0;) {
            const uint64_t at = from.at();
            FrameRecording::Certificate& certificate = out_.certificates.emplace_back();
            certificate.hidden = from.take<uint32_t>();
            certificate.count = from.take<uint32_t>();
            certificate.first = static_cast<uint32_t>(out_.named.size());
            if (certificate.hidden < next || certificate.hidden >= out_.objects.size() ||
                out_.reasons[certificate.hidden] == 0)
                return (void)wrong("a certificate of no object that was culled", at);
            next = certificate.hidden + 1;
            if (certificate.count > records(kNamed))
                return (void)wrong("a certificate that names more than there are", at);
            for (uint32_t i = 0; i < certificate.count; ++i) {
                const uint64_t at_named = named.at();
                const uint32_t object = named.take<uint32_t>();
                if (object >= out_.objects.size() || (i > 0 && object <= out_.named.back()))
                    return (void)wrong("a certificate that names what there is not, or twice", at_named);
                out_.named.push_back(object);
            }
        }
        if (named.left() > 0) wrong("more names than the certificates have", named.at());
    }

    std::span<const char> bytes_;
    std::string_view file_;
    FrameRecording& out_;
    std::string fault_;
    uint64_t fault_at_ = 0;
    ByteCursor sections_[kSectionCount];
    uint64_t counts_[kSectionCount] = {};  ///< of the occluder at hand
    uint64_t polygons_at_ = 0, edges_at_ = 0;
};

}  // namespace

bool isRecording(std::span<const char> bytes) {
    return bytes.size() >= sizeof kMagic && std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
}

Result<FrameRecording> parseRecording(std::span<const char> bytes, std::string_view file, Memory* memory) {
    FrameRecording out(memory);
    if (Status read = RecordingReader(bytes, file, out).read(); !read) return read.error();
    return out;
}

}  // namespace sightline
