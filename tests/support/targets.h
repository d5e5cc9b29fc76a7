// Runs a piece of a test once per instruction set that this machine has, the scalar one included.
// SPDX-License-Identifier: MIT
#pragma once

#include <hwy/targets.h>

#include <string>

namespace sightline::test {

/// Calls `body` with the name of each instruction set while that one is in force; returns how many there were.
template <class Body>
int forEachTarget(Body body) {
    int count = 0;
    for (int64_t left = hwy::SupportedTargets(); left; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        body(std::string(hwy::TargetName(left & -left)));
        hwy::SetSupportedTargetsForTest(0);
        ++count;
    }
    return count;
}

}  // namespace sightline::test
