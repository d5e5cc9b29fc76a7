// Fills a block of the city: buildings wall to wall around its edge, and furniture.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/tools/scene/city/layout.h"
#include "sightline/tools/scene/city/library.h"

namespace sightline::tools::city {

/// Puts objects down on the plan; keys count them.
class Planter {
public:
    explicit Planter(std::vector<SceneObject>& objects) : objects_(&objects) {}

    /// @param at       (x, z), and the height of the object's foot
    /// @param quarter  quarter turns from +z towards +x, as a side's
    /// @param scale    a negative component mirrors
    void put(uint32_t mesh, const glm::dvec2& at, double height, int quarter, const glm::dvec3& scale = glm::dvec3(1));

private:
    std::vector<SceneObject>* objects_;
};

/// Ground and buildings with what stands on their roofs, or a square, or the market; then streets and yards. All of
/// it depends on the seed and the block alone.
void fillBlock(const Library& library, uint64_t seed, const Block& block, Planter& planter);

/// The parts of fillBlock.
void fillBuildings(const Library& library, Random& random, const Block& block, bool split, int turn, Planter& planter);
void fillSquare(Random& random, const Block& block, Planter& planter);
void fillStreets(Random& random, const Block& block, bool split, int turn, Planter& planter);
void fillYards(Random& random, const Block& block, bool split, int turn, bool bare, Planter& planter);

/// The market in the middle of the city: what its visitors see does not depend on the city's size.
void fillMarket(Random& random, Planter& planter);

/// The parts of a large block between streets and lane, bounded by the fronts.
std::vector<Rectangle> plotsOf(const Block& block, bool split, int turn);

}  // namespace sightline::tools::city
