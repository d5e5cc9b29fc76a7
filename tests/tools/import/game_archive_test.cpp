// Archives: what was put in comes out, the map in them is found by its name, and nothing else is believed.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "archive_files.h"
#include "map_check.h"
#include "mutated.h"
#include "map_files.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/quake/map_source.h"
#include "tests/support/corpus.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

std::vector<MadeEntry> randomEntries(Random& random) {
    std::vector<MadeEntry> out;
    for (uint64_t left = random.below(5); left-- > 0;) {
        MadeEntry& entry = out.emplace_back();
        entry.name = "maps/" + std::to_string(left) + ".bsp";
        entry.deflated = random.below(2);
        const uint64_t letters = 1 + random.below(256);
        for (uint64_t size = random.below(5000); size-- > 0;) entry.bytes += static_cast<char>(random.below(letters));
    }
    return out;
}

TEST(GameArchive, WhatWasPutInComesOut) {
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        const std::vector<MadeEntry> made = randomEntries(random);
        const std::string before = random.below(2) ? "" : std::string(random.below(300), 'x');
        for (const std::string& bytes : {pakBytes(made), pk3Bytes(made, before)}) {
            const Result<std::vector<ArchiveEntry>> list = listArchive(bytesOf(bytes), "a");
            ASSERT_TRUE(list.ok()) << seed << ": " << list.error().message;
            ASSERT_EQ(list->size(), made.size());
            for (size_t i = 0; i < made.size(); ++i) {
                EXPECT_EQ((*list)[i].name, made[i].name);
                const Result<std::vector<unsigned char>> out = unpackEntry(bytesOf(bytes), "a", (*list)[i]);
                ASSERT_TRUE(out.ok()) << out.error().message;
                EXPECT_EQ(std::string(out->begin(), out->end()), made[i].bytes) << seed;
            }
        }
    }
}

TEST(GameArchive, SaysInOneLineWhatIsWrong) {
    const auto listLine = [](const std::string& bytes) {
        const Result<std::vector<ArchiveEntry>> list = listArchive(bytesOf(bytes), "a");
        return list.ok() ? "" : list.error().message;
    };
    const auto unpackLine = [](const std::string& bytes) {
        const Result<std::vector<ArchiveEntry>> list = listArchive(bytesOf(bytes), "a");
        if (!list.ok()) return list.error().message;
        const Result<std::vector<unsigned char>> out = unpackEntry(bytesOf(bytes), "a", list->front());
        return out.ok() ? "" : out.error().message;
    };
    const std::string pak = pakBytes({{"x.bsp", "12345678"}});
    const std::string zip = pk3Bytes({{"x.bsp", std::string(500, 'x')}});
    const size_t list = zip.find("PK\1\2"), last = zip.size() - 27;
    EXPECT_EQ(listLine("hello"), "a: is neither a .pak nor a .pk3");
    EXPECT_EQ(listLine(pak.substr(0, 50)), "a: truncated: its list ends beyond the file");
    EXPECT_EQ(listLine(patched(pak, 8, 63)), "a: its list takes 63 bytes, which is no multiple of 64");
    EXPECT_EQ(listLine(patched(pak, pak.size() - 4, 99)), "a: truncated: x.bsp ends beyond the file");
    EXPECT_EQ(listLine(zip.substr(0, last)), "a: truncated: it lacks the end of a zip archive");
    EXPECT_EQ(listLine(patched(zip, last + 4, uint16_t(1))), "a: is one of several volumes, which are not read");
    EXPECT_EQ(listLine(patched(zip, last + 16, 0xffffffffu)), "a: is zip64, which is not read");
    EXPECT_EQ(listLine(patched(zip, list, 'x')).substr(0, 40), "a: its list of files is spoiled at byte ");
    EXPECT_EQ(unpackLine(patched(zip, list + 8, uint16_t(1))), "a: x.bsp is encrypted");
    EXPECT_EQ(unpackLine(patched(zip, list + 10, uint16_t(12))), "a: x.bsp is packed by method 12, which is not read");
    EXPECT_EQ(unpackLine(patched(zip, list + 10, uint16_t(0))).substr(0, 20), "a: x.bsp is spoiled:");
    EXPECT_EQ(unpackLine(patched(zip, list + 16, 7)), "a: x.bsp is spoiled: its check sum is another one");
    EXPECT_EQ(unpackLine(patched(zip, list + 24, 501)), "a: x.bsp is spoiled: 500 of 501 bytes could be unpacked");
    EXPECT_EQ(unpackLine(patched(zip, list + 24, 1 << 29)),
              "a: x.bsp is spoiled: it is too large for what it is packed to");
    EXPECT_EQ(unpackLine(patched(zip, list + 24, 0x7fffffff)), "a: x.bsp is larger than 1024 MiB");
    EXPECT_EQ(unpackLine(patched(zip, list + 20, 1 << 20)), "a: x.bsp is truncated");
    EXPECT_EQ(unpackLine(patched(zip, list + 42, 3)), "a: x.bsp is not where the list says");
}

class MapSource : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("map_source_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
};

TEST_F(MapSource, FindsMapsInFilesAndArchives) {
    const std::string a = mapBytes(QuakeFormat::kQuake, {}), b = mapBytes(QuakeFormat::kQuake3, {});
    const std::string plain = write("a.bsp", a);
    const std::string one = write("one.PAK", pakBytes({{"progs.dat", "x"}, {"maps/b_box.bsp", b}, {"maps/a.bsp", a}}));
    const std::string two = write("two.pk3", pk3Bytes({{"maps/a.bsp", a}, {"maps/Sub/B.bsp", b}}));
    const auto expectMap = [](const std::string& name, const std::string& told, const std::string& bytes) {
        const Result<MapBytes> map = readMapBytes(name);
        ASSERT_TRUE(map.ok()) << map.error().message;
        EXPECT_EQ(map->name, told);
        EXPECT_EQ(std::string(map->bytes.begin(), map->bytes.end()), bytes);
    };
    expectMap(plain, plain, a);
    expectMap(one, one + ":maps/a.bsp", a);
    expectMap(one + ":maps/b_box.bsp", one + ":maps/b_box.bsp", b);
    expectMap(two + ":maps/a.bsp", two + ":maps/a.bsp", a);
    expectMap(two + ":MAPS/sub/b.BSP", two + ":maps/Sub/B.bsp", b);
    EXPECT_EQ(readQuakeMap(two + ":maps/sub/b.bsp")->format, QuakeFormat::kQuake3);
    const std::string odd = write("x.pk3:y.bsp", a);  // a file that is really called so
    expectMap(odd, odd, a);

    const auto expectLine = [](const std::string& name, const std::string& line) {
        const Result<QuakeMapFile> map = readQuakeMap(name);
        ASSERT_FALSE(map.ok()) << name;
        EXPECT_EQ(map.error().message, line);
    };
    expectLine(two, two + ": name one of its maps, as in " + two + ":maps/a.bsp: it has maps/a.bsp, maps/Sub/B.bsp");
    expectLine(two + ":maps/c.bsp", two + ": has no maps/c.bsp: it has maps/a.bsp, maps/Sub/B.bsp");
    const std::string none = write("none.pk3", pk3Bytes({{"readme", "x"}}));
    expectLine(none, none + ": has no map");
    expectLine(none + ":readme", none + ":readme: is no compiled map of Quake, Half-Life, Quake 2 or Quake 3");
    expectLine("/nowhere.pk3:a.bsp", "/nowhere.pk3: no such file");
}

TEST(GameArchiveMutation, SurvivesTwentyThousandMutations) {
    Random made(7);
    std::vector<std::string> samples;
    for (int i = 0; i < 6; ++i) {
        const std::vector<MadeEntry> entries = randomEntries(made);
        samples.push_back(i % 2 ? pakBytes(entries) : pk3Bytes(entries));
    }
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        ASSERT_EQ(archiveFault(mutated(samples[random.below(samples.size())], random)), "") << "seed " << seed;
    }
}

TEST(GameArchiveMutation, CorpusOfTheFuzzerIsSound) {
    forCorpus("archive", 4,
              [](const std::string& name, const std::string& bytes) { EXPECT_EQ(archiveFault(bytes), "") << name; });
}

}  // namespace
}  // namespace sightline
