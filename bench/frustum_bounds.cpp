// Large bounds and their refinement, bounds that are no boxes, and many volumes in one pass.
// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "bench/frustum_walks.h"
#include "sightline/base/random.h"
#include "sightline/studies/frustum/flat_bounds.h"

namespace sightline::bench {
using namespace studies;
namespace {

constexpr size_t kHuge = 100000;
constexpr double kDeep = 1000.0;

std::vector<Box3d> hugeBoxes() {
    Random random(2);
    std::vector<Box3d> boxes;
    for (size_t i = 0; i < kHuge; ++i) {
        const glm::dvec3 c(random.uniform(-1500, 1500), random.uniform(-1500, 1500), random.uniform(-1500, 1500));
        const glm::dvec3 half =
            kDeep * glm::dvec3(random.uniform(0.05, 0.5), random.uniform(0.05, 0.5), random.uniform(0.05, 0.5));
        boxes.push_back({c - half, c + half});
    }
    return boxes;
}

/// Of each box: the sphere around it, the box turned by nothing, the 14-DOP of its corners with these cut off by a third.
struct OtherBounds {
    std::vector<float> numbers[4 + 9 + 14];
    SphereArrays spheres;
    OrientedBoxArrays oriented;
    DopArrays dops;

    OtherBounds(const BoxArrays& boxes) {
        const size_t padded = (boxes.count + 15) / 16 * 16;
        for (auto& n : numbers) n.assign(padded, 0.0f);
        for (size_t i = 0; i < boxes.count; ++i) {
            glm::vec3 low, high;
            for (int axis = 0; axis < 3; ++axis) low[axis] = boxes.min[axis][i], high[axis] = boxes.max[axis][i];
            const glm::vec3 c = 0.5f * (low + high), half = 0.5f * (high - low) * (1.0f + 0x1p-20f);
            numbers[3][i] = glm::length(half) * (1.0f + 0x1p-20f);
            for (int axis = 0; axis < 3; ++axis) {
                numbers[axis][i] = c[axis];
                numbers[4 + 4 * axis][i] = half[axis];  // the others stay zero
            }
            for (int slab = 0; slab < Dop::kSlabs; ++slab) {
                const glm::vec3 d(Dop::kDirections[slab]);
                const float at = glm::dot(d, c), reach = glm::dot(glm::abs(d), half) * (slab < 3 ? 1.0f : 0.67f);
                numbers[13 + slab][i] = at - reach;
                numbers[20 + slab][i] = at + reach;
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            spheres.center[axis] = oriented.center[axis] = numbers[axis].data();
            for (int k = 0; k < 3; ++k) oriented.half[k][axis] = numbers[4 + 3 * k + axis].data();
        }
        spheres.radius = numbers[3].data();
        for (int slab = 0; slab < Dop::kSlabs; ++slab) {
            dops.min[slab] = numbers[13 + slab].data();
            dops.max[slab] = numbers[20 + slab].data();
        }
        const auto place = [&](auto& arrays) {
            arrays.count = boxes.count;
            arrays.origin = boxes.origin;
            arrays.reach = 3.0f * boxes.reach;
        };
        place(spheres), place(oriented), place(dops);
    }
};

}  // namespace

void addRefinementRows(const FrustumWorld& world, Table& table) {
    FlatBoxes flat(hugeBoxes());
    View view = world.view;
    view.view = lookAt({0, 0, 0}, {1, 0.1, 0.3}, {0, 1, 0});
    view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 1.0, kDeep);
    const RefinedVolume refined = refineVolume(volumeOf(makeFrustum(view)));
    const float large = static_cast<float>(0.1 * kDeep);
    size_t by_planes = 0, by_corners = 0, by_axes = 0;
    const std::vector<double> times = threadTimes(
        {[&] { by_planes = cullBounds(refined, flat.arrays, Refinement::kNone, large, flat.kept); },
         [&] { by_corners = cullBounds(refined, flat.arrays, Refinement::kCorners, large, flat.kept); },
         [&] { by_axes = cullBounds(refined, flat.arrays, Refinement::kSeparatingAxes, large, flat.kept); },
         [&] { cullBounds(refined, world.flat.arrays, Refinement::kNone, large, world.flat.kept); },
         [&] { cullBounds(refined, world.flat.arrays, Refinement::kSeparatingAxes, large, world.flat.kept); },
         [&] { refineVolume(refined.volume); }},
        world.repeat);
    // The separating axes are exact but for what float cannot tell: their set stands for the truth.
    const double excess = static_cast<double>(by_planes - by_axes);
    const std::string where = fmt::format("{} boxes, half sides to 0.5 of the view's depth", kHuge);
    const auto percent = [&](size_t kept) {
        return 100.0 * static_cast<double>(by_planes - kept) / std::max(excess, 1.0);
    };
    const Rows row{table, where};
    row("kept by the planes", by_planes, "boxes", "kept by separating axes", by_axes);
    row("of the excess, removed by corners", percent(by_corners), "%", "by separating axes", 100.0);
    row("planes and corners", times[1], "us", "planes alone", times[0]);
    row("planes and separating axes", times[2], "us", "planes alone", times[0]);
    table.rows.push_back({world.where, "planes, axes for large ones", times[4], "us", "planes alone", times[3]});
    table.rows.push_back(
        {"a frustum", "setting up its separating axes", times[5], "us", "planes alone, all boxes", times[0]});
}

void addBoundRows(const FrustumWorld& world, Table& table) {
    const OtherBounds other(world.flat.arrays);
    const ViewVolume volume = volumeOf(makeFrustum(world.view));
    size_t kept[4] = {};
    std::vector<uint32_t>& out = world.flat.kept;
    // The six sides of a cube around the eye, and four cascades along the view.
    std::vector<ViewVolume> volumes;
    const glm::dvec3 eye = eyePosition(world.view);
    for (int side = 0; side < 6; ++side) {
        View view = world.view;
        glm::dvec3 ahead(0.0);
        ahead[side / 2] = side % 2 ? 1.0 : -1.0;
        view.view = lookAt(eye, eye + ahead, {0, 1, 0});
        view.projection = perspective(glm::radians(90.0), 1.0, 0.1);
        volumes.push_back(volumeOf(makeFrustum(view)));
    }
    for (int cascade = 0; cascade < 4; ++cascade) {
        View view = world.view;
        view.projection = orthographic(50.0 * (1 << cascade), 1.0, -1000.0, 1000.0);
        volumes.push_back(volumeOf(makeFrustum(view)));
    }
    const std::vector<double> times = threadTimes(
        {[&] { kept[0] = cullBounds(volume, world.flat.arrays, out); },
         [&] { kept[1] = cullBounds(volume, other.spheres, out); },
         [&] { kept[2] = cullBounds(volume, other.oriented, out); },
         [&] { kept[3] = cullBounds(volume, other.dops, out); }, [&] { testBounds(volume, world.flat.arrays, out); },
         [&] { testVolumes(volumes, world.flat.arrays, out); },
         [&] {
             for (const ViewVolume& v : volumes) cullBounds(v, world.flat.arrays, out);
         }},
        world.repeat);
    const double per_box = 1e3 / static_cast<double>(std::max<size_t>(world.boxes.size(), 1));
    const char* names[] = {"flat, SIMD: boxes", "flat, SIMD: spheres around them", "flat, SIMD: as oriented boxes",
                           "flat, SIMD: 14-DOPs inside them"};
    for (int kind = 1; kind < 4; ++kind)
        table.rows.push_back({world.where, names[kind], times[kind] * per_box, "ns/bound", names[0], times[0] * per_box,
                              fmt::format("keeps {} of {} boxes", kept[kind], kept[0])});
    table.rows.push_back({world.where, "flat, SIMD: masks of crossed planes", times[4] * per_box, "ns/box", names[0],
                          times[0] * per_box});
    table.rows.push_back({world.where, "ten volumes in one pass", times[5] * per_box, "ns/box", "one after the other",
                          times[6] * per_box});
}

}  // namespace sightline::bench
