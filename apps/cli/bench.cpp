// The verb `bench`: measures this machine with the cases of the benchmark library.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/progress.h"
#include "apps/cli/verbs.h"
#include "bench/bench.h"
#include "sightline/report/output_file.h"

namespace sightline::cli {
namespace {

Status runBench(bench::Options options, const SceneChoice& choice) {
    const std::vector<std::string> names = bench::names();
    if (std::find(names.begin(), names.end(), options.name) == names.end())
        return Error{Error::Kind::kUsage, fmt::format("bench: there is no case \"{}\" (there are: {})", options.name,
                                                      fmt::join(names, ", "))};
    if (!options.json.empty() && options.json != "-")
        if (Status writable = canWriteFile(options.json); !writable) return writable;
    std::optional<Progress> progress(std::in_place, "measuring", "parts", 0);
    options.progress = [&](size_t done, size_t total) {
        if (progress) progress->set(done, total);
        if (done == total) progress.reset();  // clears the bar before the table is printed
    };
    if (choice.names.empty()) return bench::run(options);
    const Result<Scene> scene = loadScene(choice);
    if (!scene) return scene.error();
    options.scene = &scene.value();
    return bench::run(options);
}

}  // namespace

void addBench(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("bench", "measures this machine: each technique beside its plain baseline");
    const auto options = std::make_shared<bench::Options>();
    const auto scene = std::make_shared<SceneChoice>();
    verb->add_option("NAME", options->name, fmt::format("one of: {}", fmt::join(bench::names(), ", ")))->required();
    verb->add_option("--json", options->json, "write the rows as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--scene", scene->names, "measure on this scene instead of the case's own")->type_name("SCENE");
    addImportOptions(*verb, *scene);
    verb->add_option("--repeat", options->repeat, "measurements of each value")
        ->check(CLI::Range(1, 100000))
        ->type_name("N");
    verb->callback([options, scene, &exit_code] {
        const Status done = runBench(*options, *scene);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
