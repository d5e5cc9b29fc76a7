// What stands in offices and meeting rooms: desks, chairs, shelves, plants.
// SPDX-License-Identifier: MIT
#include "sightline/base/random.h"
#include "sightline/scene/building_library.h"

namespace sightline::building {
namespace {

using city::addBox;
using city::addPrism;
using city::addTurned;
using city::Frame;
using city::MeshBuilder;

MeshBuilder desk() {
    MeshBuilder mesh;
    addBox(mesh, kBeech, {-0.8125, 0.703125, -0.40625}, {0.8125, 0.734375, 0.40625});
    addBox(mesh, kBeech, {-0.71875, 0.34375, -0.34375}, {0.71875, 0.6875, -0.328125});
    for (const double x : {-0.734375, 0.734375}) {
        addBox(mesh, kSteel, {x - 0.03125, 0, -0.375}, {x + 0.03125, 0.03125, 0.375});
        addBox(mesh, kSteel, {x - 0.03125, 0.671875, -0.375}, {x + 0.03125, 0.703125, 0.375});
        for (const double z : {-0.28125, 0.28125})
            addTurned(mesh, kSteel, {x, 0, z}, 6, {{0.025, 0.015625}, {0.025, 0.6875}});
    }
    return mesh;
}

/// Five castors, a gas spring, a rounded seat, a curved back and arm rests.
MeshBuilder officeChair(uint32_t fabric) {
    MeshBuilder mesh;
    for (int fifth = 0; fifth < 5; ++fifth) {
        const Frame arm = fifthFrame(fifth);
        addPrism(mesh, kBlackPlastic, arm, {{0, 0.078125}, {0.28125, 0.0625}, {0.28125, 0.09375}, {0, 0.140625}}, -0.02,
                 0.02);
        addTurned(mesh, kBlackPlastic, arm.u * 0.28125, 6, {{0.02, 0}, {0.03125, 0.03125}, {0.015, 0.0625}});
    }
    addTurned(mesh, kChrome, {0, 0, 0}, 8, {{0.03125, 0.125}, {0.025, 0.40625}});
    addTurned(mesh, fabric, {0, 0, 0}, 12,
              {{0.1875, 0.40625}, {0.234375, 0.421875}, {0.25, 0.453125}, {0.234375, 0.484375}, {0.171875, 0.5}});
    // The back: an arc in the plan, (z, x), carried up.
    const std::vector<glm::dvec2> back{{-0.171875, -0.21875}, {-0.21875, -0.125},   {-0.234375, 0}, {-0.21875, 0.125},
                                       {-0.171875, 0.21875},  {-0.203125, 0.21875}, {-0.25, 0.125}, {-0.265625, 0},
                                       {-0.25, -0.125},       {-0.203125, -0.21875}};
    addPrism(mesh, fabric, city::kUpright, back, 0.59375, 1.03125);
    addPrism(mesh, kBlackPlastic, city::kAcross,
             {{-0.28125, 0.4375}, {-0.25, 0.4375}, {-0.2578125, 0.8125}, {-0.28125, 0.8125}}, -0.03125, 0.03125);
    addBox(mesh, kBlackPlastic, {-0.03125, 0.421875, -0.28125}, {0.03125, 0.4375, 0});
    for (const double x : {-0.28125, 0.28125}) {
        addBox(mesh, kBlackPlastic, {x - 0.03125, 0.65625, -0.140625}, {x + 0.03125, 0.6875, 0.125});
        addBox(mesh, kBlackPlastic, {x - 0.015625, 0.4375, -0.03125}, {x + 0.015625, 0.671875, 0.03125});
        addBox(mesh, kBlackPlastic, {x < 0 ? x : 0.1875, 0.421875, -0.03125},
               {x < 0 ? -0.1875 : x, 0.4453125, 0.03125});
    }
    return mesh;
}

MeshBuilder monitor() {
    MeshBuilder mesh;
    addTurned(mesh, kBlackPlastic, {0, 0, -0.03125}, 12, {{0.125, 0}, {0.125, 0.0078125}, {0.03125, 0.015625}});
    addBox(mesh, kBlackPlastic, {-0.03125, 0.0078125, -0.0625}, {0.03125, 0.25, -0.03125});
    addBox(mesh, kBlackPlastic, {-0.296875, 0.125, -0.03125}, {0.296875, 0.46875, 0});
    addBox(mesh, kBlackPlastic, {-0.15625, 0.1875, -0.0625}, {0.15625, 0.40625, -0.015625});
    addBox(mesh, kScreenBlack, {-0.28125, 0.140625, 0}, {0.28125, 0.453125, 0.0009765625});
    return mesh;
}

MeshBuilder keyboard() {
    MeshBuilder mesh;
    addBox(mesh, kBlackPlastic, {-0.21875, 0, -0.0625}, {0.15625, 0.015625, 0.0625});
    for (int row = 0; row < 3; ++row) {
        const double z = -0.046875 + 0.03515625 * row;
        addBox(mesh, kGreyPlastic, {-0.203125, 0.0078125, z}, {0.140625, 0.0234375, z + 0.02734375});
    }
    addTurned(mesh, kBlackPlastic, {0.25, 0, 0}, 8, {{0.03125, 0}, {0.03125, 0.015625}, {0.015, 0.03125}});  // mouse
    return mesh;
}

MeshBuilder deskLamp() {
    MeshBuilder mesh;
    addTurned(mesh, kSteel, {0, 0, 0}, 8, {{0.09375, 0}, {0.09375, 0.015625}, {0.015625, 0.03125}});
    addPrism(mesh, kSteel, city::kAcross,
             {{-0.0078125, 0.015625}, {0.0078125, 0.015625}, {-0.109375, 0.296875}, {-0.125, 0.296875}}, -0.0078125,
             0.0078125);
    addPrism(mesh, kSteel, city::kAcross,
             {{-0.125, 0.28125}, {-0.109375, 0.28125}, {0.109375, 0.4375}, {0.109375, 0.453125}}, -0.0068359375,
             0.0068359375);
    addTurned(mesh, kSteel, {0, 0, 0.125}, 8, {{0.0859375, 0.375}, {0.0390625, 0.453125}, {0.01953125, 0.484375}});
    addTurned(mesh, kLampShade, {0, 0, 0.125}, 8, {{0.03125, 0.359375}, {0.046875, 0.3828125}});
    return mesh;
}

MeshBuilder drawers() {
    MeshBuilder mesh;
    addBox(mesh, kBeech, {-0.21875, 0.0625, -0.28125}, {0.21875, 0.5625, 0.265625});
    for (int i = 0; i < 3; ++i) {
        const double y = 0.078125 + 0.15625 * i;
        addBox(mesh, kBeech, {-0.203125, y, 0.25}, {0.203125, y + 0.140625, 0.28125});
        addBox(mesh, kChrome, {-0.0625, y + 0.09375, 0.2734375}, {0.0625, y + 0.109375, 0.296875});
    }
    for (const double x : {-0.171875, 0.171875})
        for (const double z : {-0.21875, 0.21875})
            addTurned(mesh, kBlackPlastic, {x, 0, z}, 6, {{0.025, 0}, {0.025, 0.078125}});
    return mesh;
}

MeshBuilder paperBin() {
    MeshBuilder mesh;
    addTurned(mesh, kBlackPlastic, {0, 0, 0}, 12,
              {{0.109375, 0},
               {0.140625, 0.3125},
               {0.1484375, 0.3125},
               {0.1484375, 0.328125},
               {0.125, 0.328125},
               {0.109375, 0.265625}});
    addTurned(mesh, kPaper, {0.015625, 0, 0}, 6, {{0, 0.25}, {0.0625, 0.28125}, {0, 0.34375}});
    return mesh;
}

/// Two trays and a pile.
MeshBuilder papers() {
    MeshBuilder mesh;
    addBox(mesh, kPaper, {-0.109375, 0, -0.15625}, {0.109375, 0.03125, 0.15625});
    addBox(mesh, kPaper, {-0.125, 0.03125, -0.140625}, {0.09375, 0.0390625, 0.15625});
    addBox(mesh, kBookBlue, {-0.09375, 0.0390625, -0.125}, {0.109375, 0.0625, 0.140625});
    return mesh;
}

MeshBuilder phone() {
    MeshBuilder mesh;
    addPrism(mesh, kBlackPlastic, city::kAcross, {{-0.09375, 0}, {0.09375, 0}, {0.09375, 0.015625}, {-0.09375, 0.0625}},
             -0.09375, 0.09375);
    addPrism(mesh, kBlackPlastic, city::kAcross,
             {{-0.09375, 0.0546875}, {0.09375, 0.0234375}, {0.0859375, 0.046875}, {-0.078125, 0.0859375}}, -0.0859375,
             -0.0390625);
    return mesh;
}

/// Boards between two sides and a back, and books on them.
/// @param boards  one more than the rows of books
MeshBuilder bookShelf(double half, double height, int boards, uint64_t seed) {
    MeshBuilder mesh;
    const double depth = 0.15625, thick = 0.0234375;
    addBox(mesh, kOak, {-half, 0, -depth}, {-half + thick, height, depth});
    addBox(mesh, kOak, {half - thick, 0, -depth}, {half, height, depth});
    addBox(mesh, kOak, {-half + thick, 0, -depth}, {half - thick, height, -depth + 0.0078125});
    Random random(seed);
    const double step = (height - 0.0625 - thick) / (boards - 1);
    for (int board = 0; board < boards; ++board) {
        const double y = 0.0625 + board * step;
        addBox(mesh, kOak, {-half + thick, y, -depth + 0.0078125}, {half - thick, y + thick, depth - 0.0078125});
        if (board + 1 == boards) break;
        for (double x = -half + thick + 0.01; x < half - thick - 0.07;) {
            if (random.below(9) == 0) {
                x += random.uniform(0.05, 0.2);
                continue;
            }
            const double wide = random.uniform(0.03, 0.1), tall = random.uniform(0.65, 0.9) * (step - thick);
            const double front = random.uniform(0.06, 0.12);
            addBox(mesh, static_cast<uint32_t>(kBookRed + random.below(4)), {x, y + thick, -depth + 0.015625},
                   {x + wide, y + thick + tall, front});
            x += wide + 0.002;
        }
    }
    return mesh;
}

MeshBuilder plant(double pot, double height, double spread, int leaves) {
    MeshBuilder mesh;
    addPlant(mesh, pot, height, spread, leaves);
    return mesh;
}

/// What hangs on a wall: a rim around a panel.
MeshBuilder panel(double half, double height, double depth, uint32_t rim, uint32_t face) {
    MeshBuilder mesh;
    addBox(mesh, rim, {-half, 0, 0}, {half, height, depth});
    const double edge = 0.03125;
    addBox(mesh, face, {-half + edge, edge, depth}, {half - edge, height - edge, depth + 0.0009765625});
    return mesh;
}

MeshBuilder whiteboard() {
    MeshBuilder mesh = panel(0.9375, 1.1875, 0.0234375, kSteel, kPaper);
    addBox(mesh, kSteel, {-0.5, -0.015625, 0.015625}, {0.5, 0, 0.078125});
    for (int pen = 0; pen < 3; ++pen)
        addBox(mesh, static_cast<uint32_t>(kBookRed + pen), {-0.25 + 0.1875 * pen, 0, 0.046875},
               {-0.125 + 0.1875 * pen, 0.015625, 0.0625});
    return mesh;
}

MeshBuilder coatStand() {
    MeshBuilder mesh;
    addTurned(mesh, kOak, {0, 0, 0}, 8, {{0.021875, 0.03125}, {0.021875, 1.75}, {0, 1.8125}});
    addTurned(mesh, kOak, {0, 0, 0}, 12, {{0.203125, 0}, {0.203125, 0.03125}, {0.0625, 0.046875}});
    for (int fifth = 0; fifth < 5; ++fifth)
        addPrism(mesh, kOak, fifthFrame(fifth),
                 {{0.01, 1.625}, {0.171875, 1.6875}, {0.171875, 1.71875}, {0.01, 1.65625}}, -0.01, 0.01);
    addPrism(mesh, kFabricGrey, city::kUpright,
             {{0.03, -0.171875}, {0.140625, -0.1875}, {0.171875, 0}, {0.140625, 0.1875}, {0.03, 0.171875}}, 0.6875,
             1.640625);
    return mesh;
}

MeshBuilder meetingTable() {
    MeshBuilder mesh;
    // A boat's outline, (z, x).
    addPrism(mesh, kOak, city::kUpright,
             {{-0.453125, -1.203125},
              {0.453125, -1.203125},
              {0.5625, -0.5},
              {0.59375, 0},
              {0.5625, 0.5},
              {0.453125, 1.203125},
              {-0.453125, 1.203125},
              {-0.5625, 0.5},
              {-0.59375, 0},
              {-0.5625, -0.5}},
             0.703125, 0.75);
    for (const double x : {-0.75, 0.75}) {
        addTurned(mesh, kSteel, {x, 0, 0}, 12,
                  {{0.296875, 0}, {0.296875, 0.015625}, {0.0625, 0.03125}, {0.05, 0.6875}, {0.25, 0.703125}});
    }
    addBox(mesh, kBlackPlastic, {-0.140625, 0.75, -0.0625}, {0.140625, 0.765625, 0.0625});
    return mesh;
}

MeshBuilder visitorChair() {
    MeshBuilder mesh;
    for (const double x : {-0.203125, 0.203125}) {
        addTurned(mesh, kChrome, {x, 0, 0.1875}, 8, {{0.0125, 0}, {0.0125, 0.4296875}});
        addTurned(mesh, kChrome, {x, 0, -0.203125}, 8, {{0.0125, 0}, {0.0125, 0.8125}});
        addBox(mesh, kChrome, {x - 0.01171875, 0.40625, -0.203125}, {x + 0.01171875, 0.4296875, 0.1875});
    }
    // A seat with rounded front corners, (z, x).
    addPrism(mesh, kFabricRed, city::kUpright,
             {{-0.1875, -0.21875},
              {0.15625, -0.21875},
              {0.203125, -0.1953125},
              {0.2265625, -0.140625},
              {0.2265625, 0.140625},
              {0.203125, 0.1953125},
              {0.15625, 0.21875},
              {-0.1875, 0.21875}},
             0.4296875, 0.46875);
    addPrism(mesh, kFabricRed, city::kUpright,
             {{-0.1875, -0.21875},
              {-0.203125, 0},
              {-0.1875, 0.21875},
              {-0.2109375, 0.21875},
              {-0.2265625, 0},
              {-0.2109375, -0.21875}},
             0.59375, 0.8359375);
    return mesh;
}

}  // namespace

void addFurniture(Shelf& meshes) {
    shelve(meshes, kDesk, "Desk", desk());
    shelve(meshes, kOfficeChair, "Chair", officeChair(kFabricBlue));
    shelve(meshes, kMonitor, "Monitor", monitor());
    shelve(meshes, kKeyboard, "Keyboard", keyboard());
    shelve(meshes, kDeskLamp, "Desk lamp", deskLamp());
    shelve(meshes, kDrawers, "Drawers", drawers());
    shelve(meshes, kPaperBin, "Bin", paperBin());
    shelve(meshes, kPapers, "Papers", papers());
    shelve(meshes, kPhone, "Telephone", phone());
    shelve(meshes, kBookShelf, "Shelf", bookShelf(0.5, 2.0625, 6, 11));
    shelve(meshes, kLowShelf, "Low shelf", bookShelf(0.625, 0.859375, 3, 12));
    shelve(meshes, kPottedPlant, "Pot plant", plant(0.0703125, 0.421875, 0.171875, 15));
    shelve(meshes, kTallPlant, "Plant", plant(0.171875, 1.625, 0.46875, 40));
    shelve(meshes, kWhiteboard, "Whiteboard", whiteboard());
    shelve(meshes, kWallScreen, "Screen", panel(0.6875, 0.796875, 0.0546875, kBlackPlastic, kScreenBlack));
    shelve(meshes, kPicture, "Picture", panel(0.34375, 0.515625, 0.0234375, kBlackPlastic, kBookYellow));
    shelve(meshes, kCoatStand, "Coat stand", coatStand());
    shelve(meshes, kMeetingTable, "Meeting table", meetingTable());
    shelve(meshes, kVisitorChair, "Visitor's chair", visitorChair());
}

}  // namespace sightline::building
