// What machine this is, as figures name it.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sightline::tools {

/// The processor, the best instruction set in use, and how many cores: "..., AVX2, 2 cores".
std::string machineName();

}  // namespace sightline::tools
