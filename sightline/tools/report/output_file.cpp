// Writes files aside and renames them: a crash leaves the old file.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace sightline::tools {
namespace {

Error failure(const std::string& file, const std::string& what) {
    return {Error::Kind::kOutput, file + ": cannot be written: " + what};
}

/// What the system says; where the directory is missing, which.
Error failure(const std::string& file, int error) {
    const std::filesystem::path directory = std::filesystem::path(file).parent_path();
    std::error_code ignored;
    if (error == ENOENT && !directory.empty() && !std::filesystem::exists(directory, ignored))
        return failure(file, "there is no directory " + directory.string());
    return failure(file, std::strerror(error));
}

bool writeAll(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes.remove_prefix(static_cast<size_t>(written));
    }
    return true;
}

/// A new, empty file beside `file`; its name replaces the argument's. Negative if there is none.
int openBeside(std::string& file) {
    file += ".XXXXXX";
    const int descriptor = ::mkstemp(file.data());
    if (descriptor < 0) return descriptor;
    const mode_t mask = ::umask(0);  // mkstemp is private to the owner; files are as the user's umask says
    ::umask(mask);
    (void)::fchmod(descriptor, 0666 & ~mask);
    return descriptor;
}

/// True for pipes, terminals and the like: there is nothing to keep, and a rename would replace the device.
bool isDevice(const std::string& file) {
    std::error_code ignored;
    return std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
}

Status writeInPlace(const std::string& file, std::string_view bytes) {
    const int descriptor = ::open(file.c_str(), O_WRONLY);
    if (descriptor < 0) return failure(file, errno);
    const bool done = writeAll(descriptor, bytes);
    const int error = errno;
    ::close(descriptor);
    return done ? success() : failure(file, error);
}

}  // namespace

Status writeFileAside(const std::string& file, std::string_view bytes) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return failure(file, EISDIR);
    if (isDevice(file)) return writeInPlace(file, bytes);
    std::string aside = file;
    const int descriptor = openBeside(aside);
    if (descriptor < 0) return failure(file, errno);
    bool done = writeAll(descriptor, bytes) && ::fsync(descriptor) == 0;
    int error = errno;
    if (::close(descriptor) != 0 && done) {
        done = false;
        error = errno;
    }
    if (done && std::rename(aside.c_str(), file.c_str()) != 0) {
        done = false;
        error = errno;
    }
    if (done) return success();
    ::unlink(aside.c_str());
    return failure(file, error);
}

Status canWriteFile(const std::string& file) {
    std::error_code ignored;
    if (file.empty()) return failure("\"\"", "the name is empty");
    if (std::filesystem::is_directory(file, ignored)) return failure(file, EISDIR);
    if (isDevice(file)) return ::access(file.c_str(), W_OK) == 0 ? success() : failure(file, errno);
    std::string aside = file;
    const int descriptor = openBeside(aside);
    if (descriptor < 0) return failure(file, errno);
    ::close(descriptor);
    ::unlink(aside.c_str());
    return success();
}

std::string freeFileName(const std::string& stem, const std::string& extension) {
    for (int i = 1;; ++i) {
        const std::string name = stem + (i > 1 ? "-" + std::to_string(i) : "") + extension;
        std::error_code ignored;
        if (!std::filesystem::exists(name, ignored)) return name;
    }
}

Status makeDirectory(const std::string& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) return failure(directory, error.message());
    if (!std::filesystem::is_directory(directory, error)) return failure(directory, ENOTDIR);
    return success();
}

}  // namespace sightline::tools
