// What holds for a whole run of the tool: how much it says, where to, in which colours, and whether it is to stop.
// SPDX-License-Identifier: MIT
#include "apps/cli/session.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <poll.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include "apps/cli/common.h"
#include "apps/cli/verbs.h"
#include "sightline/scene/one_line.h"

namespace sightline::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char *kGreen = "\033[32m", *kRed = "\033[31m", *kNormal = "\033[0m";

struct Session {
    bool quiet = false;
    std::string colour = "auto";
    std::string log_name;
    Clock::time_point begin = Clock::now();
};

Session& session() {
    static Session session;
    return session;
}

// What a signal's handler may touch.
std::atomic<int> g_log{-1};
std::atomic<bool> g_gentle{false}, g_interrupted{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void writeAll(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        bytes.remove_prefix(static_cast<size_t>(written));
    }
}

/// Only what is safe in a signal's handler.
extern "C" void onSignal(int) {
    const int error = errno;
    ::signal(SIGINT, SIG_DFL);  // the next one ends the process at once
    ::signal(SIGTERM, SIG_DFL);
    g_interrupted = true;
    if (!g_gentle) {
        constexpr std::string_view kLine = "sightline: interrupted: nothing was finished\n";
        if (::isatty(STDERR_FILENO)) writeAll(STDERR_FILENO, "\r\033[K");
        writeAll(STDERR_FILENO, kLine);
        if (g_log >= 0) writeAll(g_log, kLine);
        ::_exit(kInterrupted);
    }
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

std::string timeStamp() {
    const auto now = std::chrono::system_clock::now();
    const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
    const auto millis = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                       utc.tm_hour, utc.tm_min, utc.tm_sec, millis);
}

/// True if standard output is a pipe that nobody reads any more, as behind `| head`: no fault that is worth a line.
bool readerHasLeft() {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR);
}

/// Without our colours, and in one line: a name in a file cannot forge another.
std::string plain(std::string_view text) {
    std::string out(text);
    for (const char* colour : {kGreen, kRed, kNormal})
        for (size_t at = 0; (at = out.find(colour, at)) != std::string::npos;) out.erase(at, std::strlen(colour));
    return oneLine(out);
}

void writeTo(std::FILE* out, std::string_view text) { (void)std::fwrite(text.data(), 1, text.size(), out); }

/// A log begins with the time. What does not, as a scene that was named by mistake, is not appended to.
bool isLogOrNew(const std::string& name) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(name, ignored)) return true;
    char begin[5] = {};
    std::ifstream(name, std::ios::binary).read(begin, sizeof begin);
    const bool empty = std::filesystem::file_size(name, ignored) == 0;
    return empty || (std::all_of(begin, begin + 4, [](char c) { return c >= '0' && c <= '9'; }) && begin[4] == '-');
}

}  // namespace

void addSessionOptions(CLI::App& app, SessionOptions& options) {
    app.add_flag("-q,--quiet", options.quiet,
                 "no progress, notes or summaries of runs; answers to a question (info, explain, bench), what - asks "
                 "for, and "
                 "errors stay")
        ->group("General");
    app.add_option("--log", options.log, "append what happens, with the time, to this file")
        ->type_name("FILE")
        ->group("General");
    app.add_option("--color", options.colour, "when to colour")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->capture_default_str()
        ->group("General");
    app.add_option("--config", options.config, "take defaults of options from this file alone")
        ->type_name("FILE.toml")
        ->configurable(false)
        ->group("General");
    app.add_flag("--no-config", options.no_config, "take them from no file")->configurable(false)->group("General");
}

void openSession() {
    session();
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

Status beginSession(const SessionOptions& options, const std::string& version, const std::string& command) {
    Session& now = session();
    now.quiet = options.quiet;
    now.colour = options.colour;
    if (options.log.empty()) return success();
    if (!isLogOrNew(options.log))
        return Error{Error::Kind::kOutput,
                     fmt::format("--log: {} holds something else, and is left as it is", options.log)};
    const int log = ::open(options.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (log < 0)
        return Error{Error::Kind::kOutput, fmt::format("{}: cannot be written: {}", options.log, std::strerror(errno))};
    now.log_name = options.log;
    g_log = log;
    logLine(fmt::format("begin {}: {}", version, command));
    return success();
}

int endSession(int exit_code) {
    const bool flushed = std::fflush(stdout) == 0;
    if ((!flushed || std::ferror(stdout)) && exit_code != kOutputUnwritable)
        exit_code =
            readerHasLeft() ? kOutputUnwritable : report({Error::Kind::kOutput, "standard output: cannot be written"});
    const double seconds = std::chrono::duration<double>(Clock::now() - session().begin).count();
    logLine(fmt::format("end: exit code {} after {:.3f} s", exit_code, seconds));
    return exit_code;
}

void stopGently() { g_gentle = true; }

bool interrupted() { return g_interrupted; }

void forgetInterruption() {
    g_gentle = g_interrupted = false;
    hear(SIGINT);
    hear(SIGTERM);
}

int reportInterruption(const std::string& done, bool written) {
    const std::string line = fmt::format("sightline: interrupted after {}: {}\n", done,
                                         written ? "what is finished was written" : "nothing was written");
    writeTo(stderr, line);
    logLine(line);
    return kInterrupted;
}

bool quiet() { return session().quiet; }

void tell(std::FILE* out, std::string_view text) {
    if (!quiet()) writeTo(out, text);
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        logLine(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

void note(const std::string& text) {
    if (!quiet()) writeTo(stderr, "note: " + plain(text) + "\n");
    logLine("note: " + text);
}

void logLine(std::string_view text) {
    if (g_log < 0) return;
    std::string line = plain(text);
    while (!line.empty() && line.back() == ' ') line.pop_back();
    writeAll(g_log, timeStamp() + " " + line + "\n");  // one write: lines of several threads stay whole
}

bool isColoured(std::FILE* out) {
    const std::string& colour = session().colour;
    if (colour != "auto") return colour == "always";
    const char* no_colour = std::getenv("NO_COLOR");
    const char* term = std::getenv("TERM");
    if ((no_colour && *no_colour) || !term || std::strcmp(term, "dumb") == 0) return false;
    return ::isatty(::fileno(out)) == 1;
}

std::string paint(std::FILE* out, Tone tone, std::string_view text) {
    if (!isColoured(out)) return std::string(text);
    return fmt::format("{}{}{}", tone == Tone::kGood ? kGreen : kRed, text, kNormal);
}

}  // namespace sightline::cli
