// What stands between the city's buildings: ground, trees, lamps, cars and the rest.
// SPDX-License-Identifier: MIT
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/scene/city_library.h"
#include "sightline/scene/city_mesh.h"

namespace sightline::city {
namespace {

// All stand on y = 0 with their front to +z, unless said otherwise.

/// The asphalt under a block, a little past the middle of the streets so that it overlaps its neighbours', and the
/// pavements on it.
/// @param lane  gap along z through the middle of the pavement; 0: none
MeshBuilder ground(double size, double lane) {
    MeshBuilder mesh;
    const double half = 0.5 * size, kerb = half - kKerb;
    const double edge = half + 0.1875;
    mesh.quad(kAsphalt, {-edge, 0, edge}, {edge, 0, edge}, {edge, 0, -edge}, {-edge, 0, -edge});
    if (lane == 0) {
        addBox(mesh, kPaving, {-kerb, -0.25, -kerb}, {kerb, kPavement, kerb});
    } else {
        addBox(mesh, kPaving, {-kerb, -0.25, -kerb}, {-0.5 * lane, kPavement, kerb});
        addBox(mesh, kPaving, {0.5 * lane, -0.25, -kerb}, {kerb, kPavement, kerb});
    }
    return mesh;
}

MeshBuilder lawn() {
    MeshBuilder mesh;
    addBox(mesh, kLawnGreen, {-0.5, 0, -0.5}, {0.5, 0.0625, 0.5});
    return mesh;
}

MeshBuilder crossing() {
    MeshBuilder mesh;
    for (int stripe = 0; stripe < 6; ++stripe) {
        const double x = -3.25 + 1.25 * stripe;
        const double y = 0.015625;
        mesh.quad(kPaint, {x, y, 1.5}, {x + 0.5, y, 1.5}, {x + 0.5, y, -1.5}, {x, y, -1.5});
    }
    return mesh;
}

/// A trunk and a crown of crossed leafy shells.
MeshBuilder tree(uint32_t leaf, const std::vector<Ring>& crown) {
    MeshBuilder mesh;
    addTurned(mesh, kBark, {0, 0, 0}, 3, {{0.25, 0}, {0, crown[2].y}});
    addTurned(mesh, leaf, {0, 0, 0}, 6, crown);
    const Ring &low = crown[1], &high = crown[crown.size() - 2];
    for (const glm::dvec3& across : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)})
        mesh.quad(leaf, -across * (0.875 * low.radius) + glm::dvec3(0, low.y, 0),
                  across * (0.875 * low.radius) + glm::dvec3(0, low.y, 0),
                  across * (0.75 * high.radius) + glm::dvec3(0, high.y, 0),
                  -across * (0.75 * high.radius) + glm::dvec3(0, high.y, 0));
    return mesh;
}

MeshBuilder hedge() {
    MeshBuilder mesh;
    addBox(mesh, kDarkLeaf, {-1.5, 0, -0.375}, {1.5, 1.25, 0.375});
    addBox(mesh, kLeaf, {-1.375, 0.125, -0.5}, {1.375, 1.0, 0.5});
    return mesh;
}

MeshBuilder lamp() {
    MeshBuilder mesh;
    addTurned(mesh, kMetal, {0, 0, 0}, 3, {{0.15625, 0}, {0.0625, 6}});
    addPrism(mesh, kMetal, kAcross, {{-0.0625, 5.9375}, {1.625, 5.8125}, {1.625, 5.96875}}, -0.15625, 0.15625);
    addBox(mesh, kLight, {-0.125, 5.75, 1}, {0.125, 5.875, 1.5625});
    return mesh;
}

MeshBuilder bench() {
    MeshBuilder mesh;
    addPrism(mesh, kMetal, kAcross, {{-0.25, 0}, {0.25, 0}, {0, 0.46875}}, -0.75, 0.75);
    addPrism(mesh, kWood, kAcross,
             {{-0.3125, 0.4375}, {0.28125, 0.4375}, {0.28125, 0.5}, {-0.25, 0.5}, {-0.25, 0.9375}, {-0.3125, 0.9375}},
             -1, 1);
    return mesh;
}

MeshBuilder bin() {
    MeshBuilder mesh;
    addTurned(mesh, kMetal, {0, 0, 0}, 6, {{0.21875, 0}, {0.28125, 0.9375}});
    return mesh;
}

MeshBuilder hydrant() {
    MeshBuilder mesh;
    addTurned(mesh, kRed, {0, 0, 0}, 4, {{0.1875, 0}, {0.15625, 0.625}, {0, 0.8125}});
    addPrism(mesh, kSilver, kAcross, {{-0.078125, 0.375}, {0.078125, 0.375}, {0, 0.53125}}, -0.21875, 0.21875);
    return mesh;
}

MeshBuilder bollard() {
    MeshBuilder mesh;
    addTurned(mesh, kMetal, {0, 0, 0}, 4, {{0.09375, 0}, {0.109375, 0.875}, {0, 1}});
    return mesh;
}

/// Six metres of flat bars between posts; the bars are drawn from both sides.
MeshBuilder fence() {
    MeshBuilder mesh;
    for (const double x : {-3.0, 3.0}) addTurned(mesh, kMetal, {x, 0, 0}, 3, {{0.0625, 0}, {0.0625, 1.75}});
    for (int bar = 0; bar < 8; ++bar) {
        const double x = -2.625 + 0.75 * bar;
        mesh.quad(kMesh, {x - 0.09375, 0.125, 0}, {x + 0.09375, 0.125, 0}, {x + 0.09375, 1.625, 0},
                  {x - 0.09375, 1.625, 0});
    }
    for (const double y : {0.1875, 1.5}) {
        const double z = 0.015625, top = y + 0.0625;
        mesh.quad(kMesh, {-3, y, z}, {3, y, z}, {3, top, z}, {-3, top, z});
    }
    return mesh;
}

MeshBuilder sign() {
    MeshBuilder mesh;
    addTurned(mesh, kSilver, {0, 0, 0}, 3, {{0.046875, 0}, {0.046875, 2.75}});
    const std::vector<glm::dvec2> rim = regularPolygon(8);
    for (size_t i = 1; i + 1 < rim.size(); ++i) {
        const auto at = [&](size_t k) { return glm::dvec3(0.3125 * rim[k].x, 2.375 + 0.3125 * rim[k].y, 0.0625); };
        mesh.triangle(kBoard, at(0), at(i), at(i + 1));
    }
    return mesh;
}

MeshBuilder kiosk() {
    MeshBuilder mesh;
    addTurned(mesh, kMetal, {0, 0, 0}, 6, {{1.25, 0}, {1.25, 2.5}});
    addTurned(mesh, kCopper, {0, 0, 0}, 6, {{1.625, 2.4375}, {0, 3.75}});
    addPrism(mesh, kWood, kAcross, {{0.625, 0.75}, {1.4375, 1}, {0.625, 1}}, -0.75, 0.75);
    mesh.quad(kGlass, {-0.5, 1.0625, 1.3125}, {0.5, 1.0625, 1.3125}, {0.5, 2.125, 1.3125}, {-0.5, 2.125, 1.3125});
    return mesh;
}

/// A stop with a roof and panes on three sides.
MeshBuilder shelter() {
    MeshBuilder mesh;
    for (const double x : {-1.8125, 1.8125})
        addTurned(mesh, kMetal, {x, 0, -0.625}, 3, {{0.09375, 0}, {0.09375, 2.375}});
    addBox(mesh, kMetal, {-2.0625, 2.34375, -0.8125}, {2.0625, 2.46875, 0.8125});
    addPrism(mesh, kWood, kAcross, {{-0.5625, 0.375}, {-0.1875, 0.5}, {-0.5625, 0.5}}, -1.5, 1.5);
    mesh.quad(kGlass, {-1.75, 0.25, -0.625}, {1.75, 0.25, -0.625}, {1.75, 2.25, -0.625}, {-1.75, 2.25, -0.625});
    for (const double x : {-1.875, 1.875})
        mesh.quad(kGlass, {x, 0.25, 0.5}, {x, 0.25, -0.5}, {x, 2.25, -0.5}, {x, 2.25, 0.5});
    return mesh;
}

/// Length along x.
MeshBuilder car(uint32_t paint) {
    MeshBuilder mesh;
    addPrism(mesh, paint, kSideways,
             {{-2.125, 0.3125},
              {2.1875, 0.3125},
              {2.125, 0.84375},
              {1.1875, 0.96875},
              {0.5, 1.4375},
              {-1.125, 1.46875},
              {-2.1875, 0.9375}},
             -0.84375, 0.84375);
    for (const double x : {-1.3125, 1.3125})  // of each axle's wheels, what shows under the body and beside it
        addPrism(mesh, kRubber, kSideways,
                 {{x - 0.1875, 0}, {x + 0.1875, 0}, {x + 0.34375, 0.40625}, {x - 0.34375, 0.40625}}, -0.90625, 0.90625);
    mesh.quad(kGlass, {-1.0, 1.03125, 0.859375}, {0.875, 1.03125, 0.859375}, {0.375, 1.375, 0.859375},
              {-0.9375, 1.375, 0.859375});
    mesh.quad(kGlass, {0.875, 1.03125, -0.859375}, {-1.0, 1.03125, -0.859375}, {-0.9375, 1.375, -0.859375},
              {0.375, 1.375, -0.859375});
    mesh.quad(kGlass, {1.171875, 1.0, 0.6875}, {1.171875, 1.0, -0.6875}, {0.578125, 1.40625, -0.6875},
              {0.578125, 1.40625, 0.6875});
    return mesh;
}

MeshBuilder planter() {
    MeshBuilder mesh;
    addBox(mesh, kStone, {-0.625, 0, -0.375}, {0.625, 0.5, 0.375});
    addTurned(mesh, kLeaf, {0, 0, 0}, 6, {{0, 0.375}, {0.5, 0.75}, {0, 1.1875}});
    return mesh;
}

/// Hangs on the front at z = 0, over a shop window.
MeshBuilder awning() {
    MeshBuilder mesh;
    mesh.quad(kCloth, {-1.75, 2.625, 1.25}, {1.75, 2.625, 1.25}, {1.75, 3.25, 0}, {-1.75, 3.25, 0});
    mesh.quad(kCloth, {-1.75, 2.375, 1.25}, {1.75, 2.375, 1.25}, {1.75, 2.625, 1.25}, {-1.75, 2.625, 1.25});
    addPrism(mesh, kMetal, kAcross, {{-0.125, 2.5}, {1.1875, 2.5625}, {-0.125, 2.5625}}, -1.625, 1.625);
    return mesh;
}

/// Three flat hoops on a rail, drawn from both sides.
MeshBuilder bicycleStand() {
    MeshBuilder mesh;
    addBox(mesh, kSilver, {-0.875, 0, -0.046875}, {0.9375, 0.0625, 0.046875});
    for (int hoop = 0; hoop < 3; ++hoop) {
        const double x = -0.75 + 0.75 * hoop;
        for (const double z : {-0.34375, 0.28125})
            mesh.quad(kMesh, {x, 0, z + 0.0625}, {x, 0, z}, {x, 0.78125, z}, {x, 0.78125, z + 0.0625});
        mesh.quad(kMesh, {x, 0.78125, 0.34375}, {x, 0.78125, -0.34375}, {x, 0.84375, -0.34375}, {x, 0.84375, 0.34375});
    }
    return mesh;
}

MeshBuilder chimney() {
    MeshBuilder mesh;
    addTurned(mesh, kBrick, {0, 0, 0}, 4, {{0.625, -1}, {0.625, 2.75}, {0, 3.25}});
    return mesh;
}

/// A water tank on two trestles.
MeshBuilder tank() {
    MeshBuilder mesh;
    for (const double x : {-0.75, 0.625})
        addPrism(mesh, kMetal, kAcross, {{-1, -0.125}, {1, -0.125}, {0, 1.625}}, -x - 0.125, -x);
    addTurned(mesh, kWood, {0, 0, 0}, 6, {{1.25, 1.4375}, {1.25, 3.5}, {0, 4.25}});
    return mesh;
}

MeshBuilder cooler() {
    MeshBuilder mesh;
    addBox(mesh, kSilver, {-0.875, -0.125, -0.625}, {0.875, 1.125, 0.625});
    addTurned(mesh, kBlack, {0, 0, 0}, 6, {{0.5, 1.0625}, {0.5, 1.25}});
    return mesh;
}

MeshBuilder shed() {
    MeshBuilder mesh;
    addBox(mesh, kWood, {-2.5, 0, -1.75}, {2.5, 2.5, 1.75});
    addPrism(mesh, kSlate, kAcross, {{-2, 2.4375}, {2, 2.4375}, {0, 3.75}}, -2.75, 2.75);
    addBox(mesh, kShade, {-1.25, 0, 1.625}, {1.25, 2.125, 1.8125});
    return mesh;
}

MeshBuilder monument() {
    MeshBuilder mesh;
    addBox(mesh, kStone, {-2.5, 0, -2.5}, {2.5, 0.375, 2.5});
    addBox(mesh, kStone, {-1.75, 0.25, -1.75}, {1.75, 0.75, 1.75});
    addBox(mesh, kTrim, {-1, 0.625, -1}, {1, 3.25, 1});
    addTurned(mesh, kStone, {0, 0, 0}, 4, {{0.75, 3.125}, {0.4375, 10}, {0, 11}});
    return mesh;
}

}  // namespace

void addItems(Library& library) {
    const auto add = [&](Item item, const char* name, const MeshBuilder& mesh) {
        SIGHTLINE_ASSERT(library.meshes.size() == item);
        library.meshes.push_back(mesh.finish(name));
    };
    add(kGroundLarge, "ground", ground(kLargeBlock, 0));
    add(kGroundSplit, "ground with lane", ground(kLargeBlock, kAlley - 2));
    add(kGroundSmall, "small ground", ground(kSmallBlock, 0));
    add(kLawn, "lawn", lawn());
    add(kCrossing, "crossing", crossing());
    add(kPlaneTree, "plane tree", tree(kLeaf, {{0, 2.75}, {2.125, 4.25}, {1.75, 6.25}, {0, 7.75}}));
    add(kLimeTree, "lime tree", tree(kDarkLeaf, {{0, 2.5}, {1.75, 3.75}, {1.0, 6}, {0, 7.25}}));
    add(kPoplar, "poplar", tree(kDarkLeaf, {{0, 1.5}, {1.125, 3.5}, {0.875, 8}, {0, 11}}));
    add(kHedge, "hedge", hedge());
    add(kLamp, "lamp", lamp());
    add(kBench, "bench", bench());
    add(kBin, "bin", bin());
    add(kHydrant, "hydrant", hydrant());
    add(kBollard, "bollard", bollard());
    add(kFence, "fence", fence());
    add(kSign, "sign", sign());
    add(kKiosk, "kiosk", kiosk());
    add(kShelter, "shelter", shelter());
    add(kRedCar, "red car", car(kRed));
    add(kBlueCar, "blue car", car(kBlue));
    add(kSilverCar, "silver car", car(kSilver));
    add(kBlackCar, "black car", car(kBlack));
    add(kPlanter, "planter", planter());
    add(kAwning, "awning", awning());
    add(kBicycleStand, "bicycle stand", bicycleStand());
    add(kChimney, "chimney", chimney());
    add(kTank, "tank", tank());
    add(kCooler, "cooler", cooler());
    add(kShed, "shed", shed());
    add(kMonument, "monument", monument());
    SIGHTLINE_ASSERT(library.meshes.size() == kItemCount);
}

}  // namespace sightline::city
