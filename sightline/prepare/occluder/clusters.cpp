// Writes runs of polygons as an occluder's clusters, with the edges and rings of those that hang together.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/clusters.h"

#include <algorithm>

namespace sightline {
namespace {

constexpr uint8_t kNone = OccluderEdge::kNone;
constexpr size_t kMostAround = 256;  // a vertex with more polygons brings none into a ring

}  // namespace

ClusterWriter::ClusterWriter(const Patchwork& patchwork, const Runs& runs, bool rings)
    : patchwork_(patchwork), runs_(runs), met_(patchwork.positions.size(), 0), local_(patchwork.positions.size(), 0) {
    if (!rings) return;
    met_polygon_.assign(patchwork.polygons.size(), 0);
    touched_.assign(patchwork.positions.size(), 0);
    const auto forVertices = [&](auto each) {
        for (uint32_t i = 0; i < patchwork.polygons.size(); ++i)
            patchwork.forLoop(i, [&](uint32_t vertex) { each(vertex, i); });
    };
    first_around_.assign(patchwork.positions.size() + 1, 0);
    forVertices([&](uint32_t vertex, uint32_t) { ++first_around_[vertex + 1]; });
    for (size_t v = 1; v < first_around_.size(); ++v) first_around_[v] += first_around_[v - 1];
    around_.resize(first_around_.back());
    std::vector<uint32_t> next(first_around_.begin(), first_around_.end() - 1);
    forVertices([&](uint32_t vertex, uint32_t polygon) { around_[next[vertex]++] = polygon; });
}

void ClusterWriter::add(Occluder& out, const Runs::Run& run) {
    ++mark_;
    vertices_.clear();
    members_.assign(runs_.order.begin() + run.first, runs_.order.begin() + run.last);
    OccluderCluster cluster;
    cluster.polygon_count = run.last - run.first;
    for (uint32_t id : members_) {
        const PatchPolygon& polygon = patchwork_.polygons[id];
        for (int k = 0; k < polygon.corners; ++k) localOf(polygon.vertex[k]);
        cluster.triangle_count += polygon.corners - 2u;
    }
    for (uint32_t vertex : vertices_) cluster.bounds.grow(patchwork_.positions[vertex]);
    if (run.joined && !around_.empty()) addRing();
    cluster.ring_count = static_cast<uint32_t>(members_.size()) - cluster.polygon_count;
    cluster.vertex_count = static_cast<uint32_t>(vertices_.size());
    cluster.first_vertex = static_cast<uint32_t>(out.x.size());
    cluster.first_polygon = static_cast<uint32_t>(out.polygons.size());
    cluster.first_edge = static_cast<uint32_t>(out.edges.size());
    addPolygons(out);
    if (run.joined) addEdges(out);
    addVertices(out);
    cluster.edge_count = static_cast<uint32_t>(out.edges.size()) - cluster.first_edge;
    out.clusters.push_back(cluster);
}

uint8_t ClusterWriter::localOf(uint32_t vertex) {
    if (met_[vertex] != mark_) {
        met_[vertex] = mark_;
        local_[vertex] = static_cast<uint8_t>(vertices_.size());
        vertices_.push_back(vertex);
    }
    return local_[vertex];
}

/// Takes in the polygons that hang together with the cluster's own and touch them at a vertex: those with a side or a
/// part of one in common first, as far as the limits allow. One that is left out only leaves its sides open.
void ClusterWriter::addRing() {
    struct Neighbour {
        uint32_t touches;  ///< vertices of the cluster's own
        uint32_t polygon;
    };
    touching_.clear();
    for (uint32_t id : members_) {
        met_polygon_[id] = mark_;
        patchwork_.forLoop(id, [&](uint32_t vertex) {
            if (touched_[vertex] != mark_) touching_.push_back(vertex);
            touched_[vertex] = mark_;
        });
    }
    const uint32_t whole = runs_.whole[members_[0]];
    std::vector<Neighbour> neighbours;
    for (uint32_t vertex : touching_) {
        const uint32_t first = first_around_[vertex], last = first_around_[vertex + 1];
        if (last - first > kMostAround) continue;
        for (uint32_t i = first; i < last; ++i) {
            const uint32_t id = around_[i];
            if (met_polygon_[id] == mark_ || runs_.whole[id] != whole) continue;
            met_polygon_[id] = mark_;
            uint32_t touches = 0;
            patchwork_.forLoop(id, [&](uint32_t v) { touches += touched_[v] == mark_; });
            neighbours.push_back({touches, id});
        }
    }
    std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
        return a.touches != b.touches ? a.touches > b.touches : a.polygon < b.polygon;
    });
    for (const Neighbour& neighbour : neighbours) {
        if (members_.size() == OccluderCluster::kMaxPolygons) return;
        const PatchPolygon& polygon = patchwork_.polygons[neighbour.polygon];
        size_t added = 0;
        for (int k = 0; k < polygon.corners; ++k) added += met_[polygon.vertex[k]] != mark_;
        if (vertices_.size() + added > OccluderCluster::kMaxVertices) continue;
        for (int k = 0; k < polygon.corners; ++k) localOf(polygon.vertex[k]);
        members_.push_back(neighbour.polygon);
    }
}

void ClusterWriter::addPolygons(Occluder& out) {
    for (uint32_t id : members_) {
        const PatchPolygon& polygon = patchwork_.polygons[id];
        OccluderPolygon& kept = out.polygons.emplace_back();
        for (int k = 0; k < polygon.corners; ++k) kept.vertex[k] = local_[polygon.vertex[k]];
        kept.double_sided = polygon.double_sided;
    }
}

void ClusterWriter::addEdges(Occluder& out) {
    sides_.clear();
    for (uint32_t i = 0; i < members_.size(); ++i) {
        const PatchPolygon& polygon = patchwork_.polygons[members_[i]];
        for (uint8_t k = 0; k < polygon.corners; ++k) {
            uint8_t from = local_[polygon.vertex[k]];
            const auto go = [&](uint32_t vertex) {
                if (met_[vertex] != mark_) return;  // nobody's corner in this cluster
                const uint8_t to = local_[vertex];
                sides_.push_back(
                    {{std::min(from, to), std::max(from, to), members_[i], k, from < to}, static_cast<uint8_t>(i)});
                from = to;
            };
            for (uint32_t vertex : patchwork_.chain(members_[i], k)) go(vertex);
            go(polygon.vertex[(k + 1) % polygon.corners]);
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
            if (pair.forward == SidePair::kNone) out.edges.push_back({high, low, memberOf(pair.backward), kNone});
            else out.edges.push_back({low, high, memberOf(pair.forward), memberOf(pair.backward)});
        }
    }
}

void ClusterWriter::addVertices(Occluder& out) {
    while (vertices_.size() % 8) vertices_.push_back(vertices_.back());
    for (uint32_t vertex : vertices_) {
        const glm::vec3& p = patchwork_.positions[vertex];
        out.bounds.grow(p);
        out.x.push_back(p.x);
        out.y.push_back(p.y);
        out.z.push_back(p.z);
    }
}

}  // namespace sightline
