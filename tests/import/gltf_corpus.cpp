// Writes the samples as seeds for the fuzzer: sightline_gltf_corpus tests/fuzz/corpus/gltf
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "gltf_samples.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: sightline_gltf_corpus FOLDER\n");
        return 2;
    }
    for (const sightline::test::Sample& sample : sightline::test::gltfSamples()) {
        std::ofstream out(std::filesystem::path(argv[1]) / sample.name, std::ios::binary);
        out.write(sample.bytes.data(), std::streamsize(sample.bytes.size())).flush();
        if (!out) {
            std::fprintf(stderr, "%s: cannot be written\n", sample.name.c_str());
            return 4;
        }
    }
    return 0;
}
