// Cells as places, portals, objects and their rows come out of a file as they went in, or the file is refused.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/visfile/file_check.h"
#include "tests/visfile/made_places.h"
#include "tests/visfile/made_rows.h"
#include "tests/visfile/seal.h"

namespace sightline::test {
namespace {

constexpr VisibilityForm kForms[] = {VisibilityForm::kInPlace, VisibilityForm::kPacked};

struct Made {
    BitMatrix visible;
    MadePlaces places;

    Result<Array<char>> bytes(VisibilityForm form) const {
        return visibilityFile({visible, places.space.graph.cell_of_leaf.empty() ? std::span<const uint32_t>() : leaves,
                               "house", 5, &places.space, &places.objects, &places.object_rows,
                               views ? &places.view_tree : nullptr, views ? &places.view_rows : nullptr},
                              form);
    }
    std::vector<uint32_t> leaves;
    bool views = false;
};

Made madeOf(uint64_t seed, uint32_t size, size_t rows, size_t objects) {
    Made made;
    made.visible = randomRows(rows, 0.3, seed);
    made.places = seed % 2 == 0 ? boxesInARow(seed, size, rows, objects) : leavesOfATree(seed, size, rows, objects);
    Random random(seed);
    made.places.addViews(size % 5, random);
    made.views = objects % 2 == 0;
    std::vector<CellPortal>& portals = made.places.space.graph.portals;
    for (size_t i = 0; i < portals.size(); i += 3) portals[i].one_way = true;
    for (const uint32_t cell : made.places.space.graph.cell_of_leaf)
        made.leaves.push_back(cell == CellGraph::kNoCell ? cell : made.places.space.row_of_cell[cell]);
    return made;
}

void expectSame(const LeafTree& a, const LeafTree& b) {
    EXPECT_EQ(a.contents, b.contents);
    EXPECT_EQ(a.bounds.min, b.bounds.min);
    EXPECT_EQ(a.bounds.max, b.bounds.max);
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (size_t i = 0; i < a.nodes.size(); ++i) {
        const LeafTreeNode &p = a.nodes[i], &q = b.nodes[i];
        EXPECT_TRUE(p.plane == q.plane && p.child[0] == q.child[0] && p.child[1] == q.child[1]);
    }
}

void expectSame(const CellSpace& a, const CellSpace& b) {
    ASSERT_EQ(a.graph.cells, b.graph.cells);
    EXPECT_EQ(a.graph.cell_of_leaf, b.graph.cell_of_leaf);
    EXPECT_EQ(a.row_of_cell, b.row_of_cell);
    EXPECT_EQ(a.names, b.names);
    EXPECT_EQ(a.outside, b.outside);
    EXPECT_EQ(a.tolerance, b.tolerance);
    EXPECT_EQ(a.graph.points, b.graph.points);
    EXPECT_EQ(a.planes, b.planes);
    ASSERT_EQ(a.graph.portals.size(), b.graph.portals.size());
    for (size_t i = 0; i < a.graph.portals.size(); ++i) {
        const CellPortal &p = a.graph.portals[i], &q = b.graph.portals[i];
        EXPECT_TRUE(p.cells[0] == q.cells[0] && p.cells[1] == q.cells[1] && p.first == q.first && p.count == q.count);
        EXPECT_TRUE(p.plane == q.plane && p.thickness == q.thickness && p.door == q.door && p.one_way == q.one_way);
    }
    ASSERT_EQ(a.regions.size(), b.regions.size());
    for (size_t i = 0; i < a.regions.size(); ++i) {
        const CellRegion &p = a.regions[i], &q = b.regions[i];
        EXPECT_TRUE(p.first_plane == q.first_plane && p.plane_count == q.plane_count);
        EXPECT_TRUE(p.bounds.min == q.bounds.min && p.bounds.max == q.bounds.max) << i;
    }
    ASSERT_EQ(a.doors.size(), b.doors.size());
    for (size_t i = 0; i < a.doors.size(); ++i) {
        const CellDoor &p = a.doors[i], &q = b.doors[i];
        EXPECT_TRUE(p.name == q.name && p.key == q.key && p.slide == q.slide);
    }
    expectSame(a.tree, b.tree);
}

void expectSameViews(const VisibilityFile& file, const MadePlaces& made) {
    ASSERT_TRUE(file.hasViewCells());
    expectSame(file.viewTree(), made.view_tree);
    ASSERT_EQ(file.viewRows().rows(), made.view_rows.rows());
    std::vector<uint64_t> row((file.objects().size() + 63) / 64, ~uint64_t{0});
    for (uint32_t r = 0; r < file.viewRows().rows(); ++r) {
        file.viewRows().row(r, row);
        EXPECT_TRUE(std::ranges::equal(row, made.view_rows.row(r))) << r;
    }
}

void expectSame(const VisibilityFile& file, const MadePlaces& made) {
    ASSERT_TRUE(file.hasCells() && file.hasObjects() && file.hasObjectRows());
    CellSpace expected = made.space;
    if (expected.ofTree()) expected.tree.bounds = made.space.tree.bounds;
    expectSame(file.cellSpace(), expected);
    const PlacedObjects& objects = file.objects();
    ASSERT_EQ(objects.size(), made.objects.size());
    for (size_t i = 0; i < objects.size(); ++i) {
        EXPECT_EQ(objects.key(i), made.objects.keys[i]);
        EXPECT_EQ(objects.bounds(i).min, made.objects.bounds[i].min);
        EXPECT_EQ(objects.bounds(i).max, made.objects.bounds[i].max);
        EXPECT_EQ(objects.seenFromEverywhere(i), made.objects.everywhere[i]);
        EXPECT_EQ(objects.isWall(i), made.objects.wall[i]);
        const std::span<const uint32_t> in = made.objects.cellsOf(i);
        ASSERT_EQ(objects.cells(i).size(), in.size());
        for (size_t k = 0; k < in.size(); ++k) EXPECT_EQ(objects.cells(i)[k], in[k]);
        EXPECT_EQ(objects.find(objects.key(i)).first, i / 2 * 2);
        EXPECT_EQ(objects.find(objects.key(i)).second, std::min(i / 2 * 2 + 2, objects.size()));
    }
    EXPECT_EQ(objects.find(~uint64_t{0}).first, objects.size());
    std::vector<uint64_t> row((objects.size() + 63) / 64, ~uint64_t{0});
    for (uint32_t r = 0; r < file.rows().cells(); ++r) {
        file.objectRow(r, row);
        EXPECT_TRUE(std::ranges::equal(row, made.object_rows.row(r))) << r;
    }
}

TEST(VisibilityPlaces, ComeOutAsTheyWentIn) {
    for (const uint32_t size : {1, 2, 7, 60})
        for (const size_t objects : {0, 1, 63, 64, 65, 4100})
            for (const uint64_t seed : {0, 1}) {
                SCOPED_TRACE(testing::Message() << size << " cells, " << objects << " objects, seed " << seed);
                const Made made = madeOf(seed + 10, size, 5 + size, objects);
                for (const VisibilityForm form : kForms) {
                    const Result<Array<char>> bytes = made.bytes(form);
                    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
                    EXPECT_EQ(*made.bytes(form), *bytes);
                    const Result<VisibilityFile> file = VisibilityFile::open(*bytes, "f");
                    ASSERT_TRUE(file.ok()) << file.error().message;
                    expectSame(*file, made.places);
                    EXPECT_EQ(file->hasViewCells(), made.views);
                    if (made.views) expectSameViews(*file, made.places);
                    EXPECT_EQ(packedFile(*file), *made.bytes(VisibilityForm::kPacked));
                    EXPECT_EQ(faultOfAnswers(*file), "");
                    EXPECT_GT(file->residentBytes(), file->rows().bytes());
                }
            }
}

TEST(VisibilityPlaces, AreOptionalOneByOne) {
    const Made made = madeOf(2, 9, 6, 20);
    const auto opened = [&](const CellSpace* space, const ObjectPlaces* objects, const BitMatrix* rows,
                            const LeafTree* tree = nullptr, const BitMatrix* seen = nullptr) {
        const Result<Array<char>> bytes =
            visibilityFile({made.visible, {}, "", 0, space, objects, rows, tree, seen}, VisibilityForm::kInPlace);
        if (!bytes.ok()) return bytes.error().message;
        const VisibilityFile file = std::move(*VisibilityFile::open(*bytes, "f"));
        return std::string(file.hasCells() ? "cells " : "") + (file.hasObjects() ? "objects " : "") +
               (file.hasObjectRows() ? "rows" : "") + (file.hasViewCells() ? "views" : "");
    };
    const MadePlaces& places = made.places;
    EXPECT_EQ(opened(nullptr, nullptr, nullptr), "");
    EXPECT_EQ(opened(&places.space, nullptr, nullptr), "cells ");
    EXPECT_EQ(opened(&places.space, &places.objects, nullptr), "cells objects ");
    EXPECT_EQ(opened(&places.space, &places.objects, &places.object_rows), "cells objects rows");
    EXPECT_EQ(opened(nullptr, &places.objects, nullptr), "objects without cells");
    EXPECT_EQ(opened(&places.space, nullptr, &places.object_rows), "rows of objects without objects");
    const LeafTree* tree = &places.view_tree;
    const BitMatrix* seen = &places.view_rows;
    EXPECT_EQ(opened(&places.space, &places.objects, nullptr, tree, seen), "cells objects views");
    EXPECT_EQ(opened(&places.space, nullptr, nullptr, tree, seen), "rows of objects without objects");
    for (const bool rows_alone : {false, true})
        EXPECT_EQ(
            opened(&places.space, &places.objects, nullptr, rows_alone ? nullptr : tree, rows_alone ? seen : nullptr),
            "view cells without rows, or rows without view cells");
}

TEST(VisibilityPlaces, AreNotWrittenOfWhatAReaderWouldRefuse) {
    const auto refused = [](const std::function<void(Made&)>& spoil, uint64_t seed = 2) {
        Made made = madeOf(seed, 9, 6, 20);
        EXPECT_TRUE(made.bytes(VisibilityForm::kInPlace).ok());
        spoil(made);
        const Result<Array<char>> bytes = made.bytes(VisibilityForm::kInPlace);
        if (bytes.ok()) return std::string();
        EXPECT_EQ(bytes.error().kind, Error::Kind::kUsage);
        return bytes.error().message;
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refused([](Made& m) { m.places.space.row_of_cell[3] = 6; }), "a cell with a row that there is not");
    EXPECT_EQ(refused([](Made& m) { m.places.space.row_of_cell.pop_back(); }), "not a row for each cell");
    EXPECT_EQ(refused([](Made& m) { m.places.space.names.pop_back(); }), "not a name for each cell");
    EXPECT_EQ(refused([](Made& m) { m.places.space.tolerance = kNan; }), "a tolerance that is none");
    EXPECT_EQ(refused([](Made& m) { m.places.space.outside = 9; }), "an outside that is no cell");
    EXPECT_EQ(refused([](Made& m) { m.places.space.outside = 0; }, 3), "an outside that is no cell");
    EXPECT_EQ(refused([](Made& m) { m.places.space.regions.pop_back(); }), "not a region for each cell");
    EXPECT_EQ(refused([](Made& m) { m.places.space.regions[1].bounds = Box3d(); }), "a region without bounds");
    EXPECT_EQ(refused([](Made& m) { m.places.space.planes[1].x = 2; }),
              "a plane of a region whose normal has not length 1");
    EXPECT_EQ(refused([](Made& m) { m.places.space.graph.portals[1].cells[1] = 9; }),
              "a portal that does not join two cells");
    EXPECT_EQ(refused([](Made& m) { m.places.space.graph.points[2].y = kNan; }),
              "a portal whose outline is not finite");
    EXPECT_EQ(refused([](Made& m) { m.places.space.doors.clear(); }), "a portal with a door that there is not");
    EXPECT_EQ(refused([](Made& m) { m.places.space.doors[0].slide.z = kNan; }), "a door whose slide is not finite");
    EXPECT_EQ(refused([](Made& m) { m.places.object_rows = BitMatrix(6, 21); }),
              "rows of objects that are not rows of these cells and objects");
    EXPECT_EQ(refused([](Made& m) { m.places.view_rows = BitMatrix(4, 20); }),
              "rows of view cells that are not rows of these cells and objects");
    EXPECT_EQ(refused([](Made& m) { m.places.view_tree.bounds = Box3d(); }).substr(0, 27),
              "tree: a tree without bounds");
    const auto objectFault = [&](const std::function<void(ObjectPlaces&)>& spoil) {
        const std::string line = refused([&](Made& m) { spoil(m.places.objects); });
        return line.substr(0, line.find(" at byte"));
    };
    EXPECT_EQ(objectFault([](ObjectPlaces& o) { o.cells[0] = 9; }),
              "objects: an object in a cell that there is not, or twice in one");
    EXPECT_EQ(objectFault([](ObjectPlaces& o) { o.keys[3] = 0; }), "objects: keys that do not rise");
    EXPECT_EQ(objectFault([](ObjectPlaces& o) { o.bounds[3].min.x = kNan; }), "objects: an object without bounds");
    const auto treeFault = [&](const std::function<void(LeafTree&)>& spoil) {
        const std::string line = refused([&](Made& m) { spoil(m.places.space.tree); }, 3);
        return line.substr(0, line.find(" at byte"));
    };
    EXPECT_EQ(treeFault([](LeafTree& t) { t.nodes[0].plane = glm::dvec4(0); }), "tree: a plane without a direction");
    EXPECT_EQ(treeFault([](LeafTree& t) { t.bounds = Box3d(); }), "tree: a tree without bounds");
    EXPECT_EQ(treeFault([](LeafTree& t) { t.nodes[0].child[0] = 0; }),
              "tree: a child that is not a node of its own behind its parent");
    EXPECT_EQ(treeFault([](LeafTree& t) { t.nodes[0].child[0] = LeafTreeNode::kLeaf + 99; }),
              "tree: a child that is a leaf that there is not");
}

TEST(VisibilityPlaces, OfATreeThatIsTooDeepAreRefused) {
    LeafTree tree;
    tree.bounds = {glm::dvec3(0), glm::dvec3(1)};
    tree.contents.assign(1, LeafContents::kSolid);
    for (uint32_t i = 0; i < kDeepestTreeInFile; ++i)
        tree.nodes.push_back({{1, 0, 0, -0.5}, {LeafTreeNode::kLeaf, i + 1}});
    tree.nodes.back().child[1] = LeafTreeNode::kLeaf;
    EXPECT_TRUE(treeSection(tree).ok());
    tree.nodes.back().child[1] = kDeepestTreeInFile;
    tree.nodes.push_back({{1, 0, 0, -0.5}, {LeafTreeNode::kLeaf, LeafTreeNode::kLeaf}});
    EXPECT_EQ(treeSection(tree).error().message.substr(0, 29), "tree: a tree that is too deep");
}

TEST(VisibilityPlaces, RefuseEveryChangedByte) {
    for (const uint64_t seed : {2, 3}) {
        const Array<char> good = *madeOf(seed, 6, 4, 9).bytes(VisibilityForm::kInPlace);
        for (size_t i = 0; i < good.size(); ++i) {
            Array<char> bytes = good;
            bytes[i] ^= static_cast<char>(1u << i % 8);
            ASSERT_FALSE(VisibilityFile::open(bytes, "f").ok()) << i;
        }
    }
}

TEST(VisibilityPlaces, ThatWereSealedAgainHaveAnswersOrAreRefused) {
    Random random(11);
    for (const uint64_t seed : {2, 3})
        for (const VisibilityForm form : kForms) {
            const Array<char> good = *madeOf(seed, 8, 5, 70).bytes(form);
            int opened_files = 0;
            for (int i = 0; i < 25000; ++i) {
                Array<char> bytes = good;
                for (uint64_t k = 0; k <= random.below(3); ++k) {
                    const uint64_t at = random.below(bytes.size());
                    if (random.below(4) == 0) bytes[at] = static_cast<char>(random.below(256));
                    else bytes[at] ^= static_cast<char>(1u << random.below(8));
                }
                seal(bytes);
                bool opened = false;
                ASSERT_EQ(faultOfReading(bytes, opened), "") << i;
                opened_files += opened;
            }
            EXPECT_GT(opened_files, 100);
            EXPECT_LT(opened_files, 25000);
        }
}

}  // namespace
}  // namespace sightline::test
