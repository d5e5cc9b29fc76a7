// Writes the made maps as seeds for the fuzzers.
// SPDX-License-Identifier: MIT
//
// Run it as sightline_map_corpus tests/fuzz/corpus.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "archive_files.h"
#include "map_files.h"

int main(int count, char** words) {
    using namespace sightline;
    using namespace sightline::tools;
    if (count != 2) {
        std::fputs("usage: sightline_map_corpus FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path root = words[1];
    const auto write = [&](const char* fuzzer, const char* name, const std::string& bytes) {
        std::filesystem::create_directories(root / fuzzer);
        std::ofstream(root / fuzzer / name, std::ios::binary) << bytes;
    };
    const char* const names[] = {"quake", "bsp2", "2psb", "half_life", "quake2", "quake3"};
    for (const QuakeFormat format : test::kQuakeFormats) {
        test::MadeMap made;
        test::madeVisibility(format, true, made);
        write("bsp", names[static_cast<size_t>(format)], test::mapBytes(format, made));
    }
    const std::vector<test::MadeEntry> entries = {
        {"maps/a.bsp", std::string(300, 'a'), true}, {"b", "stored", false}, {"empty", "", false}};
    write("archive", "pak", test::pakBytes(entries));
    write("archive", "pk3", test::pk3Bytes(entries));
    write("archive", "behind", test::pk3Bytes(entries, "#!/bin/unpack\n"));
    write("archive", "none", test::pk3Bytes({}));
    return 0;
}
