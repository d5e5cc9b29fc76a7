// Text of unknown origin, made fit for a line that a terminal shows.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sightline::tools {

/// The text without what a terminal would obey: control characters of 7 and of 8 bits, line ends among them, and those
/// that turn the direction of writing are spaces; bytes that are no UTF-8 are '?'. Nothing else changes.
/// @param most  of a longer text only the end is left, behind "..."; never half a character  [bytes] [>= 3]
std::string oneLine(std::string_view text, size_t most = std::string_view::npos);

/// The same, but of a longer text the beginning and the end are left, with "..." between them.
std::string withoutMiddle(std::string_view text, size_t most);

/// The beginning of a text of one line, with "..." behind it if anything is left out; never half a character.
/// @param most  [bytes] [>= 3]
std::string shortened(std::string_view text, size_t most);

/// The texts with something between each two.
std::string joined(const std::vector<std::string>& texts, std::string_view between);

/// "a + b"; of more than four names the first three and a count: "a + b + c + 126 more".
std::string joinedFew(const std::vector<std::string>& names);

}  // namespace sightline::tools
