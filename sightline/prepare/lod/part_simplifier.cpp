// Makes one part of a mesh simpler by collapsing edges, and gives its corners vertices of the part again.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/lod/part_simplifier.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <meshoptimizer.h>

#include "sightline/math/box.h"

namespace sightline {
namespace {

constexpr uint32_t kMostCopies = 64;  // of a place that are chosen from: a fan's tip may have thousands

/// Of length one, or zero.
glm::dvec3 directionOf(const glm::dvec3& v) {
    const double most = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(most > 0)) return glm::dvec3(0.0);
    return glm::normalize(v / most);  // neither squares of what is very small nor of what is very large
}

glm::dvec3 normalOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return directionOf(glm::cross(b - a, c - a));
}

}  // namespace

PartSimplifier::PartSimplifier(const MeshView& mesh, std::span<const uint32_t> indices, std::span<const uint32_t> place,
                               bool lock_borders)
    : mesh_(mesh), lock_borders_(lock_borders) {
    // Numbers of the part's own places, in their order among all.
    std::vector<uint32_t> used;
    used.reserve(indices.size());
    for (const uint32_t vertex : indices) used.push_back(place[vertex]);
    std::vector<uint32_t> own = used;
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    for (uint32_t& number : used)
        number = static_cast<uint32_t>(std::lower_bound(own.begin(), own.end(), number) - own.begin());
    first_.assign(own.size(), kNone);

    Box3d box;
    for (const uint32_t vertex : indices) box.grow(glm::dvec3(mesh.positions[vertex]));
    if (box.empty()) return;
    extent_ = std::max({box.size().x, box.size().y, box.size().z});
    const double shrink = extent_ > 0 ? 1 / extent_ : 0;
    places_.resize(own.size());
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        glm::dvec3 corner[3];
        for (size_t k = 0; k < 3; ++k) corner[k] = glm::dvec3(mesh.positions[indices[t + k]]);
        const glm::dvec3 normal = normalOf(corner[0], corner[1], corner[2]);
        const glm::dvec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
        for (size_t k = 0; k < 3; ++k) {
            places_[used[t + k]] = glm::vec3((corner[k] - box.center()) * shrink);
            if (Copy* copy = copyOf(used[t + k], indices[t + k])) {
                copy->normal += normal;
                copy->way += directionOf(middle - corner[k]);
            }
        }
        if (used[t] != used[t + 1] && used[t + 1] != used[t + 2] && used[t + 2] != used[t])
            indices_.insert(indices_.end(), {used[t], used[t + 1], used[t + 2]});
    }
    for (Copy& copy : copies_) copy.normal = directionOf(copy.normal), copy.way = directionOf(copy.way);
    scale_ = meshopt_simplifyScale(&places_[0].x, places_.size(), sizeof(glm::vec3));
}

PartSimplifier::Copy* PartSimplifier::copyOf(uint32_t local, uint32_t vertex) {
    uint32_t* at = &first_[local];
    uint32_t before = 0;
    for (; *at != kNone && copies_[*at].vertex != vertex; at = &copies_[*at].next)
        if (++before == kMostCopies) return nullptr;
    if (*at == kNone) {
        *at = static_cast<uint32_t>(copies_.size());  // before the array moves
        copies_.push_back({vertex, kNone});
        return &copies_.back();
    }
    return &copies_[*at];
}

glm::dvec3 PartSimplifier::positionOf(uint32_t local) const {
    return glm::dvec3(mesh_.positions[copies_[first_[local]].vertex]);
}

std::vector<uint32_t> PartSimplifier::collapse(size_t triangles, double error) const {
    if (indices_.empty() || !(extent_ > 0)) return indices_;
    std::vector<uint32_t> out(indices_.size());
    const double most = std::min(error / (extent_ * scale_), double{std::numeric_limits<float>::max()});
    out.resize(meshopt_simplify(out.data(), indices_.data(), indices_.size(), &places_[0].x, places_.size(),
                                sizeof(glm::vec3), std::min(3 * triangles, indices_.size()), static_cast<float>(most),
                                lock_borders_ ? meshopt_SimplifyLockBorder : 0, nullptr));
    return out;
}

std::vector<uint32_t> PartSimplifier::merge(size_t triangles) const {
    if (indices_.empty() || !(extent_ > 0)) return indices_;
    std::vector<uint32_t> out(indices_.size());
    out.resize(meshopt_simplifySloppy(out.data(), indices_.data(), indices_.size(), &places_[0].x, places_.size(),
                                      sizeof(glm::vec3), std::min(3 * triangles, indices_.size()), 1.0f, nullptr));
    return out;
}

void PartSimplifier::writeCorners(std::span<const uint32_t> triangles, std::vector<uint32_t>& out) const {
    for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const glm::dvec3 a = positionOf(triangles[t]), b = positionOf(triangles[t + 1]),
                         c = positionOf(triangles[t + 2]);
        const glm::dvec3 normal = normalOf(a, b, c), middle = (a + b + c) / 3.0;
        for (size_t k = 0; k < 3; ++k) {
            uint32_t best = first_[triangles[t + k]];
            if (copies_[best].next != kNone) {
                const glm::dvec3 way = directionOf(middle - positionOf(triangles[t + k]));
                double most = -std::numeric_limits<double>::infinity();
                for (uint32_t i = best; i != kNone; i = copies_[i].next) {
                    const double likeness = glm::dot(copies_[i].normal, normal) + glm::dot(copies_[i].way, way);
                    if (likeness > most) most = likeness, best = i;
                }
            }
            out.push_back(copies_[best].vertex);
        }
    }
}

}  // namespace sightline
