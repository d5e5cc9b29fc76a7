// What stands in the kitchens and bathrooms of a procedural building.
// SPDX-License-Identifier: MIT
#include "sightline/scene/building_library.h"

namespace sightline::building {
namespace {

using city::addBox;
using city::addPrism;
using city::addTurned;
using city::kAcross;
using city::kUpright;
using city::MeshBuilder;

/// A base unit with two doors; a worktop that may have a hole for something deep.
void addUnit(MeshBuilder& mesh, double half) {
    addBox(mesh, kBlackPlastic, {-half, 0, -0.28125}, {half, 0.109375, 0.234375});
    addBox(mesh, kWhite, {-half, 0.09375, -0.296875}, {half, 0.875, 0.28125});
    for (const double side : {-1.0, 1.0}) {
        const double x0 = side < 0 ? -half + 0.0078125 : 0.00390625, x1 = side < 0 ? -0.00390625 : half - 0.0078125;
        addBox(mesh, kBeech, {x0, 0.125, 0.2734375}, {x1, 0.859375, 0.296875});
        const double handle = side < 0 ? x1 - 0.046875 : x0 + 0.03125;
        addBox(mesh, kChrome, {handle, 0.703125, 0.2890625}, {handle + 0.015625, 0.828125, 0.3125});
    }
}

MeshBuilder counter() {
    MeshBuilder mesh;
    addUnit(mesh, 0.46875);
    addBox(mesh, kOak, {-0.46875, 0.8671875, -0.296875}, {0.46875, 0.90625, 0.3125});
    return mesh;
}

void addTap(MeshBuilder& mesh, const glm::dvec3& foot, double height) {
    addTurned(mesh, kChrome, foot, 8, {{0.02, 0}, {0.015625, 0.03125}, {0.01171875, height}});
    addBox(mesh, kChrome, foot + glm::dvec3(-0.01171875, height - 0.01953125, -0.01171875),
           foot + glm::dvec3(0.01171875, height, 0.140625));
    addBox(mesh, kChrome, foot + glm::dvec3(-0.0078125, height - 0.046875, 0.125),
           foot + glm::dvec3(0.0078125, height - 0.0078125, 0.140625));
}

MeshBuilder sinkCounter() {
    MeshBuilder mesh;
    addUnit(mesh, 0.46875);
    // The worktop in four pieces around the basin.
    addPrism(mesh, kOak, kUpright,
             {{-0.296875, -0.46875}, {0.3125, -0.46875}, {0.3125, -0.265625}, {-0.296875, -0.265625}}, 0.8671875,
             0.90625);
    addPrism(mesh, kOak, kUpright, {{-0.296875, 0.265625}, {0.3125, 0.265625}, {0.3125, 0.46875}, {-0.296875, 0.46875}},
             0.8671875, 0.90625);
    addBox(mesh, kOak, {-0.265625, 0.8671875, -0.296875}, {0.265625, 0.90625, -0.171875});
    addBox(mesh, kOak, {-0.265625, 0.8671875, 0.203125}, {0.265625, 0.90625, 0.3125});
    addBox(mesh, kSteel, {-0.265625, 0.859375, -0.171875}, {0.265625, 0.8828125, 0.203125});
    for (const double x : {-0.265625, 0.25})
        addBox(mesh, kSteel, {x, 0.8671875, -0.171875}, {x + 0.015625, 0.9140625, 0.203125});
    for (const double z : {-0.171875, 0.1875})
        addBox(mesh, kSteel, {-0.265625, 0.8671875, z}, {0.265625, 0.9140625, z + 0.015625});
    addTurned(mesh, kChrome, {0, 0.8828125, 0.015625}, 12, {{0.04, -0.01}, {0.04, 0.00390625}});
    addTap(mesh, {0, 0.90625, -0.21875}, 0.25);
    return mesh;
}

MeshBuilder stove() {
    MeshBuilder mesh;
    addBox(mesh, kSteel, {-0.296875, 0, -0.296875}, {0.296875, 0.890625, 0.28125});
    addBox(mesh, kScreenBlack, {-0.296875, 0.8828125, -0.296875}, {0.296875, 0.90625, 0.296875});
    for (const double x : {-0.140625, 0.140625})
        for (const double z : {-0.140625, 0.125})
            addTurned(mesh, kBlackPlastic, {x, 0.90625, z}, 16,
                      {{0.09375, -0.0078125}, {0.09375, 0.00390625}, {0.0859375, 0.0078125}});
    addBox(mesh, kScreenBlack, {-0.25, 0.203125, 0.2734375}, {0.25, 0.640625, 0.2890625});
    addBox(mesh, kChrome, {-0.234375, 0.671875, 0.2734375}, {0.234375, 0.6875, 0.3125});
    for (int knob = 0; knob < 4; ++knob) {
        const double x = -0.1875 + 0.125 * knob;
        addBox(mesh, kBlackPlastic, {x - 0.015625, 0.765625, 0.2734375}, {x + 0.015625, 0.796875, 0.3046875});
    }
    return mesh;
}

MeshBuilder wallCupboard() {
    MeshBuilder mesh;
    addBox(mesh, kWhite, {-0.46875, 0, 0}, {0.46875, 0.6875, 0.3125});
    for (const double x : {-0.4609375, 0.00390625})
        addBox(mesh, kBeech, {x, 0.0078125, 0.3046875}, {x + 0.45703125, 0.6796875, 0.328125});
    return mesh;
}

MeshBuilder fridge() {
    MeshBuilder mesh;
    addBox(mesh, kCeramic, {-0.296875, 0.03125, -0.3125}, {0.296875, 1.84375, 0.265625});
    addBox(mesh, kCeramic, {-0.296875, 0.0625, 0.2734375}, {0.296875, 0.640625, 0.3203125});
    addBox(mesh, kCeramic, {-0.296875, 0.65625, 0.2734375}, {0.296875, 1.84375, 0.3203125});
    addBox(mesh, kBlackPlastic, {-0.28125, 0.0625, 0.25}, {0.28125, 1.828125, 0.28125});
    for (const double y : {0.4375, 0.75})
        addBox(mesh, kChrome, {0.234375, y, 0.3125}, {0.2578125, y + 0.171875, 0.359375});
    for (const double x : {-0.25, 0.25})
        for (const double z : {-0.25, 0.1875})
            addTurned(mesh, kBlackPlastic, {x, 0, z}, 6, {{0.025, 0}, {0.025, 0.0390625}});
    return mesh;
}

MeshBuilder roundTable() {
    MeshBuilder mesh;
    addTurned(mesh, kBeech, {0, 0, 0}, 16,
              {{0.484375, 0.703125}, {0.5, 0.71875}, {0.5, 0.734375}, {0.4921875, 0.7421875}});
    addTurned(mesh, kSteel, {0, 0, 0}, 12,
              {{0.296875, 0}, {0.296875, 0.015625}, {0.046875, 0.046875}, {0.0390625, 0.640625}, {0.1875, 0.703125}});
    return mesh;
}

MeshBuilder coffeeMachine() {
    MeshBuilder mesh;
    addBox(mesh, kBlackPlastic, {-0.15625, 0, -0.1875}, {0.15625, 0.046875, 0.1875});
    addBox(mesh, kBlackPlastic, {-0.15625, 0.03125, -0.1875}, {0.15625, 0.40625, -0.03125});
    addBox(mesh, kSteel, {-0.15625, 0.25, -0.0625}, {0.15625, 0.40625, 0.15625});
    addTurned(mesh, kChrome, {0, 0, 0.0625}, 8, {{0.015625, 0.203125}, {0.03125, 0.2578125}});
    addTurned(mesh, kBlackPlastic, {0, 0, -0.0625}, 12, {{0.09375, 0.3984375}, {0.109375, 0.5}});
    return mesh;
}

MeshBuilder mug() {
    MeshBuilder mesh;
    addTurned(
        mesh, kBookRed, {0, 0, 0}, 12,
        {{0.03515625, 0}, {0.0390625, 0.0078125}, {0.0390625, 0.09375}, {0.03515625, 0.09375}, {0.03515625, 0.015625}});
    addBox(mesh, kBookRed, {0.03515625, 0.0234375, -0.005859375}, {0.0625, 0.0703125, 0.005859375});
    return mesh;
}

/// Cistern at the back, z = 0 the wall.
MeshBuilder toilet() {
    MeshBuilder mesh;
    addTurned(mesh, kCeramic, {0, 0, 0.40625}, 16,
              {{0.109375, 0},
               {0.125, 0.125},
               {0.171875, 0.296875},
               {0.1875, 0.375},
               {0.1875, 0.3984375},
               {0.140625, 0.3984375},
               {0.125, 0.34375},
               {0.0625, 0.25},
               {0, 0.234375}});
    addBox(mesh, kCeramic, {-0.09375, 0, 0.125}, {0.09375, 0.3125, 0.34375});
    addBox(mesh, kCeramic, {-0.1875, 0.3125, 0.0625}, {0.1875, 0.3984375, 0.28125});
    addBox(mesh, kCeramic, {-0.1875, 0.390625, 0}, {0.1875, 0.765625, 0.171875});
    addBox(mesh, kCeramic, {-0.1953125, 0.7578125, 0}, {0.1953125, 0.7890625, 0.1796875});
    addTurned(mesh, kChrome, {0, 0, 0.09375}, 8, {{0.025, 0.78125}, {0.025, 0.796875}});
    // The seat: a ring.
    addTurned(mesh, kGreyPlastic, {0, 0, 0.40625}, 16,
              {{0.1953125, 0.3984375}, {0.1953125, 0.421875}, {0.1328125, 0.421875}, {0.1328125, 0.3994140625}});
    addPrism(mesh, kGreyPlastic, kAcross,
             {{0.171875, 0.421875}, {0.203125, 0.421875}, {0.1796875, 0.78125}, {0.171875, 0.78125}}, -0.171875,
             0.171875);
    return mesh;
}

/// z = 0 the wall.
MeshBuilder washbasin() {
    MeshBuilder mesh;
    addTurned(mesh, kCeramic, {0, 0, 0.25}, 16,
              {{0.0625, 0.65625},
               {0.1875, 0.75},
               {0.234375, 0.84375},
               {0.2421875, 0.859375},
               {0.203125, 0.859375},
               {0.1640625, 0.78125},
               {0.0625, 0.734375},
               {0, 0.7265625}});
    addBox(mesh, kCeramic, {-0.21875, 0.78125, 0}, {0.21875, 0.859375, 0.09375});
    addBox(mesh, kCeramic, {-0.09375, 0.703125, 0.03125}, {0.09375, 0.78125, 0.1875});
    addTurned(mesh, kChrome, {0, 0, 0.1875}, 8, {{0.02, 0.375}, {0.02, 0.703125}});
    addBox(mesh, kChrome, {-0.01953125, 0.375, 0}, {0.01953125, 0.4140625, 0.1875});
    addTap(mesh, {0, 0.859375, 0.0546875}, 0.140625);
    return mesh;
}

/// Walls of a cubicle, a metre wide, its door ajar; z = 0 the wall of the room, open towards +z.
MeshBuilder cubicle() {
    MeshBuilder mesh;
    addBox(mesh, kPanelBlue, {-0.5, 0.125, 0}, {-0.46875, 2.03125, 1.40625});
    addBox(mesh, kPanelBlue, {0.46875, 0.125, 0}, {0.5, 2.03125, 1.40625});
    for (const double x : {-0.484375, 0.484375})
        addTurned(mesh, kChrome, {x, 0, 1.375}, 8, {{0.0125, 0}, {0.0125, 0.140625}});
    addBox(mesh, kPanelBlue, {-0.46875, 0.125, 1.375}, {-0.3125, 2.03125, 1.40625});
    addBox(mesh, kPanelBlue, {0.3125, 0.125, 1.375}, {0.46875, 2.03125, 1.40625});
    addBox(mesh, kChrome, {-0.5, 2.015625, 1.375}, {0.5, 2.0625, 1.4140625});
    addPrism(mesh, kPanelBlue, kUpright, {{0.8984375, 0.015625}, {0.9140625, 0}, {1.390625, 0.296875}, {1.375, 0.3125}},
             0.140625, 2);
    addTurned(mesh, kPaper, {-0.40625, 0, 0.25}, 12, {{0.05, 0.703125}, {0.05, 0.8046875}});
    return mesh;
}

MeshBuilder handDryer() {
    MeshBuilder mesh;
    addPrism(mesh, kCeramic, kAcross,
             {{0, 0}, {0.140625, 0.015625}, {0.171875, 0.171875}, {0.125, 0.25}, {0, 0.265625}}, -0.140625, 0.140625);
    addTurned(mesh, kChrome, {0, 0, 0.0859375}, 12, {{0.025, -0.046875}, {0.03125, 0.02}});
    return mesh;
}

}  // namespace

void addWetRooms(Shelf& meshes) {
    shelve(meshes, kCounter, "Counter", counter());
    shelve(meshes, kSinkCounter, "Sink", sinkCounter());
    shelve(meshes, kStove, "Stove", stove());
    shelve(meshes, kWallCupboard, "Cupboard", wallCupboard());
    shelve(meshes, kFridge, "Fridge", fridge());
    shelve(meshes, kRoundTable, "Table", roundTable());
    shelve(meshes, kCoffeeMachine, "Coffee machine", coffeeMachine());
    shelve(meshes, kMug, "Mug", mug());
    shelve(meshes, kToilet, "Toilet", toilet());
    shelve(meshes, kWashbasin, "Washbasin", washbasin());
    MeshBuilder mirror;
    addBox(mirror, kMirror, {-0.3125, 0, 0}, {0.3125, 0.875, 0.015625});
    shelve(meshes, kMirrorPane, "Mirror", mirror);
    shelve(meshes, kCubicle, "Cubicle", cubicle());
    shelve(meshes, kHandDryer, "Hand dryer", handDryer());
}

}  // namespace sightline::building
