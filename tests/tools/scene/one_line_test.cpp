// Text of unknown origin in one line: nothing that a terminal obeys is left, and all else is as it was.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/one_line.h"

#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/scene.h"

namespace sightline {
using namespace tools;
namespace {

TEST(OneLine, LeavesWhatIsText) {
    for (const std::string text : {"", "Floor 3/Desk", "T\xc3\xbcr \xe2\x82\xac \xf0\x9f\x9a\xaa", "a\"b'c<d>\\"})
        EXPECT_EQ(oneLine(text), text);
    EXPECT_EQ(oneLine("\xd7\x90\xd7\x91"), "\xd7\x90\xd7\x91") << "writing from right to left is text";
}

TEST(OneLine, DropsWhatATerminalObeys) {
    EXPECT_EQ(oneLine("a\x1b[2Jb\nc\r\td\x7f"), "a [2Jb c  d ");
    EXPECT_EQ(oneLine("a\xc2\x9b"
                      "31mb"),
              "a 31mb")
        << "a control character of 8 bits";
    EXPECT_EQ(oneLine("a\xe2\x80\xae"
                      "b\xe2\x81\xa6"
                      "c\xe2\x80\xa9"),
              "a b c ")
        << "the direction of writing";
    EXPECT_EQ(oneLine(std::string_view("a\0b", 3)), "a b");
}

TEST(OneLine, MarksWhatIsNoUtf8) {
    EXPECT_EQ(oneLine("\xff\xfe"), "??");
    EXPECT_EQ(oneLine("a\xc3"), "a?") << "half a character";
    EXPECT_EQ(oneLine("\xc0\x9b"), "??") << "a control character in two bytes";
    EXPECT_EQ(oneLine("\xed\xa0\x80"), "???") << "half a pair";
    EXPECT_EQ(oneLine("\x9b"
                      "31m"),
              "?31m");
}

TEST(OneLine, KeepsTheEndOfALongText) {
    EXPECT_EQ(oneLine("abcdefgh", 8), "abcdefgh");
    EXPECT_EQ(oneLine("abcdefghi", 8), "...efghi");
    EXPECT_EQ(oneLine("abc\xc3\xbc"
                      "efgh",
                      8),
              "...efgh")
        << "never half a character";
    EXPECT_EQ(shortened("abcdefghi", 8), "abcde...");
    EXPECT_EQ(shortened("abcd\xc3\xbc"
                        "efg",
                        8),
              "abcd...");
    EXPECT_EQ(shortened("abcd", 8), "abcd");
}

TEST(OneLine, LeavesBothEndsOfALongText) {
    EXPECT_EQ(withoutMiddle("abcdefghi", 9), "abcdefghi");
    EXPECT_EQ(withoutMiddle("abcdefghijkl", 9), "ab...ijkl");
    EXPECT_EQ(withoutMiddle("a\xc3\xbc"
                            "cdefghijk",
                            9),
              "a...ghijk")
        << "never half a character";
    EXPECT_EQ(withoutMiddle("a\nbcdefghijkl", 9), "a ...ijkl");
    EXPECT_EQ(withoutMiddle("abcdef", 3), "...");
}

TEST(OneLine, IsFitForATerminalWhateverComes) {
    Random random(7);
    for (int i = 0; i < 20000; ++i) {
        std::string text;
        for (uint64_t n = random.below(12); n > 0; --n) text += static_cast<char>(random.below(256));
        for (const std::string& line : {oneLine(text, 8), withoutMiddle(text, 8)}) {
            EXPECT_LE(line.size(), 8u);
            EXPECT_EQ(oneLine(line), line) << "what is fit stays";
            for (const char c : line) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
        }
    }
}

TEST(ObjectPath, OfManyNestedNodesKeepsTheEnd) {
    // Each of n nested nodes may have an object: paths in full would be n * n names.
    Scene scene;
    for (uint32_t i = 0; i < 100000; ++i)
        scene.nodes.push_back({"node " + std::to_string(i), i == 0 ? SceneNode::kNone : i - 1});
    SceneObject object{.name = "lamp", .node = 99999};
    const std::string path = objectPath(scene, object);
    EXPECT_LE(path.size(), kLongestPath);
    EXPECT_EQ(path.substr(0, 4), ".../");
    const std::string end = "node 99998/node 99999/lamp";
    ASSERT_GT(path.size(), end.size());
    EXPECT_EQ(path.substr(path.size() - end.size()), end);
    object.name = std::string(100000, 'x');
    EXPECT_LE(objectPath(scene, object).size(), kLongestPath);
    object.node = 2;
    object.name = "lamp";
    EXPECT_EQ(objectPath(scene, object), "node 0/node 1/node 2/lamp");
}

}  // namespace
}  // namespace sightline
