// Whatever the bytes are, the glTF reader answers with a sound scene or with one line.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "gltf_reading.h"
#include "sightline/base/random.h"

namespace sightline::test {
namespace {

/// Empty, or what is wrong with the answer.
std::string faultOf(const std::string& bytes) {
    const Result<Scene> result = parse(bytes);
    return result.ok() ? sceneFault(*result) : messageFault(result.error(), "test.glb");
}

// Flips bits, overwrites with telling numbers, removes, repeats: one to eight times.
std::string mutated(std::string bytes, Random& random) {
    for (uint64_t left = 1 + random.below(8); left-- > 0 && !bytes.empty();) {
        const size_t at = random.below(bytes.size());
        const size_t length = std::min<size_t>(1 + random.below(16), bytes.size() - at);
        switch (random.below(6)) {
            case 0:
                bytes[at] = char(bytes[at] ^ 1 << random.below(8));
                break;
            case 1:
                bytes[at] = char(random.next());
                break;
            case 2:
                bytes.replace(at, length, length, "\xff\x00\x7f\x80"[random.below(4)]);
                break;
            case 3:
                bytes.erase(at, length);
                break;
            case 4:
                bytes.insert(at, bytes.substr(at, length));
                break;
            default:
                // A digit elsewhere keeps the JSON whole and changes what it says.
                if (const size_t digit = bytes.find_first_of("0123456789", at); digit != std::string::npos)
                    bytes[digit] = char('0' + random.below(10));
        }
    }
    return bytes;
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
