// Real scenes as the hidden-surface methods draw them, and views of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/verify.h"

namespace sightline::test {
using namespace studies;
using namespace tools;

/// From outside, from within, and in parallel projection.
inline std::vector<View> viewsOf(const Box3d& box, uint64_t seed) {
    const double size = glm::length(box.size());
    Random random(seed);
    std::vector<View> views;
    for (int i = 0; i < 3; ++i) {
        View view;
        view.width = 320;
        view.height = 180;
        const glm::dvec3 part(random.uniform(0.3, 0.7), random.uniform(0.3, 0.7), random.uniform(0.3, 0.7));
        const glm::dvec3 inside = box.min + part * box.size();
        const glm::dvec3 outside = box.center() + glm::dvec3(0.4, 0.3, 0.5) * size;
        view.view = lookAt(i == 1 ? inside : outside, box.center() + 0.01 * inside, {0, 1, 0});
        view.projection = i == 2 ? orthographic(0.8 * size, 16.0 / 9, 1e-3 * size, 4 * size)
                                 : perspective(1.0, 16.0 / 9, 5e-4 * size);
        views.push_back(view);
    }
    return views;
}

/// Triangles that hide nothing are left out. The facts must outlive the items.
inline std::vector<DrawItem> itemsOf(const SceneFacts& facts) {
    std::vector<DrawItem> items;
    for (uint32_t i = 0; i < facts.scene().objects.size(); ++i) {
        DrawItem item;
        item.mesh = {facts.mesh(i).positions, facts.mesh(i).indices};
        item.double_sided = facts.facts(i).double_sided;
        if (!facts.facts(i).all_hide) item.writes_depth = facts.facts(i).hides;
        item.transform = facts.scene().objects[i].transform;
        item.id = i;
        items.push_back(item);
    }
    return items;
}

/// Asks the witness of a query's answer to a view; what was culled and is seen is a failure each, and so is what was culled and
/// cannot be proved to be hidden, if that is asked for.
inline void expectNoFalseCulls(const Witness& witness, const View& view, const std::vector<uint8_t>& reasons,
                               const WitnessSettings& looks, const std::string& what) {
    const FrameVerdict verdict = witness.judge(view, reasons, looks);
    if (verdict.proofs) { EXPECT_EQ(verdict.proofs->culled_undecided, 0u) << what; }
    for (const FalseCull& cull : verdict.false_culls)
        ADD_FAILURE() << what << ": object " << cull.object << " is seen at (" << cull.x << ", " << cull.y << ") by "
                      << cull.witness << " but was culled by stage " << int(reasons[cull.object]) - 1;
}

}  // namespace sightline::test
