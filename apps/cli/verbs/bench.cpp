// The verb `bench`: measures this machine with the cases of the benchmark library.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "bench/bench.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Checks what single options cannot.
Status check(const Command& verb, bench::Options& options, const std::string& size) {
    const std::vector<std::string> names = bench::names();
    if (std::find(names.begin(), names.end(), options.name) == names.end())
        return usageError(
            fmt::format("bench: there is no case \"{}\" (there are: {})", options.name, joined(names, ", ")));
    if (options.proof.wanted && options.name != "occlusion") return usageError("--verify goes with the case occlusion");
    if (!options.only.empty() && options.name != "occlusion") return usageError("--only goes with the case occlusion");
    for (const char* option : {"--jitters", "--rays-per-box", "--first-cameras"})
        if (verb.count(option) > 0 && !options.proof.wanted)
            return usageError(fmt::format("{} goes with --verify", option));
    for (const char* option : {"--scene", "--repeat"})
        if (verb.count(option) > 0 && options.proof.wanted)
            return usageError(fmt::format("--verify excludes {}", option));
    const std::vector<std::string> scenes = bench::sceneNames();
    for (const std::string& name : options.only)
        if (std::find(scenes.begin(), scenes.end(), name) == scenes.end())
            return usageError(
                fmt::format("--only: there is no scene \"{}\" (there are: {})", name, joined(scenes, ", ")));
    if (verb.count("--size") > 0)
        if (Status read = readSize("--size", size, options.proof.width, options.proof.height); !read) return read;
    return canWriteFiles({options.json});
}

/// Returns the exit code.
Result<int> runBench(const Command& verb, bench::Options options, const SceneChoice& choice, const std::string& size) {
    if (Status good = check(verb, options, size); !good) return good.error();
    std::optional<Progress> progress(std::in_place, options.proof.wanted ? "judging" : "measuring", "parts", 0);
    options.progress = [&](size_t done, size_t total) {
        if (progress) progress->set(done, total);
        if (done == total) progress.reset();  // clears the bar before the table is printed
    };
    std::optional<Result<Scene>> scene;
    if (!choice.names.empty()) {
        scene = loadScene(choice);
        if (!*scene) return scene->error();
        options.scene = &scene->value();
    }
    const Result<bool> good = bench::run(options);
    if (!good) return good.error();
    return *good ? kDone : kAnswerIsNo;
}

void addProofOptions(Command& verb, bench::ProofOptions& proof, std::string& size) {
    verb.add_flag("--verify", proof.wanted,
                  "(occlusion) look for every hidden box by jittered samples and aimed rays, on every instruction set; "
                  "exit code 1 if one is seen. Takes minutes");
    verb.add_option("--size", size, "(--verify) of the viewport [pixels] (default: 1280x720 and 1920x1080)")
        ->type_name("WxH");
    verb.add_option("--jitters", proof.jitters, "(--verify) pictures of 4x4 samples a pixel, each shifted otherwise")
        ->check(Range{0u, 1024u})
        ->type_name("N")
        ->capture_default_str();
    verb.add_option("--rays-per-box", proof.rays,
                    "(--verify) aimed at each hidden box, half of them past edges before it")
        ->check(Range{0u, 1000000u})
        ->type_name("N")
        ->capture_default_str();
    verb.add_option("--first-cameras", proof.cameras, "(--verify) only so many of each scene (default: all)")
        ->check(Range{1u, 1000u})
        ->type_name("N");
}

}  // namespace

void addBench(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "bench");
    const auto options = std::make_shared<bench::Options>();
    const auto scene = std::make_shared<SceneChoice>();
    verb->add_option("NAME", options->name, fmt::format("one of: {}", joined(bench::names(), ", ")))->required();
    verb->add_option("--json", options->json, "write the rows as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--scene", scene->names, "measure on this scene instead of the case's own")->type_name("SCENE");
    addImportOptions(*verb, *scene);
    verb->add_option("--repeat", options->repeat, "measurements of each value")
        ->check(Range{1, 100000})
        ->type_name("N");
    verb->add_option("--only", options->only, "(occlusion) these of the case's own scenes, separated by commas")
        ->delimiter(',')
        ->type_name("NAMES");
    verb->add_option("--occlusion-size", options->occlusion_size, "longer side of the occlusion buffer [pixels]")
        ->check(Range{1u, 8192u})
        ->type_name("N");
    const auto size = std::make_shared<std::string>();
    addProofOptions(*verb, options->proof, *size);
    verb->callback([verb, options, scene, size, &exit_code] {
        const Result<int> done = runBench(*verb, *options, *scene, *size);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
