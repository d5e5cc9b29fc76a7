// Records what one frame asked of its occlusion buffer.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/occlusion_recording.h"

#include <algorithm>
#include <compare>
#include <unordered_map>

#include "sightline/query/recorded_traversal.h"
#include "sightline/geom/make_plane_mesh.h"

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
            makePlaneMesh(to);
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
    using Index = std::unordered_map<const Occluder*, uint32_t, std::hash<const Occluder*>, std::equal_to<>,
                                     MemoryAllocator<std::pair<const Occluder* const, uint32_t>>>;
    Index index_;  ///< into met_
    Array<Drawn> drawn_;
    Array<uint32_t> first_;  ///< per occluder of the recording: into drawn_
};

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

}  // namespace sightline
