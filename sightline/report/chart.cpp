// Line charts as inline SVG.
// SPDX-License-Identifier: MIT
#include "sightline/report/chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace sightline {
namespace {

constexpr double kWidth = 640, kHeight = 220, kLeft = 62, kRight = 12, kTop = 14, kBottom = 30;
constexpr size_t kMostPoints = 800;

/// 1, 2 or 5 times a power of ten: the distance of about four grid lines.
double gridStep(double most) {
    const double rough = most / 4, power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough) return factor * power;
    return 10 * power;
}

double xOf(double frame, size_t frames) {
    return kLeft + (kWidth - kLeft - kRight) * (frames > 1 ? frame / static_cast<double>(frames - 1) : 0.5);
}

std::string gridLines(double most, double step) {
    std::string out;
    for (double value = 0; value <= most * 1.0001; value += step) {
        const double y = kHeight - kBottom - (kHeight - kTop - kBottom) * value / most;
        out += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
            "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
            kLeft, kWidth - kRight, y, y, kLeft - 8, y + 4, readable(value));
    }
    return out;
}

std::string frameTicks(size_t frames) {
    std::string out;
    const size_t last = frames - 1;
    const size_t step =
        std::max<size_t>(1, static_cast<size_t>(gridStep(static_cast<double>(std::max<size_t>(last, 4)))));
    for (size_t frame = 0; frame <= last; frame += step)
        out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                           xOf(static_cast<double>(frame), frames), kHeight - 10, frame);
    return out;
}

std::string seriesLine(const ChartSeries& series, double most) {
    const size_t frames = series.values.size(), group = (frames + kMostPoints - 1) / kMostPoints;
    std::string points, marks;
    for (size_t i = 0; i < frames; i += group) {
        double value = series.values[i];
        for (size_t k = i; k < std::min(i + group, frames); ++k) value = std::max(value, series.values[k]);
        const double x = xOf(static_cast<double>(i), frames);
        const double y = kHeight - kBottom - (kHeight - kTop - kBottom) * value / most;
        points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x, y);
        if (frames <= 100) marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\"/>", x, y);
    }
    return fmt::format("<g class=\"{}\"><polyline points=\"{}\"/>{}</g>", series.css_class, points, marks);
}

/// Wide invisible columns that show the values of a frame when pointed at.
std::string tooltips(const Chart& chart, size_t frames) {
    std::string out;
    const size_t group = (frames + kMostPoints - 1) / kMostPoints;
    const double column = (kWidth - kLeft - kRight) / static_cast<double>(std::max<size_t>(frames / group, 1));
    for (size_t i = 0; i < frames; i += group) {
        std::string text = fmt::format("frame {}", i);
        for (const ChartSeries& series : chart.series)
            text += fmt::format("\n{}: {} {}", series.name, readable(series.values[i]), chart.unit);
        out += fmt::format(
            "<rect class=\"hit\" data-frame=\"{}\" x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\">"
            "<title>{}</title></rect>",
            i, xOf(static_cast<double>(i), frames) - column / 2, kTop, column, kHeight - kTop - kBottom,
            escapeHtml(text));
    }
    return out;
}

}  // namespace

std::string readable(double value) {
    if (!std::isfinite(value)) return "–";
    if (std::abs(value) < 1000) return fmt::format("{:.4g}", value);
    std::string text = fmt::format("{:.0f}", value);
    const size_t first = text[0] == '-' ? 1 : 0;
    for (size_t place = text.size(); place > first + 3; place -= 3) text.insert(place - 3, 1, ',');
    return text;
}

std::string escapeHtml(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string chartSvg(const Chart& chart) {
    double most = 0;
    size_t frames = 0;
    for (const ChartSeries& series : chart.series) {
        frames = std::max(frames, series.values.size());
        for (const double value : series.values) most = std::max(most, value);
    }
    if (frames == 0) return {};
    const double step = gridStep(most > 0 ? most : 1);
    most = step * std::ceil((most > 0 ? most : 1) / step - 1e-9);
    std::string out = fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                                  kHeight, escapeHtml(chart.title));
    out += gridLines(most, step) + frameTicks(frames);
    out += fmt::format(
        "<line class=\"now\" id=\"{}-now\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\" data-left=\"{}\" "
        "data-right=\"{}\"/>",
        chart.id, kLeft, kLeft, kTop, kHeight - kBottom, xOf(0, frames), xOf(static_cast<double>(frames - 1), frames));
    for (const ChartSeries& series : chart.series) out += seriesLine(series, most);
    return out + tooltips(chart, frames) + "</svg>";
}

}  // namespace sightline
