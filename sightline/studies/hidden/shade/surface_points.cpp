// Where a sample's line of sight meets the surface that the sample shows.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/surface_points.h"

namespace sightline::studies {

SurfacePoint SurfacePoints::at(uint32_t row, uint32_t sample, uint32_t surface) const {
    const DrawList::Place place = list_.placeOf(surface);
    const DrawItem& item = list_.items()[place.item];
    // The difference of the large translations comes first: what follows is relative to the eye.
    const glm::dmat3 turn(item.transform);
    const glm::dvec3 shift = glm::dvec3(item.transform[3]) - eye_;
    glm::dvec3 corners[3];
    for (int k = 0; k < 3; ++k) {
        const uint32_t index = item.mesh.indices[size_t{3} * place.triangle + static_cast<size_t>(k)];
        corners[k] = turn * glm::dvec3(item.mesh.positions[index]) + shift;
    }
    const Unprojection::Line line = unprojection_.lineOfSight(sample, row);
    const glm::dvec3 origin = to_world_ * line.origin, direction = to_world_ * line.direction;
    const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area = glm::dot(across, across), facing = glm::dot(across, direction);

    SurfacePoint point;
    point.item = place.item;
    point.triangle = place.triangle;
    point.weights = glm::dvec3(1, 0, 0);
    if (area > 0 && facing != 0) {
        const glm::dvec3 met = origin + glm::dot(across, corners[0] - origin) / facing * direction;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
            point.weights[k] = glm::max(0.0, glm::dot(across, glm::cross(c - b, met - b)) / area);
        }
        const double sum = point.weights.x + point.weights.y + point.weights.z;
        point.weights = sum > 0 ? point.weights / sum : glm::dvec3(1, 0, 0);
        // A mirroring transform has turned the winding about.
        point.from_behind = (facing > 0) != (glm::determinant(turn) < 0);
        point.normal = across * ((facing > 0 ? -1.0 : 1.0) / std::sqrt(area));
    }
    for (int k = 0; k < 3; ++k) point.position += point.weights[k] * corners[k];
    return point;
}

}  // namespace sightline::studies
