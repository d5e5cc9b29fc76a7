// The verb `calibrate`: what a cluster's test and a triangle cost on this machine.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/profile/facing_costs.h"
#include "sightline/tools/report/run/calibration_json.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct CalibrateOptions {
    std::string json;
};

Result<int> runCalibrate(const CalibrateOptions& options) {
    if (Status writable = canWriteFiles({options.json}); !writable) return writable.error();
    const std::string machine = machineName();
    const FacingCosts costs = measureFacingCosts();
    tell(options.json == "-" ? stderr : stdout,
         fmt::format("{}\n"
                     "a cluster's test                    {:8.2f} ns\n"
                     "a back face that is dropped         {:8.2f} ns   a test is worth {:.3g} triangles\n"
                     "a back face that is drawn           {:8.2f} ns   a test is worth {:.3g} triangles\n",
                     machine, costs.test, costs.dropped, costs.testInTriangles(ShadingCost::kCheap), costs.drawn,
                     costs.testInTriangles(ShadingCost::kDear)));
    if (!options.json.empty())
        if (Status written = writeText(options.json, calibrationJson(costs, machine)); !written) return written.error();
    return kDone;
}

}  // namespace

void addCalibrate(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "calibrate");
    const auto options = std::make_shared<CalibrateOptions>();
    verb->add_option("--json", options->json, "write the figures as JSON (-: standard output): for --calibration")
        ->type_name("FILE");
    verb->callback([options, &exit_code] {
        const Result<int> done = runCalibrate(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
