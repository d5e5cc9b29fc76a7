// Occlusion queries draw the image of all items, whatever moves, however late answers are: held to a draw of everything.
// SPDX-License-Identifier: MIT
#include "sightline/cull/queries/occlusion_queries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "sightline/tree/descend.h"
#include "tests/cull/queries/queried_world.h"
#include "tests/support/memory.h"

namespace sightline::test {
namespace {

constexpr QueryMethod kMethods[] = {QueryMethod::kNone, QueryMethod::kStopAndWait, QueryMethod::kChc,
                                    QueryMethod::kChcPlusPlus};

/// A walk, with a cut now and then.
View walkView(uint64_t seed, int frame, const Camera& camera) {
    Random random(mixSeed(seed, static_cast<uint64_t>(frame / 15)));
    const glm::dvec3 start = randomVector(random, {15, 3, 15}), to = randomVector(random, {1, 0.3, 1});
    const double turned = 0.03 * frame;
    const glm::dvec3 direction(to.x * std::cos(turned) - to.z * std::sin(turned), to.y,
                               to.x * std::sin(turned) + to.z * std::cos(turned));
    return viewFrom(start + 0.05 * double(frame % 15) * glm::normalize(to), direction, camera);
}

Camera cameraOf(uint64_t round) {
    constexpr Camera kCameras[] = {{60, 96, 54, 0.1, {0, 1, 0}},
                                   {100, 31, 77, 0.5, {0.3, 1, 0}},
                                   {20, 1, 1, 0.1, {0, 1, 0}},
                                   {75, 129, 65, 0.01, {0, 1, 0}}};
    return kCameras[round % 4];
}

std::string name(QueryMethod method) { return kQueryMethodNames[static_cast<int>(method)]; }

TEST(OcclusionQueries, DrawTheImageOfAllItems) {
    for (uint64_t round = 0; round < casesToMake(12, 400); ++round) {
        Random random(mixSeed(7, round));
        QueriedWorld world(round, 120 + static_cast<uint32_t>(random.below(400)));
        for (const QueryMethod method : kMethods) {
            // Corners on a sixteenth of a pixel, depths of 24 bits: the coarsest that a GL may have, and exact ones.
            SimulatedGpuSettings rounding;
            if (round % 2) rounding = {{}, static_cast<uint32_t>(round % 4), 1, 4, 24};
            else rounding.frames_late = static_cast<uint32_t>(round % 4);
            HeldToAll held(world, rounding);
            OcclusionQueries queries;
            OcclusionQuerySettings settings;
            settings.method = method;
            settings.order = static_cast<QueryOrder>(round % 3);
            settings.leaf_items = 1 + static_cast<uint32_t>(random.below(12));
            settings.batch = 1 + static_cast<uint32_t>(random.below(40));
            settings.together = 1 + static_cast<uint32_t>(random.below(20));
            settings.seen_frames = 1 + static_cast<uint32_t>(random.below(8));
            settings.tight_boxes = random.below(2) == 0;
            for (int frame = 0; frame < 30; ++frame) {
                const std::string what =
                    name(method) + " round " + std::to_string(round) + " frame " + std::to_string(frame);
                View view = walkView(round, frame, cameraOf(round));
                if (round % 5 == 4) view.projection = orthographic(12, double(view.width) / view.height, -2.0, 80.0);
                EXPECT_EQ(held.missed(queries, view, settings, what), std::vector<uint32_t>()) << what;
                EXPECT_EQ(queries.stats().assumed, 0u) << what;
                world.change();
                if (frame % 10 == 9) world.rebuild();
                if (HasFailure()) return;
            }
        }
    }
}

TEST(OcclusionQueries, HideMostOfWhatIsHidden) {
    for (const QueryMethod method : kMethods) {
        const QueriedWorld world(3, 1500);
        HeldToAll held(world, {});
        OcclusionQueries queries;
        OcclusionQuerySettings settings;
        settings.method = method;
        uint64_t hidden = 0, outside = 0;
        for (int frame = 0; frame < 45; ++frame) {
            held.missed(queries, walkView(3, frame, cameraOf(0)), settings, name(method));
            hidden += queries.stats().hidden;
            outside += queries.stats().outside;
        }
        EXPECT_GT(outside, 0u);
        if (method == QueryMethod::kNone) {
            EXPECT_EQ(hidden, 0u);
            EXPECT_GT(held.drawn(), 1000u);
        } else {
            EXPECT_GT(hidden, held.drawn()) << name(method);
        }
    }
}

struct Walked {
    uint64_t questions = 0, nodes = 0, together = 0, failed = 0, waits = 0, switches = 0, drawn = 0;
};

Walked walked(QueryMethod method, const OcclusionQuerySettings& with = {}) {
    const QueriedWorld world(3, 3000);
    HeldToAll held(world, {});
    OcclusionQueries queries;
    OcclusionQuerySettings settings = with;
    settings.method = method;
    Walked sum;
    for (int frame = 0; frame < 60; ++frame) {
        EXPECT_TRUE(held.missed(queries, walkView(3, frame, cameraOf(0)), settings, name(method)).empty());
        const OcclusionQueryStats& stats = queries.stats();
        sum.questions += stats.questions;
        sum.nodes += stats.nodes_asked;
        sum.together += stats.together;
        sum.failed += stats.together_failed;
        sum.waits += stats.waits;
        sum.switches += stats.switches;
        sum.drawn += stats.drawn;
    }
    return sum;
}

TEST(OcclusionQueries, ChcPlusPlusAsksLess) {
    const Walked wait = walked(QueryMethod::kStopAndWait), chc = walked(QueryMethod::kChc),
                 chcpp = walked(QueryMethod::kChcPlusPlus);
    EXPECT_EQ(wait.waits, wait.questions);
    EXPECT_LT(chc.waits, wait.waits);
    EXPECT_LT(2 * chcpp.questions, chc.questions);
    EXPECT_LT(2 * chcpp.switches, chc.switches);
    EXPECT_GT(chcpp.together, 0u);
    EXPECT_LT(chcpp.failed, chcpp.together);
    EXPECT_GT(chcpp.nodes, chcpp.questions);
    EXPECT_EQ(chc.nodes, chc.questions);
}

TEST(OcclusionQueries, WithoutWaitingWhatAppearsIsDrawnFramesLater) {
    for (const QueryMethod method : {QueryMethod::kChc, QueryMethod::kChcPlusPlus})
        for (uint32_t late = 1; late < 4; ++late) {
            QueriedWorld world(5, 800);
            HeldToAll held(world, {{}, late, 1, 0, 0});
            OcclusionQueries queries;
            OcclusionQuerySettings settings;
            settings.method = method;
            settings.never_wait = true;
            uint64_t assumed = 0, waits = 0, missed = 0;
            for (int frame = 0; frame < 120; ++frame) {
                // The eye moves, and then stands still: then all that is seen must have come.
                const View view = walkView(5, frame / 30 * 15 + std::min(frame % 30, 12), cameraOf(0));
                const std::vector<uint32_t> gone = held.missed(queries, view, settings, name(method));
                missed += gone.size();
                if (frame % 30 == 29) {
                    EXPECT_EQ(gone, std::vector<uint32_t>()) << name(method) << " frame " << frame;
                }
                assumed += queries.stats().assumed;
                waits += queries.stats().waits;
                if (frame % 30 == 2) world.change();
            }
            EXPECT_GT(assumed, 0u);
            EXPECT_EQ(waits, 0u);
            EXPECT_GT(missed, 0u) << "so it is not conservative";
        }
}

/// Answers that come in the middle of the next frame's walk, as those of a GPU that is a frame behind.
TEST(OcclusionQueries, WithoutWaitingNothingIsDrawnTwice) {
    for (uint32_t ahead = 1; ahead < 4; ++ahead)
        for (const QueryMethod method : kMethods) {
            QueriedWorld world(5, 600);
            SimulatedGpuSettings slow;
            slow.frames_ahead = ahead;
            slow.costs.shade = 1e-7;
            HeldToAll held(world, slow);
            OcclusionQueries queries;
            OcclusionQuerySettings settings;
            settings.method = method;
            settings.never_wait = true;
            for (int frame = 0; frame < 60; ++frame) {
                if (frame % 20 == 19) settings.method = kMethods[(static_cast<int>(method) + frame) % 4];
                held.missed(queries, walkView(5, frame, cameraOf(0)), settings, name(method));
                EXPECT_LE(queries.stats().assumed, 600u);
                if (settings.method == QueryMethod::kStopAndWait) { EXPECT_EQ(queries.stats().assumed, 0u); }
                if (frame % 3 == 0) world.change();
            }
        }
}

TEST(OcclusionQueries, AnotherDeviceIsNotAskedForAnswersOfTheLast) {
    const QueriedWorld world(5, 400);
    SimulatedGpu first(world.items()), second(world.items());
    OcclusionQueries queries;
    for (int frame = 0; frame < 20; ++frame) {
        SimulatedGpu& gpu = frame % 4 < 2 ? first : second;
        const View view = walkView(5, frame, cameraOf(0));
        gpu.beginFrame(view);
        queries.draw(world.tree(), view, gpu);
        gpu.endFrame();
        EXPECT_GT(queries.stats().drawn, 0u);
    }
}

TEST(OcclusionQueries, AfterNotWaitingAFrameThatWaitsDrawsAll) {
    QueriedWorld world(6, 500);
    HeldToAll held(world, {{}, 2, 1, 0, 0});
    OcclusionQueries queries;
    for (int frame = 0; frame < 60; ++frame) {
        OcclusionQuerySettings settings;
        settings.method = frame % 5 == 0 ? QueryMethod::kStopAndWait
                          : frame % 2    ? QueryMethod::kChc
                                         : QueryMethod::kChcPlusPlus;
        settings.never_wait = frame % 3 != 0;
        const std::string what = "frame " + std::to_string(frame);
        const auto missed = held.missed(queries, walkView(6, frame, cameraOf(0)), settings, what);
        if (!settings.never_wait || settings.method == QueryMethod::kStopAndWait) {
            EXPECT_EQ(missed, std::vector<uint32_t>()) << what;
        }
        world.change();
    }
}

/// Without padding, boxes lose samples to rounding that what is in them shows: so the padding is needed, and enough.
TEST(OcclusionQueries, PaddingIsWhatCoversRounding) {
    size_t missed = 0;
    for (const bool padded : {false, true}) {
        for (uint64_t seed = 0; seed < 12; ++seed) {
            const QueriedWorld world(seed, 400);
            HeldToAll held(world, {{}, 0, 1, 4, 24});
            OcclusionQuerySettings settings;
            settings.method = QueryMethod::kStopAndWait;
            if (!padded) settings.rounding = {0, 0};
            for (int frame = 0; frame < 20; ++frame) {
                OcclusionQueries queries;
                const auto gone = held.missed(queries, walkView(seed, 15 * frame, cameraOf(0)), settings, "");
                if (padded) {
                    EXPECT_EQ(gone, std::vector<uint32_t>()) << "seed " << seed << " frame " << frame;
                } else {
                    missed += gone.size();
                }
            }
        }
    }
    EXPECT_GT(missed, 0u);
}

TEST(OcclusionQueries, AThresholdHidesWhatShowsLittle) {
    const QueriedWorld world(3, 1500);
    size_t missed = 0;
    for (const uint64_t threshold : {0u, 40u}) {
        HeldToAll held(world, {});
        OcclusionQueries queries;
        OcclusionQuerySettings settings;
        settings.threshold = threshold;
        for (int frame = 0; frame < 15; ++frame) {
            const auto gone = held.missed(queries, walkView(3, frame, cameraOf(0)), settings, "");
            EXPECT_TRUE(gone.empty() || threshold > 0);
            missed += gone.size();
        }
    }
    EXPECT_GT(missed, 0u);
}

TEST(OcclusionQueries, WhatCannotBeAskedIsDrawn) {
    const QueriedWorld world(4, 300);
    SimulatedGpu gpu(world.items());
    OcclusionQueries queries;
    View view = viewFrom({0, 0, 0}, {1, 0, 0});
    gpu.beginFrame(view);
    view.view[0][0] = std::numeric_limits<double>::quiet_NaN();
    const std::span<const uint32_t> drawn = queries.draw(world.tree(), view, gpu);
    EXPECT_EQ(std::set<uint32_t>(drawn.begin(), drawn.end()).size(), 300u);
    EXPECT_EQ(queries.stats().questions, 0u);

    const WorldBvh nothing;
    EXPECT_TRUE(queries.draw(nothing.now(), viewFrom({0, 0, 0}, {1, 0, 0}), gpu).empty());

    // A near plane far out cuts every box: nothing can be asked.
    const View far_plane = viewFrom({0, 0, 0}, {1, 0, 0}, {60, 96, 54, 100.0, {0, 1, 0}});
    gpu.beginFrame(far_plane);
    for (const QueryMethod method : kMethods) {
        OcclusionQuerySettings settings;
        settings.method = method;
        queries.draw(world.tree(), far_plane, gpu, settings);
        EXPECT_EQ(queries.stats().questions, 0u);
    }
}

TEST(OcclusionQueries, AllocateNothingInAFrameThatHasSeenItsLike) {
    CountingMemory memory;
    const QueriedWorld world(3, 1500);
    SimulatedGpu gpu(world.items(), {});
    OcclusionQueries queries(&memory);
    uint64_t before = 0;
    for (int frame = 0; frame < 90; ++frame) {
        if (frame == 45) before = memory.allocations;
        const View view = walkView(3, frame % 45, cameraOf(0));
        gpu.beginFrame(view);
        queries.draw(world.tree(), view, gpu);
        gpu.endFrame();
    }
    EXPECT_GT(before, 0u);
    EXPECT_LE(memory.allocations, before + 3);  // answers come in another order
}

TEST(AskedBoxes, HoldAllItemsBelowAndAreNotMuchLarger) {
    const QueriedWorld world(8, 2000);
    const PlacedBvh& tree = world.tree();
    size_t several = 0;
    for (uint32_t slot = 0; slot < 8 * tree.nodes.size(); ++slot) {
        const BvhNode& node = tree.nodes[slot / 8];
        if (node.count[slot % 8] == 0) continue;
        for (const bool tight : {false, true}) {
            Array<Box3f> boxes;
            appendBoxes(tree, slot, tight, boxes);
            float area = 0;
            for (const Box3f& box : boxes) area += halfArea(box);
            const float own = halfArea(slotBox(node, static_cast<int>(slot % 8)));
            EXPECT_LE(area, 1.4f * own * 1.0001f);
            EXPECT_LE(boxes.size(), 8u);
            if (!tight) { EXPECT_EQ(boxes.size(), 1u); }
            several += boxes.size() > 1;
            for (uint32_t place = node.first[slot % 8]; place < node.first[slot % 8] + node.count[slot % 8]; ++place) {
                const uint32_t item = tree.order[place];
                if (item == PlacedBvh::kNone) continue;
                const uint32_t at = tree.slot[item];
                const Box3f inner = slotBox(tree.nodes[at / 8], static_cast<int>(at % 8));
                EXPECT_TRUE(
                    std::any_of(boxes.begin(), boxes.end(), [&](const Box3f& box) { return box.holds(inner); }));
            }
        }
    }
    EXPECT_GT(several, 0u);
}

/// Each corner has a ball around it in the padded box that looks as large as the rounding, the farthest corner the largest.
TEST(BoxPadding, HoldsABallAroundEachCorner) {
    Random random(10);
    for (int i = 0; i < 1000; ++i) {
        const View view = viewFrom(randomVector(random, 5.0), randomUnit(random));
        const BoxPadding padding(view, {0.25, 0x1p-20});
        const glm::dvec3 at = randomVector(random, 30.0);
        const Box3d box{at, at + glm::dvec3(random.uniform(0, 20), random.uniform(0, 20), random.uniform(0, 20))};
        const Box3d padded = padding.padded(box);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 point(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                   corner & 4 ? box.max.z : box.min.z);
            const double depth = (view.projection * view.view * glm::dvec4(point, 1.0)).w;
            if (depth <= 0) continue;
            // A pixel at that depth; and a step of the depth, which is 1 - near / depth.
            const double pixel = 2 * depth / (view.projection[1][1] * view.height);
            const double step = depth * depth * 0x1p-20 / 0.1;
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(padded.min[axis], point[axis] - 0.25 * pixel - step);
                EXPECT_GE(padded.max[axis], point[axis] + 0.25 * pixel + step);
            }
        }
    }
}

TEST(BoxPadding, CoversItsRoundingAtTheFarthestCorner) {
    Random random(9);
    size_t asked = 0;
    for (int i = 0; i < 2000; ++i) {
        View view = anyView(random);
        if (i % 3 == 0) view.projection[1][0] = random.uniform(-1, 1);  // sheared
        if (i % 4 == 0) view.projection[0][1] = random.uniform(-1, 1);
        if (i % 5 == 0) view.projection *= random.uniform(0.001, 1000);  // the same image
        if (!isUsable(view)) continue;
        const RasterRounding rounding{random.uniform(0, 0.5), std::ldexp(1.0, -int(random.below(20)) - 10)};
        const BoxPadding padding(view, rounding);
        const glm::dvec3 at = randomVector(random, 30.0);
        const Box3d box = padding.padded({at, at});
        const glm::dmat4 to_clip = view.projection * view.view;
        const glm::dvec4 clip = to_clip * glm::dvec4(at, 1.0);
        if (clip.w <= 0.2 * std::abs(view.projection[isOrthographic(view) ? 3 : 2][3]) || clip.z < -clip.w) continue;
        // The point moved by the rounding lies in the image of the box, and the box has a point as near as the depth says.
        bool behind = false;
        double left = 1e300, right = -1e300, low = 1e300, high = -1e300, nearest = 1e300;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 point(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                   corner & 4 ? box.max.z : box.min.z);
            const glm::dvec4 moved = to_clip * glm::dvec4(point, 1.0);
            if (moved.w <= 0) {
                behind = true;
                break;
            }
            left = std::min(left, moved.x / moved.w);
            right = std::max(right, moved.x / moved.w);
            low = std::min(low, moved.y / moved.w);
            high = std::max(high, moved.y / moved.w);
            nearest = std::min(nearest, moved.z / moved.w);
        }
        if (behind) continue;
        ++asked;
        const double by_x = 2.0 * rounding.pixels / view.width * (1 - 1e-9),
                     by_y = 2.0 * rounding.pixels / view.height * (1 - 1e-9);
        EXPECT_LE(left, clip.x / clip.w - by_x);
        EXPECT_GE(right, clip.x / clip.w + by_x);
        EXPECT_LE(low, clip.y / clip.w - by_y);
        EXPECT_GE(high, clip.y / clip.w + by_y);
        EXPECT_LE(0.5 * nearest, 0.5 * clip.z / clip.w - rounding.depth_step * (1 - 1e-9));
    }
    EXPECT_GT(asked, 200u);
}

}  // namespace
}  // namespace sightline::test
