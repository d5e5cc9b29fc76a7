// Line and area charts over the frames of a run, as inline SVG.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sightline {

struct ChartSeries {
    std::string name;
    std::string css_class;       ///< gives the colour
    std::vector<double> values;  ///< one per frame; NaN: none
    bool stacked = false;        ///< an area upon those before it; else a line
};

/// Values over frames, on one axis that begins at zero.
struct Chart {
    std::string id;     ///< of the element; the marker of the frame in the player is `ID-now`
    std::string title;  ///< for those who cannot see it
    std::string unit;   ///< of the values
    std::vector<ChartSeries> series;
};

/// The chart as an element that fills its container's width: the lines in an SVG that is stretched, the texts beside
/// them in a size that is not. It takes the focus, and has a line below for the values of a frame. Of more than 800
/// frames, each point is the largest value of its group.
std::string chartHtml(const Chart& chart);

/// A swatch and a name for each series.
std::string chartLegend(const Chart& chart);

/// Where grid lines lie: whole multiples of 1, 2 or 5 times a power of ten, about four of them.
double gridStep(double most);

/// A number for reading: 4 digits, grouped if it is large.
std::string readable(double value);

/// The text with the characters that mean something in HTML replaced.
std::string escapeHtml(const std::string& text);

}  // namespace sightline
