// Files of a test: read whole, and written.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace sightline::test {

inline std::string readBytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Says on standard error if it cannot; the folder is made.
inline bool writeBytes(const std::filesystem::path& file, std::string_view bytes) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream out(file, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    if (!out) std::fprintf(stderr, "%s: cannot be written\n", file.string().c_str());
    return bool(out);
}

/// The main function of a program that is called with a folder: make(seed) calls seed(name, bytes) for each file.
template <class Make>
int writeSeeds(int argc, char** argv, Make make) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    bool written = true;
    make([&](const std::string& name, const auto& bytes) {
        written &= writeBytes(std::filesystem::path(argv[1]) / name, {bytes.data(), bytes.size()});
    });
    return written ? 0 : 4;
}

}  // namespace sightline::test
