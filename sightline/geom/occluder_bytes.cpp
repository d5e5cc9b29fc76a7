// Writes occluders as bytes, and reads them.
// SPDX-License-Identifier: MIT
#include "sightline/geom/occluder_bytes.h"
#include "sightline/geom/make_plane_mesh.h"

#include <cmath>

namespace sightline {

using namespace occluder_bytes;

namespace {

bool holds(const Box3f& box, const glm::vec3& p) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] <= p[axis] && p[axis] <= box.max[axis])) return false;
    return true;
}

}  // namespace

void putOccluder(const Occluder& occluder, std::span<Array<char>, kRuns> runs) {
    ByteWriter head(runs[kHeads]), clusters(runs[kClusters]), vertices(runs[kVertices]), polygons(runs[kPolygons]),
        edges(runs[kEdges]);
    putBox(head, occluder.clusters.empty() ? Box3f() : occluder.bounds);
    for (const size_t count :
         {occluder.clusters.size(), occluder.x.size(), occluder.polygons.size(), occluder.edges.size()})
        head.put(static_cast<uint32_t>(count));
    for (const OccluderCluster& c : occluder.clusters) {
        putBox(clusters, c.bounds);
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

bool takeFinite(ByteCursor& from, float& value, ByteFault& fault) {
    const uint64_t at = from.at();
    value = from.take<float>();
    return std::isfinite(value) || fault.wrong("a number that is not finite", at);
}

bool takeBox(ByteCursor& from, Box3f& box, ByteFault& fault) {
    const uint64_t at = from.at();
    for (glm::vec3* corner : {&box.min, &box.max})
        for (int axis = 0; axis < 3; ++axis)
            if (!takeFinite(from, (*corner)[axis], fault)) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] <= box.max[axis])) return fault.wrong("bounds that are empty", at);
    return true;
}

bool OccluderReader::take(Occluder& occluder) {
    if (!fault_.none()) return false;
    ByteCursor& heads = runs_[kHeads];
    if (heads.left() < kRecordBytes[kHeads]) return wrong("fewer occluders than forms", heads.at());
    ByteCursor bounds = heads;
    for (int i = 0; i < 6; ++i) heads.take<float>();
    const auto reserve = [&](Run run, auto... arrays) {
        const uint64_t at = heads.at(), count = heads.take<uint32_t>();
        if (count > runs_[run].left() / kRecordBytes[run]) return wrong("an occluder that has more than the file", at);
        (arrays->reserve(count), ...);
        counts_[run] = count;
        return true;
    };
    const uint64_t at = heads.at();
    if (!reserve(kClusters, &occluder.clusters) || !reserve(kVertices, &occluder.x, &occluder.y, &occluder.z) ||
        !reserve(kPolygons, &occluder.polygons) || !reserve(kEdges, &occluder.edges))
        return false;
    if (counts_[kClusters] > 0) {
        if (!takeBox(bounds, occluder.bounds, fault_) || !takeParts(occluder)) return false;
        makePlaneMesh(occluder);
        return true;
    }
    return counts_[kVertices] + counts_[kPolygons] + counts_[kEdges] == 0 ||
           wrong("an occluder without clusters that has parts", at);
}

bool OccluderReader::end() {
    for (const Run run : {kHeads, kClusters, kVertices, kPolygons, kEdges})
        if (runs_[run].left() > 0) return wrong("more than the occluders have", runs_[run].at());
    return fault_.none();
}

/// Vertices, polygons and edges first: the clusters are what holds them to each other.
bool OccluderReader::takeParts(Occluder& occluder) {
    for (uint64_t i = 0; i < counts_[kVertices]; ++i)
        for (Array<float>* axis : {&occluder.x, &occluder.y, &occluder.z}) {
            float value = 0;
            if (!takeFinite(runs_[kVertices], value, fault_)) return false;
            axis->push_back(value);
        }
    polygons_at_ = runs_[kPolygons].at();
    for (uint64_t i = 0; i < counts_[kPolygons]; ++i) {
        OccluderPolygon& polygon = occluder.polygons.emplace_back();
        for (uint8_t& vertex : polygon.vertex) vertex = runs_[kPolygons].take<uint8_t>();
        const uint64_t at = runs_[kPolygons].at();
        const uint8_t sides = runs_[kPolygons].take<uint8_t>();
        if (sides > 1) return wrong("a polygon with neither one side nor two", at);
        polygon.double_sided = sides == 1;
    }
    edges_at_ = runs_[kEdges].at();
    for (uint64_t i = 0; i < counts_[kEdges]; ++i) {
        OccluderEdge& edge = occluder.edges.emplace_back();
        for (uint8_t* value : {&edge.from, &edge.to, &edge.left, &edge.right}) *value = runs_[kEdges].take<uint8_t>();
    }
    for (uint64_t i = 0; i < counts_[kClusters]; ++i)
        if (!takeCluster(occluder)) return false;
    return true;
}

bool OccluderReader::takeCluster(Occluder& occluder) {
    ByteCursor& from = runs_[kClusters];
    const uint64_t at = from.at();
    OccluderCluster& c = occluder.clusters.emplace_back();
    if (!takeBox(from, c.bounds, fault_)) return false;
    for (uint32_t* value : {&c.first_vertex, &c.vertex_count, &c.first_polygon, &c.polygon_count, &c.ring_count,
                            &c.first_edge, &c.edge_count})
        *value = from.take<uint32_t>();
    const auto within = [](uint64_t first, uint64_t count, uint64_t size) { return first + count <= size; };
    if (!holds(occluder.bounds, c.bounds.min) || !holds(occluder.bounds, c.bounds.max))
        return wrong("a cluster that its occluder's bounds do not hold", at);
    if (c.first_vertex % 8 != 0 || c.vertex_count == 0 || c.vertex_count > OccluderCluster::kMaxVertices ||
        !within(c.first_vertex, (uint64_t{c.vertex_count} + 7) / 8 * 8, occluder.x.size()))
        return wrong("a cluster with vertices that there are not", at);
    const uint64_t polygons = uint64_t{c.polygon_count} + c.ring_count;
    const uint64_t most = c.edge_count > 0 ? OccluderCluster::kMaxOwn : OccluderCluster::kMaxLoose;
    if (c.polygon_count == 0 || c.polygon_count > most || polygons > OccluderCluster::kMaxPolygons ||
        !within(c.first_polygon, polygons, occluder.polygons.size()))
        return wrong("a cluster with polygons that there are not", at);
    if (c.edge_count > 4 * OccluderCluster::kMaxVertices * OccluderCluster::kMaxPolygons ||
        !within(c.first_edge, c.edge_count, occluder.edges.size()))
        return wrong("a cluster with edges that there are not", at);
    if (!checkPolygons(occluder, c, static_cast<uint32_t>(polygons))) return false;
    for (uint32_t i = c.first_edge; i < c.first_edge + c.edge_count; ++i) {
        const OccluderEdge& edge = occluder.edges[i];
        if (edge.from >= c.vertex_count || edge.to >= c.vertex_count || edge.from == edge.to || edge.left >= polygons ||
            (edge.right >= polygons && edge.right != OccluderEdge::kNone))
            return wrong("an edge between what there is not", edges_at_ + kRecordBytes[kEdges] * i);
    }
    return true;
}

bool OccluderReader::checkPolygons(const Occluder& occluder, OccluderCluster& c, uint32_t polygons) {
    for (uint32_t i = 0; i < polygons; ++i) {
        const OccluderPolygon& polygon = occluder.polygons[c.first_polygon + i];
        const uint64_t at = polygons_at_ + kRecordBytes[kPolygons] * (c.first_polygon + i);
        if (i < c.polygon_count) c.triangle_count += static_cast<uint32_t>(polygon.corners() - 2);
        for (int k = 0; k < polygon.corners(); ++k) {
            if (polygon.vertex[k] >= c.vertex_count) return wrong("a polygon of a vertex that there is not", at);
            for (int j = 0; j < k; ++j)
                if (polygon.vertex[j] == polygon.vertex[k]) return wrong("a polygon that names a vertex twice", at);
            const uint32_t vertex = c.first_vertex + polygon.vertex[k];
            if (i < c.polygon_count && !holds(c.bounds, {occluder.x[vertex], occluder.y[vertex], occluder.z[vertex]}))
                return wrong("a polygon that its cluster's bounds do not hold", at);
        }
    }
    return true;
}

}  // namespace sightline
