// A tree of boxes over triangles that finds the one nearest to a point.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/lod/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sightline {
namespace {

constexpr uint32_t kMostInLeaf = 2;
constexpr size_t kDeepest = 64;  // halves of 2^32 triangles need half as many

double squaredDistance(const Box3d& box, const glm::dvec3& p) {
    const glm::dvec3 out = glm::max(glm::max(box.min - p, p - box.max), glm::dvec3(0.0));
    return glm::dot(out, out);
}

/// How far all of the triangle lies beyond the plane through the point that the direction is normal to: it is no
/// nearer.
double beyond(const TriangleCorners& t, const glm::dvec3& p, const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0)) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& corner : t.at) least = std::min(least, glm::dot(corner - p, direction));
    return std::max(least / length, 0.0);
}

/// Planes across the way to the nearest point, and along the triangle: close above a needle the way is not known well.
double leastDistance(const TriangleCorners& t, const glm::dvec3& p) {
    const glm::dvec3 way = nearestPoint(t, p) - p, normal = glm::cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
    return std::max({beyond(t, p, way), beyond(t, p, normal), beyond(t, p, -normal)});
}

}  // namespace

TriangleTree::TriangleTree(std::span<const TriangleCorners> triangles) : number_(triangles.size()) {
    if (triangles.empty()) return;
    std::iota(number_.begin(), number_.end(), 0u);
    std::vector<glm::dvec3> middle(triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i)
        middle[i] = (triangles[i].at[0] + triangles[i].at[1] + triangles[i].at[2]) / 3.0;
    struct Job {
        uint32_t node, first, count;
    };
    std::vector<Job> jobs = {{0, 0, static_cast<uint32_t>(triangles.size())}};
    nodes_.emplace_back();
    while (!jobs.empty()) {
        const Job job = jobs.back();
        jobs.pop_back();
        Box3d box, middles;
        for (uint32_t i = job.first; i < job.first + job.count; ++i) {
            for (const glm::dvec3& corner : triangles[number_[i]].at) box.grow(corner);
            middles.grow(middle[number_[i]]);
        }
        nodes_[job.node] = {box, job.first, job.count};
        if (job.count <= kMostInLeaf) continue;
        const glm::dvec3 size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const uint32_t half = job.count / 2;
        const auto begin = number_.begin() + job.first;
        std::nth_element(begin, begin + half, begin + job.count, [&](uint32_t a, uint32_t b) {
            return middle[a][axis] != middle[b][axis] ? middle[a][axis] < middle[b][axis] : a < b;
        });
        const auto child = static_cast<uint32_t>(nodes_.size());
        nodes_[job.node].first = child;
        nodes_[job.node].count = 0;
        nodes_.resize(nodes_.size() + 2);
        jobs.push_back({child, job.first, half});
        jobs.push_back({child + 1, job.first + half, job.count - half});
    }
    triangles_.reserve(triangles.size());
    for (const uint32_t i : number_) triangles_.push_back(triangles[i]);
}

template <class AtLeaf>
void TriangleTree::visit(const glm::dvec3& point, const double& squared, AtLeaf atLeaf) const {
    if (nodes_.empty()) return;
    struct Open {
        uint32_t node;
        double squared;
    };
    Open open[kDeepest];
    size_t count = 0;
    open[count++] = {0, squaredDistance(nodes_[0].box, point)};
    while (count > 0) {
        const Open next = open[--count];
        if (!(next.squared < squared)) continue;
        const Node& node = nodes_[next.node];
        if (node.count > 0) {
            atLeaf(node);
            continue;
        }
        Open near{node.first, squaredDistance(nodes_[node.first].box, point)};
        Open far{node.first + 1, squaredDistance(nodes_[node.first + 1].box, point)};
        if (far.squared < near.squared) std::swap(near, far);
        open[count++] = far;
        open[count++] = near;
    }
}

NearTriangle TriangleTree::nearest(const glm::dvec3& point, NearTriangle best, double enough) const {
    double within = best.squared <= enough ? 0 : best.squared;
    visit(point, within, [&](const Node& node) {
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const double squared = sightline::squaredDistance(triangles_[i], point);
            if (!(squared < best.squared)) continue;
            best = {squared, number_[i]};
            within = squared;
        }
        if (best.squared <= enough) within = 0;
    });
    return best;
}

double TriangleTree::leastDistance(const glm::dvec3& point, double known) const {
    double least = known, squared = known * known;
    visit(point, squared, [&](const Node& node) {
        for (uint32_t i = node.first; i < node.first + node.count; ++i)
            least = std::min(least, sightline::leastDistance(triangles_[i], point));
        squared = least * least;
    });
    return least;
}

}  // namespace sightline
