// --watch: runs a verb again whenever a file changes that it reads.
// SPDX-License-Identifier: MIT
#include "apps/cli/watch.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/cli/common.h"
#include "apps/cli/config.h"
#include "apps/cli/scene_inputs.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "sightline/scene/one_line.h"
#include "sightline/scene/procedural.h"

namespace sightline::cli {
namespace {

using Files = std::vector<std::string>;
using Clock = std::chrono::steady_clock;

constexpr auto kStill = std::chrono::milliseconds(150);  // that a file must be, lest it be read half written
constexpr auto kPatience = std::chrono::seconds(10);     // with a file that is never still
constexpr auto kLookAnyway = std::chrono::milliseconds(2000);

/// Words that a verb's option was given, on the command line or by the configuration.
Files wordsOf(const CLI::App& verb, const std::string& name, const ConfigFile& config) {
    const CLI::Option* const option = verb.get_option_no_throw(name);
    if (!option) return {};
    if (option->count() > 0) return option->results();
    const ConfigEntry* const entry = findEntry(config, verb.get_name(), name.substr(name.find_first_not_of('-')));
    return entry ? entry->words : Files();
}

/// The files that the next run will read, as far as can be told before it.
Files inputsOf(const CLI::App& verb, const SessionOptions& options) {
    Files files = configPlaces(options);
    ConfigFile config;
    if (const ConfigChoice choice = findConfig(options); !choice.file.empty())
        if (Result<ConfigFile> read = readConfig(choice.file)) config = std::move(*read);
    const auto add = [&](const Files& more) { files.insert(files.end(), more.begin(), more.end()); };
    for (const std::string& name : wordsOf(verb, "SCENE", config))
        if (!isProcedural(name)) add(filesOfScene(name));
    add(wordsOf(verb, "--cameras", config));
    return files;
}

/// Wakes when anything happens in the directories of some files, or of what they are links to.
class Directories {
public:
    explicit Directories(const Files& files) : descriptor_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
        namespace fs = std::filesystem;
        constexpr uint32_t kEvents =
            IN_CLOSE_WRITE | IN_MODIFY | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE | IN_ATTRIB;
        std::set<std::string> places;
        for (const std::string& file : files) {
            std::error_code error;
            const fs::path parent = fs::path(file).parent_path();
            places.insert(parent.empty() ? "." : parent.string());
            const fs::path real = fs::canonical(file, error);
            if (!error) places.insert(real.parent_path().string());
        }
        for (const std::string& place : places) (void)::inotify_add_watch(descriptor_, place.c_str(), kEvents);
    }
    ~Directories() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    Directories(const Directories&) = delete;
    Directories& operator=(const Directories&) = delete;

    /// Waits for an event, a signal or the time's end; signals that are blocked come through meanwhile.
    void wait(std::chrono::milliseconds most, const sigset_t& signals) const {
        pollfd poll{descriptor_, POLLIN, 0};
        const timespec time{most.count() / 1000, most.count() % 1000 * 1000000};
        if (::ppoll(&poll, descriptor_ >= 0 ? 1 : 0, &time, &signals) <= 0) return;
        char bytes[16384];
        while (::read(descriptor_, bytes, sizeof bytes) > 0) {}
    }

private:
    int descriptor_;
};

/// Signals wait until someone waits for them, so that none comes between a look and a sleep.
class HeldSignals {
public:
    HeldSignals() {
        struct sigaction action {};
        action.sa_handler = [](int) {};  // the end of a run is to wake the watch, no more
        ::sigaction(SIGCHLD, &action, &old_action_);
        sigset_t held;
        sigemptyset(&held);
        for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&held, signal);
        ::sigprocmask(SIG_BLOCK, &held, &open_);
        while_waiting_ = open_;
        for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigdelset(&while_waiting_, signal);
    }
    /// Signals as they were before; in a run's process.
    void release() const {
        ::sigaction(SIGCHLD, &old_action_, nullptr);
        ::sigprocmask(SIG_SETMASK, &open_, nullptr);
    }
    const sigset_t& whileWaiting() const { return while_waiting_; }

private:
    struct sigaction old_action_ {};
    sigset_t open_{}, while_waiting_{};
};

/// Makes this process one of a run: out of the terminal's reach, so that Ctrl-C comes from the watch alone and once.
void becomeRun(const HeldSignals& signals, pid_t watch) {
    ::setpgid(0, 0);
    ::signal(SIGTTOU, SIG_IGN);  // it may write to the terminal all the same
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != watch) ::_exit(kInterrupted);
    forgetInterruption();
    signals.release();
}

/// Waits for a run; passes an interruption on to it.
/// @return its exit code, or minus the signal that ended it
int awaitRun(pid_t run, const Directories& directories, const HeldSignals& signals) {
    bool told = false;
    for (;;) {
        int status = 0;
        if (::waitpid(run, &status, WNOHANG) == run) return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        if (interrupted() && !told) {
            ::kill(run, SIGINT);
            told = true;
        }
        directories.wait(kLookAnyway, signals.whileWaiting());
    }
}

/// Waits until the files are in another state than this and are still. False: interrupted.
bool awaitChange(const Files& files, const std::vector<uint64_t>& before, const HeldSignals& signals) {
    std::vector<uint64_t> now = before;
    while (now == before) {
        if (interrupted()) return false;
        const Directories directories(files);  // before the look, so that no change is between the two
        now = stateOf(files);
        if (now == before) directories.wait(kLookAnyway, signals.whileWaiting());
    }
    const Directories directories(files);
    for (const auto begin = Clock::now(); !interrupted() && Clock::now() - begin < kPatience;) {
        const auto still_at = Clock::now() + kStill;
        while (Clock::now() < still_at && !interrupted()) directories.wait(kStill, signals.whileWaiting());
        std::vector<uint64_t> later = stateOf(files);
        if (later == now) break;
        now = std::move(later);
    }
    return !interrupted();
}

}  // namespace

void addWatchOption(CLI::App& verb, SessionOptions& options) {
    verb.add_flag("--watch", options.watch, "run again whenever a file changes that is read, until Ctrl-C")
        ->configurable(false)
        ->group("General");
}

std::vector<uint64_t> stateOf(const std::vector<std::string>& files) {
    std::vector<uint64_t> state;
    for (const std::string& file : files) {
        struct stat facts {};
        const bool there = ::stat(file.c_str(), &facts) == 0;
        state.push_back(std::hash<std::string>()(file));
        state.push_back(there);
        if (!there) continue;
        for (const auto number : {static_cast<uint64_t>(facts.st_size), static_cast<uint64_t>(facts.st_ino),
                                  static_cast<uint64_t>(facts.st_dev), static_cast<uint64_t>(facts.st_mtim.tv_sec),
                                  static_cast<uint64_t>(facts.st_mtim.tv_nsec)})
            state.push_back(number);
    }
    return state;
}

std::optional<int> watchRuns(CLI::App& verb, const SessionOptions& options) {
    const Files words = verb.get_option("SCENE")->results();
    if (inputsOf(verb, options).size() == configPlaces(options).size())
        return report(
            {Error::Kind::kUsage, fmt::format("--watch: {} is no file that could change, nor are there --cameras",
                                              words.empty() ? "no scene" : words[0])});
    stopGently();
    const HeldSignals signals;
    const pid_t watch = ::getpid();
    const bool say = !options.quiet;
    for (;;) {
        const Files inputs = inputsOf(verb, options);
        const std::vector<uint64_t> state = stateOf(inputs);  // before the run: what changes in it counts
        std::fflush(nullptr);
        const pid_t run = ::fork();
        if (run < 0) return report({Error::Kind::kInput, fmt::format("--watch: no process: {}", std::strerror(errno))});
        if (run == 0) {
            becomeRun(signals, watch);
            return std::nullopt;
        }
        const int ended = awaitRun(run, Directories(inputs), signals);
        if (ended < 0) report({Error::Kind::kInput, fmt::format("the run was ended by signal {}", -ended)});
        if (interrupted()) return ended < 0 || ended == kInterrupted ? kInterrupted : kDone;
        if (say)
            tell(stderr, fmt::format("watching {} for changes; Ctrl-C ends\n",
                                     oneLine(fmt::format("{}", fmt::join(words, ", ")))));
        if (!awaitChange(inputs, state, signals)) return kDone;
    }
}

}  // namespace sightline::cli
