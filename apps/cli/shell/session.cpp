// What holds for a whole run of the tool: how much it says, in which colours, how it fails, and whether it is to stop.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/session.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <initializer_list>
#include <malloc.h>
#include <mutex>
#include <poll.h>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

bool g_quiet = false;
// What a signal's handler may touch.
std::atomic<bool> g_gentle{false}, g_interrupted{false}, g_waits{false};
constexpr unsigned kHearing = 1;  // for work that is to hear of it  [s]
static_assert(std::atomic<bool>::is_always_lock_free);

/// Whoever reads it in a signal's handler may find a half of two names: no harm.
char g_step[128] = "";

/// Ends the process with one line. Only what is safe in a signal's handler.
[[noreturn]] void endAtOnce(std::initializer_list<std::string_view> line) {
    constexpr std::string_view kClear = "\r\033[K";
    if (::isatty(STDERR_FILENO)) (void)!::write(STDERR_FILENO, kClear.data(), kClear.size());
    for (const std::string_view part : line) (void)!::write(STDERR_FILENO, part.data(), part.size());
    ::_exit(kInterrupted);
}

/// Work that has not asked for a second whether to stop is not waited for.
extern "C" void onAlarm(int) {
    if (!g_waits) return;
    const std::string_view step = g_step;
    endAtOnce({"sightline: interrupted in the midst of ", step.empty() ? "a step" : step,
               ", which cannot stop half-way: what was not written is lost\n"});
}

/// Only what is safe in a signal's handler.
extern "C" void onSignal(int) {
    const int error = errno;
    ::signal(SIGINT, SIG_DFL);  // the next one ends the process at once
    ::signal(SIGTERM, SIG_DFL);
    g_interrupted = true;
    if (!g_gentle) endAtOnce({"sightline: interrupted: nothing was finished\n"});
    g_waits = true;
    ::signal(SIGALRM, onAlarm);
    ::alarm(kHearing);
    errno = error;
}

/// What a parent has told to be ignored stays so: a job in the background does not end by another's Ctrl-C.
void hear(int signal) {
    struct sigaction old {};
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN) return;
    struct sigaction action {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

/// True if standard output is a pipe that nobody reads any more, as behind `| head`: no fault that is worth a line.
bool readerHasLeft() {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR);
}

}  // namespace

int report(const Error& error) {
    const std::string line = "sightline: " + oneLine(error.message) + "\n";
    (void)std::fwrite(line.data(), 1, line.size(), stderr);
    switch (error.kind) {
        case Error::Kind::kUsage:
            return kWrongArguments;
        case Error::Kind::kOutput:
            return kOutputUnwritable;
        case Error::Kind::kInput:
            break;
    }
    return kInputUnreadable;
}

Error usageError(std::string message) { return {Error::Kind::kUsage, std::move(message)}; }

void addSessionOptions(CLI::App& app, SessionOptions& options) {
    app.add_flag("-q,--quiet", options.quiet,
                 "no progress, notes or summaries of runs; answers to a question (info, explain, bench), what - asks "
                 "for, and errors stay")
        ->group("General");
    app.add_option("--config", options.config, "take defaults of options from this file alone")
        ->type_name("FILE.toml")
        ->configurable(false)
        ->group("General");
    app.add_flag("--no-config", options.no_config, "take them from no file")->configurable(false)->group("General");
}

void openSession() {
    // A file that is opened must not become what others take for standard output. Reading from what is to be written,
    // and the other way round, fails as it should.
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
            (void)::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    for (const int signal : {SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_IGN);  // writing then fails, and that is said
    // Each of malloc's arenas reserves 64 MB of addresses, which a limit of these counts as if they were used.
    rlimit addresses{};
    if (::getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur != RLIM_INFINITY) ::mallopt(M_ARENA_MAX, 1);
    hear(SIGINT);
    hear(SIGTERM);
}

int endSession(int exit_code) {
    const bool flushed = std::fflush(stdout) == 0;
    if ((flushed && !std::ferror(stdout)) || exit_code == kOutputUnwritable) return exit_code;
    if (readerHasLeft()) return kOutputUnwritable;
    return report({Error::Kind::kOutput, "standard output: cannot be written"});
}

void stopGently() { g_gentle = true; }

bool interrupted() {
    if (!g_interrupted) return false;
    if (g_waits.exchange(false)) ::alarm(0);
    return true;
}

void nameStep(std::string_view what) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    g_step[what.copy(g_step, sizeof g_step - 1)] = 0;
}

int reportInterruption(const std::string& done, bool written) {
    fmt::print(stderr, "sightline: interrupted after {}: {}\n", done,
               written ? "what is finished was written" : "nothing was written");
    return kInterrupted;
}

void setQuiet(bool quiet) { g_quiet = quiet; }

bool quiet() { return g_quiet; }

void tell(std::FILE* out, std::string_view text) {
    if (!g_quiet) (void)std::fwrite(text.data(), 1, text.size(), out);
}

void note(const std::string& text) { tell(stderr, "note: " + oneLine(text) + "\n"); }

std::string paint(std::FILE* out, Tone tone, std::string_view text) {
    const char* const no_colour = std::getenv("NO_COLOR");
    const char* const term = std::getenv("TERM");
    const bool plain = (no_colour && *no_colour) || !term || std::string_view(term) == "dumb";
    if (plain || ::isatty(::fileno(out)) != 1) return std::string(text);
    return fmt::format("\033[{}m{}\033[0m", tone == Tone::kGood ? 32 : 31, text);
}

}  // namespace sightline::cli
