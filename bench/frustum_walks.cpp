// Hierarchies beside the flat list, and what two frames have in common.
// SPDX-License-Identifier: MIT
#include "bench/frustum_walks.h"

#include <fmt/core.h>

#include "sightline/studies/frustum/coherent_frustum.h"

namespace sightline::bench {
using namespace studies;
namespace {

RefinedVolume plainVolume(const View& view) {
    RefinedVolume refined;
    refined.volume = volumeOf(makeFrustum(view));
    return refined;
}

/// Everything from outside.
View viewOfBoxes(const std::vector<Box3d>& boxes) {
    Box3d all;
    for (const Box3d& box : boxes) all.grow(box);
    const double size = glm::length(all.size());
    View view;
    view.view = lookAt(all.center() + glm::dvec3(1.5 * size, 0.2 * size, 0.1 * size), all.center(), {0, 1, 0});
    view.projection = perspective(1.0, 16.0 / 9.0, 0.01 * size);
    return view;
}

}  // namespace

void addHierarchyRows(const FrustumWorld& world, Table& table) {
    const WorldBvh tree = treeOver(world.boxes);
    const double count = static_cast<double>(std::max<size_t>(world.boxes.size(), 1));
    std::vector<uint32_t> kept(world.boxes.size() + 16);
    HierarchyCuller culler;
    HierarchyCulling no_masks, two_states;
    no_masks.masking = false;
    two_states.masking = two_states.inside = false;
    const auto walk = [&](const RefinedVolume& volume, const HierarchyCulling& how) {
        return culler.cull(volume, tree.now(), how, kept);
    };
    for (const View& view : {world.view, viewOfBoxes(world.boxes)}) {
        const Frustum frustum = makeFrustum(view);
        const RefinedVolume volume = plainVolume(view);
        const std::vector<double> times =
            threadTimes({[&] { cullFrustum(frustum, world.flat.arrays, world.flat.kept); }, [&] { walk(volume, {}); },
                         [&] { walk(volume, no_masks); }, [&] { walk(volume, two_states); }},
                        world.repeat);
        const size_t found = walk(volume, {});
        const double tests = static_cast<double>(culler.stats().plane_tests);
        const std::string where =
            fmt::format("{}, {:.3g} % in view", world.where, 100.0 * static_cast<double>(found) / count);
        const Rows row{table, where, "us"};
        row("walk, eight at once, masks", times[1], "flat, SIMD", times[0]);
        row("walk, eight at once, masks", times[1], "the same without masks", times[2]);
        row("walk, eight at once, masks", times[1], "nor a word for what is inside", times[3]);
        walk(volume, no_masks);
        const double unmasked = static_cast<double>(culler.stats().plane_tests);
        walk(volume, two_states);
        row("plane tests with masks", tests, "tests", "without masks", unmasked);
        row("plane tests with masks", tests, "tests", "nor a word for what is inside", culler.stats().plane_tests);
    }
}

void addCoherencyRows(const FrustumWorld& world, Table& table) {
    struct Kind {
        const char* name;
        HierarchyCulling how;
    };
    HierarchyCulling basic;
    basic.eight_at_once = basic.masking = false;
    std::vector<Kind> kinds(8, Kind{"one by one: basic test", basic});
    kinds[1] = {"one by one: octant test", basic}, kinds[1].how.octant = true;
    kinds[2] = {"one by one: masks", basic}, kinds[2].how.masking = true;
    kinds[3] = {"one by one: plane coherency", basic}, kinds[3].how.plane_coherency = true;
    kinds[4] = {"one by one: translation and rotation coherency", basic};
    kinds[4].how.translation = kinds[4].how.rotation = true;
    kinds[5] = {"one by one: masks, plane coherency", kinds[2].how}, kinds[5].how.plane_coherency = true;
    kinds[6] = {"one by one: all of them", everyCoherency()};
    kinds[7] = {"eight at once, masks", {}};

    const WorldBvh tree = treeOver(world.boxes);
    std::vector<uint32_t> kept(world.boxes.size() + 16);
    std::vector<HierarchyCuller> cullers(kinds.size());
    std::vector<std::vector<double>> times(kinds.size());
    std::vector<uint64_t> tests(kinds.size());
    Box3d all;
    for (const Box3d& box : world.boxes) all.grow(box);
    const double step = 0.02 * 0.5 * all.size().x, turn = 0.02 * glm::radians(60.0);
    constexpr int kFrames = 24;
    for (int frame = 0; frame < kFrames; ++frame) {
        const double angle = 0.3 + turn * frame;
        const glm::dvec3 ahead(std::cos(angle), 0.1, std::sin(angle));
        View view = world.view;
        const glm::dvec3 eye = all.center() + step * (frame - 0.5 * kFrames) * ahead;
        view.view = lookAt(eye, eye + ahead, {0, 1, 0});
        const RefinedVolume volume = plainVolume(view);
        for (size_t k = 0; k < kinds.size(); ++k) {
            const double start = threadTime();
            cullers[k].cull(volume, tree.now(), kinds[k].how, kept);
            if (frame == 0) continue;  // nothing is remembered yet
            times[k].push_back(threadTime() - start);
            tests[k] += cullers[k].stats().plane_tests;
        }
    }
    const std::string where = world.where + ", camera moves and turns by 2 %";
    std::vector<double> medians;
    for (std::vector<double>& t : times) {
        std::nth_element(t.begin(), t.begin() + kFrames / 2, t.end());
        medians.push_back(t[kFrames / 2]);
    }
    for (size_t k = 1; k < kinds.size(); ++k)
        table.rows.push_back(
            {where, kinds[k].name, medians[k], "us", kinds[0].name, medians[0],
             fmt::format("{:.3f}x its plane tests",
                         static_cast<double>(tests[k]) / static_cast<double>(std::max<uint64_t>(tests[0], 1)))});
    table.rows.push_back({where, kinds[6].name, medians[6], "us", kinds[2].name, medians[2]});
    table.rows.push_back({where, kinds[5].name, medians[5], "us", kinds[2].name, medians[2]});
}

}  // namespace sightline::bench
