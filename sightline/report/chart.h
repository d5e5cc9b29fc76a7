// Line charts as inline SVG.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sightline {

struct ChartSeries {
    std::string name;
    std::string css_class;       ///< gives the colour
    std::vector<double> values;  ///< one per frame
};

/// Values over frames, on one axis that begins at zero.
struct Chart {
    std::string id;  ///< of the marker that shows the frame in the player: `ID-now`
    std::string title;
    std::string unit;  ///< of the values, for titles and tooltips
    std::vector<ChartSeries> series;
};

/// The chart as an SVG element that scales with its container. Of more than 800 frames, each point is the largest
/// value of its group.
std::string chartSvg(const Chart& chart);

/// A number for reading: 4 digits, grouped if it is large.
std::string readable(double value);

/// The text with the characters that mean something in HTML replaced.
std::string escapeHtml(const std::string& text);

}  // namespace sightline
