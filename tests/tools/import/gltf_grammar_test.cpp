// What is taken for plain JSON is JSON to a full parser, too.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_text.h"

#include <string>

#include <gtest/gtest.h>

#include "gltf_samples.h"
#include "sightline/base/random.h"

namespace sightline::test {
using namespace tools;
namespace {

bool plain(const std::string& text) {
    return gltf::plainJson(std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

TEST(GltfGrammar, KnowsPlainJson) {
    for (const char* text :
         {"{}", "[]", " [ ] ", "{\"a\" : [1, -2.5e+10, 0.25, true, false, null, \"\"]}", "3", "\"\\u00e9\\n\\\\\"",
          "[[[]],{}]", "\"\xc3\xa9 \xe4\xb8\xad \xf0\x9f\x8f\xa0\"", "{\"a\":{},\"b\":[{}]}", "-0"})
        EXPECT_TRUE(plain(text)) << text;
}

TEST(GltfGrammar, LeavesTheRestToAParser) {
    for (const char* text : {"",
                             " ",
                             "{",
                             "}",
                             "[1,]",
                             "[,1]",
                             "{\"a\"}",
                             "{\"a\":}",
                             "{a:1}",
                             "{\"a\":1,}",
                             "01",
                             "1.",
                             ".5",
                             "1e",
                             "+1",
                             "nul",
                             "truefalse",
                             "\"",
                             "\"\n\"",
                             "\"\\x\"",
                             "\"\\u12g4\"",
                             "1 2",
                             "[1}",
                             "\"\xc0\x80\"",
                             "\"\xed\xa0\x80\"",
                             "\"\xf4\x90\x80\x80\"",
                             "\"\xe4\xb8\"",
                             "\"\xff\"",
                             "1e999",
                             "\"\\ud800\"",
                             "[1 2]",
                             "{\"a\":1 \"b\":2}",
                             "\"\\"})
        EXPECT_FALSE(plain(text)) << text;
    EXPECT_FALSE(plain(std::string(400, '9'))) << "infinite in double";
    EXPECT_FALSE(plain(std::string("[1\0]", 4)));
    const std::string deep = std::string(256, '[') + std::string(256, ']');
    EXPECT_TRUE(plain(deep));
    EXPECT_FALSE(plain("[" + deep + "]"));
}

TEST(GltfGrammar, AcceptsNothingThatAParserRefuses) {
    const std::string alphabet = "{}[]\",:\\ 0123456789+-.eEtrufalsn\n\t\x01\x7f\xc3\xa9\xe4\xb8\xad\xed\xa0\xf0\x9f";
    std::vector<std::string> texts;
    for (const Sample& sample : gltfSamples()) {
        const bool binary = sample.name.ends_with(".glb");
        texts.push_back(binary ? sample.bytes.substr(20, *reinterpret_cast<const uint32_t*>(&sample.bytes[12]))
                               : sample.bytes);
        EXPECT_TRUE(plain(texts.back())) << sample.name;
    }
    texts.push_back(R"({"a\u0041": [1e5, -0.5, "é\n", null, true, false, {}, [], ""], "b": {"c": {"d": [[]]}}})");
    size_t accepted = 0;
    for (uint64_t seed = 1; seed <= 100'000; ++seed) {
        Random random(seed);
        std::string text = texts[random.below(4) == 0 ? random.below(texts.size()) : texts.size() - 1];
        for (uint64_t left = 1 + random.below(3); left-- > 0 && !text.empty();) {
            const size_t at = random.below(text.size());
            const char c = alphabet[random.below(alphabet.size())];
            if (const uint64_t how = random.below(3); how == 0) text[at] = c;
            else if (how == 1) text.insert(at, 1, c);
            else text.erase(at, 1 + random.below(3));
        }
        if (!plain(text)) continue;
        ++accepted;
        ASSERT_TRUE(Json::accept(text)) << "seed " << seed << ": " << text;
    }
    EXPECT_GT(accepted, 10'000u);
}

}  // namespace
}  // namespace sightline::test
