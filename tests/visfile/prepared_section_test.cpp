// Prepared meshes come out of a file as they went in, or are refused.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/prepared_section.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "tests/visfile/made_meshes.h"
#include "tests/visfile/made_places.h"
#include "tests/visfile/made_rows.h"
#include "tests/visfile/file_check.h"

namespace sightline::test {
namespace {

Array<char> bytesOf(const PreparedMeshes& made) { return preparedSection(made.meshes, made.mesh_of_object); }

TEST(PreparedSection, ComesOutAsItWentIn) {
    const PreparedMeshes made = madeMeshes(1, 9);
    ASSERT_FALSE(made.meshes[0].inner.empty());
    ASSERT_GT(made.meshes[0].clusters.count(), 4u);
    ASSERT_FALSE(made.meshes[0].clusters.facing.turned.empty());
    ASSERT_FALSE(made.meshes[0].clusters.facing.cones.empty());
    ASSERT_FALSE(made.meshes[0].clusters.facing.masks.empty());
    ASSERT_GT(made.meshes[0].lods.levels.size(), 2u);
    const Array<char> bytes = bytesOf(made);
    const Result<PreparedMeshes> read = readPreparedSection(bytes, 9, "file");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(bytesOf(*read), bytes);
    // And what is not in the bytes as such.
    const PreparedMesh &was = made.meshes[0], &is = read->meshes[0];
    EXPECT_EQ(is.occluder.triangleCount(), was.occluder.triangleCount());
    EXPECT_EQ(is.clusters.stride, was.clusters.stride);
    EXPECT_EQ(is.clusters.facing.stride, was.clusters.facing.stride);
    EXPECT_EQ(is.clusters.facing.first, was.clusters.facing.first);
    EXPECT_EQ(is.clusters.facing.triangles, was.clusters.facing.triangles);
    EXPECT_EQ(is.clusters.closed.size(), was.clusters.closed.size());
    EXPECT_EQ(is.lods.parts, was.lods.parts);
    EXPECT_TRUE(is.occluder_is_shape);
    EXPECT_TRUE(read->meshes[2].has_shape);
    EXPECT_EQ(faultOfPrepared(readPreparedSection(bytes, 9, "a/map.see"), 9), "");
    const Array<char> none = bytesOf(PreparedMeshes());
    EXPECT_TRUE(readPreparedSection(none, 0, "file").ok());
}

TEST(PreparedSection, EachEndTooEarlyIsTold) {
    const Array<char> bytes = bytesOf(madeMeshes(2, 3));
    for (size_t size = 0; size < bytes.size(); size += 1 + size / 7) {
        const Result<PreparedMeshes> read = readPreparedSection(std::span(bytes).first(size), 3, "a/map.see", 100);
        ASSERT_FALSE(read.ok()) << size;
        EXPECT_EQ(faultOfPrepared(read, 3), "");
    }
    EXPECT_FALSE(readPreparedSection(bytes, 4, "a/map.see").ok()) << "of other objects";
}

// Bytes are changed at random, most of them where numbers stand that others hang on: what is read can be drawn.
TEST(PreparedSection, NothingInItIsBelieved) {
    const Array<char> bytes = bytesOf(madeMeshes(3, 5));
    Random random(4);
    int refused = 0, read = 0;
    constexpr uint64_t kHeads = 8 * visibility_file::kPreparedRuns;
    for (int round = 0; round < 1500; ++round) {
        Array<char> changed = bytes;
        const int changes = 1 + static_cast<int>(random.below(3));
        for (int i = 0; i < changes; ++i) {
            const size_t at = kHeads + random.below(changed.size() - kHeads);
            if (random.below(2) == 0) changed[at] = static_cast<char>(random.below(256));
            else changed[at] = static_cast<char>(changed[at] ^ (1 << random.below(8)));
        }
        const Result<PreparedMeshes> meshes = readPreparedSection(changed, 5, "a/map.see");
        (meshes.ok() ? read : refused) += 1;
        ASSERT_EQ(faultOfPrepared(meshes, 5), "") << round;
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(read, 100);
}

TEST(PreparedSection, IsHeldByAVisibilityFileInBothForms) {
    const MadePlaces places = boxesInARow(4, 5, 6, 12);
    const BitMatrix visible = randomRows(6, 0.3, 5);
    const PreparedMeshes made = madeMeshes(5, 12);
    VisibilityContent content{visible, {}, "house", 5, &places.space, &places.objects};
    content.prepared = made.meshes;
    content.prepared_of_object = made.mesh_of_object;
    for (const VisibilityForm form : {VisibilityForm::kInPlace, VisibilityForm::kPacked}) {
        const Result<Array<char>> bytes = visibilityFile(content, form);
        ASSERT_TRUE(bytes.ok()) << bytes.error().message;
        const Result<VisibilityFile> file = VisibilityFile::open(*bytes, "file");
        ASSERT_TRUE(file.ok()) << file.error().message;
        ASSERT_TRUE(file->hasPrepared());
        const Result<PreparedMeshes> read = file->prepared("file");
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_EQ(bytesOf(*read), bytesOf(made));
        bool opened = false;
        EXPECT_EQ(faultOfReading(*bytes, opened), "");
        EXPECT_TRUE(opened);
    }
    content.prepared_of_object = content.prepared_of_object.first(11);
    EXPECT_FALSE(visibilityFile(content, VisibilityForm::kInPlace).ok());
    content.objects = nullptr;
    EXPECT_FALSE(visibilityFile(content, VisibilityForm::kInPlace).ok());
    const Result<Array<char>> plain =
        visibilityFile({visible, {}, "house", 5, &places.space, &places.objects}, VisibilityForm::kInPlace);
    EXPECT_FALSE(VisibilityFile::open(*plain, "file")->hasPrepared());
}

}  // namespace
}  // namespace sightline::test
