// Whatever the bytes are, the glTF reader answers with a sound scene or with one line.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <iterator>

#include "gltf_reading.h"
#include "mutated.h"

namespace sightline::test {
namespace {

/// Empty, or what is wrong with the answer.
std::string faultOf(const std::string& bytes) {
    const Result<Scene> result = parse(bytes);
    return result.ok() ? sceneFault(*result) : messageFault(result.error(), "test.glb");
}

TEST(GltfMutation, SamplesSurviveTwentyThousandMutations) {
    const std::vector<Sample> samples = gltfSamples();
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        const Sample& sample = samples[random.below(samples.size())];
        const std::string fault = faultOf(mutated(sample.bytes, random));
        ASSERT_EQ(fault, "") << "seed " << seed << " on " << sample.name;
    }
}

TEST(GltfMutation, EverySampleLoads) {
    for (const Sample& sample : gltfSamples()) {
        const Result<Scene> scene = parse(sample.bytes);
        EXPECT_TRUE(scene.ok()) << sample.name << ": " << scene.error().message;
    }
}

TEST(GltfMutation, CorpusOfTheFuzzerIsSound) {
    const std::filesystem::path folder = SIGHTLINE_GLTF_CORPUS;
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
        EXPECT_EQ(faultOf(bytes), "") << entry.path();
        ++files;
    }
    EXPECT_GE(files, gltfSamples().size());
}

}  // namespace
}  // namespace sightline::test
