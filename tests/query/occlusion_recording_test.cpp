// A recording of a frame is read as it was written, and nothing in a file is believed.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/occlusion_recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/query/made_recording.h"
#include "tests/support/corpus.h"
#include "tests/support/memory.h"

namespace sightline::test {
namespace {

using namespace recording_file;

bool sameBox(const Box3f& a, const Box3f& b) { return a.min == b.min && a.max == b.max; }

bool sameOccluder(const Occluder& a, const Occluder& b) {
    const auto same_polygon = [](const OccluderPolygon& p, const OccluderPolygon& q) {
        return std::equal(p.vertex, p.vertex + 4, q.vertex) && p.double_sided == q.double_sided;
    };
    const auto same_edge = [](const OccluderEdge& p, const OccluderEdge& q) {
        return p.from == q.from && p.to == q.to && p.left == q.left && p.right == q.right;
    };
    const auto same_cluster = [](const OccluderCluster& p, const OccluderCluster& q) {
        return sameBox(p.bounds, q.bounds) && p.first_vertex == q.first_vertex && p.vertex_count == q.vertex_count &&
               p.first_polygon == q.first_polygon && p.polygon_count == q.polygon_count &&
               p.ring_count == q.ring_count && p.first_edge == q.first_edge && p.edge_count == q.edge_count &&
               p.triangle_count == q.triangle_count;
    };
    return a.x == b.x && a.y == b.y && a.z == b.z && sameBox(a.bounds, b.bounds) &&
           std::equal(a.polygons.begin(), a.polygons.end(), b.polygons.begin(), b.polygons.end(), same_polygon) &&
           std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), same_edge) &&
           std::equal(a.clusters.begin(), a.clusters.end(), b.clusters.begin(), b.clusters.end(), same_cluster);
}

bool sameAsked(const TileLog& a, const TileLog& b) {
    const auto same_rect = [](const TileLog::RectTest& p, const TileLog::RectTest& q) {
        return p.rect.x0 == q.rect.x0 && p.rect.y0 == q.rect.y0 && p.rect.x1 == q.rect.x1 && p.rect.y1 == q.rect.y1 &&
               p.rect.nearness == q.rect.nearness && p.box == q.box && p.seams == q.seams && p.hidden == q.hidden;
    };
    const auto same_tile = [](const TileLog::TileTest& p, const TileLog::TileTest& q) {
        return p.tile == q.tile && p.box == q.box && p.seams == q.seams && p.window == q.window && p.open == q.open;
    };
    return a.calls == b.calls && a.nearest == b.nearest && a.boxes.size() == b.boxes.size() &&
           std::memcmp(a.boxes.data(), b.boxes.data(), a.boxes.size() * sizeof a.boxes[0]) == 0 &&
           std::equal(a.rects.begin(), a.rects.end(), b.rects.begin(), b.rects.end(), same_rect) &&
           std::equal(a.tiles.begin(), a.tiles.end(), b.tiles.begin(), b.tiles.end(), same_tile);
}

bool same(const OcclusionRecording& a, const OcclusionRecording& b) {
    const auto same_instance = [](const auto& p, const auto& q) {
        return p.occluder == q.occluder && p.transform == q.transform;
    };
    const auto same_draw = [](const auto& p, const auto& q) {
        return p.instance == q.instance && p.cluster == q.cluster;
    };
    return a.view.view == b.view.view && a.view.projection == b.view.projection && a.view.width == b.view.width &&
           a.view.height == b.view.height && a.view.jitter == b.view.jitter &&
           a.settings.occlusion_size == b.settings.occlusion_size &&
           std::equal(a.occluders.begin(), a.occluders.end(), b.occluders.begin(), b.occluders.end(), sameOccluder) &&
           std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(), same_instance) &&
           std::equal(a.draws.begin(), a.draws.end(), b.draws.begin(), b.draws.end(), same_draw) &&
           sameAsked(a.asked, b.asked);
}

/// Reads what may be broken: a recording that can be replayed and is written as it was read, or one line.
/// @return whether it was a recording
bool readAndReplay(const Array<char>& bytes) {
    const Result<OcclusionRecording> read = parseRecording(bytes, "frame.rec");
    if (!read) {
        const std::string& line = read.error().message;
        EXPECT_EQ(line.rfind("frame.rec: ", 0), 0u) << line;
        EXPECT_NE(line.find(" at byte "), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        return false;
    }
    EXPECT_EQ(recordingBytes(*read), bytes);
    OcclusionReplay(*read).run();
    return true;
}

/// Where a section begins, and how long it is.
struct Place {
    size_t at = 0, size = 0;
};
Place placeOf(const Array<char>& bytes, Section section) {
    Place place{kHashedAt + 8 * kSectionCount, 0};
    for (uint32_t i = 0;; ++i) {
        place.size = ByteCursor(std::span<const char>(bytes).subspan(kHashedAt + 8 * i)).take<uint64_t>();
        if (i == section) return place;
        place.at += place.size;
    }
}

template <class T>
void overwrite(Array<char>& bytes, size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

TEST(OcclusionRecording, IsReadAsItWasWritten) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const OcclusionRecording recording = recordWithTiles(seed);
        const Array<char> bytes = recordingBytes(recording);
        EXPECT_EQ(recordingBytes(recordWithTiles(seed)), bytes) << "the same frame, other bytes";
        const Result<OcclusionRecording> read = parseRecording(bytes, "frame.rec");
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_TRUE(same(recording, *read));
        EXPECT_TRUE(OcclusionReplay(*read).run().same());
    }
}

TEST(OcclusionRecording, OfNothingIsOne) {
    World world;
    const Result<OcclusionRecording> recording = recordOcclusion(world.commit(), View());
    ASSERT_TRUE(recording.ok());
    EXPECT_TRUE(readAndReplay(recordingBytes(*recording)));
    EXPECT_FALSE(recordOcclusion(world.commit(), View(), {.stages = stageBit(Stage::kFrustum)}).ok());
    View view;
    view.projection[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(recordOcclusion(world.commit(), view).ok());
}

TEST(OcclusionRecording, SaysInOneLineWhatIsWrongAndWhere) {
    const Array<char> good = recordingBytes(recordWithTiles(3));
    const auto expect = [&](const std::string& what, size_t at, auto change, bool sealed = true) {
        Array<char> bytes = good;
        change(bytes);
        if (sealed) seal(bytes);
        const Result<OcclusionRecording> read = parseRecording(bytes, "a/frame.rec");
        ASSERT_FALSE(read.ok()) << what;
        EXPECT_EQ(read.error().message, "a/frame.rec: " + what + " at byte " + std::to_string(at));
    };
    const auto in = [&](Section section, size_t offset) { return placeOf(good, section).at + offset; };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expect("not a recording of occlusion calls", 0, [](auto& b) { b[3] = 'X'; });
    expect("not a recording of occlusion calls", 0, [](auto& b) { b.clear(); });
    expect("the file ends within its head", 20, [](auto& b) { b.resize(20); });
    expect("the file ends within its head", 100, [](auto& b) { b.resize(100); });
    expect("a recording of version 9, where version 3 is read", 16, [](auto& b) { b[16] = 9; });
    expect("a recording of version 1, where version 3 is read", 16, [](auto& b) { b[16] = 1; });
    expect("bytes after the last section", good.size(), [](auto& b) { b.push_back(0); });
    expect(
        "the content does not have the hash that it says", 24, [&](auto& b) { b[in(kVertices, 5)] ^= 1; }, false);
    expect("a section that is longer than the file", kHashedAt + 8 * kEdges,
           [](auto& b) { overwrite(b, kHashedAt + 8 * kEdges, ~uint64_t{0} / 8 * 8); });
    expect("a section that ends within a record", kHashedAt + 8 * kView,
           [](auto& b) { overwrite(b, kHashedAt, uint64_t{3}); });
    expect("a number that is not finite", in(kView, 8), [&](auto& b) { overwrite(b, in(kView, 8), HUGE_VAL); });
    expect("a view that cannot be used", in(kView, 0), [&](auto& b) { overwrite(b, in(kView, 256), 0u); });
    expect("a buffer of no pixels, or of more than 8192 in a row", in(kView, 272),
           [&](auto& b) { overwrite(b, in(kView, 272), 8193u); });
    expect("a number that is not finite", in(kVertices, 16), [&](auto& b) { overwrite(b, in(kVertices, 16), nan); });
    expect("bounds that are empty", in(kOccluders, 0), [&](auto& b) { overwrite(b, in(kOccluders, 0), 1e9f); });
    expect("an occluder that has more than the file", in(kOccluders, 28),
           [&](auto& b) { overwrite(b, in(kOccluders, 28), ~0u); });
    expect("a polygon of a vertex that there is not", in(kPolygons, 0), [&](auto& b) { b[in(kPolygons, 2)] = '\xf0'; });
    expect("a polygon that names a vertex twice", in(kPolygons, 0),
           [&](auto& b) { b[in(kPolygons, 1)] = b[in(kPolygons, 0)]; });
    expect("a polygon with neither one side nor two", in(kPolygons, 4), [&](auto& b) { b[in(kPolygons, 4)] = 2; });
    expect("a cluster with vertices that there are not", in(kClusters, 0),
           [&](auto& b) { overwrite(b, in(kClusters, 24), 8u << 20); });
    expect("a cluster with polygons that there are not", in(kClusters, 0),
           [&](auto& b) { overwrite(b, in(kClusters, 36), 251u); });
    expect("a cluster with edges that there are not", in(kClusters, 0),
           [&](auto& b) { overwrite(b, in(kClusters, 44), ~0u); });
    expect("an instance of an occluder that there is not", in(kInstances, 132),
           [&](auto& b) { overwrite(b, in(kInstances, 132), 77u); });
    expect("a call of a kind that is not known", in(kCalls, 1), [&](auto& b) { b[in(kCalls, 1)] = 3; });
    expect("a draw of a cluster that there is not", in(kDraws, 0),
           [&](auto& b) { overwrite(b, in(kDraws, 4), 1u << 30); });
    expect("a test of a rectangle outside of the buffer", in(kRects, 17),
           [&](auto& b) { overwrite(b, in(kRects, 17 + 4), uint16_t{9000}); });
    expect("a test of a box that there is not", in(kRects, 12),
           [&](auto& b) { overwrite(b, in(kRects, 12), 1u << 30); });
    expect("a test of a box that there is not", in(kTiles, 20), [&](auto& b) { overwrite(b, in(kTiles, 20), ~1u); });
    expect("a number that is not finite", in(kBoxes, 160 + 24),
           [&](auto& b) { overwrite(b, in(kBoxes, 160 + 24), HUGE_VAL); });
    expect("a test of a tile outside of the buffer", in(kTiles, 25),
           [&](auto& b) { overwrite(b, in(kTiles, 25), 1u << 20); });
    size_t part = in(kTiles, 4);  // the window of a test that does not ask about all of its tile
    const auto asksAll = [&](size_t at) {
        return std::all_of(good.begin() + long(at), good.begin() + long(at) + 8, [](char c) { return c == '\xff'; });
    };
    while (asksAll(part)) part += 25;
    expect("fewer nearnesses than tests ask for", in(kBoxes, 0), [&](auto& b) { overwrite(b, part, ~uint64_t{0}); });
    expect("a number that is not one", in(kNearest, 4), [&](auto& b) { overwrite(b, in(kNearest, 4), nan); });
}

TEST(OcclusionRecording, SurvivesAnyBytes) {
    Array<char> good = recordingBytes(recordWithTiles(2));
    for (size_t size = 0; size < good.size(); size += 1 + size / 16) {
        Array<char> bytes(good.begin(), good.begin() + static_cast<ptrdiff_t>(size));
        seal(bytes);
        ASSERT_FALSE(readAndReplay(bytes));
    }
    Random random(4);
    int replayed = 0;
    for (int i = 0; i < 1500; ++i) {
        Array<char> bytes = good;
        for (uint64_t k = 0; k <= random.below(3); ++k) {
            const Place place = placeOf(good, static_cast<Section>(random.below(kSectionCount)));
            const size_t at = place.at + random.below(std::max<size_t>(place.size, 1));
            if (at < bytes.size()) bytes[at] ^= static_cast<char>(1u << random.below(8));
        }
        seal(bytes);
        const Result<OcclusionRecording> read = parseRecording(bytes, "frame.rec");
        if (read && read->settings.occlusion_size > 1024) continue;  // sound, and slow
        replayed += readAndReplay(bytes);
    }
    EXPECT_GT(replayed, 300);
}

TEST(OcclusionRecording, TakesNoMoreMemoryThanAFewTimesItsFile) {
    for (const uint64_t seed : {1, 2}) {
        const Array<char> bytes = recordingBytes(recordWithTiles(seed));
        CountingMemory counted;
        const Result<OcclusionRecording> read = parseRecording(bytes, "frame.rec", &counted);
        ASSERT_TRUE(read.ok());
        EXPECT_LT(counted.most, 5 * bytes.size());
    }
    // Occluders of nothing but promises.
    OcclusionRecording empty;
    empty.occluders.resize(1000);
    for (Occluder& occluder : empty.occluders) {
        occluder.bounds.grow({0, 0, 0});
        occluder.clusters.resize(1);
    }
    const Array<char> bytes = recordingBytes(empty);
    CountingMemory counted;
    EXPECT_FALSE(parseRecording(bytes, "frame.rec", &counted).ok());
    EXPECT_LT(counted.most, 6 * bytes.size());
}

TEST(OcclusionRecording, CorpusOfTheFuzzerIsReadAndReplayed) {
    int recordings = 0, others = 0;
    forCorpus("occlusion_recording", 6, [&](const std::string&, const std::string& read) {
        Array<char> bytes(read.begin(), read.end());
        if (readAndReplay(bytes)) ++recordings;
        else ++others;
        seal(bytes);
        readAndReplay(bytes);
    });
    EXPECT_GE(recordings, 3);
    EXPECT_GE(others, 3);
}

}  // namespace
}  // namespace sightline::test
