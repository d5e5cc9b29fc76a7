// Numbers as a reader takes them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace sightline::tools {

/// A number for reading: 4 digits, grouped if it is large.
std::string readable(double value);

/// "1 frame", "1,234 frames".
/// @param what  one of them
std::string counted(uint64_t count, const char* what);

}  // namespace sightline::tools
