// Numbers as a reader takes them.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sightline::tools {

/// A number for reading: 4 digits, grouped if it is large.
std::string readable(double value);

}  // namespace sightline::tools
