// A recorded frame is read as it was written, asked again with the same answer, and nothing in a file is believed.
// SPDX-License-Identifier: MIT
#include "sightline/geom/setting_rows.h"
#include "sightline/query/record/frame_recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/query/made_recording.h"
#include "tests/support/corpus.h"
#include "tests/support/memory.h"
#include "tests/support/random.h"
#include "tests/support/targets.h"

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

bool sameForm(const FrameRecording::Form& a, const FrameRecording::Form& b) {
    const auto same_inner = [](const InnerOccluder& p, const InnerOccluder& q) {
        return sameOccluder(p.occluder, q.occluder) && sameBox(p.outside, q.outside) && p.error == q.error;
    };
    return sameOccluder(a.occluder, b.occluder) &&
           std::equal(a.inner.begin(), a.inner.end(), b.inner.begin(), b.inner.end(), same_inner);
}

bool sameObject(const ObjectDef& a, const ObjectDef& b) {
    return a.bounds.min == b.bounds.min && a.bounds.max == b.bounds.max && a.transform == b.transform &&
           a.key == b.key && a.occluder == b.occluder && a.layers == b.layers && a.shape == b.shape &&
           a.limits == b.limits && a.lods == b.lods && a.hides_in_lods == b.hides_in_lods;
}

bool sameSettings(const QuerySettings& a, const QuerySettings& b) {
    bool same = true;
    forEachSetting([&](const auto& row) { same = same && a.*row.member == b.*row.member; });
    return same;
}

void expectSame(const FrameRecording& a, const FrameRecording& b) {
    EXPECT_EQ(a.view.view, b.view.view);
    EXPECT_EQ(a.view.projection, b.view.projection);
    EXPECT_EQ(a.view.layers, b.view.layers);
    EXPECT_EQ(a.view.jitter, b.view.jitter);
    EXPECT_TRUE(sameSettings(a.settings, b.settings));
    EXPECT_EQ(a.volumes, b.volumes);
    EXPECT_TRUE(std::equal(a.forms.begin(), a.forms.end(), b.forms.begin(), b.forms.end(), sameForm));
    EXPECT_EQ(a.chains.size(), b.chains.size());
    EXPECT_TRUE(std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(), sameObject));
    EXPECT_EQ(a.reasons, b.reasons);
    EXPECT_EQ(a.again, b.again);
    EXPECT_EQ(a.named, b.named);
}

/// Reads what may be broken: a recording that can be asked again and written again, or one line.
/// @return whether it was a recording
bool readAndReplay(const Array<char>& bytes) {
    const Result<FrameRecording> read = parseRecording(bytes, "frame.rec");
    if (!read) {
        const std::string& line = read.error().message;
        EXPECT_EQ(line.rfind("frame.rec: ", 0), 0u) << line;
        EXPECT_NE(line.find(" at byte "), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        return false;
    }
    const Array<char> again = recordingBytes(*read);
    const Result<FrameRecording> second = parseRecording(again, "frame.rec");
    EXPECT_TRUE(second.ok() && recordingBytes(*second) == again);
    FrameReplay(*read).run();
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

TEST(FrameRecording, IsReadAsItWasWrittenAndAskedAgainOnEveryInstructionSet) {
    size_t objects = 0, culled = 0, inner = 0, chains = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const FrameRecording recording = recordOf(seed);
        const Array<char> bytes = recordingBytes(recording);
        EXPECT_EQ(recordingBytes(recordOf(seed)), bytes) << "the same frame, other bytes";
        const Result<FrameRecording> read = parseRecording(bytes, "frame.rec");
        ASSERT_TRUE(read.ok()) << read.error().message;
        expectSame(recording, *read);
        EXPECT_EQ(recordingBytes(*read), bytes);
        FrameReplay replay(*read);
        forEachTarget([&](const std::string& target) {
            const FrameReplay::Answer answer = replay.run();
            EXPECT_TRUE(answer.same()) << target << ", seed " << seed << ": " << answer.differences
                                       << " objects differ, first " << answer.different;
        });
        objects += read->objects.size();
        culled +=
            static_cast<size_t>(std::count_if(read->again.begin(), read->again.end(), [](uint8_t r) { return r > 0; }));
        for (const FrameRecording::Form& form : read->forms) inner += form.inner.size();
        chains += read->chains.size();
    }
    EXPECT_GT(objects, 300u);
    EXPECT_GT(culled, 100u);
    EXPECT_GT(inner, 3u);
    EXPECT_GT(chains, 3u);
}

TEST(FrameRecording, HoldsWhatTheAnswerWasAndAllThatMatters) {
    for (uint64_t seed = 11; seed <= 14; ++seed) {
        MadeWorld made = someWorld(seed, 300, 0);
        const Snapshot now = made.world.commit();
        const View view = someView(seed);
        Query query;
        const std::vector<uint8_t> kept = keptOf(query.visible(now, view, someSettings(seed)), made.transforms.size());
        const Result<FrameRecording> recording = recordFrame(query);
        ASSERT_TRUE(recording.ok());
        const std::vector<uint8_t> seen = made.seen(view, 2), reasons = reasonsOf(query, now);
        std::vector<uint8_t> recorded(kept.size(), 0);
        for (size_t i = 0; i < recording->objects.size(); ++i) {
            const uint64_t key = recording->objects[i].key;
            recorded[key] = 1;
            EXPECT_EQ(recording->reasons[i], reasons[key]);
            // The hierarchy over fewer objects is another one, but hides nothing that is seen.
            EXPECT_TRUE(recording->again[i] == 0 || !seen[key]) << "seed " << seed << ", object " << key;
        }
        for (size_t i = 0; i < kept.size(); ++i) {
            EXPECT_TRUE(recorded[i] || !kept[i]);
            const bool shows_nothing = reasons[i] == 1 + static_cast<uint8_t>(Stage::kFrustum) ||
                                       reasons[i] == 1 + static_cast<uint8_t>(Stage::kFacing);
            EXPECT_TRUE(recorded[i] || shows_nothing) << int(reasons[i]);
        }
        EXPECT_LT(recording->objects.size(), kept.size());
    }
}

TEST(FrameRecording, NoticesAnAnswerThatIsNotTheSame) {
    FrameRecording recording = recordOf(2);
    EXPECT_TRUE(FrameReplay(recording).run().same());
    recording.again[5] = recording.again[5] == 0 ? 7 : 0;
    recording.again.back() ^= 1;
    const FrameReplay::Answer answer = FrameReplay(recording).run();
    EXPECT_EQ(answer.differences, 2u);
    EXPECT_EQ(answer.different, 5u);
}

TEST(FrameRecording, HoldsTheCertificatesOfAQueryThatRemembers) {
    size_t certificates = 0;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        MadeWorld made = someWorld(seed, 500, 0);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        const glm::dvec3 eye = randomVector(random, {15, 3, 15}), target = randomVector(random, {5, 0, 5});
        for (int frame = 0; frame < 30; ++frame) {
            const glm::dvec3 step(0.01 * frame, 0, 0);
            const View view = viewAt(eye + step, target + step, {.width = 320, .height = 180});
            query.visible(now, view);
            const Result<FrameRecording> recording = recordFrame(query);
            ASSERT_TRUE(recording.ok());
            certificates += recording->certificates.size();
            std::vector<uint8_t> has(recording->objects.size(), 0);
            Array<Visible> named;
            for (const FrameRecording::Certificate& certificate : recording->certificates) {
                has[certificate.hidden] = 1;
                const uint64_t key = recording->objects[certificate.hidden].key;
                ASSERT_TRUE(query.certificateOf(made.ids[key], named));
                ASSERT_EQ(named.size(), certificate.count);
                for (const uint32_t hider : recording->namedBy(certificate))
                    EXPECT_TRUE(std::any_of(named.begin(), named.end(), [&](const Visible& one) {
                        return one.key == recording->objects[hider].key;
                    }));
            }
            for (size_t i = 0; i < has.size(); ++i)
                EXPECT_EQ(has[i] == 1, recording->reasons[i] != 0 &&
                                           query.certificateOf(made.ids[recording->objects[i].key], named));
            if (frame == 29) expectSame(*recording, *parseRecording(recordingBytes(*recording), "frame.rec"));
        }
    }
    EXPECT_GT(certificates, 100u);
}

TEST(FrameRecording, KeepsEachSettingAndTheWholeView) {
    MadeWorld made = someWorld(5, 50, 2);
    QuerySettings settings;
    forEachSetting([&](const auto& row) {
        auto& value = settings.*row.member;
        using Value = std::remove_reference_t<decltype(value)>;
        value = static_cast<Value>(std::min(row.most, static_cast<double>(value) + 1));
    });
    settings.max_distance = std::numeric_limits<double>::infinity();
    View view = someView(5);
    view.layers = 3;
    view.sections.add({0, 1, 0, 4});
    view.window.add({1, 0, 0, 30});
    view.through.points[0] = {1, 2, 3};
    view.through.points[1] = {2, 2, 3};
    view.through.points[2] = {2, 3, 3};
    view.through.count = 3;
    const Result<FrameRecording> recording = recordFrame(made.world.commit(), view, settings);
    ASSERT_TRUE(recording.ok());
    EXPECT_TRUE(sameSettings(recording->settings, settings));
    const Result<FrameRecording> read = parseRecording(recordingBytes(*recording), "frame.rec");
    ASSERT_TRUE(read.ok()) << read.error().message;
    expectSame(*recording, *read);
    EXPECT_EQ(read->view.sections.count, 1u);
    EXPECT_EQ(read->view.sections.planes[0], glm::dvec4(0, 1, 0, 4));
    EXPECT_EQ(read->view.window.planes[0], glm::dvec4(1, 0, 0, 30));
    EXPECT_EQ(read->view.through.count, 3u);
    EXPECT_EQ(read->view.through.points[2], glm::dvec3(2, 3, 3));
    EXPECT_TRUE(FrameReplay(*read).run().same());

    // What is beyond its limits counts as they do.
    QuerySettings wild;
    wild.occlusion_size = 0;
    wild.contribution = std::numeric_limits<double>::quiet_NaN();
    wild.lod_error = -1;
    wild.bins = 1000;
    const Result<FrameRecording> tame = recordFrame(made.world.commit(), someView(5), wild);
    ASSERT_TRUE(tame.ok());
    EXPECT_TRUE(readAndReplay(recordingBytes(*tame)));
}

TEST(FrameRecording, OfNothingIsOne) {
    World world;
    const Result<FrameRecording> recording = recordFrame(world.commit(), View());
    ASSERT_TRUE(recording.ok());
    EXPECT_TRUE(readAndReplay(recordingBytes(*recording)));
    EXPECT_TRUE(readAndReplay(recordingBytes(*recordFrame(Snapshot(), View()))));
    EXPECT_TRUE(readAndReplay(recordingBytes(*recordFrame(Query()))));  // that was never asked
    View view;
    view.projection[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(recordFrame(world.commit(), view).ok());
}

TEST(FrameRecording, HoldsObjectsOfAnyNumbers) {
    World world;
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double odd : {nan, inf, -inf, 1e300, 0.0}) {
        ObjectDef def;
        def.bounds = {glm::dvec3(odd), glm::dvec3(1)};
        world.add(def);
        def.bounds = {glm::dvec3(0), glm::dvec3(1)};
        def.transform[1][1] = odd;
        def.limits.factor = odd;
        def.occluder = world.addOccluder(Occluder());
        world.add(def);
    }
    const Result<FrameRecording> recording = recordFrame(world.commit(), View());
    ASSERT_TRUE(recording.ok());
    EXPECT_GT(recording->objects.size(), 3u);
    EXPECT_TRUE(readAndReplay(recordingBytes(*recording)));
}

TEST(FrameRecording, SaysInOneLineWhatIsWrongAndWhere) {
    FrameRecording recording = recordOf(3);
    uint32_t hidden = 0;
    while (recording.reasons[hidden] == 0) ++hidden;
    recording.certificates.assign(1, {hidden, 0, 2});
    recording.named = {0, 1};
    const Array<char> good = recordingBytes(recording);
    ASSERT_TRUE(parseRecording(good, "a/frame.rec").ok());
    const auto expect = [&](const std::string& what, size_t at, auto change, bool sealed = true) {
        Array<char> bytes = good;
        change(bytes);
        if (sealed) sealRecording(bytes);
        const Result<FrameRecording> read = parseRecording(bytes, "a/frame.rec");
        ASSERT_FALSE(read.ok()) << what;
        EXPECT_EQ(read.error().message, "a/frame.rec: " + what + " at byte " + std::to_string(at));
    };
    const auto in = [&](Section section, size_t offset) { return placeOf(good, section).at + offset; };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expect("not a recording of a frame", 0, [](auto& b) { b[3] = 'X'; });
    expect("not a recording of a frame", 0, [](auto& b) { b.clear(); });
    expect("the file ends within its head", 20, [](auto& b) { b.resize(20); });
    expect("the file ends within its head", 100, [](auto& b) { b.resize(100); });
    expect("a recording of version 9, where version 4 is read", 16, [](auto& b) { b[16] = 9; });
    expect("a recording of version 3, where version 4 is read", 16, [](auto& b) { b[16] = 3; });
    expect("bytes after the last section", good.size(), [](auto& b) { b.push_back(0); });
    expect(
        "the content does not have the hash that it says", 24, [&](auto& b) { b[in(kVertices, 5)] ^= 1; }, false);
    expect("a section that is longer than the file", kHashedAt + 8 * kEdges,
           [](auto& b) { overwrite(b, kHashedAt + 8 * kEdges, ~uint64_t{0} / 8 * 8); });
    expect("a section that ends within a record", kHashedAt + 8 * kView,
           [](auto& b) { overwrite(b, kHashedAt, uint64_t{3}); });
    expect("a view that cannot be used", in(kView, 0), [&](auto& b) { overwrite(b, in(kView, 8), HUGE_VAL); });
    expect("a view that cannot be used", in(kView, 0), [&](auto& b) { overwrite(b, in(kView, 256), 0u); });
    expect("flags that are not known", in(kView, kRecordBytes[kView] - 4),
           [&](auto& b) { overwrite(b, in(kView, kRecordBytes[kView] - 4), 2u); });
    expect("a setting that is not known", in(kSettings, 40), [&](auto& b) { b[in(kSettings, 41)] ^= 1; });
    expect("a setting beyond its limits", in(kSettings, 40), [&](auto& b) { overwrite(b, in(kSettings, 72), 1.5); });
    expect("a setting beyond its limits", in(kSettings, 0), [&](auto& b) { overwrite(b, in(kSettings, 32), -1.0); });
    expect("more inner occluders than the file has", in(kForms, 0), [&](auto& b) { overwrite(b, in(kForms, 0), 9u); });
    expect("a number that is not finite", in(kVertices, 16), [&](auto& b) { overwrite(b, in(kVertices, 16), nan); });
    expect("bounds that are empty", in(kOccluders, 0), [&](auto& b) { overwrite(b, in(kOccluders, 0), 1e9f); });
    expect("an occluder that has more than the file", in(kOccluders, 28),
           [&](auto& b) { overwrite(b, in(kOccluders, 28), ~0u); });
    expect("an occluder without clusters that has parts", in(kOccluders, 24),
           [&](auto& b) { overwrite(b, in(kOccluders, 24), 0u); });
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
    expect("more levels of detail than there are", in(kChains, 0), [&](auto& b) { overwrite(b, in(kChains, 0), 3u); });
    expect("an object with what there is not", in(kObjects, 220),
           [&](auto& b) { overwrite(b, in(kObjects, 220 + 188), 77u); });
    expect("flags that are not known", in(kObjects, 220), [&](auto& b) { overwrite(b, in(kObjects, 220 + 216), 4u); });
    expect("a stage that there is not", in(kAgain, 2), [&](auto& b) { b[in(kAgain, 2)] = 77; });
    expect("a certificate of no object that was culled", in(kCertificates, 0),
           [&](auto& b) { overwrite(b, in(kCertificates, 0), ~0u); });
    expect("a certificate that names more than there are", in(kCertificates, 0),
           [&](auto& b) { overwrite(b, in(kCertificates, 4), 3u); });
    expect("more names than the certificates have", in(kNamed, 4),
           [&](auto& b) { overwrite(b, in(kCertificates, 4), 1u); });
    expect("a certificate that names what there is not, or twice", in(kNamed, 4),
           [&](auto& b) { overwrite(b, in(kNamed, 4), 0u); });
}

TEST(FrameRecording, SurvivesAnyBytes) {
    MadeWorld made = someWorld(2, 30, 4, 6);
    Array<char> good = recordingBytes(*recordFrame(made.world.commit(), someView(2), {.occlusion_size = 64}));
    for (size_t size = 0; size < good.size(); size += 1 + size / 16) {
        Array<char> bytes(good.begin(), good.begin() + static_cast<ptrdiff_t>(size));
        sealRecording(bytes);
        ASSERT_FALSE(readAndReplay(bytes));
    }
    Random random(4);
    uint64_t replayed = 0;
    for (uint64_t i = 0; i < rounds(1500, 300); ++i) {
        Array<char> bytes = good;
        for (uint64_t k = 0; k <= random.below(3); ++k) {
            const Place place = placeOf(good, static_cast<Section>(random.below(kSectionCount)));
            const size_t at = place.at + random.below(std::max<size_t>(place.size, 1));
            if (at < bytes.size()) bytes[at] ^= static_cast<char>(1u << random.below(8));
        }
        sealRecording(bytes);
        const Result<FrameRecording> read = parseRecording(bytes, "frame.rec");
        if (read && read->settings.occlusion_size > 1024) continue;  // sound, and slow
        replayed += readAndReplay(bytes);
    }
    EXPECT_GT(replayed, rounds(300, 60));
}

TEST(FrameRecording, TakesNoMoreMemoryThanAFewTimesItsFile) {
    for (const uint64_t seed : {1, 2}) {
        const Array<char> bytes = recordingBytes(recordOf(seed));
        CountingMemory counted;
        const Result<FrameRecording> read = parseRecording(bytes, "frame.rec", &counted);
        ASSERT_TRUE(read.ok());
        EXPECT_LT(counted.most, 4 * bytes.size());
    }
    // Occluders and chains of nothing but promises.
    FrameRecording empty;
    for (int i = 0; i < 1000; ++i) {
        Occluder& occluder = empty.forms.emplace_back(defaultMemory()).occluder;
        occluder.bounds.grow({0, 0, 0});
        occluder.clusters.resize(1);
    }
    const Array<char> bytes = recordingBytes(empty);
    CountingMemory counted;
    EXPECT_FALSE(parseRecording(bytes, "frame.rec", &counted).ok());
    EXPECT_LT(counted.most, 10 * bytes.size());
    empty.forms.clear();
    empty.chains.resize(1000);
    EXPECT_FALSE(parseRecording(recordingBytes(empty), "frame.rec").ok());
}

TEST(FrameRecording, CorpusOfTheFuzzerIsReadAndReplayed) {
    int recordings = 0, others = 0;
    forCorpus("frame_recording", 6, [&](const std::string&, const std::string& read) {
        Array<char> bytes(read.begin(), read.end());
        if (readAndReplay(bytes)) ++recordings;
        else ++others;
        sealRecording(bytes);
        readAndReplay(bytes);
    });
    EXPECT_GE(recordings, 3);
    EXPECT_GE(others, 3);
}

}  // namespace
}  // namespace sightline::test
