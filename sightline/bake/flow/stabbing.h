// Whether any line can pass a chain of portals: Teller's test, by linear programming in Plücker coordinates.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
// Charles Lawson, Richard Hanson. Solving Least Squares Problems. 1974.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::bake {

/// A chain of windows, to be asked whether a line passes them all. Its memory is used again by the next chain.
///
/// A directed line is a point of six coordinates, direction and moment; it passes an edge of a window on the inner
/// side if a linear form of these is not negative. A combination of the forms may prove that no point of
/// six-dimensional space satisfies all of them: then no line does. A point that does proves nothing, for it need not be
/// a line.
class StabbingChain {
public:
    /// @param normal     of the first window, along the way: lines go that way
    /// @param extent     no coordinate is larger  [world units]
    /// @param precision  how well corners are known: lines that pass them by less count as passing  [world units]
    void begin(const glm::dvec3& normal, double extent, double precision);
    /// @param outline  convex, counter-clockwise about its normal along the way
    void add(std::span<const glm::dvec3> outline);

    /// True: it is proved that no line through all windows rises by at least `rise` from the first to the last.
    /// False: it is not known. O(edges) for each of some ten steps.
    /// @param rise      the height of the last window's lowest corner above the first one's plane  [> 0] [world units]
    /// @param distance  no two points of the first and the last window are farther apart  [world units]
    bool isProvedEmpty(double rise, double distance);

private:
    static constexpr int kSize = 6;
    struct Form {
        double value[kSize];
    };

    std::vector<Form> forms_;
    glm::dvec3 normal_{0.0};
    double scale_ = 1, precision_ = 0;
};

}  // namespace sightline::bake
