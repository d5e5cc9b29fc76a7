// Completions in the real shells.
// SPDX-License-Identifier: MIT
#include <set>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

using Set = std::set<std::string>;

bool has(const std::string& program) { return std::system(("command -v " + program + " >/dev/null").c_str()) == 0; }

Set linesOf(const std::string& text) {
    Set lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.insert(line);
    return lines;
}

class Completions : public Tool {
protected:
    /// What the tool offers behind some words, of which the last one is typed in part.
    Set offered(const std::string& words) const { return linesOf(run("completions --words " + words).out); }
};

TEST_F(Completions, OffersVerbsOptionsChoicesAndScenes) {
    EXPECT_EQ(offered("ver"), Set{"verify"});
    EXPECT_EQ(offered("-q inf"), Set{"info"});
    EXPECT_EQ(offered("cull --cam"), Set{"--cameras"});
    EXPECT_EQ(offered("render x --method w"), Set{"warnock"});
    EXPECT_EQ(offered("render x --method=ray"), Set{"--method=raycast"});
    EXPECT_EQ(offered("cull x --skip frustum,o"), Set{"frustum,occlusion"});
    EXPECT_EQ(offered("cull bui"), Set{"building:"});
    EXPECT_EQ(offered("cull made:cy"), Set{"made:cycle"});
    EXPECT_EQ(offered("cull mod"), Set{}) << "files are the shell's";
    EXPECT_EQ(offered("completions f"), Set{"fish"});
    EXPECT_EQ(offered("help rend"), Set{"render"});
    EXPECT_EQ(offered("''"), offered("help ''"));
    for (const char* verb : {"cull", "verify", "render", "info"}) {
        const Set options = offered(std::string(verb) + " --");
        std::istringstream help(run(std::string(verb) + " --help").out);
        size_t count = 0;
        for (std::string line; std::getline(help, line);) {
            if (line.rfind("  -", 0) != 0) continue;
            const size_t at = line.find("--");
            const std::string option = line.substr(at, line.find_first_of(" ,\n", at) - at);
            EXPECT_TRUE(options.count(option)) << verb << " " << option;
            ++count;
        }
        EXPECT_GE(count, 6u);
    }
}

TEST_F(Completions, BashReplacesThePartAtTheCursor) {
    if (!has("bash")) GTEST_SKIP() << "bash is not here";
    const auto replies = [&](const std::string& line, const std::string& parts) {
        write("try.sh", "source <('" SIGHTLINE_TOOL "' completions bash)\nCOMP_LINE=\"" + line +
                            "\" COMP_POINT=${#COMP_LINE}\nCOMP_WORDS=(" + parts +
                            ")\nCOMP_CWORD=$((${#COMP_WORDS[@]}-1))\n_sightline\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
        const std::string command = "cd '" + directory_.string() + "' && bash --norc try.sh >offered 2>&1";
        EXPECT_EQ(std::system(command.c_str()), 0) << read(path("offered"));
        return linesOf(read(path("offered")));
    };
    const std::string tool = SIGHTLINE_TOOL;
    EXPECT_EQ(replies(tool + " rend", tool + " rend"), Set{"render"});
    EXPECT_EQ(replies(tool + " cull made:cy", tool + " cull made : cy"), Set{"cycle"});
    EXPECT_EQ(replies(tool + " cull made:cy", tool + " cull made:cy"), Set{"made:cycle"}) << "where : parts no words";
    EXPECT_TRUE(replies(tool + " cull made:", tool + " cull made :").count("cycle"));
    EXPECT_EQ(replies(tool + " render x --method=ray", tool + " render x --method = ray"), Set{"raycast"});
    EXPECT_TRUE(replies(tool + " completions ", tool + " completions ''").count("zsh"));
    EXPECT_EQ(replies(tool + " cull mod", tool + " cull mod"), Set{""}) << "readline then completes files";
}

TEST_F(Completions, EachShellReadsItsOwn) {
    for (const char* shell : {"bash", "zsh", "fish"}) {
        const Outcome outcome = succeed(std::string("completions ") + shell);
        if (!has(shell)) {
            std::printf("%s is not here: its syntax was not checked\n", shell);
            continue;
        }
        write("script", outcome.out);
        EXPECT_EQ(std::system((std::string(shell) + " -n '" + path("script") + "'").c_str()), 0) << shell;
    }
    expectError("completions csh", 2, "csh");
}

}  // namespace
}  // namespace sightline
