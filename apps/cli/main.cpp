// The command line tool `sightline`. Verbs that are rarely asked for are in programs beside it.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"

int main(int count, char** words) { return sightline::cli::toolMain(count, words, {}); }
