// What holds for a whole run of the tool: how much it says, where to, and whether it is to stop.
// SPDX-License-Identifier: MIT
#include "apps/cli/session.h"

namespace sightline::cli {

bool interrupted() { return false; }
bool quiet() { return false; }

}  // namespace sightline::cli
