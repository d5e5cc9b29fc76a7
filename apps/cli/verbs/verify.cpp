// The verb `verify`: every cull of every frame against two witnesses, and how tight the answer is.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <memory>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/setting_options.h"
#include "apps/cli/verbs/summary.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// The whole verb. Returns the exit code.
Result<int> runVerify(const Command& verb, RunOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    ApartFiles files = filesRead(options);
    files.write("--json", options.json);
    if (!files.status()) return files.status().error();
    Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (Status writable = canWriteFiles({options.json}); !writable) return writable.error();

    prepareLods(*scene, options);
    CullRun run = cullPath(*scene, *path, options);
    if (run.frames.empty()) return exitCodeOf(run, path->frames.size(), true);
    countChanges(*scene, options, run);
    verifyPath(*scene, options, run);

    printVerdicts(options.json == "-" ? stderr : stdout, run);
    if (Status explained = explainFalseCulls(*scene, options, run); !explained) return explained.error();
    if (!options.json.empty())
        if (Status written = writeText(options.json, cullJson(run, *scene)); !written) return written.error();
    return exitCodeOf(run, path->frames.size(), true);
}

}  // namespace

void addVerify(Command& tool, int& exit_code) {
    Command verb = tool.add_subcommand("verify", "proof run: every cull checked by rays and an id-buffer");
    const auto options = std::make_shared<RunOptions>();
    options->repeat = 1;
    addSceneOptions(*verb, *options);
    addQueryOptions(*verb, *options);
    verb->callback([verb, options, &exit_code] {
        const Result<int> done = runVerify(*verb, *options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
