// What Assimp says of a file that it nevertheless reads: what is missing or was left out.
// SPDX-License-Identifier: MIT
#include "apps/import/warnings.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <assimp/DefaultLogger.hpp>
#include <assimp/LogStream.hpp>
#include <fmt/format.h>

namespace sightline::import {
using namespace tools;
namespace {

constexpr size_t kMostKinds = 1000, kMostNotes = 8;

class Ear : public Assimp::LogStream {
public:
    explicit Ear(Warnings& warnings) : warnings_(warnings) {}
    void write(const char* message) override { warnings_.hear(message); }

private:
    Warnings& warnings_;
};

/// "Warn,  T0: text\n" without what stands around the text, and without numbers that differ from line to line.
std::string plain(std::string line) {
    if (const size_t colon = line.find(": "); colon != std::string::npos && colon < 16) line.erase(0, colon + 2);
    if (const size_t id = line.find(" id is "); id != std::string::npos) line.resize(id);
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    return line;
}

bool tellsOfLoss(std::string_view line) {
    // Of things that are not taken anyway, and of versions that are read nevertheless.
    for (const char* word :
         {"LayerElement", "newer format version", "CONTENT_TYPES", "texture", "Texture", "animation"})
        if (line.find(word) != std::string_view::npos) return false;
    for (const char* word : {"skipping", "Skipping", "skipped", "Unable to locate material", "failed to", "Failed to",
                             "could not", "unsupported", "Unsupported", "not supported", "ignoring", "too many"})
        if (line.find(word) != std::string_view::npos) return true;
    return false;
}

}  // namespace

Warnings::Warnings() {
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Ear(*this), Assimp::Logger::Warn | Assimp::Logger::Err);
}

Warnings::~Warnings() { Assimp::DefaultLogger::kill(); }

void Warnings::hear(std::string line) {
    line = plain(std::move(line));
    if (tellsOfLoss(line) && (heard_.size() < kMostKinds || heard_.count(line))) ++heard_[line];
}

void Warnings::send(SceneStreamWriter& out) const {
    size_t sent = 0;
    for (const auto& [line, times] : heard_) {
        if (sent++ == kMostNotes) {
            out.note(fmt::format("and {} more of this kind", heard_.size() - kMostNotes));
            return;
        }
        out.note(times == 1 ? line : fmt::format("{} ({} times)", line, times));
    }
}

}  // namespace sightline::import
