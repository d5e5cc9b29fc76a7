// A visibility file answers as what it was written from, or is refused with a reason.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/visibility_file.h"

#include <gtest/gtest.h>

#include "tests/support/corpus.h"
#include "tests/visfile/file_check.h"
#include "tests/visfile/made_file.h"
#include "tests/visfile/seal.h"

namespace sightline::test {
namespace {

constexpr VisibilityForm kFileForms[] = {VisibilityForm::kInPlace, VisibilityForm::kPacked};

void expectSame(const VisibilityFile& file, const MadeFile& made) {
    ASSERT_EQ(file.rows().cells(), made.visible.rows());
    for (uint32_t a = 0; a < file.rows().cells(); ++a)
        for (uint32_t b = 0; b < file.rows().cells(); ++b) ASSERT_EQ(file.rows().sees(a, b), made.visible.at(a, b));
    ASSERT_EQ(file.leaves(), made.cell_of_leaf.size());
    for (uint32_t i = 0; i < file.leaves(); ++i) ASSERT_EQ(file.cellOfLeaf(i), made.cell_of_leaf[i]);
}

bool opensAndAnswers(const Array<char>& bytes) {
    bool opened = false;
    EXPECT_EQ(faultOfReading(bytes, opened), "");
    return opened;
}

TEST(VisibilityFile, AnswersAsWhatItWasWrittenFrom) {
    for (const size_t cells : {1, 8, 70, 300}) {
        const MadeFile made(cells, cells);
        for (const VisibilityForm form : kFileForms) {
            const Array<char> bytes = made.bytes(form);
            EXPECT_EQ(made.bytes(form), bytes);
            const Result<VisibilityFile> file = VisibilityFile::open(bytes, "f");
            ASSERT_TRUE(file.ok()) << file.error().message;
            expectSame(*file, made);
            EXPECT_EQ(file->mapName(), "e1m5.bsp");
            EXPECT_EQ(file->mapHash(), 77u);
        }
        EXPECT_EQ(VisibilityFile::open(made.bytes(kFileForms[0]), "f")->residentBytes(),
                  VisibilityFile::open(made.bytes(kFileForms[1]), "f")->residentBytes());
    }
}

TEST(VisibilityFile, PacksToTheSameBytesFromEitherForm) {
    for (const size_t cells : {1, 70, 300}) {
        const MadeFile made(cells, cells);
        const Array<char> packed = made.bytes(VisibilityForm::kPacked);
        for (const VisibilityForm form : kFileForms) {
            const Array<char> bytes = made.bytes(form);
            EXPECT_EQ(packedFile(*VisibilityFile::open(bytes, "f")), packed);
        }
    }
}

TEST(VisibilityFile, AnswersWhereverItIsMoved) {
    const MadeFile made(1);
    for (const VisibilityForm form : kFileForms) {
        const Array<char> bytes = made.bytes(form);
        Result<VisibilityFile> opened = VisibilityFile::open(bytes, "f");
        ASSERT_TRUE(opened.ok());
        std::vector<VisibilityFile> files;
        files.push_back(std::move(*opened));
        for (int i = 0; i < 9; ++i) files.push_back(std::move(*VisibilityFile::open(bytes, "f")));
        for (const VisibilityFile& file : files) expectSame(file, made);
    }
}

TEST(VisibilityFile, OfNothingIsOne) {
    const BitMatrix none;
    for (const VisibilityForm form : kFileForms) {
        const Array<char> bytes = *visibilityFile({none, {}, ""}, form);
        const Result<VisibilityFile> file = VisibilityFile::open(bytes, "f");
        ASSERT_TRUE(file.ok()) << file.error().message;
        EXPECT_EQ(file->rows().cells(), 0u);
        EXPECT_EQ(file->leaves(), 0u);
    }
}

TEST(VisibilityFile, IsNotWrittenOfWhatItCannotHold) {
    const BitMatrix five = onlyThemselves(5);
    const std::vector<uint32_t> leaves = {4, 5};
    EXPECT_EQ(visibilityFile({five, leaves, ""}, kFileForms[0]).error().message, "a leaf of a cell that there is not");
    EXPECT_EQ(visibilityFile({BitMatrix(5, 5), {}, ""}, kFileForms[0]).error().kind, Error::Kind::kUsage);
}

TEST(VisibilityFile, RefusesEveryChangedByte) {
    for (const VisibilityForm form : kFileForms) {
        const Array<char> good = MadeFile(2).bytes(form);
        for (size_t i = 0; i < good.size(); ++i) {
            Array<char> bytes = good;
            bytes[i] ^= static_cast<char>(1u << i % 8);
            ASSERT_FALSE(VisibilityFile::open(bytes, "f").ok()) << i;
        }
        for (size_t size = 0; size < good.size(); ++size)
            ASSERT_FALSE(VisibilityFile::open(std::span(good).first(size), "f").ok()) << size;
    }
}

TEST(VisibilityFile, ThatWasSealedAgainHasAnswersOrIsRefused) {
    Random random(9);
    for (const VisibilityForm form : kFileForms) {
        const Array<char> good = MadeFile(3, 24).bytes(form);
        int opened = 0;
        for (int i = 0; i < 50000; ++i) {
            Array<char> bytes = good;
            for (uint64_t k = 0; k <= random.below(3); ++k)
                bytes[random.below(bytes.size())] ^= static_cast<char>(1u << random.below(8));
            seal(bytes);
            opened += opensAndAnswers(bytes);
        }
        EXPECT_GT(opened, 100);
    }
}

TEST(VisibilityFile, SaysInOneLineWhatIsMissing) {
    using namespace visibility_file;
    const Array<char> good = MadeFile(4).bytes(VisibilityForm::kInPlace);
    const SectionFile sections = *SectionFile::open(good, "f");
    const auto without = [&](uint32_t left_out, uint32_t twice = 0) {
        SectionWriter writer;
        for (const uint32_t tag : {kMap, kRows, kLeaves}) {
            const std::span<const char> section = sections.find(tag);
            if (tag != left_out) writer.add(tag, Array<char>(section.begin(), section.end()));
            if (tag == twice) writer.add(kPackedRows, Array<char>(section.begin(), section.end()));
        }
        const Array<char> bytes = writer.file();
        const Result<VisibilityFile> file = VisibilityFile::open(bytes, "f");
        return file.ok() ? std::string() : file.error().message.substr(0, file.error().message.find(" at byte"));
    };
    EXPECT_EQ(without(0), "");
    EXPECT_EQ(without(kMap), "f: no word on the map");
    EXPECT_EQ(without(kRows), "f: no rows");
    EXPECT_EQ(without(kLeaves), "f: not as many leaves as it says");
    EXPECT_EQ(without(0, kRows), "f: a section that is there twice, packed and not");
}

TEST(VisibilityFile, HasNoLeafOfACellThatThereIsNot) {
    const MadeFile made(6);
    Array<char> bytes = made.bytes(VisibilityForm::kInPlace);
    const SectionFile sections = *SectionFile::open(bytes, "f");
    const uint64_t leaves = sections.placeOf(sections.find(visibility_file::kLeaves));
    bytes[leaves + 2] = 70;
    seal(bytes);
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "f");
    ASSERT_FALSE(file.ok());
    EXPECT_EQ(file.error().message, "f: a leaf of a cell that there is not at byte " + std::to_string(leaves));
}

TEST(VisibilityFile, PassesOverSectionsThatItDoesNotKnow) {
    using namespace visibility_file;
    const MadeFile made(5);
    const Array<char> good = made.bytes(VisibilityForm::kPacked);
    const SectionFile sections = *SectionFile::open(good, "f");
    SectionWriter writer;
    writer.add(section_file::tagOf("late"), Array<char>(13, 'x'));
    for (const uint32_t tag : {kPackedLeaves, kMap, kPackedRows}) {
        const std::span<const char> section = sections.find(tag);
        writer.add(tag, Array<char>(section.begin(), section.end()));
    }
    const Array<char> bytes = writer.file();
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "f");
    ASSERT_TRUE(file.ok()) << file.error().message;
    expectSame(*file, made);
}

TEST(VisibilityFile, ReplaysTheCorpusOfTheFuzzer) {
    int opened = 0, refused = 0;
    forCorpus("visibility_file", 8, [&](const std::string& name, const std::string& read) {
        SCOPED_TRACE(name);
        Array<char> bytes(read.begin(), read.end());
        ++(opensAndAnswers(bytes) ? opened : refused);
        seal(bytes);
        opensAndAnswers(bytes);
    });
    EXPECT_GE(opened, 4);
    EXPECT_GE(refused, 4);
}

}  // namespace
}  // namespace sightline::test
