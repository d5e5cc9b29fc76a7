// What clusters cost, on the command line: --cluster-test, --calibration, --dear-shading.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/cluster_options.h"

#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "sightline/tools/report/run/calibration_json.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace tools;

void addClusterOptions(CLI::App& verb, RunOptions& options) {
    verb.add_option_function<double>(
            "--cluster-test",
            [&options](const double& test) {
                if (!(test > 0.0) || std::isinf(test))
                    throw CLI::ValidationError("--cluster-test", "wants a number above 0");
                options.cluster_test = test;
            },
            fmt::format("what a cluster's test costs, in triangles: for the stage clusters [{}]",
                        RunOptions().cluster_test))
        ->type_name("T")
        ->group("Culling");
    verb.add_option("--calibration", options.calibration, "takes that from a file of calibrate")
        ->type_name("FILE")
        ->group("Culling");
    verb.add_flag("--dear-shading", options.dear_shading, "of the calibration, what dear shading says")
        ->group("Culling");
}

Status finishClusterOptions(RunOptions& options) {
    if (options.calibration.empty()) {
        if (!options.dear_shading) return success();
        return Error{Error::Kind::kUsage, "--dear-shading: says which figure of --calibration is taken"};
    }
    const Result<std::string> text = readTextFile(options.calibration);
    if (!text) return text.error();
    const Result<FacingCosts> costs = parseCalibration(*text, options.calibration);
    if (!costs) return costs.error();
    options.cluster_test = costs->testInTriangles(options.dear_shading ? ShadingCost::kDear : ShadingCost::kCheap);
    return success();
}

std::string clusterOptionsOf(double cluster_test) {
    return cluster_test == 0 || cluster_test == RunOptions().cluster_test
               ? ""
               : fmt::format(" --cluster-test {}", cluster_test);
}

}  // namespace sightline::cli
