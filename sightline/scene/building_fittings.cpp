// What is built into a procedural building: door leaves, windows, stairs, the lift.
// SPDX-License-Identifier: MIT
#include "sightline/scene/building_library.h"
#include "sightline/scene/building_plan.h"

namespace sightline::building {
namespace {

using city::addBox;
using city::addPrism;
using city::addTurned;
using city::kAcross;
using city::MeshBuilder;

constexpr double kOverlay = 0.015625;  // by which a leaf laps over the wall around its opening  [metres]
constexpr double kInset = 0.03125;     // of what stands in the opening, from its sides
constexpr double kFace = 0.0234375;    // thickness of the leaf on either side of the wall's face

/// A handle through the leaf at x.
void addHandle(MeshBuilder& mesh, double x) {
    for (const double side : {-1.0, 1.0}) {
        const double z0 = side < 0 ? -0.0703125 : 0.015625, z1 = side < 0 ? -0.015625 : 0.0703125;
        addBox(mesh, kChrome, {x - 0.0234375, 0.9375, side < 0 ? -0.02734375 : 0.015625},
               {x + 0.0234375, 1.1640625, side < 0 ? -0.015625 : 0.02734375});
        addBox(mesh, kChrome, {x - 0.0078125, 1.0625, z0}, {x + 0.0078125, 1.078125, z1});
        addBox(mesh, kChrome, {x - 0.125, 1.05859375, side < 0 ? z0 : z1 - 0.01953125},
               {x + 0.01171875, 1.08203125, side < 0 ? z0 + 0.01953125 : z1});
    }
}

/// A leaf that laps over three sides of its opening, so that nothing is seen past it when it is shut.
MeshBuilder leaf(double width, double height, uint32_t material) {
    MeshBuilder mesh;
    addBox(mesh, material, {-kOverlay, 0, 0}, {width + kOverlay, height + kOverlay, kFace});
    addBox(mesh, material, {kInset, 0, -kFace}, {width - kInset, height - kInset, 0.5 * kFace});
    for (const double low : {0.203125, 1.1875})  // raised panels
        addBox(mesh, material, {0.171875, low, 0.5 * kFace}, {width - 0.171875, low + 0.6875, kFace + 0.0078125});
    addHandle(mesh, width - 0.09375);
    for (const double y : {0.25, 1.6875})
        addTurned(mesh, kChrome, {-kOverlay + 0.0078125, 0, kFace}, 8, {{0.0078125, y}, {0.0078125, y + 0.09375}});
    return mesh;
}

/// Bars around two panes.
MeshBuilder glassLeaf() {
    MeshBuilder mesh;
    const double w = kGlassDoorWidth, h = kDoorHeight, z0 = -0.03125, z1 = 0.03125;
    for (const double x : {0.0, 0.5 * w - 0.0625, 0.5 * w, w - 0.0625})
        addBox(mesh, kFrameGrey, {x, 0, z0}, {x + 0.0625, h, z1});
    for (const double x : {0.0625, 0.5 * w + 0.0625}) {
        const double end = x + 0.5 * w - 0.125;
        addBox(mesh, kFrameGrey, {x, 0, z0}, {end, 0.125, z1});
        addBox(mesh, kFrameGrey, {x, h - 0.0625, z0}, {end, h, z1});
        addBox(mesh, kGlass, {x, 0.125, -0.0078125}, {end, h - 0.0625, 0.0078125});
    }
    for (const double x : {0.5 * w - 0.09375, 0.5 * w + 0.078125})
        for (const double z : {-0.0703125, 0.0546875})
            addBox(mesh, kChrome, {x, 0.75, z}, {x + 0.015625, 1.25, z + 0.015625});
    return mesh;
}

MeshBuilder liftLeaf() {
    MeshBuilder mesh;
    addBox(mesh, kSteel, {-0.0625, 0, 0}, {kLiftDoorWidth + 0.0625, kDoorHeight + 0.0625, 0.046875});
    addBox(mesh, kSteel, {kInset, 0.03125, -0.015625},
           {0.5 * kLiftDoorWidth - 0.0078125, kDoorHeight - kInset, 0.015625});
    addBox(mesh, kSteel, {0.5 * kLiftDoorWidth + 0.0078125, 0.03125, -0.015625},
           {kLiftDoorWidth - kInset, kDoorHeight - kInset, 0.015625});
    return mesh;
}

/// The lining of an opening behind its leaf.
MeshBuilder doorFrame(double width, double wall) {
    MeshBuilder mesh;
    const double h = kDoorHeight, bar = 0.0234375;
    addBox(mesh, kWhite, {0, 0, -wall}, {bar, h, -kInset});
    addBox(mesh, kWhite, {width - bar, 0, -wall}, {width, h, -kInset});
    addBox(mesh, kWhite, {bar, h - bar, -wall}, {width - bar, h, -kInset});
    return mesh;
}

/// @param size  of the opening
MeshBuilder window(const glm::dvec2& size, bool parted) {
    MeshBuilder mesh;
    const double x = 0.5 * size.x, y = 0.5 * size.y, bar = 0.0625, z = 0.0390625;
    addBox(mesh, kFrameGrey, {-x, -y, -z}, {x, -y + bar, z});
    addBox(mesh, kFrameGrey, {-x, y - bar, -z}, {x, y, z});
    addBox(mesh, kFrameGrey, {-x, -y + bar, -z}, {-x + bar, y - bar, z});
    addBox(mesh, kFrameGrey, {x - bar, -y + bar, -z}, {x, y - bar, z});
    if (parted) addBox(mesh, kFrameGrey, {-0.5 * bar, -y + bar, -z}, {0.5 * bar, y - bar, z});
    for (const double side : {-1.0, 1.0}) {
        if (!parted && side > 0) break;
        const double x0 = !parted || side < 0 ? -x + bar : 0.5 * bar, x1 = !parted || side > 0 ? x - bar : -0.5 * bar;
        addBox(mesh, kGlass, {x0, -y + bar, -0.0078125}, {x1, y - bar, 0.0078125});
        const double handle = side < 0 ? x1 : x0;
        addBox(mesh, kChrome, {handle - 0.0078125, -0.0625, z - 0.0078125}, {handle + 0.0078125, 0.0625, z + 0.03125});
    }
    return mesh;
}

MeshBuilder flight() {
    MeshBuilder mesh;
    const double rise = 0.5 * kStorey / kFlightSteps, tread = kFlightRun / (kFlightSteps - 1);
    std::vector<glm::dvec2> profile{{0, 0}};
    for (int step = 0; step + 1 < kFlightSteps; ++step) {
        profile.push_back({-step * tread, (step + 1) * rise});
        profile.push_back({-(step + 1) * tread, (step + 1) * rise});
    }
    profile.push_back({-kFlightRun, (kFlightSteps - 1) * rise - 0.25});
    profile.push_back({-0.40625, 0});
    addPrism(mesh, kTerrazzo, kAcross, profile, -kFlightWidth, 0);
    return mesh;
}

MeshBuilder flightRail() {
    MeshBuilder mesh;
    const double rise = 0.5 * kStorey / kFlightSteps, tread = kFlightRun / (kFlightSteps - 1),
                 x = kFlightWidth - 0.046875;
    for (int step = 0; step + 1 < kFlightSteps; ++step)
        addTurned(mesh, kSteel, {x, 0, -(step + 0.5) * tread}, 6,
                  {{0.015625, (step + 1) * rise}, {0.015625, (step + 1) * rise + 0.859375}});
    const double top = (kFlightSteps - 1) * rise + 0.90625;
    addPrism(mesh, kOak, kAcross, {{0, 0.90625}, {0, 0.96875}, {-kFlightRun, top + 0.0625}, {-kFlightRun, top}},
             -x - 0.025, -x + 0.025);
    return mesh;
}

MeshBuilder landingRail() {
    MeshBuilder mesh;
    const double width = kStairWidth - kFlightWidth;
    for (int post = 0; post <= 10; ++post)
        addTurned(mesh, kSteel, {0.03125 + post * (width - 0.0625) / 10, 0, 0.03125}, 6,
                  {{0.015625, 0}, {0.015625, 0.9375}});
    addBox(mesh, kOak, {0, 0.921875, 0.00390625}, {width, 0.984375, 0.05859375});
    return mesh;
}

/// Its opening to +z, at z = 0.
MeshBuilder liftCab() {
    MeshBuilder mesh;
    const double x = 0.84375, back = -1.71875, top = 2.34375;
    addBox(mesh, kLinoleum, {-x, 0, back}, {x, 0.0234375, 0});
    addBox(mesh, kWhite, {-x, top, back}, {x, top + 0.0625, 0});
    addBox(mesh, kSteel, {-x, 0.015625, back}, {x, top + 0.0078125, back + 0.03125});
    for (const double side : {-x, x - 0.03125})
        addBox(mesh, kSteel, {side, 0.015625, back + 0.0234375}, {side + 0.03125, top + 0.0078125, 0});
    addBox(mesh, kMirror, {-0.625, 0.9375, back + 0.0234375}, {0.625, 2.1875, back + 0.0390625});
    addBox(mesh, kChrome, {-0.625, 0.84375, back + 0.0625}, {0.625, 0.875, back + 0.09375});
    for (const double end : {-0.5, 0.5})
        addBox(mesh, kChrome, {end - 0.015625, 0.84375, back + 0.0234375}, {end + 0.015625, 0.875, back + 0.078125});
    addBox(mesh, kBlackPlastic, {x - 0.046875, 0.9375, -0.5}, {x - 0.0234375, 1.5, -0.34375});
    for (int button = 0; button < 6; ++button)
        addBox(mesh, kLampShade, {x - 0.0546875, 0.984375 + 0.078125 * button, -0.4453125},
               {x - 0.03125, 1.0234375 + 0.078125 * button, -0.3984375});
    for (const double lamp : {-0.375, 0.375})
        addTurned(mesh, kLampShade, {lamp, 0, 0.5 * back}, 12, {{0.109375, top - 0.015625}, {0.125, top + 0.0078125}});
    addBox(mesh, kSteel, {-0.0625, top + 0.046875, 0.5 * back - 0.0625}, {0.0625, top + 0.25, 0.5 * back + 0.0625});
    return mesh;
}

/// A rail of a T's profile from floor to floor.
MeshBuilder liftRail() {
    MeshBuilder mesh;
    addPrism(mesh, kSteel, city::kUpright,
             {{-0.046875, 0},
              {0.046875, 0},
              {0.046875, 0.0078125},
              {0.0078125, 0.0078125},
              {0.0078125, 0.0625},
              {-0.0078125, 0.0625},
              {-0.0078125, 0.0078125},
              {-0.046875, 0.0078125}},
             0, kStorey);
    return mesh;
}

}  // namespace

void addFittings(Shelf& meshes) {
    shelve(meshes, kDoorLeaf, "Door", leaf(kDoorWidth, kDoorHeight, kDoorWood));
    shelve(meshes, kFireLeaf, "Fire door", leaf(kFireDoorWidth, kDoorHeight, kSteel));
    shelve(meshes, kGlassLeaf, "Glass door", glassLeaf());
    shelve(meshes, kLiftLeaf, "Lift door", liftLeaf());
    shelve(meshes, kDoorFrame, "Door frame", doorFrame(kDoorWidth, kCorridorWall));
    shelve(meshes, kThinDoorFrame, "Door frame", doorFrame(kDoorWidth, kInnerWall));
    shelve(meshes, kFireFrame, "Door frame", doorFrame(kFireDoorWidth, kInnerWall));
    shelve(meshes, kWindow, "Window", window(kWindowSize, true));
    shelve(meshes, kSmallWindow, "Window", window(kSmallWindowSize, false));
    shelve(meshes, kStairWindow, "Window", window(kStairWindowSize, true));
    shelve(meshes, kFlight, "Flight", flight());
    shelve(meshes, kFlightRail, "Railing", flightRail());
    MeshBuilder landing, half;
    addBox(landing, kTerrazzo, {0, -kSlab, -kLandingDepth}, {kStairWidth, 0, 0});
    shelve(meshes, kLanding, "Landing", landing);
    addBox(half, kTerrazzo, {0, -kSlab, 0}, {kStairWidth, 0, kCoreDepth - kLandingDepth - kFlightRun});
    shelve(meshes, kHalfLanding, "Half-landing", half);
    shelve(meshes, kLandingRail, "Railing", landingRail());
    shelve(meshes, kLiftCab, "Cab", liftCab());
    MeshBuilder weight;
    for (int block = 0; block < 8; ++block)
        addBox(weight, kConcrete, {-0.46875, 0.1875 * block, -0.0859375},
               {0.46875, 0.1875 * block + 0.171875, 0.0859375});
    for (const double x : {-0.484375, 0.453125})
        addBox(weight, kSteel, {x, 0, -0.09375}, {x + 0.03125, 1.5625, 0.09375});
    addBox(weight, kSteel, {-0.484375, 1.5, -0.0898437500}, {0.484375, 1.578125, 0.08984375});
    shelve(meshes, kCounterweight, "Counterweight", weight);
    shelve(meshes, kLiftRail, "Lift rail", liftRail());
}

void addOutdoorItems(Shelf& meshes) {
    MeshBuilder cooler;
    addBox(cooler, kSteel, {-0.96875, 0.15625, -0.625}, {0.96875, 1.21875, 0.625});
    for (const double x : {-0.8125, 0.6875}) addBox(cooler, kConcrete, {x, 0, -0.6875}, {x + 0.125, 0.171875, 0.6875});
    for (const double x : {-0.46875, 0.46875}) {
        addTurned(cooler, kBlackPlastic, {x, 0, 0}, 16,
                  {{0.40625, 1.203125}, {0.40625, 1.3125}, {0.375, 1.3125}, {0.375, 1.234375}});
        for (int fifth = 0; fifth < 5; ++fifth) {
            city::Frame frame = fifthFrame(fifth);
            frame.origin = {x, 0, 0};
            addPrism(cooler, kGreyPlastic, frame,
                     {{0.03125, 1.2578125}, {0.34375, 1.2578125}, {0.34375, 1.2734375}, {0.03125, 1.2890625}},
                     -0.046875, 0.046875);
        }
    }
    for (int slat = 0; slat < 6; ++slat)
        addPrism(cooler, kGreyPlastic, kAcross,
                 {{0.6171875, 0.25 + 0.15625 * slat},
                  {0.65625, 0.25 + 0.15625 * slat},
                  {0.6171875, 0.328125 + 0.15625 * slat}},
                 -0.90625, 0.90625);
    shelve(meshes, kCooler, "Cooler", cooler);
    MeshBuilder vent;
    addTurned(vent, kSteel, {0, 0, 0}, 16,
              {{0.25, 0},
               {0.25, 0.03125},
               {0.15625, 0.0625},
               {0.15625, 0.625},
               {0.28125, 0.640625},
               {0.28125, 0.6875},
               {0.078125, 0.8125}});
    shelve(meshes, kVent, "Vent", vent);
    MeshBuilder solar;
    addPrism(solar, kSteel, kAcross,
             {{-0.515625, 0.65625}, {0.515625, 0.15625}, {0.515625, 0.1875}, {-0.515625, 0.6875}}, -0.8125, 0.8125);
    for (int i = 0; i < 5; ++i) {
        const double x = -0.796875 + 0.328125 * i;
        addPrism(solar, kPanelBlue, kAcross, {{-0.5, 0.6796875}, {0.5, 0.1953125}, {0.5, 0.203125}, {-0.5, 0.6875}},
                 -x - 0.296875, -x);
    }
    for (const double x : {-0.6875, 0.65625}) {
        addBox(solar, kSteel, {x, 0, 0.4375}, {x + 0.03125, 0.203125, 0.46875});
        addBox(solar, kSteel, {x, 0, -0.46875}, {x + 0.03125, 0.640625, -0.4375});
    }
    shelve(meshes, kSolarPanel, "Solar panel", solar);
    MeshBuilder tree;
    addTurned(tree, kBark, {0, 0, 0}, 8, {{0.21875, 0}, {0.15625, 0.5}, {0.109375, 3.5}, {0, 5}});
    for (int fifth = 0; fifth < 5; ++fifth)
        addPrism(tree, kBark, fifthFrame(fifth), {{0.05, 2.25}, {1.5, 3.5}, {1.5, 3.5625}, {0.05, 2.4375}}, -0.03125,
                 0.03125);
    addTurned(tree, kLeaf, {0, 0, 0}, 16,
              {{0, 2.25}, {1.25, 2.5}, {2, 3.5}, {2.0625, 4.25}, {1.5, 5.5}, {0.75, 6.25}, {0, 6.5}});
    addTurned(tree, kLeaf, {0, 0, 0}, 12, {{0, 2.75}, {1.25, 3.25}, {1.375, 4.25}, {0.75, 5.5}, {0, 5.75}});
    shelve(meshes, kTree, "Tree", tree);
    MeshBuilder hedge;
    addPrism(hedge, kGrass, kAcross,
             {{-0.375, 0}, {0.375, 0}, {0.40625, 0.75}, {0.28125, 1}, {-0.28125, 1}, {-0.40625, 0.75}}, -1.25, 1.25);
    shelve(meshes, kHedge, "Hedge", hedge);
    MeshBuilder lamp;
    addTurned(lamp, kFrameGrey, {0, 0, 0}, 12, {{0.125, 0}, {0.125, 0.0625}, {0.0625, 0.125}, {0.046875, 3.25}});
    addTurned(lamp, kLampShade, {0, 0, 0}, 12, {{0.0625, 3.25}, {0.1875, 3.375}, {0.203125, 3.5}, {0.171875, 3.625}});
    addTurned(lamp, kFrameGrey, {0, 0, 0}, 12, {{0.25, 3.609375}, {0.25, 3.640625}, {0, 3.75}});
    shelve(meshes, kLampPost, "Lamp post", lamp);
}

}  // namespace sightline::building
