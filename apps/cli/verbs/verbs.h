// The verbs of the command line tool, one file each.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cli/shell/session.h"

namespace CLI {
class App;
}

namespace sightline::cli {

/// Each adds its verb with its options to the tool. The verb's action sets the exit code.
void addCull(CLI::App& tool, int& exit_code);
void addVerify(CLI::App& tool, int& exit_code);
void addRender(CLI::App& tool, int& exit_code);
void addExplain(CLI::App& tool, int& exit_code);
void addSight(CLI::App& tool, int& exit_code);
void addVis(CLI::App& tool, int& exit_code);
void addBake(CLI::App& tool, int& exit_code);
void addExport(CLI::App& tool, int& exit_code);
void addCheck(CLI::App& tool, int& exit_code);
void addReplay(CLI::App& tool, int& exit_code);
void addCalibrate(CLI::App& tool, int& exit_code);
void addProfile(CLI::App& tool, int& exit_code);
void addAdvise(CLI::App& tool, int& exit_code);
void addReport(CLI::App& tool, int& exit_code);
void addInfo(CLI::App& tool, int& exit_code);
void addBench(CLI::App& tool, int& exit_code);
void addView(CLI::App& tool, int& exit_code);

}  // namespace sightline::cli
