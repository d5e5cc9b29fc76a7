// The program `sightline-lab`: the tool with its verbs that measure, export, render and replay.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"
#include "apps/cli/verbs/verbs.h"

int main(int count, char** words) {
    using namespace sightline::cli;
    return toolMain(count, words,
                    {{"render", addRender},
                     {"sight", addSight},
                     {"replay", addReplay},
                     {"check", addCheck},
                     {"judge", addJudge},
                     {"export", addExport},
                     {"calibrate", addCalibrate},
                     {"profile", addProfile},
                     {"advise", addAdvise},
                     {"report", addReport},
                     {"config"}});
}
