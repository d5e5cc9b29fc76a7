// Writes runs of polygons as an occluder's clusters, with the edges of those that hang together.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/clusters.h"

#include <algorithm>

#include "sightline/prepare/side_pairs.h"

namespace sightline {
namespace {

constexpr uint8_t kNone = OccluderEdge::kNone;

/// A polygon's side by the cluster's numbers of its vertices.
struct LocalSide : PatchSide {
    uint8_t member;  ///< the polygon's number in the cluster
};

/// Makes one cluster after the other; keeps what they would otherwise allocate again and again.
class ClusterWriter {
public:
    ClusterWriter(Occluder& out, const Patchwork& patchwork)
        : out_(out),
          patchwork_(patchwork),
          met_(patchwork.positions.size(), 0),
          local_(patchwork.positions.size(), 0) {}

    void add(std::span<const uint32_t> own, bool joined) {
        ++mark_;
        vertices_.clear();
        members_.assign(own.begin(), own.end());
        OccluderCluster cluster;
        cluster.first_vertex = static_cast<uint32_t>(out_.x.size());
        cluster.first_polygon = static_cast<uint32_t>(out_.polygons.size());
        cluster.polygon_count = static_cast<uint32_t>(own.size());
        for (uint32_t id : members_) {
            const PatchPolygon& polygon = patchwork_.polygons[id];
            OccluderPolygon& kept = out_.polygons.emplace_back();
            for (int k = 0; k < polygon.corners; ++k) kept.vertex[k] = localOf(polygon.vertex[k]);
            kept.double_sided = polygon.double_sided;
            cluster.triangle_count += polygon.corners - 2u;
        }
        for (uint32_t vertex : vertices_) cluster.bounds.grow(patchwork_.positions[vertex]);
        cluster.first_edge = static_cast<uint32_t>(out_.edges.size());
        if (joined) addEdges();
        cluster.edge_count = static_cast<uint32_t>(out_.edges.size()) - cluster.first_edge;
        cluster.vertex_count = static_cast<uint32_t>(vertices_.size());
        addVertices();
        out_.bounds.grow(cluster.bounds);
        out_.clusters.push_back(cluster);
    }

private:
    uint8_t localOf(uint32_t vertex) {
        if (met_[vertex] != mark_) {
            met_[vertex] = mark_;
            local_[vertex] = static_cast<uint8_t>(vertices_.size());
            vertices_.push_back(vertex);
        }
        return local_[vertex];
    }

    void addVertices() {
        while (vertices_.size() % 8) vertices_.push_back(vertices_.back());
        for (uint32_t vertex : vertices_) {
            const glm::vec3& p = patchwork_.positions[vertex];
            out_.x.push_back(p.x);
            out_.y.push_back(p.y);
            out_.z.push_back(p.z);
        }
    }

    void addEdges() {
        sides_.clear();
        for (uint32_t i = 0; i < members_.size(); ++i) {
            const PatchPolygon& polygon = patchwork_.polygons[members_[i]];
            for (uint8_t k = 0; k < polygon.corners; ++k) {
                const uint8_t from = local_[polygon.vertex[k]], to = local_[polygon.vertex[(k + 1) % polygon.corners]];
                sides_.push_back(
                    {{std::min(from, to), std::max(from, to), members_[i], k, from < to}, static_cast<uint8_t>(i)});
            }
        }
        std::sort(sides_.begin(), sides_.end(), [](const LocalSide& a, const LocalSide& b) {
            return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.member < b.member;
        });
        for (size_t i = 0, end = 0; i < sides_.size(); i = end) {
            shared_.clear();
            for (; end < sides_.size() && sides_[end].joins(sides_[i]); ++end) shared_.push_back(sides_[end]);
            pairSides(patchwork_, shared_, pairs_);
            const auto memberOf = [&](uint32_t at) { return at == SidePair::kNone ? kNone : sides_[i + at].member; };
            const uint8_t low = static_cast<uint8_t>(sides_[i].low), high = static_cast<uint8_t>(sides_[i].high);
            for (const SidePair& pair : pairs_) {
                if (pair.forward == SidePair::kNone) out_.edges.push_back({high, low, memberOf(pair.backward), kNone});
                else out_.edges.push_back({low, high, memberOf(pair.forward), memberOf(pair.backward)});
            }
        }
    }

    Occluder& out_;
    const Patchwork& patchwork_;
    std::vector<uint32_t> met_;   ///< per vertex: the cluster that met it last
    std::vector<uint8_t> local_;  ///< per vertex: its number there
    uint32_t mark_ = 0;
    std::vector<uint32_t> vertices_;  ///< of the cluster
    std::vector<uint32_t> members_;   ///< its polygons
    std::vector<LocalSide> sides_;
    std::vector<PatchSide> shared_;
    std::vector<SidePair> pairs_;
};

}  // namespace

void addClusters(Occluder& out, const Patchwork& patchwork, const Runs& runs, size_t first, size_t last) {
    ClusterWriter writer(out, patchwork);
    for (size_t i = first; i < last; ++i) {
        const Runs::Run& run = runs.runs[i];
        writer.add(std::span(runs.order).subspan(run.first, run.last - run.first), run.joined);
    }
}

}  // namespace sightline
