// Writes the samples as seeds for the fuzzer.
// SPDX-License-Identifier: MIT
#include "gltf_samples.h"
#include "tests/support/files.h"

int main(int argc, char** argv) {
    using namespace sightline::test;
    return writeInto(argc, argv, [](const std::filesystem::path& folder) {
        bool written = true;
        for (const Sample& sample : gltfSamples()) written = writeBytes(folder / sample.name, sample.bytes) && written;
        return written;
    });
}
