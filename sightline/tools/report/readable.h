// Numbers as a reader takes them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace sightline::tools {

/// A number for reading: so many digits, more if its whole part has more, which is grouped; no exponent, no zeros at the
/// end. What rounding leaves of zero is 0.
std::string readable(double value, int digits = 4);

/// "1 frame", "1,234 frames".
/// @param what  one of them
std::string counted(uint64_t count, const char* what);

}  // namespace sightline::tools
