// The region from which a cluster is seen from its back, as a solid that can be drawn.
// SPDX-License-Identifier: MIT
#include "tests/prepare/facing/volume_polyhedron.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

using Face = std::vector<glm::dvec3>;

std::vector<Face> facesOf(const Box3d& box) {
    const auto corner = [&](int i) {
        return glm::dvec3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
    };
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    std::vector<Face> faces;
    for (const auto& face : kFaces) {
        Face& made = faces.emplace_back();
        for (const int i : face) made.push_back(corner(i));
    }
    return faces;
}

/// The face that a cut leaves: the points on it, around their middle.
Face capOf(std::vector<glm::dvec3> points, const glm::dvec3& normal, double tolerance) {
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& p : points) middle += p / static_cast<double>(points.size());
    const glm::dvec3 other = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, normal)), v = glm::cross(normal, u);
    const auto angle = [&](const glm::dvec3& p) {
        return std::atan2(glm::dot(v, p - middle), glm::dot(u, p - middle));
    };
    std::sort(points.begin(), points.end(),
              [&](const glm::dvec3& a, const glm::dvec3& b) { return angle(a) < angle(b); });
    Face cap;
    for (const glm::dvec3& p : points)
        if (cap.empty() || glm::distance(p, cap.back()) > tolerance) cap.push_back(p);
    while (cap.size() > 1 && glm::distance(cap.front(), cap.back()) <= tolerance) cap.pop_back();
    return cap;
}

/// Keeps what has normal * p <= limit.
void cut(std::vector<Face>& faces, const glm::dvec3& normal, double limit, double tolerance) {
    std::vector<Face> kept;
    std::vector<glm::dvec3> on;
    bool any = false;
    for (const Face& face : faces) {
        Face part;
        for (size_t i = 0; i < face.size(); ++i) {
            const glm::dvec3 &a = face[i], &b = face[(i + 1) % face.size()];
            const double da = glm::dot(normal, a) - limit, db = glm::dot(normal, b) - limit;
            any |= da > tolerance;
            if (da <= tolerance) part.push_back(a);
            if (std::abs(da) <= tolerance) on.push_back(a);
            if ((da > tolerance && db < -tolerance) || (da < -tolerance && db > tolerance)) {
                part.push_back(a + da / (da - db) * (b - a));
                on.push_back(part.back());
            }
        }
        if (part.size() >= 3) kept.push_back(std::move(part));
    }
    if (!any) return;
    faces = std::move(kept);
    Face cap = faces.empty() ? Face{} : capOf(std::move(on), normal, 4.0 * tolerance);
    if (cap.size() >= 3) faces.push_back(std::move(cap));
}

}  // namespace

Polyhedron volumePolyhedron(const CullingVolume& volume, const Box3d& box) {
    std::vector<Face> faces = facesOf(box);
    const double tolerance = 1e-10 * glm::length(box.max - box.min);
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 normal;
        for (int axis = 0; axis < 3; ++axis) normal[axis] = corner >> axis & 1 ? volume.most[axis] : volume.least[axis];
        const double length = glm::length(normal);
        if (!(length > 1e-12)) {
            if (volume.back < 0) faces.clear();
            continue;
        }
        const double limit = volume.back + glm::dot(normal, glm::dvec3(volume.origin));
        cut(faces, normal / length, limit / length, tolerance);
    }
    Polyhedron out;
    if (faces.size() < 4) return out;  // no solid
    for (const Face& face : faces) {
        std::vector<uint32_t>& numbers = out.faces.emplace_back();
        for (const glm::dvec3& p : face) {
            const auto same = [&](const glm::dvec3& q) { return glm::distance(p, q) <= 8.0 * tolerance; };
            const auto at = std::find_if(out.positions.begin(), out.positions.end(), same);
            numbers.push_back(static_cast<uint32_t>(at - out.positions.begin()));
            if (at == out.positions.end()) out.positions.push_back(p);
        }
    }
    return out;
}

std::vector<uint32_t> trianglesOf(const Polyhedron& polyhedron) {
    std::vector<uint32_t> triangles;
    for (const std::vector<uint32_t>& face : polyhedron.faces)
        for (size_t i = 2; i < face.size(); ++i) triangles.insert(triangles.end(), {face[0], face[i - 1], face[i]});
    return triangles;
}

}  // namespace sightline
