// Reads the formats that Assimp knows, in a process of their own.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/foreign/foreign.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <functional>
#include <poll.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "sightline/base/result.h"
#include "sightline/tools/import/foreign/float_error.h"
#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::tools {
namespace {

// A program that reads for us: started with a pipe, given a time, ended for good.

/// A child process whose standard output is read here. It inherits nothing but its working directory and environment: standard input
/// and error are /dev/null, other files are closed, signals are as at the start of a program. Any thread may have its
/// own, and several at once.
class WorkerProcess {
public:
    /// How it ended.
    struct Exit {
        int code = -1;   ///< of exit(), or -1
        int signal = 0;  ///< that ended it, or 0
    };

    WorkerProcess() = default;
    /// Kills the child and all that it has started.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    /// @param words  the program's path and its arguments
    /// @param seconds  from now on, until reading stops  [> 0]
    /// Errors are one line that names the program.
    Status start(const std::vector<std::string>& words, double seconds);

    /// Waits for bytes. 0: its output has ended, or the time is over (see timedOut()).
    /// @param waiting  called a few times a second while nothing comes; may be empty
    size_t read(unsigned char* to, size_t size, const std::function<void()>& waiting);

    bool timedOut() const { return timed_out_; }

    /// Gives it what is left of its time to end by itself, if it was not told to end; then kills it.
    /// @param now  do not wait
    Exit finish(bool now);

private:
    using Clock = std::chrono::steady_clock;

    bool late() const { return Clock::now() >= deadline_; }

    int child_ = -1, pipe_ = -1;
    Clock::time_point deadline_;
    bool timed_out_ = false;
};

constexpr double kLongest = 1e8;  // [seconds], so that clocks do not overflow

/// What posix_spawn is to do in the child before it runs the program.
class SpawnPlan {
public:
    explicit SpawnPlan(int output) {
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);

        // A group of its own: it dies with all that it starts, and Ctrl-C is the parent's to answer.
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setpgroup(&attributes, 0);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&files);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
};

Status WorkerProcess::start(const std::vector<std::string>& words, double seconds) {
    const auto failed = [&](int error) {
        return Error{Error::Kind::kInput, fmt::format("{} cannot be started: {}", words[0], std::strerror(error))};
    };
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return failed(errno);
    // The ends must not be where the child's own standard files go.
    for (int& end : ends)
        if (end <= STDERR_FILENO) {
            const int moved = fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
            close(end);
            end = moved;
        }
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(std::clamp(seconds, 0.0, kLongest)));
    const SpawnPlan plan(ends[1]);
    pid_t child = -1;
    const int error = posix_spawn(&child, words[0].c_str(), &plan.files, &plan.attributes, arguments.data(), environ);
    close(ends[1]);
    if (error != 0) {
        close(ends[0]);
        return failed(error);
    }
    child_ = child;
    pipe_ = ends[0];
    return success();
}

size_t WorkerProcess::read(unsigned char* to, size_t size, const std::function<void()>& waiting) {
    constexpr int kPatience = 200;  // [ms]
    for (;;) {
        if (late()) {
            timed_out_ = true;
            return 0;
        }
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
        pollfd wait{pipe_, POLLIN, 0};
        const int ready = poll(&wait, 1, static_cast<int>(std::clamp<long>(left, 0, kPatience)));
        if (ready < 0 && errno != EINTR) return 0;
        if (ready <= 0) {
            if (waiting) waiting();
            continue;
        }
        const ssize_t got = ::read(pipe_, to, size);
        if (got >= 0) return static_cast<size_t>(got);
        if (errno != EINTR && errno != EAGAIN) return 0;
    }
}

WorkerProcess::Exit WorkerProcess::finish(bool now) {
    Exit out;
    if (child_ < 0) return out;
    int status = 0;
    pid_t ended = 0;
    bool killed = false;
    for (useconds_t pause = 100; ended == 0; pause = std::min<useconds_t>(2 * pause, 20000)) {
        if (!killed && (now || late())) {
            timed_out_ |= !now;
            kill(-child_, SIGKILL);
            killed = true;
        }
        ended = waitpid(child_, &status, killed ? 0 : WNOHANG);
        if (ended < 0 && errno == EINTR) ended = 0;
        if (ended == 0 && !killed) usleep(pause);
    }
    if (!killed) kill(-child_, SIGKILL);  // what it may have left behind
    if (ended == child_ && WIFEXITED(status)) out.code = WEXITSTATUS(status);
    if (ended == child_ && WIFSIGNALED(status)) out.signal = WTERMSIG(status);
    close(pipe_);
    child_ = pipe_ = -1;
    return out;
}

WorkerProcess::~WorkerProcess() { finish(true); }

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
    const std::string at = stream.part.empty() ? "" : ", at " + oneLine(stream.part);
    if (late || exit.signal == SIGXCPU)
        return fmt::format("took longer than {:g} s to read (--import-time){}", settings.time_limit, at);
    if (stream.end == SceneStream::End::kLarge || exit.code == kImportOutOfMemory)
        return fmt::format("needs more memory than {} (--import-memory){}", bytesInWords(settings.memory_limit), at);
    if (stream.end == SceneStream::End::kBroken)
        return fmt::format("its reader sent what is no scene: {}", stream.what);
    if (exit.signal == SIGKILL) return fmt::format("its reader was killed{}: perhaps the machine lacks memory", at);
    const std::string rid = at.empty() ? "" : ": leave that out of the file, or export the file as glTF";
    if (exit.signal != 0) return fmt::format("the reader crashed on it ({}){}{}", strsignal(exit.signal), at, rid);
    return fmt::format("its reader ended without a word (exit code {}){}{}", exit.code, at, rid);
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
    std::vector<std::string> places;
    std::error_code error;
    if (const fs::path self = fs::read_symlink("/proc/self/exe", error); !error) {
        places.push_back((self.parent_path() / kProgram).string());
        places.push_back((self.parent_path().parent_path() / SIGHTLINE_LIBEXEC / kProgram).string());
    }
    places.push_back((fs::path(SIGHTLINE_FULL_LIBEXEC) / kProgram).string());
    for (const std::string& place : places)
        if (access(place.c_str(), X_OK) == 0 && !fs::is_directory(place, error)) return place;
    return {};
}

Result<Scene> loadForeign(const std::string& file, std::string_view suffix, const ImportSettings& settings) {
    const auto failed = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", file, what)};
    };
    const std::string worker = findImportWorker(settings);
    if (worker.empty())
        return failed(
            fmt::format("{1}, which reads .{0} files, is not beside this program: `./run.sh info FILE.{0}` builds it, "
                        "if libassimp-dev is installed",
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
    // web-ifc keeps places in doubles; Assimp keeps nothing so.
    const bool in_floats = suffix != "ifc" && suffix != "ifczip";
    if (const std::string lost = in_floats ? floatErrorText(stream.scene, settings.scale) : ""; !lost.empty())
        stream.notes.push_back(lost);
    for (const std::string& note : stream.notes)
        if (settings.note) settings.note(fmt::format("{}: {}", file, oneLine(note)));
    return std::move(stream.scene);
}

}  // namespace sightline::tools
