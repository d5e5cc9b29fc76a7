// Gathers the polygons of clusters by planes.
// SPDX-License-Identifier: MIT
#include "sightline/geom/make_plane_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <vector>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr double kFlat = 2e-6;    // how far a vertex may lie from its group's plane  [radii of the cluster]
constexpr double kTilted = 2e-3;  // how much a triangle's normal may differ from its group's

struct Group {
    glm::dvec3 normal{0.0};
    double offset = 0, thick = 0, tilt = 0;
    bool both = false;
    std::vector<uint8_t> corners;
};

/// Makes one or more clusters of some polygons of a cluster.
class Gather {
public:
    Gather(const Occluder& from, uint32_t cluster, PlaneMesh& out)
        : from_(from), cluster_(from.clusters[cluster]), index_(cluster), out_(out) {}

    /// @param polygons  numbers in the cluster, one after the other

    void add(std::vector<uint32_t> polygons, bool loose) {
        if (polygons.empty()) return;
        in_.assign(256, false);
        for (const uint32_t p : polygons) in_[p] = true;
        takeVertices(polygons);
        takeGroups(polygons);
        const bool fits =
            groups_.size() <= PlaneMesh::kMostGroups && countEdges(polygons, loose) <= PlaneMesh::kMostEdges;
        if (!fits && polygons.size() == 1) {
            out_.is_whole = false;
            return;
        }
        if (!fits) {
            const auto half = polygons.begin() + static_cast<std::ptrdiff_t>(polygons.size() / 2);
            add({polygons.begin(), half}, loose);
            add({half, polygons.end()}, loose);
            return;
        }
        if (!groups_.empty()) write(polygons, loose);
    }

private:
    glm::dvec3 at(uint32_t vertex) const {
        const size_t i = size_t{cluster_.first_vertex} + vertex;
        return {from_.x[i], from_.y[i], from_.z[i]};
    }
    bool isIn(uint8_t p) const { return p != OccluderEdge::kNone && in_[p]; }
    const OccluderPolygon& polygon(uint32_t p) const { return from_.polygons[cluster_.first_polygon + p]; }

    uint8_t groupOf(uint8_t p) const { return isIn(p) ? group_of_[p] : PlaneMesh::kNoGroup; }

    size_t countEdges(const std::vector<uint32_t>& polygons, bool loose) const {
        if (loose) return 4 * polygons.size();
        size_t count = 0;
        for (uint32_t i = 0; i < cluster_.edge_count; ++i) {
            const OccluderEdge& e = from_.edges[cluster_.first_edge + i];
            count += groupOf(e.left) != groupOf(e.right);
        }
        return count;
    }

    void takeVertices(const std::vector<uint32_t>& polygons) {
        place_.assign(cluster_.vertex_count, -1);
        vertices_.clear();
        Box3d box;
        const auto take = [&](uint8_t v) {
            if (place_[v] >= 0) return;
            place_[v] = static_cast<int>(vertices_.size());
            vertices_.push_back(v);
            box.grow(at(v));
        };
        for (const uint32_t p : polygons)
            for (int k = 0; k < polygon(p).corners(); ++k) take(polygon(p).vertex[k]);
        // A side that several neighbours share is in parts, which end at their corners.
        for (uint32_t i = 0; i < cluster_.edge_count; ++i) {
            const OccluderEdge& e = from_.edges[cluster_.first_edge + i];
            if (!isIn(e.left) && !isIn(e.right)) continue;
            take(e.from);
            take(e.to);
        }
        centre_ = glm::vec3(box.center());
        half_ = glm::max(box.max - glm::dvec3(centre_), glm::dvec3(centre_) - box.min);
        radius_ = 0;
        for (const uint8_t v : vertices_) radius_ = std::max(radius_, glm::distance(at(v), glm::dvec3(centre_)));
    }

    /// The normals of a polygon's triangles; none where they have no area to speak of.
    std::vector<glm::dvec3> normalsOf(const glm::dvec3 (&q)[4], int corners) const {
        std::vector<glm::dvec3> out;
        for (int k = 2; k < corners; ++k) {
            const glm::dvec3 area = glm::cross(q[k - 1] - q[0], q[k] - q[0]);
            const double length = glm::length(area);
            if (length > 1e-14 * radius_ * radius_) out.push_back(area / length);
        }
        return out;
    }

    void takeGroups(const std::vector<uint32_t>& polygons) {
        groups_.clear();
        group_of_.assign(256, PlaneMesh::kNoGroup);
        for (const uint32_t p : polygons) {
            glm::dvec3 q[4];
            const int corners = polygon(p).corners();
            for (int k = 0; k < corners; ++k) q[k] = at(polygon(p).vertex[k]) - glm::dvec3(centre_);
            const std::vector<glm::dvec3> normals = normalsOf(q, corners);
            if (static_cast<int>(normals.size()) != corners - 2) {
                out_.is_whole = false;
                continue;
            }
            const auto fit = [&](const Group& group, double& thick, double& tilt) {
                thick = tilt = 0;
                for (int k = 0; k < corners; ++k)
                    thick = std::max(thick, std::abs(glm::dot(group.normal, q[k]) - group.offset));
                for (const glm::dvec3& n : normals) tilt = std::max(tilt, glm::distance(n, group.normal));
                return group.both == polygon(p).double_sided && thick <= kFlat * radius_ && tilt <= kTilted;
            };
            double thick = 0, tilt = 0;
            size_t g = 0;
            while (g < groups_.size() && !fit(groups_[g], thick, tilt)) ++g;
            if (g == groups_.size()) {
                Group fresh;
                fresh.normal = corners == 4 ? glm::normalize(normals[0] + normals[1]) : normals[0];
                fresh.offset = glm::dot(fresh.normal, q[0]);
                fresh.both = polygon(p).double_sided;
                fit(fresh, thick, tilt);
                groups_.push_back(fresh);
            }
            Group& group = groups_[g];
            group.thick = std::max(group.thick, thick);
            group.tilt = std::max(group.tilt, tilt);
            for (int k = 0; k < corners; ++k)
                group.corners.push_back(static_cast<uint8_t>(place_[polygon(p).vertex[k]]));
            group_of_[p] = static_cast<uint8_t>(g);
            if (groups_.size() > PlaneMesh::kMostGroups) return;
        }
    }

    template <class T>
    static void pad(Array<T>& array, T with) {
        while (array.size() % PlaneMesh::kPadding) array.push_back(with);
    }

    void write(const std::vector<uint32_t>& polygons, bool loose) {
        PlaneMesh::Part part;
        part.centre = centre_;
        part.half = glm::vec3(half_ * (1 + 1e-6));
        part.radius = static_cast<float>(radius_ * (1 + 1e-6));
        part.first_vertex = static_cast<uint32_t>(out_.x.size());
        part.vertices = static_cast<uint32_t>(vertices_.size());
        for (const uint8_t v : vertices_) {
            const glm::dvec3 r = at(v) - glm::dvec3(centre_);
            out_.x.push_back(static_cast<float>(r.x));
            out_.y.push_back(static_cast<float>(r.y));
            out_.z.push_back(static_cast<float>(r.z));
            out_.source.push_back(v);
        }
        part.cluster = index_;
        part.first_polygon = polygons.front();
        part.polygons = static_cast<uint32_t>(polygons.size());
        part.first_group_of = static_cast<uint32_t>(out_.group_of.size());
        for (const uint32_t p : polygons) out_.group_of.push_back(group_of_[p]);
        while (out_.source.size() < out_.x.size() || out_.source.size() % PlaneMesh::kPadding)
            out_.source.push_back(out_.source.back());
        for (Array<float>* list : {&out_.x, &out_.y, &out_.z}) pad(*list, list->back());
        part.first_group = static_cast<uint32_t>(out_.nx.size());
        part.groups = static_cast<uint32_t>(groups_.size());
        for (Group& group : groups_) {
            out_.nx.push_back(static_cast<float>(group.normal.x));
            out_.ny.push_back(static_cast<float>(group.normal.y));
            out_.nz.push_back(static_cast<float>(group.normal.z));
            out_.nd.push_back(static_cast<float>(group.offset));
            out_.thick.push_back(static_cast<float>(group.thick * 1.001 + 0x1p-22 * radius_));
            out_.tilt.push_back(static_cast<float>(group.tilt * 1.001));
            out_.both.push_back(group.both ? 1.0f : 0.0f);
            std::sort(group.corners.begin(), group.corners.end());
            group.corners.erase(std::unique(group.corners.begin(), group.corners.end()), group.corners.end());
            out_.first_corner.push_back(static_cast<uint32_t>(out_.corners.size()));
            out_.corner_count.push_back(static_cast<uint32_t>(group.corners.size()));
            for (const uint8_t corner : group.corners) out_.corners.push_back(corner);
        }
        for (Array<float>* list : {&out_.nx, &out_.ny, &out_.nz, &out_.nd, &out_.thick, &out_.tilt, &out_.both})
            pad(*list, 0.0f);
        pad(out_.first_corner, uint32_t{0});
        pad(out_.corner_count, uint32_t{0});
        writeEdges(polygons, loose, part);
        out_.parts.push_back(part);
    }

    void writeEdges(const std::vector<uint32_t>& polygons, bool loose, PlaneMesh::Part& part) {
        part.first_edge = static_cast<uint32_t>(out_.from.size());
        const auto edge = [&](uint8_t a, uint8_t b, uint8_t left, uint8_t right) {
            if (left == right) return;
            SIGHTLINE_DEBUG_ASSERT(place_[a] >= 0 && place_[b] >= 0);
            out_.from.push_back(static_cast<uint8_t>(place_[a]));
            out_.to.push_back(static_cast<uint8_t>(place_[b]));
            out_.left.push_back(left);
            out_.right.push_back(right);
        };
        if (loose) {
            for (const uint32_t p : polygons)
                for (int k = 0, n = polygon(p).corners(); k < n; ++k)
                    edge(polygon(p).vertex[k], polygon(p).vertex[(k + 1) % n], group_of_[p], PlaneMesh::kNoGroup);
        } else {
            for (uint32_t i = 0; i < cluster_.edge_count; ++i) {
                const OccluderEdge& e = from_.edges[cluster_.first_edge + i];
                edge(e.from, e.to, groupOf(e.left), groupOf(e.right));
            }
        }
        part.edges = static_cast<uint32_t>(out_.from.size()) - part.first_edge;
        uint32_t border = 0;
        for (uint32_t e = part.first_edge; e < part.first_edge + part.edges; ++e)
            border += out_.left[e] == PlaneMesh::kNoGroup || out_.right[e] == PlaneMesh::kNoGroup;
        part.cost = PlaneMesh::kLeastCost + border + (part.edges - border) / 8;
        for (Array<uint8_t>* list : {&out_.from, &out_.to}) pad(*list, uint8_t{0});
        for (Array<uint8_t>* list : {&out_.left, &out_.right}) pad(*list, PlaneMesh::kNoGroup);
    }

    const Occluder& from_;
    const OccluderCluster& cluster_;
    const uint32_t index_;
    PlaneMesh& out_;
    std::vector<bool> in_;  ///< polygons that are taken
    std::vector<int> place_;
    std::vector<uint8_t> vertices_, group_of_;
    std::vector<Group> groups_;
    glm::vec3 centre_{0.0f};
    glm::dvec3 half_{0.0};
    double radius_ = 0;
};

}  // namespace

void makePlaneMesh(Occluder& occluder) {
    PlaneMesh out(occluder.x.memory());
    std::vector<uint32_t> some;
    for (uint32_t c = 0; c < occluder.clusters.size(); ++c) {
        const OccluderCluster& cluster = occluder.clusters[c];
        out.first_part.push_back(static_cast<uint32_t>(out.parts.size()));
        some.resize(cluster.polygon_count + cluster.ring_count);
        std::iota(some.begin(), some.end(), 0u);
        Gather(occluder, c, out).add(some, cluster.edge_count == 0);
    }
    out.first_part.push_back(static_cast<uint32_t>(out.parts.size()));
    occluder.planes = std::move(out);
}

}  // namespace sightline
