// Sections are found where they were put, and no damage goes unseen.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/section_file.h"

#include <gtest/gtest.h>

#include <string>

#include "sightline/base/random.h"
#include "tests/visfile/seal.h"

namespace sightline::test {
namespace {

using namespace section_file;

Array<char> arrayOf(std::string_view text) { return Array<char>(text.begin(), text.end()); }

Array<char> threeSections() {
    SectionWriter writer;
    writer.add(tagOf("one "), arrayOf("first"));
    writer.add(tagOf("none"), arrayOf(""));
    writer.add(tagOf("two "), arrayOf("the second, longer than eight"));
    return writer.file();
}

std::string textOf(std::span<const char> bytes) { return {bytes.begin(), bytes.end()}; }

TEST(SectionFile, FindsSectionsByTheirTags) {
    const Array<char> bytes = threeSections();
    EXPECT_EQ(threeSections(), bytes);
    const Result<SectionFile> file = SectionFile::open(bytes, "f");
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(textOf(file->find(tagOf("one "))), "first");
    EXPECT_EQ(textOf(file->find(tagOf("two "))), "the second, longer than eight");
    EXPECT_TRUE(file->find(tagOf("none")).empty());
    EXPECT_TRUE(file->find(tagOf("????")).empty());
    for (const char* tag : {"one ", "two "}) {
        const std::span<const char> section = file->find(tag[0] == 'o' ? tagOf("one ") : tagOf("two "));
        EXPECT_EQ(file->placeOf(section) % 8, 0u);
        EXPECT_EQ(bytes.data() + file->placeOf(section), section.data());
    }
    const Array<char> empty = SectionWriter().file();
    EXPECT_TRUE(SectionFile::open(empty, "f").ok());
    EXPECT_TRUE(SectionFile().find(tagOf("one ")).empty());
}

TEST(SectionFile, RefusesEveryChangedByteAndEveryOtherLength) {
    const Array<char> good = threeSections();
    for (size_t i = 0; i < good.size(); ++i)
        for (int bit = 0; bit < 8; ++bit) {
            Array<char> bytes = good;
            bytes[i] ^= static_cast<char>(1 << bit);
            ASSERT_FALSE(SectionFile::open(bytes, "f").ok()) << i << ", bit " << bit;
        }
    for (size_t size = 0; size < good.size(); ++size)
        ASSERT_FALSE(SectionFile::open(std::span(good).first(size), "f").ok()) << size;
    Array<char> longer = good;
    longer.push_back(0);
    EXPECT_FALSE(SectionFile::open(longer, "f").ok());
}

TEST(SectionFile, SaysInOneLineWhatIsWrongAndWhere) {
    const Array<char> good = threeSections();
    const auto expect = [&](const std::string& what, size_t at, auto change, bool sealed = true) {
        Array<char> bytes = good;
        change(bytes);
        if (sealed) seal(bytes);
        const Result<SectionFile> file = SectionFile::open(bytes, "a/map.see");
        ASSERT_FALSE(file.ok()) << what;
        EXPECT_EQ(file.error().message, "a/map.see: " + what + " at byte " + std::to_string(at));
    };
    expect("not a visibility file", 0, [](auto& b) { b[3] = 'X'; });
    expect("not a visibility file", 0, [](auto& b) { b.clear(); });
    expect("the file ends within its head", 20, [](auto& b) { b.resize(20); });
    expect("the file ends within its head", 50, [](auto& b) { b.resize(50); });
    expect("a visibility file of version 9, where version 1 is read", 16, [](auto& b) { b[16] = 9; });
    expect("more sections than there may be", 20, [](auto& b) { b[20] = 65; });
    expect("two sections of one kind", 56, [](auto& b) { std::copy_n(b.begin() + 32, 4, b.begin() + 56); });
    expect("a section with a mark that is not known", 36, [](auto& b) { b[36] = 1; });
    expect("a section that is not in its place", 40, [](auto& b) { b[40] += 8; });
    expect("a section that is not in its place", 88, [](auto& b) { b[95] = '\x80'; });
    expect("a section that is longer than the file", 96, [](auto& b) { b[103] = '\x80'; });
    expect("bytes after the last section", good.size(), [](auto& b) { b.push_back(0); });
    expect(
        "the content does not have the hash that it says", 24, [](auto& b) { b.back() ^= 1; }, false);
}

TEST(SectionFile, SurvivesAnyBytes) {
    Random random(1);
    const Array<char> good = threeSections();
    int opened = 0;
    for (int i = 0; i < 100000; ++i) {
        Array<char> bytes = good;
        for (uint64_t k = 0; k <= random.below(3); ++k)
            bytes[random.below(good.size())] ^= static_cast<char>(1u << random.below(8));
        if (random.below(4) == 0) bytes.resize(random.below(bytes.size()));
        seal(bytes);
        const Result<SectionFile> file = SectionFile::open(bytes, "f");
        if (!file.ok()) continue;
        ++opened;
        for (const uint32_t tag : {tagOf("one "), tagOf("none"), tagOf("two ")}) {
            const std::span<const char> section = file->find(tag);
            ASSERT_LE(file->placeOf(section) + section.size(), bytes.size());
        }
    }
    EXPECT_GT(opened, 10000);
}

}  // namespace
}  // namespace sightline::test
