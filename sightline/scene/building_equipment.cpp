// What stands in the stores, the lobby and the corridors of a procedural building, and on its walls and ceilings.
// SPDX-License-Identifier: MIT
#include "sightline/scene/building_library.h"
#include "sightline/scene/building_plan.h"

namespace sightline::building {
namespace {

using city::addBox;
using city::addPrism;
using city::addTurned;
using city::kAcross;
using city::kUpright;
using city::MeshBuilder;

MeshBuilder metalShelf() {
    MeshBuilder mesh;
    for (const double x : {-0.484375, 0.484375})
        for (const double z : {-0.21875, 0.21875})
            addBox(mesh, kSteel, {x - 0.015625, 0, z - 0.015625}, {x + 0.015625, 2, z + 0.015625});
    for (int board = 0; board < 5; ++board) {
        const double y = 0.0625 + 0.46875 * board;
        addBox(mesh, kSteel, {-0.4921875, y, -0.2265625}, {0.4921875, y + 0.03125, 0.2265625});
        if (board == 4) break;
        for (int i = 0; i < 4; ++i) {
            if ((board * 5 + i * 3) % 7 == 2) continue;
            const double x = -0.453125 + 0.234375 * i, tall = 0.203125 + 0.03125 * ((board + 2 * i) % 5);
            const uint32_t colour = (board + i) % 3 == 0 ? kGreyPlastic : kCardboard;
            addBox(mesh, colour, {x, y + 0.03125, -0.171875}, {x + 0.203125, y + 0.03125 + tall, 0.15625});
        }
    }
    return mesh;
}

MeshBuilder boxes() {
    MeshBuilder mesh;
    addBox(mesh, kCardboard, {-0.3125, 0, -0.234375}, {0.296875, 0.421875, 0.234375});
    addBox(mesh, kPaper, {-0.03125, 0.0625, 0.2265625}, {0.125, 0.1875, 0.2373046875});
    addBox(mesh, kCardboard, {-0.25, 0.421875, -0.203125}, {0.1875, 0.734375, 0.1875});
    addBox(mesh, kPaper, {-0.25390625, 0.5625, -0.046875}, {0.19140625, 0.59375, 0.046875});
    return mesh;
}

MeshBuilder ladder() {
    MeshBuilder mesh;
    for (const double x : {-0.203125, 0.203125}) {
        addPrism(mesh, kSteel, kAcross, {{0.359375, 0}, {0.40625, 0}, {0.046875, 1.75}, {0, 1.75}}, -x - 0.015625,
                 -x + 0.015625);
        addPrism(mesh, kSteel, kAcross, {{-0.40625, 0}, {-0.375, 0}, {0.015625, 1.71875}, {-0.015625, 1.71875}},
                 -x - 0.0146484375, -x + 0.0146484375);
    }
    for (int step = 1; step < 7; ++step) {
        const double y = 0.25 * step, z = 0.3828125 * (1 - y / 1.75);
        addBox(mesh, kSteel, {-0.203125, y - 0.015625, z - 0.03125}, {0.203125, y, z + 0.0625});
    }
    return mesh;
}

MeshBuilder trolley() {
    MeshBuilder mesh;
    for (const double y : {0.15625, 0.5})
        addBox(mesh, kGreyPlastic, {-0.40625, y, -0.234375}, {0.40625, y + 0.03125, 0.234375});
    for (const double x : {-0.375, 0.375}) {
        for (const double z : {-0.203125, 0.203125}) {
            addTurned(mesh, kChrome, {x, 0, z}, 8, {{0.0125, 0.078125}, {0.0125, 0.890625}});
            addTurned(mesh, kBlackPlastic, {x, 0, z}, 8,
                      {{0.015625, 0}, {0.0390625, 0.015625}, {0.0390625, 0.0625}, {0.015625, 0.0859375}});
        }
        addBox(mesh, kChrome, {x - 0.01171875, 0.875, -0.203125}, {x + 0.01171875, 0.8984375, 0.203125});
    }
    addTurned(mesh, kFabricRed, {-0.1875, 0.53125, 0}, 12,
              {{0.109375, 0}, {0.140625, 0.28125}, {0.1328125, 0.28125}, {0.109375, 0.03125}});
    addTurned(mesh, kFabricBlue, {0.15625, 0.53125, 0}, 12,
              {{0.109375, 0}, {0.140625, 0.28125}, {0.1328125, 0.28125}, {0.109375, 0.03125}});
    return mesh;
}

MeshBuilder reception() {
    MeshBuilder mesh;
    // A bent counter, (z, x), with a ledge on its outer side.
    addPrism(mesh, kOak, kUpright,
             {{0.25, -1.5},
              {0.5, -0.75},
              {0.5625, 0},
              {0.5, 0.75},
              {0.25, 1.5},
              {0.203125, 1.484375},
              {0.4453125, 0.734375},
              {0.5078125, 0},
              {0.4453125, -0.734375},
              {0.203125, -1.484375}},
             0, 1.0625);
    addPrism(mesh, kTerrazzo, kUpright,
             {{0.296875, -1.515625},
              {0.5625, -0.75},
              {0.625, 0},
              {0.5625, 0.75},
              {0.296875, 1.515625},
              {0.09375, 1.453125},
              {0.3125, 0.71875},
              {0.375, 0},
              {0.3125, -0.71875},
              {0.09375, -1.453125}},
             1.0625, 1.109375);
    addPrism(mesh, kBeech, kUpright,
             {{-0.25, -1.328125},
              {0.25, -1.5},
              {0.484375, -0.75},
              {0.546875, 0},
              {0.484375, 0.75},
              {0.25, 1.5},
              {-0.25, 1.328125},
              {-0.140625, 0.65625},
              {-0.125, 0},
              {-0.140625, -0.65625}},
             0.703125, 0.734375);
    return mesh;
}

MeshBuilder sofa() {
    MeshBuilder mesh;
    addBox(mesh, kFabricGrey, {-0.875, 0.09375, -0.40625}, {0.875, 0.28125, 0.390625});
    for (const double x : {-0.359375, 0.359375}) {
        addPrism(mesh, kFabricGrey, kAcross,
                 {{-0.25, 0.2734375},
                  {0.390625, 0.2734375},
                  {0.421875, 0.3125},
                  {0.421875, 0.40625},
                  {0.390625, 0.4375},
                  {-0.25, 0.421875}},
                 -x - 0.34375, -x + 0.34375);
        addPrism(
            mesh, kFabricGrey, kAcross,
            {{-0.25, 0.40625}, {-0.15625, 0.421875}, {-0.21875, 0.828125}, {-0.265625, 0.859375}, {-0.328125, 0.84375}},
            -x - 0.3359375, -x + 0.3359375);
    }
    addPrism(mesh, kFabricGrey, kAcross,
             {{-0.40625, 0.2734375}, {-0.234375, 0.2734375}, {-0.3125, 0.78125}, {-0.40625, 0.78125}}, -0.875, 0.875);
    for (const double x : {-0.8046875, 0.8046875})
        addPrism(mesh, kFabricGrey, kAcross,
                 {{-0.3984375, 0.265625},
                  {0.3984375, 0.265625},
                  {0.3984375, 0.546875},
                  {0.359375, 0.59375},
                  {-0.390625, 0.625}},
                 -x - 0.0859375, -x + 0.0859375);
    for (const double x : {-0.796875, 0.796875})
        for (const double z : {-0.34375, 0.34375})
            addTurned(mesh, kChrome, {x, 0, z}, 8, {{0.02, 0}, {0.025, 0.1015625}});
    return mesh;
}

MeshBuilder lowTable() {
    MeshBuilder mesh;
    addBox(mesh, kOak, {-0.546875, 0.359375, -0.296875}, {0.546875, 0.390625, 0.296875});
    for (const double x : {-0.484375, 0.484375})
        for (const double z : {-0.234375, 0.234375})
            addTurned(mesh, kOak, {x, 0, z}, 8, {{0.015625, 0}, {0.025, 0.3671875}});
    addBox(mesh, kBookYellow, {-0.25, 0.390625, -0.140625}, {-0.046875, 0.3984375, 0.125});
    addBox(mesh, kBookBlue, {0.0625, 0.390625, -0.09375}, {0.265625, 0.40625, 0.171875});
    return mesh;
}

MeshBuilder copier() {
    MeshBuilder mesh;
    addBox(mesh, kGreyPlastic, {-0.3125, 0.046875, -0.296875}, {0.3125, 0.90625, 0.28125});
    for (int tray = 0; tray < 4; ++tray) {
        const double y = 0.078125 + 0.15625 * tray;
        addBox(mesh, kWhite, {-0.296875, y, 0.265625}, {0.296875, y + 0.140625, 0.3046875});
        addBox(mesh, kBlackPlastic, {-0.078125, y + 0.09375, 0.296875}, {0.078125, y + 0.109375, 0.3203125});
    }
    addBox(mesh, kBlackPlastic, {-0.296875, 0.8984375, -0.28125}, {0.296875, 0.9296875, 0.265625});
    addPrism(mesh, kGreyPlastic, kAcross,
             {{-0.28125, 0.921875}, {0.25, 0.921875}, {0.234375, 0.9765625}, {-0.28125, 1.0546875}}, -0.296875,
             0.296875);
    addPrism(mesh, kScreenBlack, kAcross,
             {{0.234375, 0.890625}, {0.359375, 0.8984375}, {0.359375, 0.9140625}, {0.25, 1}}, -0.171875, 0.171875);
    for (const double x : {-0.25, 0.25})
        for (const double z : {-0.234375, 0.21875})
            addTurned(mesh, kBlackPlastic, {x, 0, z}, 6, {{0.03125, 0}, {0.03125, 0.0546875}});
    return mesh;
}

MeshBuilder bench() {
    MeshBuilder mesh;
    for (int slat = 0; slat < 4; ++slat) {
        const double z = -0.1875 + 0.1015625 * slat;
        addBox(mesh, kOak, {-0.75, 0.421875, z}, {0.75, 0.4453125, z + 0.078125});
    }
    for (const double x : {-0.5625, 0.5625})
        addPrism(mesh, kSteel, kAcross,
                 {{-0.171875, 0},
                  {-0.140625, 0},
                  {-0.0625, 0.390625},
                  {0.0703125, 0.390625},
                  {0.1484375, 0},
                  {0.1796875, 0},
                  {0.171875, 0.421875},
                  {-0.1640625, 0.421875}},
                 -x - 0.025390625, -x + 0.025390625);
    return mesh;
}

/// Hangs on a wall at z = 0.
MeshBuilder extinguisher() {
    MeshBuilder mesh;
    addTurned(mesh, kSignalRed, {0, 0, 0.109375}, 12,
              {{0.0703125, 0}, {0.078125, 0.015625}, {0.078125, 0.375}, {0.0546875, 0.4296875}, {0.0234375, 0.453125}});
    addTurned(mesh, kBlackPlastic, {0, 0, 0.109375}, 8, {{0.015625, 0.4453125}, {0.015625, 0.5}});
    addBox(mesh, kBlackPlastic, {-0.015625, 0.484375, 0.109375}, {0.015625, 0.5078125, 0.21875});
    addBox(mesh, kSteel, {-0.03125, 0.25, 0}, {0.03125, 0.3125, 0.0625});
    return mesh;
}

MeshBuilder exitSign() {
    MeshBuilder mesh;
    addBox(mesh, kSteel, {-0.140625, -0.109375, -0.01171875}, {-0.125, 0, 0.01171875});
    addBox(mesh, kSteel, {0.125, -0.109375, -0.01171875}, {0.140625, 0, 0.01171875});
    addBox(mesh, kSignGreen, {-0.203125, -0.3125, -0.025390625}, {0.203125, -0.1015625, 0.025390625});
    for (const double side : {-1.0, 1.0})
        addBox(mesh, kPaper, {-0.09375, -0.2578125, side < 0 ? -0.02734375 : 0.015625},
               {0.09375, -0.15625, side < 0 ? -0.015625 : 0.02734375});
    return mesh;
}

MeshBuilder ceilingLight() {
    MeshBuilder mesh;
    addBox(mesh, kWhite, {-0.59375, -0.0546875, -0.140625}, {0.59375, 0, 0.140625});
    for (const double z : {-0.0703125, 0.0703125})
        addPrism(mesh, kLampShade, kAcross,
                 {{z - 0.0390625, -0.05078125},
                  {z - 0.025, -0.0703125},
                  {z + 0.025, -0.0703125},
                  {z + 0.0390625, -0.05078125}},
                 -0.578125, 0.578125);
    return mesh;
}

/// z = 0 the wall.
MeshBuilder radiator() {
    MeshBuilder mesh;
    for (int rib = 0; rib < 8; ++rib) {
        const double x = -0.5625 + 0.14453125 * rib;
        addBox(mesh, kCeramic, {x, 0.125, 0.046875}, {x + 0.09375, 0.625, 0.140625});
    }
    for (const double y : {0.15625, 0.5625})
        addBox(mesh, kCeramic, {-0.59375, y, 0.0703125}, {0.59375, y + 0.0390625, 0.109375});
    addTurned(mesh, kCeramic, {-0.578125, 0, 0.0859375}, 8, {{0.01171875, 0}, {0.01171875, 0.1640625}});
    addTurned(mesh, kGreyPlastic, {0.609375, 0, 0.0859375}, 8, {{0.02, 0.546875}, {0.025, 0.625}});
    return mesh;
}

MeshBuilder wallSwitch() {
    MeshBuilder mesh;
    addBox(mesh, kCeramic, {-0.0390625, 0, 0}, {0.0390625, 0.078125, 0.0078125});
    addPrism(mesh, kCeramic, kAcross,
             {{0.00390625, 0.01171875}, {0.009765625, 0.01171875}, {0.015625, 0.06640625}, {0.00390625, 0.06640625}},
             -0.02734375, 0.02734375);
    return mesh;
}

MeshBuilder column() {
    MeshBuilder mesh;
    const double top = kStorey - kSlab;
    addTurned(mesh, kConcrete, {0, 0, 0}, 16,
              {{0.25, 0},
               {0.25, 0.125},
               {0.1953125, 0.15625},
               {0.1875, top - 0.25},
               {0.28125, top - 0.0625},
               {0.28125, top}});
    return mesh;
}

}  // namespace

void addEquipment(Shelf& meshes) {
    shelve(meshes, kMetalShelf, "Metal shelf", metalShelf());
    shelve(meshes, kBoxes, "Boxes", boxes());
    shelve(meshes, kLadder, "Ladder", ladder());
    shelve(meshes, kTrolley, "Trolley", trolley());
    shelve(meshes, kReception, "Reception", reception());
    shelve(meshes, kSofa, "Sofa", sofa());
    shelve(meshes, kLowTable, "Low table", lowTable());
    shelve(meshes, kCopier, "Copier", copier());
    shelve(meshes, kBench, "Bench", bench());
    shelve(meshes, kExtinguisher, "Fire extinguisher", extinguisher());
    shelve(meshes, kExitSign, "Exit sign", exitSign());
    shelve(meshes, kCeilingLight, "Ceiling light", ceilingLight());
    shelve(meshes, kRadiator, "Radiator", radiator());
    shelve(meshes, kSwitch, "Light switch", wallSwitch());
    shelve(meshes, kColumn, "Column", column());
}

}  // namespace sightline::building
