// Explanations as sentences: what is said, and that nothing is left out.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/explain_text.h"

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

std::string nameOf(ObjectId id) {
    std::string name = "'?'";
    name[1] = static_cast<char>('A' + id.index);
    return name;
}

Explanation occluded() {
    Explanation why;
    why.verdict = Verdict::kOccluded;
    why.occlusion.hiders.push_back({{1, 1}, 10, 0.71});
    why.occlusion.hiders.push_back({{2, 1}, 11, 0.29});
    why.occlusion.without = Without::kVisible;
    return why;
}

TEST(ExplainText, NamesTheOccludersAndWhatWouldBeWithoutThem) {
    Explanation why = occluded();
    EXPECT_EQ(
        explanationText(why, "object 7 'Desk'", nameOf),
        "culled by occlusion: object 7 'Desk' lies behind 'B' (71 %) and 'C' (29 %); without these two it would be "
        "kept.");
    EXPECT_EQ(explanationClause(why, nameOf), "behind 'B' (71 %) and 'C' (29 %)");
    EXPECT_EQ(stageOf(why), "occlusion");
    why.occlusion.hiders.pop_back();
    why.occlusion.without = Without::kOccluded;
    why.occlusion.others.push_back({{3, 1}, 12, 1});
    why.together = 13;
    why.on_screen = true;
    why.width = 320;
    why.height = 180;
    why.rect = {10, 20, 30, 25};
    why.depth = 12.5;
    EXPECT_EQ(
        explanationText(why, "object 7", nameOf),
        "culled by occlusion: object 7 lies behind 'B'; without that one it would still be hidden, by 'D'. It was "
        "culled in one step with 12 objects that lie near it. Its box takes 20 x 5 pixels from (10, 20) and begins "
        "12.5 units away.");
    why.occlusion.outside_too = true;
    why.occlusion.without = Without::kOutsideFrustum;
    why.frustum.outside[1] = 3.25;
    why.frustum.plane = 1;
    EXPECT_EQ(
        explanationText(why, "object 7", nameOf),
        "culled by occlusion: object 7 was culled in one step with 12 objects near it, all behind 'B'. By itself it "
        "lies beyond the right plane by 3.25 units, out of view; without that one the frustum would cull it.");
}

TEST(ExplainText, NamesWhomACertificateNames) {
    Explanation why = occluded();
    why.certificate.push_back({12, {3, 1}});
    why.certificate.push_back({13, {4, 1}});
    EXPECT_EQ(
        explanationText(why, "object 7", nameOf),
        "culled by occlusion: object 7 lies behind 'B' (71 %) and 'C' (29 %); without these two it would be kept. "
        "A certificate culled it, which names 'D' and 'E'.");
    EXPECT_EQ(explanationClause(why, nameOf), "behind 'B' (71 %) and 'C' (29 %), by a certificate");
    // Drawing would keep it: there are no shares.
    why.occlusion.hiders.clear();
    for (const Visible& hider : why.certificate) why.occlusion.hiders.push_back({hider.id, hider.key, 0});
    EXPECT_EQ(explanationText(why, "object 7", nameOf),
              "culled by occlusion: object 7 lies in the shadow of 'D' and 'E': a certificate proves it. Drawing would "
              "keep it.");
    EXPECT_EQ(explanationClause(why, nameOf, 1), "behind 'D' and 1 other, by a certificate");
}

TEST(ExplainText, SaysWhatOfAnObjectWasAsked) {
    Explanation why = occluded();
    why.occlusion.by_faces = true;
    EXPECT_EQ(explanationText(why, "it", nameOf),
              "culled by occlusion: it lies behind 'B' (71 %) and 'C' (29 %); without these two it would be kept. The "
              "rectangle around its box is not hidden all over; the faces of the box are.");
    why.occlusion.by_faces = false;
    why.occlusion.by_triangles = true;
    EXPECT_NE(explanationText(why, "it", nameOf)
                  .find(" The rectangle around its box is not hidden all over; its own triangles are."),
              std::string::npos);
    EXPECT_EQ(explanationClause(why, nameOf), "behind 'B' (71 %) and 'C' (29 %), by its triangles");
    why.verdict = Verdict::kOutsideFrustum;
    why.frustum.by_triangles = true;
    EXPECT_EQ(explanationText(why, "it", nameOf),
              "culled by frustum: it lies out of view: its box reaches into it, but none of its triangles does.");
    Explanation away;
    away.verdict = Verdict::kFacesAway;
    EXPECT_TRUE(explanationText(away, "it", nameOf)
                    .starts_with("culled by facing: it has faces in the view that all look away"));
    EXPECT_EQ(explanationClause(away, nameOf), "faces in the view that all look away from the eye");
    EXPECT_EQ(stageOf(away), "facing");
    EXPECT_STREQ(verdictName(away.verdict), "faces away");
    why.frustum.by_triangles = false;
    why.frustum.by_faces = true;
    EXPECT_EQ(explanationClause(why, nameOf),
              "out of view: the box along the axes reaches into it, but not its own, which is turned");
    why.verdict = Verdict::kVisible;
    why.visible.covered = true;
    why.visible.open_pixels = 1;
    why.visible.pixels = 2;
    why.visible.by_faces = true;
    EXPECT_NE(
        explanationText(why, "it", nameOf)
            .find("not in front of the nearest point of its box's faces there; 50 % of what its box's faces touch "
                  "is open"),
        std::string::npos);
    why.visible.by_faces = false;
    why.visible.by_triangles = true;
    EXPECT_NE(
        explanationText(why, "it", nameOf)
            .find("not in front of the nearest point of its triangles there; 50 % of what its own triangles touch "
                  "is open"),
        std::string::npos);
    why.visible.because = KeptBecause::kBudgetSpent;
    EXPECT_NE(explanationText(why, "it", nameOf).find("--occluder-triangles"), std::string::npos);
    why.visible.second_look_spent = true;
    EXPECT_NE(explanationText(why, "it", nameOf).find("--second-look-polygons"), std::string::npos);
}

TEST(ExplainText, ShortensLongLists) {
    Explanation why = occluded();
    why.occlusion.hiders.clear();
    for (uint32_t i = 0; i < 12; ++i) why.occlusion.hiders.push_back({{i, 1}, i, i < 10 ? 0.099 : 0.005});
    const std::string text = explanationText(why, "it", nameOf);
    EXPECT_NE(text.find("'F' (10 %) and 6 others (41 %)"), std::string::npos) << text;
    EXPECT_EQ(text.find("'G'"), std::string::npos) << text;
}

TEST(ExplainText, NamesPlanesAndDoubts) {
    Explanation why;
    why.verdict = Verdict::kOutsideFrustum;
    why.frustum.outside[0] = 3.25;
    why.frustum.outside[4] = 1.5;
    why.frustum.outside[2] = -2;
    EXPECT_EQ(explanationText(why, "object 7", nameOf),
              "culled by frustum: object 7 lies beyond the left plane by 3.25 units (and beyond near by 1.5).");
    EXPECT_EQ(stageOf(why), "frustum");
    why.verdict = Verdict::kVisible;
    EXPECT_EQ(stageOf(why), "");
    for (int because = 1; because <= static_cast<int>(KeptBecause::kBudgetSpent); ++because) {
        why.visible.because = static_cast<KeptBecause>(because);
        EXPECT_EQ(explanationText(why, "object 7", nameOf).rfind("kept: object 7: ", 0), 0u);
        EXPECT_GT(std::string(keptBecauseName(why.visible.because)).size(), 6u);
    }
    why.visible.because = KeptBecause::kOpenPixel;
    why.visible.x = 3.5;
    why.visible.y = 8;
    why.visible.open_pixels = 1;
    why.visible.pixels = 4;
    why.visible.covered = true;
    why.visible.cover = {4, 1};
    EXPECT_EQ(explanationText(why, "object 7", nameOf),
              "kept: object 7: nothing hides pixel (3.5, 8.0): 'E' covers it, but not in front of the nearest point of "
              "its box; 25 % of its rectangle is open.");
    EXPECT_EQ(
        explanationText(why, "object 7", nameOf, "is seen: a ray meets it at pixel (3.0, 9.0)."),
        "kept: object 7 is seen: a ray meets it at pixel (3.0, 9.0). Nothing hides pixel (3.5, 8.0): 'E' covers it, "
        "but not in front of the nearest point of its box; 25 % of its rectangle is open.");
    why.id = why.visible.cover;
    EXPECT_EQ(explanationText(why, "object 7", nameOf),
              "kept: object 7: nothing hides pixel (3.5, 8.0), which it covers itself; 25 % of its rectangle is open.");
    why.verdict = Verdict::kOutsideLayers;
    EXPECT_NE(explanationText(why, "object 7", nameOf).find("layers"), std::string::npos);
    why.verdict = Verdict::kNoSuchObject;
    EXPECT_EQ(explanationText(why, "object 7", nameOf), "there is no such object.");
}

TEST(ExplainText, BreaksLinesBetweenWords) {
    EXPECT_EQ(wrapped("one two three", 7, "  "), "one two\n  three");
    EXPECT_EQ(wrapped("one extraordinarily two", 6), "one\nextraordinarily\ntwo");
    EXPECT_EQ(wrapped("", 6), "");
}

}  // namespace
}  // namespace sightline
