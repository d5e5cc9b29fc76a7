// Reads the formats that Assimp knows, in a process of their own.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/foreign/foreign.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "sightline/tools/import/foreign/scene_stream.h"
#include "sightline/tools/import/foreign/worker_process.h"

namespace sightline::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "sightline-import";

std::string bytesInWords(uint64_t bytes) {
    constexpr std::pair<int, const char*> kUnits[] = {{30, "GiB"}, {20, "MiB"}, {10, "KiB"}};
    for (const auto& [shift, name] : kUnits)
        if (bytes >= uint64_t(1) << shift)
            return fmt::format("{:.3g} {}", static_cast<double>(bytes) / static_cast<double>(uint64_t(1) << shift),
                               name);
    return fmt::format("{} bytes", bytes);
}

/// Text of unknown origin, fit for one line.
std::string oneLine(std::string_view text) {
    constexpr size_t kMost = 300;
    std::string out(text.substr(0, kMost));
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    while (!out.empty() && out.back() == ' ') out.pop_back();
    return text.size() > kMost ? out + "..." : out;
}

/// Why there is no scene, of a stream that is not whole and a process that has ended.
std::string reason(const SceneStream& stream, const WorkerProcess::Exit& exit, bool late,
                   const ImportSettings& settings) {
    if (stream.end == SceneStream::End::kFault) return oneLine(stream.what);
    if (late || exit.signal == SIGXCPU)
        return fmt::format("took longer than {:g} s to read (--import-time)", settings.time_limit);
    if (stream.end == SceneStream::End::kLarge || exit.code == kImportOutOfMemory)
        return fmt::format("needs more memory than {} (--import-memory)", bytesInWords(settings.memory_limit));
    if (stream.end == SceneStream::End::kBroken)
        return fmt::format("its reader sent what is no scene: {}", stream.what);
    if (exit.signal == SIGKILL) return "its reader was killed: perhaps the machine lacks memory";
    if (exit.signal != 0) return fmt::format("the reader crashed on it ({})", strsignal(exit.signal));
    return fmt::format("its reader ended without a word (exit code {})", exit.code);
}

std::vector<std::string> commandOf(const std::string& worker, const std::string& file, std::string_view suffix,
                                   const ImportSettings& settings) {
    const double seconds = std::clamp(std::ceil(settings.time_limit), 1.0, 1e8);
    return {worker,
            "--memory",
            std::to_string(settings.memory_limit),
            "--time",
            fmt::format("{:.0f}", seconds),
            "--parent",
            std::to_string(getpid()),
            "--format",
            std::string(suffix),
            "--",
            file};
}

}  // namespace

std::string findImportWorker(const ImportSettings& settings) {
    if (!settings.worker.empty()) return settings.worker;
    if (const char* named = std::getenv("SIGHTLINE_IMPORT"); named && *named) return named;
    std::vector<fs::path> places;
    std::error_code error;
    if (const fs::path self = fs::read_symlink("/proc/self/exe", error); !error) {
        places.push_back(self.parent_path() / kProgram);
        places.push_back(self.parent_path().parent_path() / SIGHTLINE_LIBEXEC / kProgram);
    }
    places.push_back(fs::path(SIGHTLINE_FULL_LIBEXEC) / kProgram);
    for (const fs::path& place : places)
        if (access(place.c_str(), X_OK) == 0 && !fs::is_directory(place, error)) return place.string();
    return {};
}

Result<Scene> loadForeign(const std::string& file, std::string_view suffix, const ImportSettings& settings) {
    const auto failed = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", file, what)};
    };
    const std::string worker = findImportWorker(settings);
    if (worker.empty())
        return failed(
            fmt::format("this build does not read .{} files ({} is missing: install libassimp-dev and build "
                        "again)",
                        suffix, kProgram));
    WorkerProcess process;
    if (Status started = process.start(commandOf(worker, file, suffix, settings), settings.time_limit); !started)
        return failed(started.error().message);

    size_t done = 0, total = 100;
    const auto progress = [&](size_t now, size_t all) {
        done = now;
        total = all;
        if (settings.progress) settings.progress(done, total);
    };
    const std::function<void()> waiting = [&] {
        if (settings.progress) settings.progress(done, total);
    };
    const ByteSource source = [&](unsigned char* to, size_t size) { return process.read(to, size, waiting); };
    SceneStream stream = readSceneStream(source, settings.memory_limit, progress);
    const bool cut = stream.end == SceneStream::End::kCut;
    const WorkerProcess::Exit exit = process.finish(!cut || process.timedOut());
    if (stream.end != SceneStream::End::kWhole) return failed(reason(stream, exit, process.timedOut(), settings));
    for (const std::string& note : stream.notes)
        if (settings.note) settings.note(fmt::format("{}: {}", file, oneLine(note)));
    return std::move(stream.scene);
}

}  // namespace sightline::tools
