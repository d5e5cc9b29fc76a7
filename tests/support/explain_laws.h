// What must hold of every explanation: the world is changed as it says, and asked again.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "sightline/geom/frustum.h"
#include "sightline/base/random.h"
#include "sightline/query/explain/explain.h"
#include "sightline/query/query.h"
#include "sightline/world/world_state.h"
#include "tests/support/answers.h"

namespace sightline::test {

/// A world of some of a snapshot's objects, made through World alone.
struct Copy {
    World world;
    std::vector<ObjectId> ids;  ///< per item given

    Copy(const Snapshot& from, const std::vector<uint32_t>& items) {
        std::map<uint32_t, OccluderId> occluders;
        for (const uint32_t item : items) {
            const detail::ObjectRecord& object = from.state().object(item);
            ObjectDef def;
            def.bounds = object.bounds;
            def.transform = object.transform;
            def.key = object.key;
            def.layers = object.layers;
            def.limits = object.limits;
            if (object.occluder.index != 0) {
                const auto [at, is_new] = occluders.try_emplace(object.occluder.index);
                if (is_new) at->second = world.addOccluder(*from.state().occluders[object.occluder.index]);
                def.occluder = at->second;
            }
            if (object.shape.index != 0) {
                const auto [at, is_new] = occluders.try_emplace(object.shape.index);
                if (is_new) at->second = world.addShape(*from.state().occluders[object.shape.index]);
                def.shape = at->second;
            }
            ids.push_back(world.add(def));
        }
    }
};

inline std::vector<uint32_t> allItems(const Snapshot& now) {
    std::vector<uint32_t> items(now.objectCount());
    for (uint32_t i = 0; i < items.size(); ++i) items[i] = i;
    return items;
}

/// The stage that culled an object of a fresh query's answer: 0 visible, 1 + Stage, 255 outside the layers.
inline uint8_t reasonOf(const Snapshot& now, const View& view, const QuerySettings& settings, uint32_t item) {
    Query query;
    query.visible(now, view, settings);
    return reasonsOf(query, now)[item];
}

constexpr uint8_t kByFrustum = 1 + static_cast<uint8_t>(Stage::kFrustum);
constexpr uint8_t kByOcclusion = 1 + static_cast<uint8_t>(Stage::kOcclusion);

inline uint8_t reasonOf(const Explanation& why) {
    switch (why.verdict) {
        case Verdict::kVisible:
            return 0;
        case Verdict::kOutsideFrustum:
            return kByFrustum;
        case Verdict::kFacesAway:
            return 1 + static_cast<uint8_t>(Stage::kFacing);
        case Verdict::kOccluded:
            return 1 + static_cast<uint8_t>(why.occlusion.stage);
        default:
            return 255;
    }
}

/// How often each law was put to the test.
struct LawCount {
    uint64_t verdicts = 0, planes = 0, by_rectangle = 0, occluded = 0, insufficient = 0, without = 0, hidden_again = 0;
    uint64_t outside_too = 0, open_pixels = 0, covered = 0, doubts = 0, hiders = 0, with_nodes = 0, by_look = 0;

    void add(const LawCount& other) {
        for (const auto& [name, field] : kFields) this->*field += other.*field;
    }
    /// For whoever wants to know how much was tried.
    void record() const {
        for (const auto& [name, field] : kFields) testing::Test::RecordProperty(name, std::to_string(this->*field));
    }

private:
    static const std::vector<std::pair<std::string, uint64_t LawCount::*>> kFields;
};

inline const std::vector<std::pair<std::string, uint64_t LawCount::*>> LawCount::kFields = {
    {"verdicts", &LawCount::verdicts},
    {"planes", &LawCount::planes},
    {"by_rectangle", &LawCount::by_rectangle},
    {"occluded", &LawCount::occluded},
    {"insufficient", &LawCount::insufficient},
    {"without", &LawCount::without},
    {"hidden_again", &LawCount::hidden_again},
    {"outside_too", &LawCount::outside_too},
    {"open_pixels", &LawCount::open_pixels},
    {"covered", &LawCount::covered},
    {"doubts", &LawCount::doubts},
    {"hiders", &LawCount::hiders},
    {"with_nodes", &LawCount::with_nodes},
    {"by_look", &LawCount::by_look}};

/// Holds explanations of one query to their word.
class Laws {
public:
    Laws(const Snapshot& now, const View& view, const QuerySettings& settings, std::string name)
        : now_(now), view_(view), settings_(settings), name_(std::move(name)), explainer_(now, view, settings) {
        Query query;
        query.visible(now, view, settings);
        reasons_ = reasonsOf(query, now);
    }

    LawCount count;

    const std::vector<uint8_t>& reasons() const { return reasons_; }

    /// The verdict alone.
    Explanation expectVerdict(uint32_t item, const ExplainSettings& asked = {false, false}) {
        Explanation why = explainer_.explain(now_.state().object(item).id, asked);
        ++count.verdicts;
        EXPECT_EQ(int(reasonOf(why)), int(reasons_[item])) << name_ << ": object " << item;
        return why;
    }

    /// All that the explanation claims.
    void expectTrue(uint32_t item) {
        const Explanation why = expectVerdict(item, {});
        if (why.verdict == Verdict::kOutsideFrustum) expectPlane(item, why);
        if (why.verdict == Verdict::kOccluded) expectHiders(item, why);
        if (why.verdict == Verdict::kOccluded) expectLook(item, why);
        if (why.verdict == Verdict::kVisible) expectOpenPixel(why, item);
        count.with_nodes += why.together > 1;
    }

    /// So many objects of each stage's, or all that it has.
    void expectTrueOfSome(Random& random, size_t most) {
        for (const uint8_t reason : {uint8_t{0}, kByFrustum, kByOcclusion}) {
            std::vector<uint32_t> items;
            for (uint32_t i = 0; i < reasons_.size(); ++i)
                if (reasons_[i] == reason) items.push_back(i);
            for (size_t i = 0; i < most && !items.empty(); ++i) {
                const size_t pick = random.below(items.size());
                expectTrue(items[pick]);
                items[pick] = items.back();
                items.pop_back();
            }
        }
    }

private:
    std::string at(uint32_t item) const { return name_ + ": object " + std::to_string(item); }

    /// The object moved along the plane's normal, inward.
    uint8_t reasonAfterMove(uint32_t item, uint32_t plane, double distance, Explanation* why) const {
        const Frustum frustum = makeFrustum(view_);
        uint32_t which = 0;
        while (frustum.side[which] != plane) ++which;
        Copy copy(now_, allItems(now_));
        copy.world.commit();
        glm::dmat4 transform = now_.state().object(item).transform;
        transform[3] += glm::dvec4(glm::dvec3(frustum.planes[which]) * distance, 0.0);
        EXPECT_TRUE(copy.world.move(copy.ids[item], transform));
        const Snapshot moved = copy.world.commit();
        if (why) *why = Explainer(moved, view_, settings_).explain(copy.ids[item], {false, false});
        return reasonOf(moved, view_, settings_, item);
    }

    void expectPlane(uint32_t item, const Explanation& why) {
        ++count.planes;
        count.by_rectangle += why.frustum.by_rectangle;
        if (why.frustum.by_faces || why.frustum.by_triangles) {
            ++count.by_look;
            EXPECT_EQ(int(reasonAmong(item, {})), int(kByFrustum)) << at(item) << " is outside whatever else there is";
            QuerySettings rough = settings_;
            rough.faces = rough.second_look = false;
            EXPECT_NE(int(reasonOf(now_, view_, rough, item)), int(kByFrustum))
                << at(item) << ": its box reaches into the view";
            return;
        }
        const double distance = why.frustum.distance(), rounding = why.frustum.rounding;
        ASSERT_GT(distance, 0) << at(item);
        EXPECT_LT(rounding, 1e-3 * (1 + distance) + 1e-5 * glm::length(eyePosition(view_))) << at(item);
        const double less = 0.999 * (distance - rounding);
        if (less > 0) {
            // With a node that reaches into the view it may be occluded first.
            Explanation then;
            const uint8_t reason = reasonAfterMove(item, why.frustum.plane, less, &then);
            EXPECT_NE(int(reason), 0) << at(item);
            EXPECT_TRUE(reason == kByFrustum || then.occlusion.outside_too) << at(item);
            EXPECT_GT(then.frustum.outside[why.frustum.plane], 0.0) << at(item);
        }
        Explanation then;
        const double hair = 1e-9 * (distance + glm::length(eyePosition(view_)) + 1);
        const uint8_t reason = reasonAfterMove(item, why.frustum.plane, distance + hair, &then);
        EXPECT_LE(then.frustum.outside[why.frustum.plane], 0.0) << at(item);
        if (then.frustum.distance() <= 0 && !then.frustum.by_faces && !then.frustum.by_triangles) {
            EXPECT_NE(int(reason), int(kByFrustum)) << at(item);
        }
    }

    /// What becomes of the object in a world of itself and some others.
    uint8_t reasonAmong(uint32_t item, const std::vector<ObjectId>& others) const {
        std::vector<uint32_t> items;
        for (uint32_t i = 0; i < now_.objectCount(); ++i)
            if (i == item || std::find(others.begin(), others.end(), now_.state().object(i).id) != others.end())
                items.push_back(i);
        EXPECT_EQ(items.size(), others.size() + 1);
        Copy copy(now_, items);
        const auto self = std::find(items.begin(), items.end(), item) - items.begin();
        return reasonOf(copy.world.commit(), view_, settings_, static_cast<uint32_t>(self));
    }

    void expectHiders(uint32_t item, const Explanation& why) {
        ++count.occluded;
        count.hiders += why.occlusion.hiders.size();
        ASSERT_FALSE(why.occlusion.hiders.empty()) << at(item);
        double sum = 0;
        std::vector<ObjectId> hiders;
        for (const Hider& hider : why.occlusion.hiders) {
            EXPECT_GE(hider.share, 0.0);
            sum += hider.share;
            hiders.push_back(hider.id);
        }
        EXPECT_NEAR(sum, 1.0, 1e-9) << at(item);
        if (why.occlusion.outside_too) {
            ++count.outside_too;
            if (settings_.stages & stageBit(Stage::kFrustum)) {
                EXPECT_GT(why.together, 1u) << at(item);
                EXPECT_EQ(int(reasonAmong(item, hiders)), int(kByFrustum)) << at(item) << " is outside by itself";
            }
        } else if (why.occlusion.sufficient) {
            // Culled with others, it may lie outside of the view by its faces or triangles when it is asked alone.
            const uint8_t alone = reasonAmong(item, hiders);
            if (!(alone == kByFrustum && (settings_.faces || settings_.second_look))) {
                EXPECT_EQ(int(alone), int(kByOcclusion)) << at(item) << " with its hiders alone";
            }
            for (size_t k = 0; k < hiders.size(); ++k) {
                std::vector<ObjectId> fewer = hiders;
                fewer.erase(fewer.begin() + static_cast<ptrdiff_t>(k));
                // It may lie outside of the view all the same, by its faces or triangles.
                EXPECT_NE(int(reasonAmong(item, fewer)), int(kByOcclusion)) << at(item) << " without one of its hiders";
            }
        } else {
            ++count.insufficient;
        }
        expectWithout(item, why, hiders);
    }

    /// What a closer look culled is kept by the rectangle around its box alone.
    void expectLook(uint32_t item, const Explanation& why) {
        if (!why.occlusion.by_faces && !why.occlusion.by_triangles) return;
        ++count.by_look;
        QuerySettings rough = settings_;
        rough.second_look = rough.faces = false;
        EXPECT_EQ(int(reasonOf(now_, view_, rough, item)), 0) << at(item) << " is kept without the closer looks";
    }

    void expectWithout(uint32_t item, const Explanation& why, const std::vector<ObjectId>& hiders) {
        ++count.without;
        std::vector<uint32_t> others;
        for (uint32_t i = 0; i < now_.objectCount(); ++i)
            if (std::find(hiders.begin(), hiders.end(), now_.state().object(i).id) == hiders.end()) others.push_back(i);
        EXPECT_EQ(others.size() + hiders.size(), now_.objectCount()) << at(item);
        Copy copy(now_, others);
        const auto self = std::lower_bound(others.begin(), others.end(), item) - others.begin();
        const uint8_t reason = reasonOf(copy.world.commit(), view_, settings_, static_cast<uint32_t>(self));
        const Without without = why.occlusion.without;
        ASSERT_NE(int(without), int(Without::kNotAsked)) << at(item);
        const uint8_t said = without == Without::kVisible     ? 0
                             : without == Without::kOccluded  ? kByOcclusion
                             : without == Without::kFacesAway ? 1 + static_cast<uint8_t>(Stage::kFacing)
                                                              : kByFrustum;
        EXPECT_EQ(int(reason), int(said)) << at(item) << " without its hiders";
        EXPECT_EQ(without == Without::kOccluded, !why.occlusion.others.empty()) << at(item);
        count.hidden_again += without == Without::kOccluded;
        for (const Hider& other : why.occlusion.others)
            EXPECT_EQ(std::find(hiders.begin(), hiders.end(), other.id), hiders.end()) << at(item);
    }

    /// A speck at the place that was named, no farther than the object's nearest point, is kept too. Where something
    /// covers that place, the speck may lie behind its plane, and the object's box across it.
    void expectOpenPixel(const Explanation& why, uint32_t item) {
        if (why.visible.because != KeptBecause::kOpenPixel) {
            ++count.doubts;
            return;
        }
        ++count.open_pixels;
        count.covered += why.visible.covered;
        EXPECT_TRUE(why.on_screen) << at(item);
        EXPECT_GT(why.visible.open_pixels, 0u) << at(item);
        EXPECT_LE(why.visible.open_pixels, why.visible.pixels) << at(item);
        EXPECT_GE(why.visible.x, why.rect.left);
        EXPECT_LE(why.visible.x, why.rect.right);
        EXPECT_GE(why.visible.y, why.rect.top);
        EXPECT_LE(why.visible.y, why.rect.bottom);
        if (why.visible.covered) return;
        const glm::dmat4& p = view_.projection;
        const double w = isOrthographic(view_) ? p[3][3] : why.depth;
        const double x = 2.0 * why.visible.x / view_.width - 1.0, y = 1.0 - 2.0 * why.visible.y / view_.height;
        const glm::dvec4 eye((x * w + p[2][0] * why.depth - p[3][0]) / p[0][0],
                             (y * w + p[2][1] * why.depth - p[3][1]) / p[1][1], -why.depth, 1.0);
        const glm::dvec3 middle(glm::inverse(view_.view) * eye);
        const double half = 0.05 * w / std::max(p[0][0] * view_.width, p[1][1] * view_.height);
        Copy copy(now_, allItems(now_));
        ObjectDef speck;
        speck.bounds = {middle - glm::dvec3(half), middle + glm::dvec3(half)};
        speck.key = ~uint64_t{0};
        speck.layers = view_.layers;
        copy.world.add(speck);
        EXPECT_EQ(int(reasonOf(copy.world.commit(), view_, settings_, now_.objectCount())), 0)
            << at(item) << ": nothing is kept at (" << why.visible.x << ", " << why.visible.y << "), which is open";
    }

    Snapshot now_;
    View view_;
    QuerySettings settings_;
    std::string name_;
    Explainer explainer_;
    std::vector<uint8_t> reasons_;
};

}  // namespace sightline::test
