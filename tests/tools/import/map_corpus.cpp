// Writes the made maps as seeds for the fuzzers.
// SPDX-License-Identifier: MIT
//
// Run it as sightline_map_corpus tests/fuzz/corpus.
#include "archive_files.h"
#include "map_files.h"
#include "tests/support/files.h"

int main(int argc, char** argv) {
    using namespace sightline::test;
    return writeSeeds(argc, argv, [](auto seed) {
        const std::string names[] = {"quake", "bsp2", "2psb", "half_life", "quake2", "quake3"};
        for (const QuakeFormat format : kQuakeFormats) {
            MadeMap made;
            madeVisibility(format, true, made);
            seed("bsp/" + names[static_cast<size_t>(format)], mapBytes(format, made));
        }
        const std::vector<MadeEntry> entries = {
            {"maps/a.bsp", std::string(300, 'a'), true}, {"b", "stored", false}, {"empty", "", false}};
        seed("archive/pak", pakBytes(entries));
        seed("archive/pk3", pk3Bytes(entries));
        seed("archive/behind", pk3Bytes(entries, "#!/bin/unpack\n"));
        seed("archive/none", pk3Bytes({}));
    });
}
