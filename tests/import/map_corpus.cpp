// Writes the made maps as seeds for the fuzzers: sightline_map_corpus tests/fuzz/corpus
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "map_files.h"

int main(int count, char** words) {
    using namespace sightline;
    if (count != 2) {
        std::fputs("usage: sightline_map_corpus FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = std::filesystem::path(words[1]) / "bsp";
    std::filesystem::create_directories(folder);
    const char* const names[] = {"quake", "bsp2", "2psb", "half_life", "quake2", "quake3"};
    for (const QuakeFormat format : test::kQuakeFormats) {
        test::MadeMap made;
        test::madeVisibility(format, true, made);
        std::ofstream(folder / names[static_cast<size_t>(format)], std::ios::binary) << test::mapBytes(format, made);
    }
    return 0;
}
