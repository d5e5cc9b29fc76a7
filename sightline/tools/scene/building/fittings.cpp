// What is built into a procedural building by its measures: door leaves, windows, stairs, rails, columns.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/library.h"
#include "sightline/tools/scene/building/plan.h"

namespace sightline::tools::building {
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

void addFittings(Shelf& meshes) {
    putShape(meshes[kColumn], column());
    putShape(meshes[kDoorLeaf], leaf(kDoorWidth, kDoorHeight, kDoorWood));
    putShape(meshes[kFireLeaf], leaf(kFireDoorWidth, kDoorHeight, kSteel));
    putShape(meshes[kGlassLeaf], glassLeaf());
    putShape(meshes[kLiftLeaf], liftLeaf());
    putShape(meshes[kDoorFrame], doorFrame(kDoorWidth, kCorridorWall));
    putShape(meshes[kThinDoorFrame], doorFrame(kDoorWidth, kInnerWall));
    putShape(meshes[kFireFrame], doorFrame(kFireDoorWidth, kInnerWall));
    putShape(meshes[kWindow], window(kWindowSize, true));
    putShape(meshes[kSmallWindow], window(kSmallWindowSize, false));
    putShape(meshes[kStairWindow], window(kStairWindowSize, true));
    putShape(meshes[kFlight], flight());
    putShape(meshes[kFlightRail], flightRail());
    MeshBuilder landing, half;
    addBox(landing, kTerrazzo, {0, -kSlab, -kLandingDepth}, {kStairWidth, 0, 0});
    putShape(meshes[kLanding], landing);
    addBox(half, kTerrazzo, {0, -kSlab, 0}, {kStairWidth, 0, kCoreDepth - kLandingDepth - kFlightRun});
    putShape(meshes[kHalfLanding], half);
    putShape(meshes[kLandingRail], landingRail());
    putShape(meshes[kLiftRail], liftRail());
}

}  // namespace sightline::tools::building
