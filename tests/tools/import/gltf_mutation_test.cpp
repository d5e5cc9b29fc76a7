// Whatever the bytes are, the glTF reader answers with a sound scene or with one line.
// SPDX-License-Identifier: MIT

#include "gltf_reading.h"
#include "mutated.h"
#include "tests/support/corpus.h"

namespace sightline::test {
using namespace tools;
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
    forCorpus("gltf", gltfSamples().size(),
              [](const std::string& name, const std::string& bytes) { EXPECT_EQ(faultOf(bytes), "") << name; });
}

}  // namespace
}  // namespace sightline::test
