// Records what one frame asked of its occlusion buffer, and writes it as bytes.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/occlusion_recording.h"

#include <algorithm>
#include <compare>
#include <unordered_map>

#include "sightline/base/bytes.h"
#include "sightline/query/recorded_traversal.h"

namespace sightline {
namespace {

/// Which clusters of which occluders a traversal drew, and what they are in the recording.
class Shelf {
public:
    Shelf(const detail::RecordedTraversal& done, Memory* memory)
        : state_(done.state), record_(done.record), met_(memory), index_(memory), drawn_(memory), first_(memory) {}

    void fill(OcclusionRecording& out, Memory* memory) {
        gather();
        for (uint32_t i = 0, next = 0; i < met_.size(); ++i) {
            Occluder& to = out.occluders.emplace_back(memory);
            to.bounds = met_[i]->bounds;
            first_.push_back(next);
            for (; next < drawn_.size() && drawn_[next].occluder == i; ++next)
                addCluster(*met_[i], met_[i]->clusters[drawn_[next].cluster], to);
        }
        Array<uint32_t> instance_of(state_.instances.size(), kNone, memory);
        out.draws.reserve(record_.draws.size());
        for (const auto& draw : record_.draws) {
            const OccluderInstance& instance = state_.instances[draw.instance];
            const uint32_t occluder = index_.find(instance.occluder)->second;
            uint32_t& index = instance_of[draw.instance];
            if (index == kNone) {
                index = static_cast<uint32_t>(out.instances.size());
                out.instances.push_back({occluder, *instance.transform});
            }
            const auto at = std::lower_bound(drawn_.begin(), drawn_.end(), Drawn{occluder, draw.cluster});
            out.draws.push_back({index, static_cast<uint32_t>(at - drawn_.begin()) - first_[occluder]});
        }
    }

private:
    static constexpr uint32_t kNone = ~0u;
    struct Drawn {
        uint32_t occluder = 0, cluster = 0;
        auto operator<=>(const Drawn&) const = default;
    };

    /// The clusters that were drawn, each once; occluders in the order of meeting, so that addresses decide nothing.
    void gather() {
        for (const auto& draw : record_.draws) {
            const Occluder* occluder = state_.instances[draw.instance].occluder;
            const auto [at, fresh] = index_.try_emplace(occluder, static_cast<uint32_t>(met_.size()));
            if (fresh) met_.push_back(occluder);
            drawn_.push_back({at->second, draw.cluster});
        }
        std::sort(drawn_.begin(), drawn_.end());
        drawn_.erase(std::unique(drawn_.begin(), drawn_.end()), drawn_.end());
    }

    static void addCluster(const Occluder& from, OccluderCluster cluster, Occluder& to) {
        const auto copy = [](const auto& source, uint32_t first, uint32_t count, auto& target) {
            const uint32_t place = static_cast<uint32_t>(target.size());
            target.insert(target.end(), source.begin() + first, source.begin() + first + count);
            return place;
        };
        const uint32_t padded = (cluster.vertex_count + 7) / 8 * 8, from_vertex = cluster.first_vertex;
        cluster.first_vertex = copy(from.x, from_vertex, padded, to.x);
        copy(from.y, from_vertex, padded, to.y);
        copy(from.z, from_vertex, padded, to.z);
        cluster.first_polygon =
            copy(from.polygons, cluster.first_polygon, cluster.polygon_count + cluster.ring_count, to.polygons);
        cluster.first_edge = copy(from.edges, cluster.first_edge, cluster.edge_count, to.edges);
        to.clusters.push_back(cluster);
    }

    const detail::TraversalState& state_;
    const detail::TraversalRecord& record_;
    Array<const Occluder*> met_;
    std::pmr::unordered_map<const Occluder*, uint32_t> index_;  ///< into met_
    Array<Drawn> drawn_;
    Array<uint32_t> first_;  ///< per occluder of the recording: into drawn_
};

void put(ByteWriter& out, const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) out.put(matrix[column][row]);
}

void put(ByteWriter& out, const Box3f& box) {
    for (const glm::vec3& corner : {box.min, box.max})
        for (int axis = 0; axis < 3; ++axis) out.put(corner[axis]);
}

void putOccluders(Array<char> (&sections)[recording_file::kSectionCount], const OcclusionRecording& recording) {
    using namespace recording_file;
    ByteWriter heads(sections[kOccluders]), clusters(sections[kClusters]), vertices(sections[kVertices]),
        polygons(sections[kPolygons]), edges(sections[kEdges]);
    for (const Occluder& occluder : recording.occluders) {
        put(heads, occluder.bounds);
        for (const size_t count :
             {occluder.clusters.size(), occluder.x.size(), occluder.polygons.size(), occluder.edges.size()})
            heads.put(static_cast<uint32_t>(count));
        for (const OccluderCluster& c : occluder.clusters) {
            put(clusters, c.bounds);
            for (const uint32_t value : {c.first_vertex, c.vertex_count, c.first_polygon, c.polygon_count, c.ring_count,
                                         c.first_edge, c.edge_count})
                clusters.put(value);
        }
        for (size_t i = 0; i < occluder.x.size(); ++i)
            for (const float value : {occluder.x[i], occluder.y[i], occluder.z[i]}) vertices.put(value);
        for (const OccluderPolygon& polygon : occluder.polygons) {
            for (const uint8_t vertex : polygon.vertex) polygons.put(vertex);
            polygons.put(static_cast<uint8_t>(polygon.double_sided));
        }
        for (const OccluderEdge& e : occluder.edges)
            for (const uint8_t value : {e.from, e.to, e.left, e.right}) edges.put(value);
    }
}

void putAsked(Array<char> (&sections)[recording_file::kSectionCount], const TileLog& asked) {
    using namespace recording_file;
    ByteWriter calls(sections[kCalls]), rects(sections[kRects]), tiles(sections[kTiles]), nearest(sections[kNearest]),
        boxes(sections[kBoxes]);
    for (const TileLog::Call call : asked.calls) calls.put(static_cast<uint8_t>(call));
    const auto flags = [](Seams seams, bool hidden) {
        return static_cast<uint8_t>((seams == Seams::kLeave ? 1 : 0) | (hidden ? 2 : 0));
    };
    for (const TileLog::RectTest& test : asked.rects) {
        for (const int32_t value : {test.rect.x0, test.rect.y0, test.rect.x1, test.rect.y1})
            rects.put(static_cast<uint16_t>(value));
        rects.put(test.rect.nearness);
        rects.put(test.box);
        rects.put(flags(test.seams, test.hidden));
    }
    for (const TileLog::TileTest& test : asked.tiles) {
        tiles.put(test.tile);
        tiles.put(test.window);
        tiles.put(test.open);
        tiles.put(test.box);
        tiles.put(flags(test.seams, false));
    }
    for (const float value : asked.nearest) nearest.put(value);
    for (const OccludeeBox::Image& box : asked.boxes)
        for (const double(*row)[4] : {&box.row[0], &box.row[1], &box.row[2], &box.row[3], &box.error})
            for (const double value : *row) boxes.put(value);
}

}  // namespace

Result<OcclusionRecording> recordOcclusion(const Snapshot& now, const View& view, const QuerySettings& settings,
                                           Memory* memory) {
    if (!isUsable(view)) return Error{Error::Kind::kUsage, "the view cannot be used, so nothing was asked"};
    if (!(stagesInUse(view, settings) & stageBit(Stage::kOcclusion)))
        return Error{Error::Kind::kUsage, "without the occlusion stage there is nothing to record"};
    OcclusionRecording out(memory);
    out.view.view = view.view;
    out.view.projection = view.projection;
    out.view.width = view.width;
    out.view.height = view.height;
    out.view.jitter = view.jitter;
    out.settings.occlusion_size = std::clamp(settings.occlusion_size, 1u, 8192u);
    out.settings.masked = settings.masked;
    out.settings.close_gaps = closedGap(settings);
    detail::RecordedTraversal done(memory);
    done.record.log = &out.asked;
    done.run(now, view, settings);
    Shelf(done, memory).fill(out, memory);
    for (TileLog::TileTest& test : out.asked.tiles)  // rows of tiles may lie farther apart than they are long
        test.tile =
            test.tile / done.state.tiles.stride * done.state.tiles.columns + test.tile % done.state.tiles.stride;
    return out;
}

Array<char> recordingBytes(const OcclusionRecording& recording, Memory* memory) {
    using namespace recording_file;
    Array<char> sections[kSectionCount] = {
        Array<char>(memory), Array<char>(memory), Array<char>(memory), Array<char>(memory), Array<char>(memory),
        Array<char>(memory), Array<char>(memory), Array<char>(memory), Array<char>(memory), Array<char>(memory),
        Array<char>(memory), Array<char>(memory), Array<char>(memory)};
    ByteWriter view(sections[kView]), instances(sections[kInstances]), draws(sections[kDraws]);
    put(view, recording.view.view);
    put(view, recording.view.projection);
    view.put(recording.view.width);
    view.put(recording.view.height);
    view.put(recording.view.jitter);
    view.put(recording.settings.occlusion_size);
    view.put(static_cast<uint32_t>(recording.settings.masked ? OcclusionDetail::kMasked : OcclusionDetail::kFull) |
             static_cast<uint32_t>(recording.settings.close_gaps * kGapSteps) << 8);
    putOccluders(sections, recording);
    for (const auto& instance : recording.instances) {
        instances.put(instance.occluder);
        put(instances, instance.transform);
    }
    for (const auto& draw : recording.draws) {
        draws.put(draw.instance);
        draws.put(draw.cluster);
    }
    putAsked(sections, recording.asked);

    Array<char> hashed(memory), file(memory);
    ByteWriter sizes(hashed), head(file);
    for (const Array<char>& section : sections) sizes.put(uint64_t{section.size()});
    for (const Array<char>& section : sections) hashed.insert(hashed.end(), section.begin(), section.end());
    for (const char letter : kMagic) head.put(letter);
    head.put(kVersion);
    head.put(uint32_t{kSectionCount});
    head.put(contentHash(hashed));
    file.insert(file.end(), hashed.begin(), hashed.end());
    return file;
}

}  // namespace sightline
