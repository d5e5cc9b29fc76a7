// Completions in the real bash, and the manual page in the real groff.
// SPDX-License-Identifier: MIT
#include <set>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

bool has(const std::string& program) { return std::system(("command -v " + program + " >/dev/null").c_str()) == 0; }

std::set<std::string> linesOf(const std::string& text) {
    std::set<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.insert(line);
    return lines;
}

class Completions : public Tool {
protected:
    /// What bash offers for the last of some words, parted as bash parts them.
    std::set<std::string> offered(const std::string& words) const {
        write("try.sh", "source ./bash\nCOMP_WORDS=(" + words +
                            ")\nCOMP_CWORD=$((${#COMP_WORDS[@]}-1))\n_sightline\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
        const std::string command = "cd '" + directory_.string() + "' && bash --norc try.sh >offered 2>&1";
        EXPECT_EQ(std::system(command.c_str()), 0) << read(path("offered"));
        return linesOf(read(path("offered")));
    }
};

TEST_F(Completions, BashOffersVerbsOptionsChoicesAndFiles) {
    if (!has("bash")) GTEST_SKIP() << "bash is not here";
    write("bash", run("completions bash").out);
    write("model.glb", "");
    std::filesystem::create_directory(path("reports"));
    using Set = std::set<std::string>;
    EXPECT_EQ(offered("sightline ver"), Set{"verify"});
    EXPECT_EQ(offered("sightline -q inf"), Set{"info"});
    EXPECT_EQ(offered("sightline cull --cam"), Set{"--cameras"});
    EXPECT_EQ(offered("sightline render x --method w"), Set{"warnock"});
    EXPECT_EQ(offered("sightline render x --method = ray"), Set{"raycast"});
    EXPECT_EQ(offered("sightline cull x --skip frustum,o"), Set{"frustum,occlusion"});
    EXPECT_EQ(offered("sightline cull mod"), Set{"model.glb"});
    EXPECT_EQ(offered("sightline cull x --report rep"), Set{"reports"});
    EXPECT_EQ(offered("sightline cull x --report mod"), Set{""});
    EXPECT_EQ(offered("sightline cull bui"), Set{"building:"});
    EXPECT_EQ(offered("sightline cull made : cy"), Set{"cycle"});
    EXPECT_EQ(offered("sightline completions f"), Set{"fish"});
    EXPECT_EQ(offered("sightline help rend"), Set{"render"});
    EXPECT_EQ(offered("sightline bench fru"), Set{"frustum"});
    // Every long option of every verb's help is offered.
    for (const char* verb : {"cull", "verify", "render", "info", "bench"}) {
        const Set options = offered(std::string("sightline ") + verb + " --");
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

TEST_F(Completions, EachShellReadsItsOwn) {
    for (const char* shell : {"bash", "zsh", "fish"}) {
        const Outcome outcome = run(std::string("completions ") + shell);
        ASSERT_EQ(outcome.exit_code, 0);
        EXPECT_NE(outcome.out.find("depth-format"), std::string::npos) << shell;
        if (!has(shell)) {
            std::printf("%s is not here: its syntax was not checked\n", shell);
            continue;
        }
        write("script", outcome.out);
        EXPECT_EQ(std::system((std::string(shell) + " -n '" + path("script") + "'").c_str()), 0) << shell;
    }
    expectError("completions csh", 2, "csh");
}

TEST_F(Completions, ManualHasEveryVerbAndOption) {
    const std::string page = run("man").out;
    std::istringstream tool(run("--help").out);
    std::vector<std::string> verbs;
    bool in_verbs = false;
    for (std::string line; std::getline(tool, line);) {
        if (line.empty()) in_verbs = false;
        if (in_verbs) verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
        if (line == "Verbs:") in_verbs = true;
    }
    ASSERT_GE(verbs.size(), 9u);
    for (const std::string& verb : verbs) {
        EXPECT_NE(page.find(".SS " + verb + "\n"), std::string::npos) << verb;
        std::istringstream help(run(verb + " --help").out);
        for (std::string line; std::getline(help, line);) {
            if (line.rfind("  -", 0) != 0) continue;
            const size_t at = line.find("--");
            std::string option;
            for (const char c : line.substr(at, line.find_first_of(" ,", at) - at))
                option += c == '-' ? "\\-" : std::string(1, c);
            EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << verb << " " << option;
        }
    }
    if (!has("groff")) GTEST_SKIP() << "groff is not here";
    write("page.1", page);
    const std::string command = "groff -man -Tutf8 -ww -z '" + path("page.1") + "' 2>'" + path("warnings") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read(path("warnings")), "");
}

}  // namespace
}  // namespace sightline
