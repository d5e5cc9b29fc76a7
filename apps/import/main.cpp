// sightline-import: reads a file with Assimp, under limits, and writes the scene to standard output as a stream.
// SPDX-License-Identifier: MIT
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "apps/import/fault.h"
#include "apps/import/limits.h"
#include "apps/import/send_scene.h"
#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::import {
using namespace tools;
namespace {

constexpr const char* kUsage =
    "usage: sightline-import [--memory BYTES] [--time SECONDS] [--parent PID] --format SUFFIX -- FILE\n"
    "Reads FILE with Assimp and writes the scene as a stream of bytes. Meant to be started by sightline.\n";

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
    } catch (const std::exception& error) { return error.what(); } catch (...) {
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
    static Output output(takeOutput());
    setLimits(options.limits);
    sightline::tools::SceneStreamWriter stream([](const void* bytes, size_t size) { output.write(bytes, size); });
    const std::string fault = readInto(options, stream);
    // Assimp reports exhaustion as any other error.
    if (fault.find("bad_alloc") != std::string::npos || fault.find("bad allocation") != std::string::npos)
        _exit(sightline::tools::kImportOutOfMemory);
    fault.empty() ? stream.end() : stream.fault(fault);
    output.flush();
    _exit(0);  // the kernel frees the scene faster than its destructors do
}
