// Answers by their questions, and their bytes: each with its question and its length, in the order of the questions.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/row_journal.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "sightline/base/bytes.h"
#include "sightline/base/random.h"

namespace sightline::bake {
namespace {

constexpr uint64_t kMagic = 0x31776f7262736c73ull;  // "slsbrow1"
constexpr size_t kHead = 16, kEnd = 8;              // the magic and how many bytes there are; the hash of all before it

}  // namespace

bool RowJournal::begins(std::span<const char> bytes) { return ByteCursor(bytes).take<uint64_t>() == kMagic; }

Result<RowJournal> RowJournal::takenOff(std::span<const char>& bytes, const std::string& name) {
    RowJournal out;
    if (!begins(bytes)) return out;
    const Error damaged{Error::Kind::kInput, name + ": damaged"};
    ByteCursor in(bytes);
    in.take<uint64_t>();
    const uint64_t size = in.take<uint64_t>();
    if (size < kHead + kEnd || size > bytes.size()) return damaged;
    const std::span<const char> all = bytes.first(size - kEnd);
    if (ByteCursor(bytes.subspan(size - kEnd, kEnd)).take<uint64_t>() != contentHash(all)) return damaged;
    while (in.at() < all.size()) {
        if (all.size() - in.at() < 12) return damaged;
        const uint64_t question = in.take<uint64_t>();
        const uint32_t length = in.take<uint32_t>();
        if (length > all.size() - in.at()) return damaged;
        out.add(question, all.subspan(in.at(), length));
        in = ByteCursor(bytes.subspan(in.at() + length), in.at() + length);
    }
    out.kept_ = out.size();
    bytes = bytes.subspan(size);
    return out;
}

std::optional<std::span<const char>> RowJournal::find(uint64_t question) const {
    const auto at = answers_.find(question);
    if (at == answers_.end()) return std::nullopt;
    return std::span<const char>(at->second);
}

void RowJournal::add(uint64_t question, std::span<const char> answer) {
    answers_.insert_or_assign(question, Array<char>(answer.begin(), answer.end()));
}

std::string RowJournal::bytes() const {
    if (answers_.empty()) return {};
    std::vector<uint64_t> questions;
    size_t size = kHead + kEnd;
    for (const auto& [question, answer] : answers_) {
        questions.push_back(question);
        size += 12 + answer.size();
    }
    std::sort(questions.begin(), questions.end());
    Array<char> bytes;
    bytes.reserve(size);
    ByteWriter out(bytes);
    out.put(kMagic);
    out.put(uint64_t{size});
    for (const uint64_t question : questions) {
        const Array<char>& answer = answers_.at(question);
        out.put(question);
        out.put(static_cast<uint32_t>(answer.size()));
        bytes.insert(bytes.end(), answer.begin(), answer.end());
    }
    out.put(contentHash(bytes));
    return {bytes.begin(), bytes.end()};
}

void RowJournal::writeTo(Write write, double seconds) {
    write_ = std::move(write);
    seconds_ = seconds;
    last_ = Clock::now();
}

void RowJournal::keep(bool now) {
    if (!write_ || !written_ || size() == kept_) return;
    if (!now && std::chrono::duration<double>(Clock::now() - last_).count() < seconds_) return;
    written_ = write_(bytes());
    kept_ = size();
    last_ = Clock::now();
}

uint64_t askedWith(uint64_t question, std::span<const double> numbers) {
    for (const double number : numbers) question = mixSeed(question, std::bit_cast<uint64_t>(number));
    return question;
}

}  // namespace sightline::bake
