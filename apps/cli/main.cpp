// The command line tool: verbs, their help, and what the exit code says.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/cli/common.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"

namespace sightline::cli {
namespace {

constexpr const char* kAbout =
    "What can be seen, from any view of any world: conservative visibility, measured and proved.";
constexpr const char* kFooter =
    "Scenes: .glb and .gltf files; city:SEED:OBJECTS (a built-in city, any seed, up to 10,000,000 objects);\n"
    "made:NAME (a few triangles that show where methods fail: cycle, crossing, coplanar, near, walls, eye).\n"
    "Cameras: --cameras, else --frames and --seed, else the scene's own, else 16 seeded ones. A city with --frames\n"
    "and without --seed is walked along its streets.\n"
    "Exit codes: 0 done; 1 the answer is no (verification failed); 2 the arguments are wrong; 3 an input cannot be\n"
    "read; 4 an output cannot be written.";

/// The verb that was being parsed, as "sightline cull".
std::string verbOf(const CLI::App& tool) {
    const auto chosen = tool.get_subcommands();
    return "sightline" + (chosen.empty() ? std::string() : " " + chosen.front()->get_name());
}

std::string commandLine(int count, char** words) {
    std::string line = "sightline";
    for (int i = 1; i < count; ++i) line += " " + quoted(words[i]);
    return line;
}

int runTool(int count, char** words) {
    CLI::App tool(kAbout, "sightline");
    tool.footer(kFooter);
    tool.set_version_flag("--version", "sightline " SIGHTLINE_VERSION);
    tool.require_subcommand(1);
    int exit_code = kDone;
    addCull(tool, exit_code);
    addVerify(tool, exit_code);
    addRender(tool, exit_code);
    addExplain(tool, exit_code);
    addReport(tool, exit_code);
    addInfo(tool, exit_code);
    addBench(tool, exit_code);
    SessionOptions session;
    addSessionOptions(tool, session);
    for (CLI::App* verb : tool.get_subcommands({})) addSessionOptions(*verb, session);
    tool.parse_complete_callback([&] {
        if (Status begun = beginSession(session, "sightline " SIGHTLINE_VERSION, commandLine(count, words)); !begun)
            throw CLI::RuntimeError(report(begun.error()));
    });
    if (count <= 1) {
        std::fputs(tool.help().c_str(), stderr);
        return kWrongArguments;
    }
    const std::string first = words[1];
    const auto named = tool.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == first; });
    if (first.substr(0, 1) != "-" && named.empty())
        return report({Error::Kind::kUsage, "there is no verb \"" + first + "\" (see sightline --help)"});
    try {
        tool.parse(count, words);
    } catch (const CLI::RuntimeError& error) { return error.get_exit_code(); } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return tool.exit(error);  // --help and --version
        return report({Error::Kind::kUsage, std::string(error.what()) + " (see " + verbOf(tool) + " --help)"});
    }
    return exit_code;
}

}  // namespace
}  // namespace sightline::cli

int main(int count, char** words) {
    using sightline::Error;
    using namespace sightline::cli;
    openSession();
    int exit_code = kDone;
    try {
        exit_code = runTool(count, words);
    } catch (const std::bad_alloc&) {
        exit_code = report({Error::Kind::kInput, "not enough memory for this scene"});
    } catch (const std::exception& error) {
        // What a full or closed standard output throws is endSession()'s concern.
        if (!std::ferror(stdout)) exit_code = report({Error::Kind::kInput, error.what()});
    }
    return endSession(exit_code);
}
