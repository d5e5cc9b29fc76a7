// Writes the samples as seeds for the fuzzer.
// SPDX-License-Identifier: MIT
#include "gltf_samples.h"
#include "tests/support/files.h"

int main(int argc, char** argv) {
    using namespace sightline::test;
    return writeSeeds(argc, argv, [](auto seed) {
        for (const Sample& sample : gltfSamples()) seed(sample.name, sample.bytes);
    });
}
