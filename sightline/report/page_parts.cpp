// Pieces that the pages of reports have in common.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_parts.h"

#include <cmath>

#include <fmt/core.h>

#include "sightline/report/chart.h"
#include "sightline/report/page_assets.h"
#include "sightline/report/picture.h"

namespace sightline {

std::string number(uint64_t value) { return readable(static_cast<double>(value)); }

std::string percent(double part, double whole) {
    const double value = whole > 0 ? 100 * part / whole : 0;
    return value > 0 && value < 0.01 ? "under 0.01 %" : fmt::format("{:.{}f} %", value, value < 1 ? 2 : 1);
}

std::string pageHead(const std::string& title) {
    return fmt::format(
        R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{} – Sightline</title><style>{}</style></head><body>
)html",
        title, kPageStyle);
}

std::string sceneTitle(const std::string& scene) {
    const size_t slash = scene.rfind('/');
    return escapeHtml(slash == std::string::npos ? scene : scene.substr(slash + 1));
}

std::string embedded(std::string_view json) {
    std::string out;
    out.reserve(json.size());
    for (const char c : json) out += c == '<' ? std::string_view("\\u003c") : std::string_view(&c, 1);
    return out;
}

std::string tile(const std::string& value, const std::string& text) {
    return fmt::format("<div class=\"tile\"><b>{}</b><span class=\"soft\">{}</span></div>", value, text);
}

std::string heatLegend(double full) {
    std::string stops, ticks;
    for (int i = 0; i <= 12; ++i) {
        const Rgb c = heatColour(i / 12.0);
        stops += fmt::format("{}rgb({},{},{})", i ? "," : "", c.x, c.y, c.z);
    }
    for (const double part : {0.0, 0.125, 0.25, 0.5, 1.0}) {
        const double value = part * full, place = std::sqrt(part);  // the colours stand for square roots
        const bool whole = value >= 10 || value == std::floor(value);
        ticks += fmt::format("<span style=\"left:{:.2f}%;transform:translateX(-{:.0f}%)\">{}{}</span>", 100 * place,
                             part == 0.0 ? 0.0
                             : part < 1  ? 50.0
                                         : 100.0,
                             whole ? fmt::format("{:.0f}", value) : fmt::format("{:.2g}", value),
                             part < 1 ? "" : " or more");
    }
    return fmt::format(
        "<div class=\"bar\" style=\"background:linear-gradient(90deg,{})\" role=\"img\" aria-label=\"Colour "
        "scale\"></div>\n<div class=\"scale heatscale\">{}</div>",
        stops, ticks);
}

}  // namespace sightline
