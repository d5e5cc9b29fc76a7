// The image of a view as a plane to do geometry in: directions from the eye as pairs of numbers.
// SPDX-License-Identifier: MIT
#include "sightline/cull/proofs/image_frame.h"

#include <algorithm>
#include <cmath>

namespace sightline {

ImageFrame makeImageFrame(const Screen& screen) {
    ImageFrame frame;
    if (!screen.perspective || screen.x.w != 0 || screen.y.w != 0 || screen.w.w != 0) return frame;
    const double length = glm::length(glm::dvec3(screen.w));
    frame.w = glm::dvec3(screen.w) / length;
    frame.x = (2.0 / screen.width * glm::dvec3(screen.x) - glm::dvec3(screen.w)) / length;
    frame.y = (2.0 / screen.height * glm::dvec3(screen.y) - glm::dvec3(screen.w)) / length;
    frame.back = glm::inverse(glm::transpose(glm::dmat3(frame.x, frame.y, frame.w)));
    for (const double u : {-1.0, 1.0})
        for (const double v : {-1.0, 1.0}) {
            const glm::dvec3 q = frame.back * glm::dvec3(u, v, 1.0);
            frame.longest = std::max(frame.longest, std::abs(q.x) + std::abs(q.y) + std::abs(q.z));
        }
    frame.longest *= 1.01;                            // Uncovered's pieces reach a thousandth out of the square
    constexpr double kWidest = 64, kNarrowest = 1e5;  // from about a hundred thousandth of a degree to 178
    double size = 0;
    for (int column = 0; column < 3; ++column) size += glm::dot(glm::abs(frame.back[column]), glm::dvec3(1.0));
    frame.usable = std::isfinite(size) && frame.longest >= 1.0 && frame.longest < kWidest &&
                   glm::length(frame.x) < kNarrowest && glm::length(frame.y) < kNarrowest;
    return frame;
}

}  // namespace sightline
