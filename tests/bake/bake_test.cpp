// The list of steps: the same bytes by whatever way, and none after a stop.
// SPDX-License-Identifier: MIT
#include "sightline/bake/bake.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sightline/bake/flow/bake_state.h"
#include "sightline/base/thread_pool.h"
#include "sightline/tools/scene/procedural.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

const Scene& house() {
    static const Scene scene = *makeProcedural("building:1:2");
    return scene;
}

BakeCells houseCells() {
    SceneCellSettings settings;
    settings.trusted = true;  // by who made it
    return sceneToBake(house(), "house", settings);
}

BakeSettings withObjects() {
    BakeSettings settings;
    settings.object_rows = true;
    return settings;
}

std::string bytesOf(const Result<Baked>& baked) {
    EXPECT_TRUE(baked.ok()) << baked.error().message;
    const std::span<const char> bytes = baked->file.bytes(VisibilityForm::kPacked);
    return {bytes.begin(), bytes.end()};
}

const std::string& houseBytes() {
    static const std::string bytes = bytesOf(bake::bake(houseCells(), house(), withObjects()));
    return bytes;
}

TEST(Bake, MakesAFileThatOpens) {
    const Result<VisibilityFile> file = VisibilityFile::open(houseBytes(), "house");
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->mapName(), "house");
    EXPECT_TRUE(file->hasCells() && file->hasObjects() && file->hasObjectRows());
    EXPECT_GT(file->objects().size(), 500u);
}

// Of a scene's own walls there are no rows, whoever asks for them.
TEST(Bake, OfOwnWallsHasCellsWithoutRows) {
    SoupCellReport report;
    const std::string bytes = bytesOf(bake::bake(soupToBake(house(), "house", {}, &report), house(), withObjects()));
    EXPECT_GT(report.closed, 10u);
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "house");
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->rows().cells(), 0u);
    EXPECT_FALSE(file->hasObjectRows());
    ASSERT_TRUE(file->hasCells() && file->hasObjects());
    EXPECT_GT(file->cells().cells(), 200u);
    EXPECT_GT(file->objects().size(), 500u);
    uint64_t walls = 0;
    for (size_t i = 0; i < file->objects().size(); ++i) walls += file->objects().isWall(i);
    EXPECT_EQ(walls, report.walls.size());
}

TEST(Bake, MakesTheSameBytesWithAnyThreadsAndInPlace) {
    for (const uint32_t threads : {1u, 3u}) {
        ThreadPool pool(threads);
        BakeSettings settings = withObjects();
        settings.jobs = &pool;
        EXPECT_EQ(bytesOf(bake::bake(houseCells(), house(), settings)), houseBytes());
    }
    BakeSettings settings = withObjects();
    settings.form = VisibilityForm::kInPlace;
    const Result<Baked> baked = bake::bake(houseCells(), house(), settings);
    ASSERT_TRUE(baked.ok());
    EXPECT_TRUE(baked->file.packed.empty());
    const Array<char> packed = packedFile(*VisibilityFile::open(baked->file.bytes(settings.form), "house"));
    EXPECT_EQ(std::string(packed.begin(), packed.end()), houseBytes());
}

TEST(Bake, GoesOnFromEachCheckpointToTheSameBytes) {
    std::vector<std::string> checkpoints;
    BakeSettings settings = withObjects();
    settings.checkpoint_seconds = 0;
    settings.checkpoint = [&](const std::string& bytes) {
        checkpoints.push_back(bytes);
        return success();
    };
    EXPECT_EQ(bytesOf(bake::bake(houseCells(), house(), settings)), houseBytes());
    ASSERT_FALSE(checkpoints.empty());  // the first one is always written; where writing takes long, no other
    const CellGraph rows = houseCells().rows;
    for (const std::string& bytes : {checkpoints.front(), checkpoints.back()}) {
        Result<CellVisibilityState> state = readBakeState(bytes, "state", rows, 0);
        ASSERT_TRUE(state.ok()) << state.error().message;
        BakeSettings rest = withObjects();
        rest.resume = &*state;
        EXPECT_EQ(bytesOf(bake::bake(houseCells(), house(), rest)), houseBytes());
    }
}

TEST(Bake, EndsWithTheErrorOfACheckpoint) {
    BakeSettings settings;
    settings.checkpoint_seconds = 0;
    settings.checkpoint = [](const std::string&) -> Status { return Error{Error::Kind::kOutput, "disk full"}; };
    const Result<Baked> baked = bake::bake(houseCells(), house(), settings);
    ASSERT_FALSE(baked.ok());
    EXPECT_EQ(baked.error().message, "disk full");
}

TEST(Bake, AStopLeavesACheckpointAndNoFile) {
    std::string left;
    bool stops = false;
    BakeSettings settings = withObjects();
    settings.stop = [&] { return stops; };
    settings.progress = [&](const BakeProgress& now) { stops = stops || (now.step == std::string("flow")); };
    settings.checkpoint = [&](const std::string& bytes) {
        left = bytes;
        return success();
    };
    const Result<Baked> baked = bake::bake(houseCells(), house(), settings);
    ASSERT_TRUE(baked.ok());
    EXPECT_TRUE(baked->interrupted);
    EXPECT_TRUE(baked->file.in_place.empty());
    Result<CellVisibilityState> state = readBakeState(left, "state", houseCells().rows, 0);
    ASSERT_TRUE(state.ok()) << state.error().message;
    BakeSettings rest = withObjects();
    rest.resume = &*state;
    EXPECT_EQ(bytesOf(bake::bake(houseCells(), house(), rest)), houseBytes());
}

TEST(Bake, ALimitOfTimeLeavesMoreVisible) {
    const Result<Baked> whole = bake::bake(houseCells(), house());
    BakeSettings settings;
    settings.time_limit = 1e-9;
    const Result<Baked> stopped = bake::bake(houseCells(), house(), settings);
    ASSERT_TRUE(whole.ok() && stopped.ok());
    EXPECT_TRUE(stopped->rows.stopped);
    EXPECT_FALSE(stopped->interrupted || stopped->file.packed.empty());
    EXPECT_GT(stopped->rows.visible.count(), whole->rows.visible.count());
    for (uint32_t a = 0; a < whole->rows.visible.rows(); ++a)
        for (uint32_t b = 0; b < whole->rows.visible.rows(); ++b)
            ASSERT_LE(whole->rows.visible.at(a, b), stopped->rows.visible.at(a, b)) << a << " " << b;
}

TEST(Bake, WithoutPlacesHoldsRowsAlone) {
    BakeCells cells;
    cells.name = "rows";
    cells.rows = houseCells().rows;
    const Result<Baked> baked = bake::bake(std::move(cells), house(), withObjects());
    const std::string bytes = bytesOf(baked);
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "rows");
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_FALSE(file->hasCells() || file->hasObjects() || file->hasObjectRows());
    EXPECT_EQ(file->rows().cells(), baked->rows.visible.rows());
    EXPECT_EQ(baked->objects.places.size(), 0u);
}

TEST(Bake, MorePortalsThanFitAreAnError) {
    BakeCells cells;
    cells.name = "sponge";
    cells.rows.cells = 2;
    cells.rows.portals.resize(kMostBakedPortals + 1);
    const Result<Baked> baked = bake::bake(std::move(cells), {});
    ASSERT_FALSE(baked.ok());
    EXPECT_EQ(baked.error().message, "sponge: 65537 portals, and at most 65536 can be baked at once");
}

}  // namespace
}  // namespace sightline
