// Samples of an image back into points of eye space, and the lines of sight through them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"

namespace sightline::studies {

/// Points of the eye's space by place and nearness (DepthPlane).
class Unprojection {
public:
    /// @param width, height  of the grid of samples that covers the view
    Unprojection(const View& view, uint32_t width, uint32_t height)
        : width_(width), height_(height), parallel_(isOrthographic(view)) {
        // Rows x, y and w (or z, the nearness of a parallel view) of the projection determine the point.
        const glm::dmat4& p = view.projection;
        glm::dmat3 rows;
        for (int column = 0; column < 3; ++column)
            rows[column] = glm::dvec3(p[column][0], p[column][1], parallel_ ? (column == 2) : p[column][3]);
        constants_ = glm::dvec3(p[3][0], p[3][1], parallel_ ? 0.0 : p[3][3]);
        if (parallel_) scale_ = p[3][3];
        inverse_ = glm::inverse(rows);
    }

    glm::dvec3 point(double sample, double row, double nearness) const {
        const Line line = lineOfSight(sample, row);
        return line.origin + (parallel_ ? -nearness : 1.0 / nearness) * line.direction;
    }

    /// origin + t * direction; t grows away from the eye: it is w in perspective, and the depth in parallel views.
    struct Line {
        glm::dvec3 origin{0.0}, direction{0.0};
    };
    Line lineOfSight(double sample, double row) const {
        const double x = 2 * (sample + 0.5) / width_ - 1, y = 2 * (row + 0.5) / height_ - 1;
        if (parallel_)
            return {inverse_ * (glm::dvec3(x * scale_, y * scale_, 0) - constants_), inverse_ * glm::dvec3(0, 0, -1)};
        return {-(inverse_ * constants_), inverse_ * glm::dvec3(x, y, 1)};
    }

private:
    double width_, height_;
    bool parallel_;
    double scale_ = 1;
    glm::dmat3 inverse_{1.0};
    glm::dvec3 constants_{0.0};
};

}  // namespace sightline::studies
