// What a bake has found of its view cells so far, so that another process need not find it again.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>

#include "sightline/base/array.h"
#include "sightline/base/result.h"

namespace sightline::bake {

/// Answers by the hash of their question, which holds all that the answer depends on: the scene, the settings and the region.
/// So a journal of another bake, or of another version, answers nothing, and the order in which work was done does not matter.
///
///     RowJournal journal;
///     journal.writeTo([](const std::string& bytes) { return writeFileAside("house.state", bytes); });
///     settings.journal = &journal;
class RowJournal {
public:
    /// Takes a journal off the front of bytes, which then begin behind it. Bytes that begin otherwise stay, and the journal is
    /// empty. Errors (kInput): damaged.
    /// @param name  what errors call the bytes
    static Result<RowJournal> takenOff(std::span<const char>& bytes, const std::string& name);
    /// Whether bytes begin as a journal does.
    static bool begins(std::span<const char> bytes);

    /// The answer, or none. Several threads may ask at once, while none adds.
    std::optional<std::span<const char>> find(uint64_t question) const;
    void add(uint64_t question, std::span<const char> answer);
    size_t size() const { return answers_.size(); }
    /// Empty if nothing was added.
    std::string bytes() const;

    using Write = std::function<Status(const std::string&)>;
    /// From now on keep() gives all bytes to `write`, every so many seconds.
    void writeTo(Write write, double seconds = 10);
    /// Between pieces of work.
    /// @param now  whatever the time is
    void keep(bool now);
    /// The first error of writing.
    const Status& written() const { return written_; }

private:
    using Clock = std::chrono::steady_clock;

    std::unordered_map<uint64_t, Array<char>> answers_;
    Write write_;
    double seconds_ = 0;
    Clock::time_point last_;
    size_t kept_ = 0;  // answers at the last writing
    Status written_ = success();
};

/// The beginning of all questions: changes with whatever changes how rows are found.
constexpr uint64_t kRowsVersion = 4;

/// A question that depends on numbers besides.
uint64_t askedWith(uint64_t question, std::span<const double> numbers);

}  // namespace sightline::bake
