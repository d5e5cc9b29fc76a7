// sightline-import: reads a file with Assimp or web-ifc, under limits, and writes the scene to standard output as a stream.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <new>
#include <string>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <unistd.h>

#include "apps/import/fault.h"
#include "apps/import/node_reader.h"
#include "apps/import/send_scene.h"
#include "sightline/base/sanitized.h"
#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::import {
using namespace tools;
namespace {

// What the reader of foreign formats may take: memory, time, and no longer than who asked for it.

struct Limits {
    uint64_t memory = 0;   ///< address space [bytes]; 0: no limit
    uint64_t seconds = 0;  ///< of the processor; 0: no limit
    pid_t parent = 0;      ///< the process ends with this one; 0: with none
};

void limit(decltype(RLIMIT_AS) what, rlim_t most) {
    rlimit now{};
    if (getrlimit(what, &now) != 0) return;
    if (now.rlim_max != RLIM_INFINITY) most = std::min(most, now.rlim_max);
    now.rlim_cur = most;
    now.rlim_max = most;
    setrlimit(what, &now);
}

/// Sets them for this process, for good. Also: no core files, no files written, and an allocation that fails ends the
/// process with kImportOutOfMemory. Memory is not limited in builds with address or thread sanitizers, which reserve all of it,
/// nor where Node.js reads, which has a limit of its own.
void setLimits(const Limits& limits, bool by_node) {
    if (limits.parent != 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != limits.parent) _exit(1);  // it ended before we could ask
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    if (limits.memory != 0 && !kSanitized && !by_node) limit(RLIMIT_AS, limits.memory);
    // The engine of JavaScript has several threads; who asked counts by the clock.
    if (limits.seconds != 0) limit(RLIMIT_CPU, (by_node ? 4 : 1) * limits.seconds + 1);
    std::set_new_handler([] { _exit(kImportOutOfMemory); });
}

constexpr const char* kUsage =
    "usage: sightline-import [--memory BYTES] [--time SECONDS] [--parent PID] --format SUFFIX -- FILE\n"
    "Reads FILE with Assimp or web-ifc and writes the scene as a stream of bytes. Meant to be started by sightline.\n";

struct Options {
    Limits limits;
    std::string format, file;
};

template <class T>
bool readNumber(std::string_view text, T& out) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size();
}

bool readOptions(int count, char** words, Options& out) {
    int i = 1;
    for (; i + 1 < count && std::string_view(words[i]) != "--"; i += 2) {
        const std::string_view name = words[i], value = words[i + 1];
        const bool good = name == "--memory"   ? readNumber(value, out.limits.memory)
                          : name == "--time"   ? readNumber(value, out.limits.seconds)
                          : name == "--parent" ? readNumber(value, out.limits.parent)
                          : name == "--format" ? !(out.format = value).empty()
                                               : false;
        if (!good) return false;
    }
    if (i + 2 != count || out.format.empty()) return false;
    out.file = words[i + 1];
    return true;
}

/// Collects small writes. Who reads may leave at any time: SIGPIPE then ends this process.
class Output {
public:
    explicit Output(int file) : file_(file) {}

    void write(const void* bytes, size_t size) {
        if (size == 0 || size >= sizeof block_) {
            flush();
            writeOut(static_cast<const char*>(bytes), size);
            return;
        }
        if (size > sizeof block_ - used_) flush();
        std::memcpy(block_ + used_, bytes, size);
        used_ += size;
    }

    void flush() {
        writeOut(block_, used_);
        used_ = 0;
    }

private:
    void writeOut(const char* bytes, size_t size) {
        while (size > 0) {
            const ssize_t done = ::write(file_, bytes, size);
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) _exit(1);
            bytes += done;
            size -= static_cast<size_t>(done);
        }
    }

    int file_;
    size_t used_ = 0;
    char block_[1 << 16];
};

/// The stream has standard output to itself, whatever Assimp or what it uses may print.
int takeOutput() {
    const int out = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (out < 0 || nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0) _exit(1);
    return out;
}

std::string readInto(const Options& options, SceneStreamWriter& out) {
    try {
        sendScene(options.file, options.format, out);
        return {};
    } catch (const Fault& fault) { return fault.message; } catch (const std::bad_alloc&) {
        _exit(kImportOutOfMemory);
    } catch (const std::exception& error) { return importerFault(error.what()).message; } catch (...) {
        return "cannot be read";
    }
}

}  // namespace
}  // namespace sightline::import

int main(int count, char** words) {
    using namespace sightline::import;
    Options options;
    if (!readOptions(count, words, options)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const bool by_node = options.format == "ifc" || options.format == "ifczip";
    setLimits(options.limits, by_node);
    std::string fault;
    if (by_node) fault = readWithNode(options.file, options.format, options.limits.memory);
    static Output output(takeOutput());
    sightline::tools::SceneStreamWriter stream([](const void* bytes, size_t size) { output.write(bytes, size); });
    if (fault.empty()) fault = readInto(options, stream);
    // Assimp reports exhaustion as any other error.
    if (fault.find("bad_alloc") != std::string::npos || fault.find("bad allocation") != std::string::npos)
        _exit(sightline::tools::kImportOutOfMemory);
    fault.empty() ? stream.end() : stream.fault(fault);
    output.flush();
    _exit(0);  // the kernel frees the scene faster than its destructors do
}
