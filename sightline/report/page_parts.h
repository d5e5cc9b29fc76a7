// Pieces that the pages of reports have in common.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sightline {

/// A count for reading, grouped if it is large.
std::string number(uint64_t value);

/// A part of a whole: "12.5 %", "under 0.01 %".
std::string percent(double part, double whole);

/// From the doctype to the opened <body>, with the style.
/// @param title  escaped already
std::string pageHead(const std::string& title);

/// The name of a scene without its directories, escaped.
std::string sceneTitle(const std::string& scene);

/// JSON as a <script> takes it: no text in it ends the element, or begins a comment that would swallow its end.
std::string embedded(std::string_view json);

/// A large value and what it is.
std::string tile(const std::string& value, const std::string& text);

/// The colours of heatMap() with their values.
/// @param full  the value of the brightest colour
std::string heatLegend(double full);

}  // namespace sightline
