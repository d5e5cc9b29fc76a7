// The windows through which cells are seen, over the picture that they are of.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/window_picture.h"

#include <set>

#include <fmt/core.h>

#include "sightline/tools/report/pictures/canvas.h"

namespace sightline::tools {
namespace {

constexpr Rgb kBoxColour{20, 24, 31};

/// Colours that neighbours in number do not share; told apart on pale ground.
Rgb colourOf(uint32_t cell) {
    constexpr Rgb kColours[] = {{0, 114, 178}, {213, 94, 0},   {0, 158, 115}, {196, 18, 110},
                                {86, 120, 20}, {120, 60, 180}, {0, 130, 150}, {160, 90, 30}};
    return kColours[cell % std::size(kColours)];
}

double areaOf(std::span<const glm::dvec2> outline) {
    double twice = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

struct WindowSum {
    size_t cells = 0;
    double area = 0;
};

WindowSum sumOf(std::span<const CellWindow> windows) {
    std::set<uint32_t> cells;
    WindowSum sum;
    for (const CellWindow& window : windows) {
        cells.insert(window.cell);
        sum.area += areaOf(window.outline);
    }
    sum.cells = cells.size();
    return sum;
}

const char* cellsWord(size_t count) { return count == 1 ? "cell" : "cells"; }

}  // namespace

Image<Rgb> windowPicture(const Image<Rgb>& picture, const glm::dvec2& scale, std::span<const CellWindow> exact,
                         std::span<const CellWindow> boxes) {
    Image<Rgb> pale = picture;
    for (Rgb& pixel : pale.pixels) pixel = Rgb(128 + glm::ivec3(pixel) / 2);
    Canvas canvas(std::move(pale));
    const auto draw = [&](const CellWindow& window, double width, Rgb colour, double opacity) {
        for (size_t i = 0; i < window.outline.size(); ++i)
            canvas.line(window.outline[i] * scale, window.outline[(i + 1) % window.outline.size()] * scale, width,
                        colour, opacity);
    };
    for (const CellWindow& window : exact) {
        std::vector<glm::dvec2> corners;
        for (const glm::dvec2& corner : window.outline) corners.push_back(corner * scale);
        canvas.fill(corners, colourOf(window.cell), 0.08);
    }
    for (const CellWindow& window : boxes) draw(window, 1.0, kBoxColour, 0.35);
    for (const CellWindow& window : exact) draw(window, 2.0, colourOf(window.cell), 0.9);
    return canvas.image();
}

std::string windowText(std::span<const CellWindow> exact, std::span<const CellWindow> boxes) {
    const WindowSum some = sumOf(exact), more = sumOf(boxes);
    if (some.cells == 0)
        return "The eye, or a part of the near plane, is in no cell: everything may be seen, and no window is known.";
    return fmt::format(
        "{} {} seen through {} exact window{} (colours, one for each cell). Boxes (thin lines) reach {} {}"
        " and {:.2f} times the area.",
        some.cells, cellsWord(some.cells), exact.size(), exact.size() == 1 ? "" : "s", more.cells,
        cellsWord(more.cells), some.area > 0 ? more.area / some.area : 1.0);
}

}  // namespace sightline::tools
