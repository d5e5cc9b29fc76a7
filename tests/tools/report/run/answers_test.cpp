// What an engine says that it drew is read as it stands, and what cannot be read is told by its line or its place.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/answers.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

/// "0:a,#7;2:": frames with what they drew, keys behind a '#'.
std::string shortOf(const Answers& answers) {
    std::string text;
    for (const AnsweredFrame& frame : answers.frames) {
        text += (text.empty() ? "" : ";") + std::to_string(frame.frame) + ":";
        for (size_t i = 0; i < frame.drawn.size(); ++i)
            text += (i ? "," : "") +
                    (frame.drawn[i].name.empty() ? "#" + std::to_string(frame.drawn[i].key) : frame.drawn[i].name);
    }
    return text;
}

TEST(Answers, AreReadFromBothFormats) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"frames": [{"drawn": ["a", 7]}, {"drawn": []}]})", "0:a,#7;1:"},
        {R"({"frames": [{"frame": 5, "drawn": [1e2]}, {"frame": 2, "visible": [3.0]}]})", "2:#3;5:#100"},
        {"\xEF\xBB\xBF {\"frames\": [{\"drawn\": [\"\\u00e4\\\"\"]}]}", "0:\xC3\xA4\""},
        {R"({"frames": [{"drawn": ["twice", "twice"], "more": {}}], "more": 1})", "0:twice,twice"},
        {R"({"frames": [{"drawn": [18446744073709551615]}]})", "0:#18446744073709551615"},
        {"frame,name\n0,a\n0,b\n3,c\n", "0:a,b;3:c"},
        {"frame,key\r\n1,7\r\n0,8", "0:#8;1:#7"},
        {"frame,name\r0,a\r2,\r", "0:a;2:"},
        {"\xEF\xBB\xBF"
         "frame,name\n\n0,\"a, \"\"b\"\"\nc\"\n\n",
         "0:a, \"b\"\nc"},
        {" frame , key \n 0 , 7 \n", "0:#7"},
        {"frame,name\n0, 7 \n", "0: 7 "},
    };
    for (const auto& [text, expected] : cases) {
        const Result<Answers> read = parseAnswers(text, "f");
        ASSERT_TRUE(read.ok()) << text << "\n" << read.error().message;
        EXPECT_EQ(shortOf(*read), expected) << text;
    }
}

TEST(Answers, KnowTheirPlaces) {
    const Result<Answers> json = parseAnswers(R"({"frames": [{"frame": 4, "visible": [1, 2]}]})", "a.json");
    ASSERT_TRUE(json.ok());
    EXPECT_EQ(json->placeOf(json->frames[0], json->frames[0].drawn[1]), "a.json: frames[0].visible[1]");
    const Result<Answers> csv = parseAnswers("frame,name\r\n0,\"two\r\nlines\"\r\n0,b\r\n", "a.csv");
    ASSERT_TRUE(csv.ok());
    EXPECT_EQ(csv->placeOf(csv->frames[0], csv->frames[0].drawn[0]), "a.csv: line 2");
    EXPECT_EQ(csv->placeOf(csv->frames[0], csv->frames[0].drawn[1]), "a.csv: line 4");
}

TEST(Answers, BringTheirCameras) {
    const Result<Answers> read =
        parseAnswers(R"({"width": 64, "height": 36, "stereo": 0.06, "sections": [[0, 1, 0, -2]],
        "frames": [{"camera": {"eye": [1, 2, 3], "target": [0, 0, 0], "far": null}, "drawn": []},
                   {"camera": {"eye": [4, 5, 6], "target": [0, 0, 0], "near": 0.5}, "drawn": [1]}]})",
                     "f");
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_EQ(read->cameras.frames.size(), 2u);
    EXPECT_EQ(read->cameras.frames[1].eye, glm::dvec3(4, 5, 6));
    EXPECT_EQ(read->cameras.frames[1].z_near, 0.5);
    EXPECT_EQ(*read->width, 64u);
    EXPECT_EQ(*read->height, 36u);
    EXPECT_EQ(read->stereo, 0.06);
    ASSERT_EQ(read->sections.size(), 1u);
    EXPECT_EQ(read->sections[0].w, -2);
}

TEST(Answers, FaultsNameTheirPlace) {
    const std::pair<const char*, const char*> faults[] = {
        {"", "is empty"},
        {"\xEF\xBB\xBF\n", "is empty"},
        {"{", "not JSON: "},
        {"[1, 2]", "not an object"},
        {"{}", "frames: missing"},
        {R"({"frames": 3})", "frames: not an array"},
        {R"({"frames": []})", "no frames"},
        {R"({"frames": [[1]]})", "frames[0]: not an object"},
        {R"({"frames": [{}]})", "frames[0].drawn: missing"},
        {R"({"frames": [{"drawn": {"a": 1}}]})", "frames[0].drawn: not an array"},
        {R"({"frames": [{"drawn": [1], "visible": [1]}]})", "frames[0]: \"drawn\" and \"visible\" both"},
        {R"({"frames": [{"drawn": [true]}]})", "frames[0].drawn[0]: neither a name nor a key"},
        {R"({"frames": [{"drawn": [["a"]]}]})", "frames[0].drawn[0]: neither a name nor a key"},
        {R"({"frames": [{"drawn": [1, ""]}]})", "frames[0].drawn[1]: an empty name"},
        {R"({"frames": [{"drawn": [-1]}]})", "frames[0].drawn[0]: not a whole number"},
        {R"({"frames": [{"drawn": [1.5]}]})", "frames[0].drawn[0]: not a whole number"},
        {R"({"frames": [{"drawn": [1e300]}]})", "frames[0].drawn[0]: not a whole number"},
        {R"({"frames": [{"drawn": [1e999]}]})", "not JSON: "},
        {R"({"frames": [{"frame": 1e12, "drawn": []}]})", "frames[0].frame: not between"},
        {R"({"frames": [{"drawn": []}, {"frame": 0, "drawn": []}]})", "frames[1]: frame 0 is frames[0] already"},
        {R"({"width": 3, "frames": [{"drawn": []}]})", "\"width\" without \"height\""},
        {R"({"width": 3, "height": 99999, "frames": [{"drawn": []}]})", "height: not between"},
        {R"({"frames": [{"camera": {}, "drawn": []}]})", "cameras: frame 0: \"eye\" is missing"},
        {R"({"frames": [{"drawn": []}, {"camera": {}, "drawn": []}]})", "frames[1]: has no \"camera\""},
        {R"({"frames": [{"frame": 1, "camera": {}, "drawn": []}]})", "frames[0].frame: with a \"camera\""},
        {R"({"frames": [{"drawn": ["a)", "not JSON: "},
        {"a,b\n0,1\n", "line 1: not JSON, and the header of CSV is `frame,name` or `frame,key`"},
        {"frame;key\n0;1\n", "line 1: not JSON, and the header"},
        {"\n\nframe\n", "line 3: not JSON, and the header"},
        {"frame,key\n", "no frames"},
        {"frame,key\n0,1,2\n", "line 2: 3 fields, not 2"},
        {"frame,name\n0\n", "line 2: 1 fields, not 2"},
        {"frame,key\n0,x\n", "line 2: key \"x\" is not a whole number"},
        {"frame,key\n0,99999999999999999999\n", "line 2: key \"99999999999999999999\" is not a whole number"},
        {"frame,key\n-1,1\n", "line 2: frame \"-1\" is not a whole number"},
        {"frame,key\n99999999,1\n", "line 2: frame 99999999 is not between"},
        {"frame,name\n0,\"a\n0,b\n", "line 2: a quote that does not close"},
        {"frame,name\n0,\"a\"b\n", "line 2: text behind a closing quote"},
        {"frame,name\n0,a\"b\"\n", "line 2: a quote within a field"},
    };
    for (const auto& [text, fault] : faults) {
        const Result<Answers> read = parseAnswers(text, "f");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.error().message.rfind(std::string("f: ") + fault, 0), 0u)
            << text << "\n"
            << read.error().message << "\nwanted " << fault;
    }
    const Result<Answers> zero = parseAnswers(std::string_view("frame,key\n0,1\0\n", 15), "f");
    ASSERT_FALSE(zero.ok());
    EXPECT_NE(zero.error().message.find("zero byte"), std::string::npos);
}

// Whatever the bytes are: answers, or one line.
TEST(Answers, SurviveBrokenFiles) {
    const std::string seeds[] = {
        R"({"width": 4, "height": 4, "frames": [{"frame": 0, "drawn": ["a \"b\"", 7, 1e3]}, {"frame": 1, "visible": []}]})",
        "\xEF\xBB\xBF"
        "frame,name\r\n0,\"a, \"\"b\"\"\"\r\n1,c\r\n\r\n2,\r\n",
        "frame,key\n0,1\n0,18446744073709551615\n7,3\n",
        R"({"frames": [{"camera": {"eye": [1, 2, 3], "target": [0, 0, 0]}, "drawn": [1]}]})"};
    const char kPieces[] = "\"\"\",,\r\n\n{}[]:0123456789eE-+.\\u\xEF\xFF\t ab";
    Random random(7);
    size_t good = 0;
    for (int i = 0; i < 40000; ++i) {
        std::string text = seeds[random.below(std::size(seeds))];
        for (uint64_t change = random.below(6); change > 0; --change) {
            const size_t at = random.below(text.size() + 1);
            const char piece = kPieces[random.below(sizeof kPieces - 1)];
            switch (random.below(4)) {
                case 0:
                    text.insert(at, 1, piece);
                    break;
                case 1:
                    text.erase(at, random.below(9));
                    break;
                case 2:
                    if (at < text.size()) text[at] = piece;
                    break;
                default:
                    text.insert(at, text.substr(random.below(text.size() + 1), random.below(20)));
                    break;
            }
            if (text.empty()) text = " ";
        }
        const Result<Answers> read = parseAnswers(text, "f");
        if (read.ok()) {
            ++good;
            EXPECT_FALSE(read->frames.empty()) << i;
            for (size_t k = 1; k < read->frames.size(); ++k)
                EXPECT_LT(read->frames[k - 1].frame, read->frames[k].frame) << i;
        } else {
            EXPECT_EQ(read.error().message.rfind("f: ", 0), 0u) << i;
            EXPECT_EQ(read.error().message.find_first_of("\r\n"), std::string::npos) << i << read.error().message;
        }
    }
    EXPECT_GT(good, 5000u);
}

}  // namespace
}  // namespace sightline
