// The city's plan: where its blocks lie, from the middle outward.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::tools::city {

/// Blocks are the squares of a Pythagorean tiling, large and small: a brick bond in both directions.
/// Every street ends, after the length of a large and a small block, at the fronts of another block.
struct Block {
    int64_t distance2 = 0;  ///< of its middle from the city's middle, which is a large block's  [metres^2]
    int32_t x = 0, z = 0;   ///< its middle                                                      [metres]
    bool small = false;

    int size() const;
    /// A number of its own, for its stream of random numbers.
    uint64_t place() const;
};

/// All blocks with inner <= distance2 < outer, nearest first; ties are broken by position.
std::vector<Block> blocksBetween(int64_t inner, int64_t outer);

/// Gives the blocks one by one, nearest first, without end.
class BlockSequence {
public:
    Block next();

private:
    std::vector<Block> band_;
    size_t used_ = 0;
    int64_t bands_ = 0;
};

/// One side of a square or rectangle in the plan, seen from outside: s runs along it, t outward.
struct Side {
    int quarter = 0;   ///< quarter turns from +z to its outward direction, towards +x
    glm::dvec2 start;  ///< (x, z) of s = 0 on the line
    double length = 0;

    glm::dvec2 at(double s, double t) const;
};

/// Directions of a side: along it, and outward. Each is a unit vector along an axis, exactly.
glm::dvec2 alongSide(int quarter);
glm::dvec2 outwardOf(int quarter);

struct Rectangle {
    glm::dvec2 min, max;
};

/// Side `quarter` of a rectangle.
Side sideOf(const Rectangle& rectangle, int quarter);

}  // namespace sightline::tools::city
