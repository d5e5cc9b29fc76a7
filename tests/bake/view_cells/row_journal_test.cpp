// The journal of view cells: a bake goes on from it to the same bytes, and believes nothing that is damaged or not its own.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/row_journal.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/bake/bake.h"
#include "sightline/base/bytes.h"
#include "sightline/base/random.h"
#include "sightline/base/thread_pool.h"
#include "tests/bake/marked/random_rooms.h"
#include "tests/bake/state_check.h"
#include "tests/support/corpus.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

std::string textOf(std::span<const char> bytes) { return {bytes.begin(), bytes.end()}; }

std::optional<RowJournal> journalOf(std::span<const char> bytes) {
    Result<RowJournal> journal = RowJournal::takenOff(bytes, "x.state");
    if (!journal) return std::nullopt;
    return std::move(*journal);
}

TEST(RowJournal, ComesBackFromItsBytesAndLeavesWhatIsBehind) {
    Random random(1);
    RowJournal journal;
    EXPECT_TRUE(journal.bytes().empty());
    std::vector<std::pair<uint64_t, std::string>> answers;
    for (size_t i = 0; i < 100; ++i) {
        std::string answer(random.below(40), 'a');
        for (char& byte : answer) byte = static_cast<char>(random.below(256));
        answers.emplace_back(random.next(), answer);
        journal.add(answers.back().first, answer);
    }
    const std::string bytes = journal.bytes() + "rest";
    std::span<const char> left = bytes;
    const Result<RowJournal> back = RowJournal::takenOff(left, "x.state");
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(textOf(left), "rest");
    EXPECT_EQ(back->size(), answers.size());
    for (const auto& [question, answer] : answers) {
        ASSERT_TRUE(back->find(question).has_value());
        EXPECT_EQ(textOf(*back->find(question)), answer);
    }
    EXPECT_FALSE(back->find(7).has_value());
    EXPECT_EQ(back->bytes() + "rest", bytes);
}

TEST(RowJournal, RefusesDamagedBytes) {
    RowJournal journal;
    for (uint64_t question = 1; question < 20; ++question) journal.add(question * question, std::string(question, 'x'));
    const std::string bytes = journal.bytes();
    for (size_t size = 8; size < bytes.size(); ++size) EXPECT_FALSE(journalOf({bytes.data(), size})) << size;
    for (size_t at = 8; at < bytes.size(); ++at) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        EXPECT_FALSE(journalOf(changed)) << at;
    }
}

const Scene& rooms() {
    static const Scene scene = [] {
        Random random(6);
        return randomRooms(random, 1).scene;
    }();
    return scene;
}

/// The bytes of the file, or "" if `stop` said so.
std::string baked(const Scene& scene, RowJournal* journal, Jobs* jobs, std::function<bool()> stop = {},
                  uint32_t most_cells = 96) {
    BakeCells cells = openToBake(scene, "rooms");
    ViewCellSettings views;
    views.most_cells = most_cells;
    views.least_hidden = 0;
    views.jobs = jobs;
    views.journal = journal;
    views.stop = stop;
    addViewCells(cells, scene, views);
    if (stop && stop()) return {};
    BakeSettings settings;
    settings.jobs = jobs;
    settings.journal = journal;
    settings.stop = stop;
    const Result<Baked> out = bake::bake(std::move(cells), scene, settings);
    EXPECT_TRUE(out.ok()) << out.error().message;
    return out->interrupted ? std::string() : textOf(out->file.packed);
}

TEST(RowJournal, ABakeGoesOnFromItToTheSameBytes) {
    const std::string whole = baked(rooms(), nullptr, nullptr);
    ASSERT_FALSE(whole.empty());
    ThreadPool threads(3);
    // Each process does a little more than the one before, with other numbers of threads.
    std::string left;
    uint64_t processes = 0, ended = 0;
    for (uint64_t patience = 0; ended == 0 && patience < 1000; patience += 3, ++processes) {
        std::optional<RowJournal> journal = journalOf(left);
        ASSERT_TRUE(journal.has_value());
        const size_t before = journal->size();
        journal->writeTo(
            [&](const std::string& bytes) {
                left = bytes;
                return success();
            },
            1e9);
        uint64_t asked = 0;
        const std::string bytes =
            baked(rooms(), &*journal, processes % 2 ? &threads : nullptr, [&] { return asked++ >= patience; });
        EXPECT_GE(journal->size(), before);
        if (bytes.empty()) continue;
        EXPECT_EQ(bytes, whole);
        ++ended;
    }
    EXPECT_EQ(ended, 1u);
    EXPECT_GT(processes, 3u);
    // A journal of all answers leaves nothing to find.
    std::optional<RowJournal> journal = journalOf(left);
    ASSERT_TRUE(journal.has_value());
    const size_t all = journal->size();
    EXPECT_EQ(baked(rooms(), &*journal, nullptr), whole);
    EXPECT_GE(journal->size(), all);
    const size_t complete = journal->size();
    EXPECT_EQ(baked(rooms(), &*journal, nullptr), whole);
    EXPECT_EQ(journal->size(), complete);
}

TEST(RowJournal, AnswersNothingOfAnotherScene) {
    RowJournal journal;
    ASSERT_FALSE(baked(rooms(), &journal, nullptr).empty());
    const size_t before = journal.size();
    Scene moved = rooms();
    moved.objects[moved.objects.size() / 2].transform[3].x += 1e-3;
    EXPECT_EQ(baked(moved, &journal, nullptr), baked(moved, nullptr, nullptr));
    EXPECT_EQ(journal.size(), 2 * before) << "all was found anew";
}

TEST(RowJournal, ServesABakeOfMoreCells) {
    RowJournal journal;
    ASSERT_FALSE(baked(rooms(), &journal, nullptr, {}, 48).empty());
    EXPECT_EQ(baked(rooms(), &journal, nullptr), baked(rooms(), nullptr, nullptr));
}

TEST(RowJournal, DamagedAnswersEndNoBake) {
    RowJournal journal;
    ASSERT_FALSE(baked(rooms(), &journal, nullptr).empty());
    Random random(5);
    for (int round = 0; round < 16; ++round) {
        // Each answer is cut, or has something in its midst. Bytes have a hash: this is for those that pass it.
        RowJournal odd;
        for (auto [question, answer] : answersOf(journal)) {
            const size_t place = random.below(answer.size() + 1);
            const auto value = static_cast<char>(random.below(256));
            if (random.below(2)) answer.resize(place);
            else answer.insert(answer.begin() + static_cast<std::ptrdiff_t>(place), 1 + random.below(8), value);
            odd.add(question, answer);
        }
        EXPECT_EQ(odd.size(), journal.size());
        EXPECT_FALSE(baked(rooms(), &odd, nullptr).empty());
    }
}

TEST(BakeStates, OfTheCorpusAreReadOrRefused) {
    size_t good = 0;
    forCorpus("bake_state", 5, [&](const std::string& name, const std::string& bytes) {
        SCOPED_TRACE(name);
        EXPECT_EQ(bakeStateFault(bytes), "");
        const std::string sealed = sealedState(bytes);
        EXPECT_EQ(bakeStateFault(sealed), "");
        good += sealed == bytes;
    });
    EXPECT_GE(good, 3u) << "as they were written, but those that are to be damaged";
}

TEST(BakeStates, ThatAreSpoiledAreReadOrRefused) {
    RowJournal journal;
    smallBake().rows(journal);
    const std::string whole = journal.bytes() + smallBake().cellState(0);
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        std::string spoiled = whole;
        for (uint64_t k = 1 + random.below(8); k > 0; --k)
            spoiled[random.below(spoiled.size())] ^= static_cast<char>(1 + random.below(255));
        EXPECT_EQ(bakeStateFault(sealedState(spoiled)), "") << i;
    }
}

TEST(RowJournal, ABakeEndsWithTheErrorOfItsWriting) {
    RowJournal journal;
    journal.writeTo([](const std::string&) -> Status { return Error{Error::Kind::kOutput, "disk full"}; }, 0);
    BakeCells cells = openToBake(rooms(), "rooms");
    ViewCellSettings views;
    views.most_cells = 64;
    views.least_hidden = 0;
    addViewCells(cells, rooms(), views);
    BakeSettings settings;
    settings.journal = &journal;
    const Result<Baked> out = bake::bake(std::move(cells), rooms(), settings);
    ASSERT_FALSE(out.ok());
    EXPECT_EQ(out.error().message, "disk full");
}

}  // namespace
}  // namespace sightline
