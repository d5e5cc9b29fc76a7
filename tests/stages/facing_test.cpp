// The stage of facing counts what lies in the view and looks away, whole, in strips and by certificates, and nothing else.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/explain/explain.h"
#include "sightline/query/query.h"
#include "tests/support/answers.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/views.h"

namespace sightline::test {
namespace facing {
namespace {

constexpr uint8_t kLooksAway = 1 + static_cast<uint8_t>(Stage::kFacing);
constexpr uint8_t kBesideView = 1 + static_cast<uint8_t>(Stage::kFrustum);

/// Bent sheets, single-sided and drawn from either side, that hide nothing.
struct Sheets {
    TestMesh mesh;
    World world;
    std::vector<glm::dmat4> transforms;
    std::vector<uint8_t> double_sided;
    std::vector<ObjectId> ids;

    explicit Sheets(uint64_t seed, int count = 150) {
        constexpr uint32_t kColumns = 4;
        for (uint32_t y = 0; y < kColumns; ++y)
            for (uint32_t x = 0; x < kColumns; ++x) {
                const float u = 2 * float(x) / (kColumns - 1) - 1, v = 2 * float(y) / (kColumns - 1) - 1;
                mesh.positions.push_back({u, v, 0.2f * u * u - 0.1f * v});
            }
        mesh.addGrid(kColumns, kColumns);
        const std::vector<uint8_t> both(mesh.indices.size() / 3, 1);
        const OccluderId one = world.addShape(prepareOccluder(mesh.view())),
                         two = world.addShape(prepareOccluder(mesh.view(), {}, both));
        Random random(seed);
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 forward = randomUnit(random), up = randomUnit(random);
            glm::dmat4 t(lookAt({0, 0, 0}, forward, up));
            for (int axis = 0; axis < 3; ++axis) t[axis] *= random.uniform(0.3, 2);
            if (random.below(3) == 0) t[0] = -t[0];
            t[3] = glm::dvec4(randomVector(random, {12, 4, 12}), 1);
            ObjectDef def;
            def.bounds = {glm::dvec3(-1), glm::dvec3(1)};
            def.transform = t;
            def.key = transforms.size();
            double_sided.push_back(random.below(5) == 0);
            def.shape = double_sided.back() ? two : one;
            transforms.push_back(t);
            ids.push_back(world.add(def));
        }
    }

    /// What of an object lies in the view, as doubles have it: triangles that surely look at the eye, that surely look
    /// away, and all that may lie there.
    struct InView {
        int fronts = 0, backs = 0, may_be = 0;
    };
    InView inView(size_t object, const View& view) const {
        InView out;
        const glm::dmat4 clip = view.projection * view.view * transforms[object];
        const glm::dvec3 eye = eyePosition(view);
        const bool mirrored = glm::determinant(glm::dmat3(transforms[object])) < 0;
        for (size_t t = 0; t < mesh.indices.size(); t += 3) {
            glm::dvec4 p[3];
            glm::dvec3 q[3];
            for (size_t k = 0; k < 3; ++k) {
                const glm::dvec4 at(glm::dvec3(mesh.positions[mesh.indices[t + k]]), 1);
                p[k] = clip * at;
                q[k] = glm::dvec3(transforms[object] * at);
            }
            // Beside the view: wholly outside of one plane. The jitter widens it by less than a fiftieth.
            bool beside = false;
            for (int axis = 0; axis < 2; ++axis)
                for (const double side : {-1.0, 1.0})
                    beside = beside ||
                             std::all_of(p, p + 3, [&](const glm::dvec4& c) { return side * c[axis] > 1.02 * c.w; });
            beside = beside || std::all_of(p, p + 3, [](const glm::dvec4& c) { return c.z < -c.w; });
            if (beside) continue;
            ++out.may_be;
            const glm::dvec4 middle = (p[0] + p[1] + p[2]) / 3.0;
            const bool surely = middle.z > -middle.w && std::abs(middle.x) < middle.w && std::abs(middle.y) < middle.w;
            const glm::dvec3 normal = glm::cross(q[1] - q[0], q[2] - q[0]);
            const double towards = glm::dot(normal, eye - q[0]) * (mirrored ? -1 : 1);
            const double slack = 1e-3 * glm::length(normal) * glm::length(eye - q[0]);
            if (towards > slack || (double_sided[object] && std::abs(towards) > slack)) out.fronts += surely;
            else if (towards < -slack) out.backs += surely;
        }
        return out;
    }
};

struct Counts {
    uint64_t facing = 0, frustum = 0, must = 0;
};

/// Holds reasons of an answer to the triangles.
/// @param by_middles  certificates take a face for one in the view by its middle: it may be two triangles
void expectTrue(const Sheets& made, const View& view, const std::vector<uint8_t>& reasons, const std::string& what,
                Counts& counts, bool by_middles = false) {
    for (size_t i = 0; i < reasons.size(); ++i) {
        const Sheets::InView in = made.inView(i, view);
        const std::string of = what + ", object " + std::to_string(i);
        if (reasons[i] == kLooksAway) {
            ++counts.facing;
            EXPECT_EQ(in.fronts, 0) << of << " shows a front";
            EXPECT_GT(in.may_be, 0) << of << " lies beside the view";
        }
        if (reasons[i] == kBesideView) {
            ++counts.frustum;
            EXPECT_EQ(in.fronts, 0) << of << " lies in the view";
        }
        if (in.backs > 0 && reasons[i] != 0 && !by_middles) {
            ++counts.must;
            EXPECT_EQ(int(reasons[i]), int(kLooksAway)) << of << " is in the middle of the image";
        }
    }
}

TEST(FacingStage, CountsWhatLooksAwayAndNothingElse) {
    Counts whole, strips, proved;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        Sheets made(seed);
        const Snapshot now = made.world.commit();
        Random random(seed);
        Query query, in_strips, walks;
        for (int frame = 0; frame < 6; ++frame) {
            const View view = randomView(random, {60, 320, 180}, {8, 3, 8});
            const std::string what = "seed " + std::to_string(seed) + ", frame " + std::to_string(frame);
            const QueryStats stats = query.visible(now, view, {.stateless = true}).stats;
            const std::vector<uint8_t> reasons = reasonsOf(query, now);
            expectTrue(made, view, reasons, what, whole);
            EXPECT_EQ(stats.of(Stage::kFacing).culled,
                      static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), kLooksAway)));
            const QueryStats of_strips = in_strips.visible(now, view, {.bins = 3, .stateless = true}).stats;
            const std::vector<uint8_t> strip_reasons = reasonsOf(in_strips, now);
            for (size_t i = 0; i < reasons.size(); ++i) EXPECT_EQ(strip_reasons[i] == 0, reasons[i] == 0) << what;
            expectTrue(made, view, strip_reasons, what + " in strips", strips);
            EXPECT_EQ(of_strips.of(Stage::kFacing).culled,
                      static_cast<uint64_t>(std::count(strip_reasons.begin(), strip_reasons.end(), kLooksAway)));
            Explainer explainer(now, view, {.stateless = true});
            for (size_t i = 0; i < reasons.size(); ++i)
                EXPECT_EQ(explainer.explain(made.ids[i], {false, false}).verdict == Verdict::kFacesAway,
                          reasons[i] == kLooksAway)
                    << what << ", object " << i;
            // By the certificates of a walk: they name nobody, for nobody has to hide it.
            for (int step = 0; step < 5; ++step) {
                View moved = view;
                moved.view[3] -= 0.01 * step * moved.view[0];
                const QueryStats by_walk = walks.visible(now, moved).stats;
                if (by_walk.proved > 0)
                    expectTrue(made, moved, reasonsOf(walks, now), what + " in a walk", proved, true);
            }
        }
    }
    EXPECT_GT(whole.facing, 300u);
    EXPECT_GT(whole.must, 300u);
    EXPECT_GT(whole.frustum, 1000u);
    EXPECT_GT(strips.facing, 300u);
    EXPECT_GT(proved.facing, 50u);
}

/// Without a second look, or without the frustum, nobody asks which way a face looks.
TEST(FacingStage, IsOffWhereTrianglesAreNotAsked) {
    Sheets made(1);
    const Snapshot now = made.world.commit();
    Query query;
    const View view = viewFrom({0, 0, 0}, {0, 0, -1}, {80, 320, 180});
    EXPECT_GT(query.visible(now, view, {.stateless = true}).stats.of(Stage::kFacing).culled, 0u);
    QuerySettings settings{.stateless = true};
    settings.second_look = false;
    EXPECT_EQ(query.visible(now, view, settings).stats.of(Stage::kFacing).culled, 0u);
    for (const Stage stage : {Stage::kFrustum, Stage::kOcclusion}) {
        QuerySettings without{.stateless = true};
        without.stages &= ~stageBit(stage);
        const StageStats facing = query.visible(now, view, without).stats.of(Stage::kFacing);
        EXPECT_EQ(facing.culled, 0u);
        EXPECT_EQ(facing.tested, 0u);
    }
}

}  // namespace
}  // namespace facing
}  // namespace sightline::test
