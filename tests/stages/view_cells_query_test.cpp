// View cells of a file: rows of objects decide, and whatever is not what was baked is kept.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/cells/cell_space_build.h"
#include "sightline/query/explain/explain.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/support/furnished_rooms.h"

namespace sightline::test {
namespace {

constexpr size_t kObjects = 200;

/// Objects anywhere in a box, two view cells on both sides of x = 0, and rows that say what they like.
class Viewed {
public:
    explicit Viewed(uint64_t seed) : random_(seed) {
        CellSpace space;
        space.graph.cells = 1;
        space.graph.cell_of_leaf = {0};
        space.tree.contents = {LeafContents::kEmpty};
        space.tree.bounds = {glm::dvec3(-10), glm::dvec3(10)};
        LeafTree views;
        views.bounds = space.tree.bounds;
        views.contents.assign(2, LeafContents::kEmpty);
        views.nodes.push_back({{1, 0, 0, 0}, {LeafTreeNode::kLeaf | 0, LeafTreeNode::kLeaf | 1}});
        ObjectPlaces places;
        rows = BitMatrix(2, kObjects);
        const uint32_t only_cell = 0;
        for (size_t i = 0; i < kObjects; ++i) {
            const glm::dvec3 at(random_.uniform(-9, 9), random_.uniform(-9, 9), random_.uniform(-9, 9));
            boxes.push_back({at, at + glm::dvec3(0.5)});
            places.add(i, boxes.back(), {&only_cell, 1}, false, i % 50 == 7);
            for (size_t row = 0; row < 2; ++row)
                if (random_.below(2)) rows.set(row, i);
            ids.push_back(add(i));
        }
        bytes_ = *visibilityFile({BitMatrix(), {}, "made", 1, &space, &places, nullptr, &views, &rows},
                                 VisibilityForm::kInPlace);
        file_ = std::make_unique<VisibilityFile>(std::move(*VisibilityFile::open(bytes_, "made")));
        EXPECT_TRUE(world.attach(*file_));
    }

    ObjectId add(size_t i, uint32_t layers = 1) {
        ObjectDef def;
        def.bounds = boxes[i];
        def.key = i;
        def.layers = layers;
        return world.add(def);
    }
    Random& random() { return random_; }

    /// Looks from somewhere on a side, or from so near to x = 0 that the near rectangle is on both.
    View viewFrom(int side) {
        const double x = side == 2 ? 0 : (side == 0 ? -1 : 1) * random_.uniform(0.1, 9);
        const glm::dvec3 eye(x, random_.uniform(-9, 9), random_.uniform(-9, 9));
        const glm::dvec3 along = side == 2 ? glm::dvec3(0, random_.uniform(-1, 1), 1)
                                           : glm::dvec3(random_.uniform(-1, 1), random_.uniform(-1, 1), 1);
        return viewAt(eye, eye + along, kRoomCamera);
    }
    bool isSeen(int side, size_t object) const {
        return side == 2 ? rows.at(0, object) || rows.at(1, object) : rows.at(static_cast<size_t>(side), object);
    }

    World world = World::create({});
    std::vector<Box3d> boxes;
    std::vector<ObjectId> ids;
    BitMatrix rows;

private:
    Random random_;
    Array<char> bytes_;
    std::unique_ptr<VisibilityFile> file_;
};

std::vector<uint8_t> askedFor(Query& query, const Snapshot& now, const View& view, uint32_t stages = kCells) {
    query.visible(now, view, {.stages = stages});
    return reasonsOf(query, now);
}

TEST(ViewCellRows, DecideWhatIsCulled) {
    Viewed made(1);
    const Snapshot now = made.world.commit();
    Query query;
    for (int frame = 0; frame < 60; ++frame) {
        const int side = frame % 3;
        const View view = made.viewFrom(side);
        const std::vector<uint8_t> reasons = askedFor(query, now, view);
        Explainer explainer(now, view, {.stages = kCells});
        for (size_t i = 0; i < kObjects; ++i) {
            EXPECT_EQ(reasons[i], made.isSeen(side, i) ? 0 : kByPvs) << "frame " << frame << " object " << i;
            if (i % 20 > 0) continue;
            const Explanation why = explainer.explain(made.ids[i]);
            EXPECT_EQ(why.verdict, made.isSeen(side, i) ? Verdict::kVisible : Verdict::kNotInPvs);
            EXPECT_EQ(why.cells.view_cells, side == 2 ? 2u : 1u);
        }
        // Others take part, or it is not asked.
        const std::vector<uint8_t> with_all = askedFor(query, now, view, kDefaultStages);
        const std::vector<uint8_t> without = askedFor(query, now, view, kDefaultStages & ~kCells);
        for (size_t i = 0; i < kObjects; ++i) EXPECT_EQ(with_all[i] == 0, without[i] == 0 && made.isSeen(side, i)) << i;
    }
}

TEST(ViewCellRows, SayNothingOfWhatIsNotAsItWasBaked) {
    Viewed made(2);
    const Snapshot before = made.world.commit();
    std::set<size_t> kept;
    glm::dmat4 aside(1.0);
    aside[3].x = 0.1;
    for (size_t i = 0; i < kObjects; i += 10) {
        made.world.move(made.ids[i], aside);
        kept.insert(i);
    }
    made.boxes.push_back({glm::dvec3(1), glm::dvec3(2)});
    made.add(kObjects);  // of a key that the file does not know
    kept.insert(kObjects);
    made.add(3);  // a second one of this key and these bounds: both are kept
    kept.insert({3, kObjects + 1});
    const Snapshot now = made.world.commit();
    Query query;
    for (int frame = 0; frame < 30; ++frame) {
        const int side = frame % 3;
        const View view = made.viewFrom(side);
        const std::vector<uint8_t> reasons = askedFor(query, now, view), old = askedFor(query, before, view);
        ASSERT_EQ(reasons.size(), kObjects + 2);
        for (size_t i = 0; i < reasons.size(); ++i)
            EXPECT_EQ(reasons[i], kept.count(i) || made.isSeen(side, i) ? 0 : kByPvs) << i;
        for (size_t i = 0; i < kObjects; ++i) EXPECT_EQ(old[i], made.isSeen(side, i) ? 0 : kByPvs) << i;
    }
}

TEST(ViewCellRows, HoldOnlyWhileTheirWallsStand) {
    Viewed made(3);
    Query query;
    const auto culledBy = [&](const View& view) {
        const Snapshot now = made.world.commit();
        const VisibleSet set = query.visible(now, view, {.stages = kCells});
        return std::pair(set.stats.stages[static_cast<int>(Stage::kPvs)].culled,
                         set.stats.stages[static_cast<int>(Stage::kPvs)].doubt);
    };
    const View view = made.viewFrom(0);
    EXPECT_GT(culledBy(view).first, kObjects / 4);
    EXPECT_EQ(culledBy(view).second, 0u);
    made.world.remove(made.ids[57]);
    EXPECT_EQ(culledBy(view), std::pair(uint64_t{0}, uint64_t{kObjects - 1}));
    made.add(57);
    EXPECT_GT(culledBy(view).first, kObjects / 4);
    // Once something is in another layer, a view of one layer may be without a wall.
    View one_layer = view;
    one_layer.layers = 1;
    EXPECT_GT(culledBy(one_layer).first, kObjects / 4);
    made.add(0, 2);
    EXPECT_EQ(culledBy(one_layer).first, 0u);
    made.world.detach();
    EXPECT_EQ(culledBy(view).first, 0u);
}

/// Where most of what there is stands in the cells in sight, portals do not narrow: the answer is that without them.
TEST(CellStages, LeaveAHallAlone) {
    CellSpaceBuilder rooms;
    const uint32_t hall = *rooms.addCell("hall", Box3d{{0, 0, 0}, {20, 4, 20}});
    const uint32_t closet = *rooms.addCell("closet", Box3d{{20, 0, 0}, {24, 4, 20}});
    const std::vector<glm::dvec3> door = {{20, 0, 9}, {20, 2, 9}, {20, 2, 10}, {20, 0, 10}};
    ASSERT_TRUE(rooms.addPortal("door", hall, closet, door).ok());
    const CellSpace space = rooms.take();
    Random random(4);
    World world = World::create({});
    for (uint64_t i = 0; i < 3000; ++i) {
        const bool far = i % 10 == 0;
        const glm::dvec3 at(far ? random.uniform(20.5, 23.5) : random.uniform(0.5, 19.5), random.uniform(0.2, 3.5),
                            random.uniform(0.5, 19.5));
        ObjectDef def;
        def.bounds = {at, at + glm::dvec3(0.2)};
        def.key = i;
        world.add(def);
    }
    ASSERT_TRUE(world.attach(space).ok());
    const Snapshot now = world.commit();
    Query query;
    const auto culled = [&](const glm::dvec3& eye, const glm::dvec3& target) {
        return query.visible(now, viewAt(eye, target, kRoomCamera), {.stages = kCells})
            .stats.stages[static_cast<int>(Stage::kPortals)]
            .culled;
    };
    EXPECT_EQ(culled({10, 2, 10}, {0, 2, 10}), 0u) << "the hall has nine of ten";
    EXPECT_EQ(culled({10, 2, 10}, {24, 2, 10}), 0u);
    EXPECT_GT(culled({22, 2, 10}, {24, 2, 10}), 2500u) << "the closet has one of ten";
}

}  // namespace
}  // namespace sightline::test
