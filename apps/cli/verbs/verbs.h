// The verbs of the command line tool, one file each.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/session.h"

namespace sightline::cli {

/// Each adds its verb with its options to the tool. The verb's action sets the exit code.
void addCull(Command& tool, int& exit_code);
void addVerify(Command& tool, int& exit_code);
void addRender(Command& tool, int& exit_code);
void addExplain(Command& tool, int& exit_code);
void addSight(Command& tool, int& exit_code);
void addVis(Command& tool, int& exit_code);
void addBake(Command& tool, int& exit_code);
void addExport(Command& tool, int& exit_code);
void addCheck(Command& tool, int& exit_code);
void addJudge(Command& tool, int& exit_code);
void addReplay(Command& tool, int& exit_code);
void addCalibrate(Command& tool, int& exit_code);
void addProfile(Command& tool, int& exit_code);
void addAdvise(Command& tool, int& exit_code);
void addReport(Command& tool, int& exit_code);
void addInfo(Command& tool, int& exit_code);
void addBench(Command& tool, int& exit_code);
void addView(Command& tool, int& exit_code);

}  // namespace sightline::cli
