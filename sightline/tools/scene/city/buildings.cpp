// The city's buildings: rows, corners, towers and islands, as unions of closed solids.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <utility>

#include "sightline/tools/scene/city/library.h"
#include "sightline/tools/scene/solids.h"

namespace sightline::tools::city {
namespace {

constexpr double kGroundFloor = 4.25, kStorey = 3.25;  // heights  [metres]

/// What a building's look is drawn from; the numbers are taken in a fixed order.
struct Style {
    BodyMaterials materials;
    uint32_t roof_cover = kSlate;
    double depth = 0.75;  ///< of the bays
    bool glazed = false;
    bool pitched = false;
    uint32_t extra = 0;  ///< free choice of the builder
};

Style drawStyle(Random& random, int storeys) {
    constexpr uint32_t kWalls[] = {kSand, kRose, kBrick, kStone, kOchre, kGrey, kWhite};
    Style style;
    constexpr uint32_t kNiches[] = {kShade, kStone, kTrim};
    style.materials.wall = kWalls[random.below(7)];
    style.materials.bay = kNiches[random.below(3)];
    style.materials.roof = kGravel;
    style.materials.glass = kGlass;
    style.roof_cover = random.below(2) ? kTiles : kSlate;
    style.depth = 0.5 + 0.25 * static_cast<double>(random.below(4));
    style.glazed = random.below(6) != 0;
    style.pitched = random.below(5) < 3 && storeys <= 7;
    style.extra = static_cast<uint32_t>(random.below(1 << 16));
    return style;
}

double eavesHeight(int storeys) { return kGroundFloor + (storeys - 1) * kStorey; }

/// A rectangle counter-clockwise from above: front edge first, then right, back, left.
std::vector<glm::dvec2> rectangle(double left, double right, double back, double front) {
    return {{left, front}, {right, front}, {right, back}, {left, back}};
}

/// A gable or, for an odd choice, a mansard roof along x over z from back to front.
void addRoof(MeshBuilder& mesh, const Style& style, double left, double right, double back, double front,
             double eaves) {
    const double foot = eaves - 0.125, middle = 0.5 * (back + front);
    if (style.extra % 2 == 0) {
        addPrism(mesh, style.roof_cover, kAcross, {{back - 0.375, foot}, {front + 0.375, foot}, {middle, eaves + 3.5}},
                 -right, -left);
    } else {
        addPrism(mesh, style.roof_cover, kAcross,
                 {{back - 0.25, foot},
                  {front + 0.25, foot},
                  {front - 1.25, eaves + 2.5},
                  {middle, eaves + 3.25},
                  {back + 1.25, eaves + 2.5}},
                 -right, -left);
    }
}

/// The same for a roof along z over x.
void addCrossRoof(MeshBuilder& mesh, const Style& style, double left, double right, double back, double front,
                  double eaves) {
    const double foot = eaves - 0.125, middle = 0.5 * (left + right);
    addPrism(mesh, style.roof_cover, kSideways, {{left - 0.375, foot}, {right + 0.375, foot}, {middle, eaves + 3.5}},
             back, front);
}

void finish(Library& library, const MeshBuilder& mesh, Building building, const std::string& name) {
    building.mesh = static_cast<uint32_t>(library.meshes.size());
    library.meshes.push_back(mesh.finish(name + " " + std::to_string(building.mesh)));
    library.buildings.push_back(building);
}

/// A ground floor and, over it, loggias or oriels that a cornice closes above; or an arcade under plain storeys' bays.
void addRow(Library& library, Random& random, double width, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double eaves = eavesHeight(storeys), half = 0.5 * width;
    const bool oriels = style.extra % 5 == 0, arcade = style.extra % 5 == 1;
    const int bays = width < 12 ? 1 : width < 20 ? 2 : 3;
    MeshBuilder mesh;
    const Wall front{bays, bays == 1 ? 2.25 : 1.75, oriels ? -0.75 : style.depth, style.glazed};
    const Wall back{bays < 3 ? 1 : 0, 0.375 * width, 1.0, false};
    addBody(mesh, style.materials, rectangle(-half, half, -kRowDepth, 0), arcade ? 3.25 : 3.75, eaves,
            {front, {}, back, {}});
    const uint32_t base = style.extra % 4 < 2 ? static_cast<uint32_t>(kStone) : style.materials.wall;
    addBox(mesh, base, {-half - 0.03125, 0, -kRowDepth - 0.0625},
           {half + 0.03125, 4,
            arcade   ? -1.5
            : oriels ? -0.0625
                     : 0.0625});
    addBox(mesh, kTrim, {-half - 0.03125, eaves - 0.875, -kRowDepth - 0.25},
           {half + 0.03125, eaves - 0.375, oriels ? 1.0 : 0.4375});
    if (style.pitched) {
        addRoof(mesh, style, -half + 0.0625, half - 0.0625, -kRowDepth, 0, eaves);
    } else if (style.extra % 3 == 0) {  // a set-back top storey
        addBox(mesh, kWhite, {-half + 0.25, eaves - 0.5, -kRowDepth + 2}, {half - 0.25, eaves + 2.75, -2.5});
    } else {
        addBox(mesh, kGrey, {-1.5, eaves - 0.25, -8}, {1.5, eaves + 2.25, -5});
    }
    const double roof = style.pitched ? eaves + 1 : style.extra % 3 == 0 ? eaves + 2.75 : eaves;
    finish(library, mesh, {0, Kind::kRow, storeys, width, roof, style.pitched}, "row");
}

/// A front court between two wings.
void addCourt(Library& library, Random& random, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double eaves = eavesHeight(storeys), width = 27, half = 0.5 * width;
    MeshBuilder mesh;
    const Wall wing{1, 2.25, style.depth, style.glazed}, court{1, 2, style.depth, style.glazed};
    addBody(mesh, style.materials,
            {{-half, 0}, {-5, 0}, {-5, -5}, {5, -5}, {5, 0}, {half, 0}, {half, -kRowDepth}, {-half, -kRowDepth}}, 0,
            eaves, {wing, {}, court, {}, wing, {}, {}, {}});
    for (const double side : {-1.0, 1.0}) {
        const double inner = side * 4.75, outer = side * (half + 0.03125);
        addBox(mesh, kTrim, {std::min(inner, outer), eaves - 0.875, -4.75},
               {std::max(inner, outer), eaves - 0.375, 0.4375});
    }
    addRoof(mesh, style, -half + 0.0625, half - 0.0625, -kRowDepth, -5, eaves);
    finish(library, mesh, {0, Kind::kRow, storeys, width, eaves + 1, true}, "court");
}

/// A passage to the yard, bridged from the first floor up.
void addGateway(Library& library, Random& random, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double eaves = eavesHeight(storeys), width = 18, half = 0.5 * width;
    MeshBuilder mesh;
    const Wall front{1, 1.75, style.depth, style.glazed};
    addBody(mesh, style.materials, rectangle(-half, -2, -kRowDepth, 0), 0, eaves, {front, {}, {}, {}});
    addBody(mesh, style.materials, rectangle(2, half, -kRowDepth, 0), 0, eaves, {front, {}, {}, {}});
    addBox(mesh, style.materials.wall, {-3, 4.5, -kRowDepth + 0.25}, {3, eaves - 0.25, -0.25});
    addBox(mesh, kTrim, {-half - 0.03125, eaves - 0.875, -kRowDepth - 0.25}, {half + 0.03125, eaves - 0.375, 0.4375});
    addRoof(mesh, style, -half + 0.0625, half - 0.0625, -kRowDepth, 0, eaves);
    finish(library, mesh, {0, Kind::kRow, storeys, width, eaves + 1, true}, "gateway");
}

void addTower(Library& library, Random& random, double width, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double podium = eavesHeight(6), top = eavesHeight(storeys), half = 0.5 * width;
    MeshBuilder mesh;
    const Wall front{2, 2, style.depth, style.glazed}, shaft{1, 4, 0.75, style.glazed};
    addBody(mesh, style.materials, rectangle(-half, half, -kRowDepth, 0), 0, podium, {front, {}, {}, {}});
    addBody(mesh, style.materials, rectangle(-half + 1.5, half - 1.5, -kRowDepth + 0.5, -1.5), podium - 0.5, top,
            {shaft, {}, shaft, {}});
    addBox(mesh, kTrim, {-half + 1.25, top - 0.875, -kRowDepth + 0.25}, {half - 1.25, top - 0.375, -1.25});
    addBox(mesh, style.materials.wall, {-half + 4, top - 0.5, -kRowDepth + 2.5}, {half - 4, top + 3.25, -3.5});
    finish(library, mesh, {0, Kind::kTower, storeys, width, top + 3.25, false}, "tower");
}

void addCorner(Library& library, Random& random, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double eaves = eavesHeight(storeys), leg = kCornerLeg, depth = kRowDepth;
    const bool pitched = style.pitched, turret = style.extra % 2 == 0;
    MeshBuilder mesh;
    const Wall main{turret ? 1 : 2, turret ? 4.0 : 2.5, style.depth, style.glazed};
    const Wall side{1, 4, style.depth, style.glazed};
    addBody(mesh, style.materials, {{-leg, 0}, {0, 0}, {0, -leg}, {-depth, -leg}, {-depth, -depth}, {-leg, -depth}}, 0,
            eaves, {main, side, {}, {}, {}, {}});
    addPrism(mesh, kTrim, kUpright,
             {{0.4375, -leg - 0.03125},
              {0.4375, 0.4375},
              {-leg - 0.03125, 0.4375},
              {-leg - 0.03125, -4},
              {-4, -4},
              {-4, -leg - 0.03125}},
             eaves - 0.875, eaves - 0.375);
    if (pitched) {
        addRoof(mesh, style, -leg + 0.0625, -0.5, -depth, 0, eaves);
        addCrossRoof(mesh, style, -depth, 0, -leg + 0.0625, -0.5, eaves);
    } else {
        addBox(mesh, kGrey, {-9, eaves - 0.25, -9}, {-5, eaves + 2.25, -5});
    }
    if (turret)  // over the street corner
        addTurned(mesh, kTrim, {-1, 0, -1}, 6, {{1.75, kGroundFloor}, {1.75, eaves + 2}, {0, eaves + 5.5}});
    finish(library, mesh, {0, Kind::kCorner, storeys, leg, pitched ? eaves + 1 : eaves, pitched}, "corner");
}

/// A palace round three sides of a court.
void addPalace(Library& library, Random& random, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double eaves = eavesHeight(storeys), half = 0.5 * kIslandSize;
    MeshBuilder mesh;
    const Wall court{1, 2.5, style.depth, style.glazed}, flank{1, 6, style.depth, style.glazed};
    addBody(mesh, style.materials,
            {{-half, half}, {-5, half}, {-5, -3}, {5, -3}, {5, half}, {half, half}, {half, -half}, {-half, -half}}, 0,
            eaves, {{}, {}, court, {}, {}, flank, flank, flank});
    addCrossRoof(mesh, style, -half, -5, -half + 0.25, half - 0.25, eaves);
    addCrossRoof(mesh, style, 5, half, -half + 0.25, half - 0.25, eaves);
    addRoof(mesh, style, -half + 0.5, half - 0.5, -half, -3, eaves);
    finish(library, mesh, {0, Kind::kIsland, storeys, kIslandSize, eaves + 1, true}, "palace");
}

void addHall(Library& library, Random& random, int storeys) {
    const Style style = drawStyle(random, storeys);
    const double eaves = eavesHeight(storeys), half = 0.5 * kIslandSize;
    MeshBuilder mesh;
    const Wall front{1, 4, style.depth, style.glazed};
    addBody(mesh, style.materials, rectangle(-half, half, -half, half), 0, eaves, {front, front, front, front});
    addBox(mesh, kTrim, {-half - 0.4375, eaves - 0.875, -half - 0.4375}, {half + 0.4375, eaves - 0.375, half + 0.4375});
    addBox(mesh, kWhite, {-half + 3, eaves - 0.5, -half + 4}, {half - 3, eaves + 3.25, half - 4});
    finish(library, mesh, {0, Kind::kIsland, storeys, kIslandSize, eaves + 3.25, false}, "hall");
}

void addChurch(Library& library, Random& random) {
    const Style style = drawStyle(random, 5);
    const double half = 0.5 * kIslandSize, eaves = 13;
    MeshBuilder mesh;
    const Wall flank{1, 4, 0.5, true};
    addBody(mesh, style.materials, rectangle(-6, 6, -half, half - 5), 0, eaves, {{}, flank, {}, flank});
    addPrism(mesh, kSlate, kSideways, {{-6.5, eaves - 0.125}, {6.5, eaves - 0.125}, {0, eaves + 8}}, -half + 0.25,
             half - 5.25);
    addBox(mesh, style.materials.wall, {-3.5, 0, half - 8}, {3.5, 28, half - 1});
    addTurned(mesh, kCopper, {0, 0, half - 4.5}, 6, {{3.25, 27.5}, {2.5, 31}, {0, 42}});
    addBox(mesh, style.materials.wall, {-10, 0, -8}, {10, 11, -1});
    finish(library, mesh, {0, Kind::kIsland, 5, kIslandSize, eaves + 5, true}, "church");
}

}  // namespace

void addBuildings(Library& library, Random random) {
    for (const int storeys : {4, 5, 6, 7}) addRow(library, random, 9, storeys);
    for (const double width : {14.0, 18.0, 22.0})
        for (const int storeys : {4, 5, 6, 7, 8}) addRow(library, random, width, storeys);
    for (const int storeys : {5, 6, 7}) addRow(library, random, 27, storeys);
    for (const int storeys : {5, 6, 7}) addCourt(library, random, storeys);
    for (const int storeys : {5, 6, 7}) addGateway(library, random, storeys);
    for (const int storeys : {10, 12, 16, 20}) addTower(library, random, storeys % 8 == 0 ? 18 : 22, storeys);
    for (const int storeys : {4, 5, 6, 7, 8}) addCorner(library, random, storeys);
    for (const int storeys : {5, 6}) addPalace(library, random, storeys);
    for (const int storeys : {5, 7}) addHall(library, random, storeys);
    addChurch(library, random);
}

}  // namespace sightline::tools::city
