// The rays of a view: one through each sample, from the near plane on.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/geom/view.h"

namespace sightline::studies {

/// Points origin + t * direction, relative to the view's eye and turned like the world. t is clip w in perspective and
/// the depth in eye space in parallel views, so that it is the same function of the place for all rays of a view.
struct SampleRay {
    glm::dvec3 origin{0.0}, direction{0.0};
    double t_near = 0, t_far = 0;  ///< t_far may be infinite; t_near > t_far: the view sees nothing there
};

class SampleRays {
public:
    explicit SampleRays(const View& view);

    /// Through the centre of sample i of a row.
    SampleRay at(double row, double sample) const;

    /// t of a point relative to the eye is dot(depthAxis(), point).
    const glm::dvec3& depthAxis() const { return depth_axis_; }
    const glm::dvec3& eye() const { return eye_; }

private:
    bool parallel_;
    glm::dvec3 eye_, depth_axis_{0.0};
    glm::dvec3 origin_{0.0}, origin_per_sample_{0.0}, origin_per_row_{0.0};
    glm::dvec3 direction_{0.0}, direction_per_sample_{0.0}, direction_per_row_{0.0};
    glm::dvec4 near_{0.0}, far_{0.0};  ///< dot(plane, (p, 1)) >= 0 inside
};

}  // namespace sightline::studies
