// Line and area charts over the frames of a run, as inline SVG.
// SPDX-License-Identifier: MIT
#include "sightline/report/chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace sightline {
namespace {

constexpr double kSide = 1000;  // of the drawing, which is stretched to its container
constexpr size_t kMostPoints = 800;

double xOf(double frame, size_t frames) { return kSide * (frames > 1 ? frame / static_cast<double>(frames - 1) : 0.5); }

/// What each series is drawn at: stacked ones upon one another.
std::vector<std::vector<double>> tops(const Chart& chart, size_t frames) {
    std::vector<double> below(frames, 0.0);
    std::vector<std::vector<double>> out;
    for (const ChartSeries& series : chart.series) {
        std::vector<double> values = series.values;
        values.resize(frames, std::nan(""));
        if (series.stacked)
            for (size_t i = 0; i < frames; ++i) below[i] = values[i] = below[i] + (values[i] > 0 ? values[i] : 0);
        out.push_back(std::move(values));
    }
    return out;
}

/// The points of a line, of groups of frames if there are many: "x,y x,y".
std::vector<std::string> pointsOf(const std::vector<double>& values, double most) {
    const size_t frames = values.size(), group = (frames + kMostPoints - 1) / kMostPoints;
    std::vector<std::string> points;
    for (size_t i = 0; i < frames; i += group) {
        double value = std::nan("");
        for (size_t k = i; k < std::min(i + group, frames); ++k)
            if (!(value >= values[k])) value = values[k];
        if (!std::isfinite(value)) continue;
        points.push_back(fmt::format("{:.1f},{:.1f}", xOf(static_cast<double>(i), frames), kSide * (1 - value / most)));
    }
    return points;
}

std::string joined(const std::vector<std::string>& points) {
    std::string out;
    for (const std::string& point : points) out += (out.empty() ? "" : " ") + point;
    return out;
}

std::string lineOf(const ChartSeries& series, const std::vector<double>& values, double most) {
    const std::vector<std::string> points = pointsOf(values, most);
    std::string dots;
    if (values.size() <= 100)
        for (const std::string& point : points) dots += "M" + point + "h0";
    return fmt::format("<g class=\"{}\"><polyline points=\"{}\"/><path class=\"dots\" d=\"{}\"/></g>", series.css_class,
                       joined(points), dots);
}

/// The area of a stacked series reaches down to the axis; what lies below is drawn over it.
std::string areaOf(const ChartSeries& series, const std::vector<double>& values, double most) {
    const std::vector<std::string> points = pointsOf(values, most);
    if (points.empty()) return "";
    const auto x = [](const std::string& point) { return point.substr(0, point.find(',')); };
    // A single frame has no width: it is drawn as a column.
    const std::string left = points.size() > 1 ? x(points.front()) : "470.0",
                      right = points.size() > 1 ? x(points.back()) : "530.0";
    const std::string top = points.size() > 1 ? joined(points)
                                              : left + points[0].substr(points[0].find(',')) + " " + right +
                                                    points[0].substr(points[0].find(','));
    return fmt::format("<g class=\"{}\"><polygon points=\"{},1000 {} {},1000\"/></g>", series.css_class, left, top,
                       right);
}

std::string ticks(double most, double step, size_t frames) {
    std::string out;
    for (double value = 0; value <= most * 1.0001; value += step)
        out += fmt::format("<span class=\"tick up\" style=\"bottom:{:.2f}%\">{}</span>", 100 * value / most,
                           readable(value));
    const size_t last = frames - 1;
    const auto every = static_cast<size_t>(std::max(1.0, gridStep(static_cast<double>(std::max<size_t>(last, 4)))));
    for (size_t frame = 0; frame <= last; frame += every)
        out += fmt::format("<span class=\"tick along\" style=\"left:{:.2f}%\">{}</span>",
                           xOf(static_cast<double>(frame), frames) / kSide * 100, frame);
    return out;
}

std::string grid(double most, double step) {
    std::string path;
    for (double value = 0; value <= most * 1.0001; value += step)
        path += fmt::format("M0,{:.1f}H1000", kSide * (1 - value / most));
    return "<path class=\"grid\" d=\"" + path + "\"/>";
}

}  // namespace

double gridStep(double most) {
    const double rough = most / 4, power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough) return factor * power;
    return 10 * power;
}

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

std::string chartLegend(const Chart& chart) {
    std::string out = "<div class=\"legend\">";
    for (const ChartSeries& series : chart.series)
        out += fmt::format("<span><i class=\"{}\"></i>{}</span>", series.css_class, escapeHtml(series.name));
    return out + "</div>";
}

std::string chartHtml(const Chart& chart) {
    size_t frames = 0;
    for (const ChartSeries& series : chart.series) frames = std::max(frames, series.values.size());
    if (frames == 0) return {};
    const std::vector<std::vector<double>> drawn = tops(chart, frames);
    double most = 0;
    for (const std::vector<double>& values : drawn)
        for (const double value : values)
            if (std::isfinite(value)) most = std::max(most, value);
    const double step = gridStep(most > 0 ? most : 1);
    most = step * std::ceil((most > 0 ? most : 1) / step - 1e-9);
    std::string lines;
    for (size_t i = drawn.size(); i-- > 0;)  // areas from the tallest down, then the lines
        if (chart.series[i].stacked) lines += areaOf(chart.series[i], drawn[i], most);
    for (size_t i = 0; i < drawn.size(); ++i)
        if (!chart.series[i].stacked) lines += lineOf(chart.series[i], drawn[i], most);
    return fmt::format(
        "<div class=\"plot\" id=\"{0}\" tabindex=\"0\" role=\"slider\" aria-label=\"{1}\" aria-valuemin=\"0\" "
        "aria-valuemax=\"{2}\" aria-valuenow=\"0\"><div class=\"area\"><svg viewBox=\"0 0 1000 1000\" "
        "preserveAspectRatio=\"none\" aria-hidden=\"true\">{3}{4}</svg>{5}<i class=\"now\" id=\"{0}-now\"></i>"
        "<i class=\"at\"></i></div></div><p class=\"readout\" id=\"{0}-values\"></p>",
        chart.id, escapeHtml(chart.title), frames - 1, grid(most, step), lines, ticks(most, step, frames));
}

}  // namespace sightline
