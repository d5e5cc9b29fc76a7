// The windows of a frame, for pictures: the part of the image that each cell is seen through, as an outline.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/window_overlay.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Takes planes to the image: a plane through the sight lines is a x + b y + c >= 0 there.
class ImageLines {
public:
    explicit ImageLines(const View& view) {
        const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
        const auto row = [&](int r) { return glm::dvec3(m[0][r], m[1][r], m[2][r]); };
        parallel_ = isOrthographic(view);
        scale_ = parallel_ ? 1 / m[3][3] : 1;
        shift_ = {m[3][0], m[3][1]};
        from_planes_ = glm::inverse(glm::dmat3(row(0), row(1), parallel_ ? row(2) : row(3)));
    }
    glm::dvec3 line(const glm::dvec4& plane) const {
        glm::dvec3 line = from_planes_ * glm::dvec3(plane);
        if (parallel_) {
            line.z = plane.w - line.x * shift_.x - line.y * shift_.y;
            line.x /= scale_;
            line.y /= scale_;
        }
        return line;
    }

private:
    bool parallel_ = false;
    double scale_ = 1;
    glm::dvec2 shift_{0.0};
    glm::dmat3 from_planes_;
};

void cut(std::vector<glm::dvec2>& outline, const glm::dvec3& line) {
    std::vector<glm::dvec2> left;
    const auto at = [&](const glm::dvec2& p) { return line.x * p.x + line.y * p.y + line.z; };
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        if (at(a) >= 0) left.push_back(a);
        if ((at(a) >= 0) != (at(b) >= 0)) left.push_back(a + at(a) / (at(a) - at(b)) * (b - a));
    }
    outline.swap(left);
}

}  // namespace

WindowOverlay::WindowOverlay(const RunOptions& options) : graph_(options.opened->file.cellSpace()) {
    const CellSpace space = options.opened->file.cellSpace();
    doors_.resize(space.doors.size());
    for (const DoorAsked& asked : options.visibility.doors)
        for (size_t i = 0; i < space.doors.size(); ++i)
            if (space.doors[i].name == asked.name) {
                doors_[i].open = static_cast<float>(asked.open);
                break;
            }
}

std::vector<CellWindow> WindowOverlay::windows(const View& view, PortalWindows kind, uint32_t depth) const {
    std::vector<CellWindow> out;
    PortalSettings settings;
    settings.windows = kind;
    settings.depth = depth;
    PortalFlood flood;
    if (!isUsable(view) || !flood.run(graph_, view, settings, doors_)) return out;
    const ImageLines lines(view);
    for (const SeenCell& seen : flood.cells()) {
        CellWindow window;
        window.cell = seen.cell;
        window.outline = {
            {seen.left, seen.bottom}, {seen.right, seen.bottom}, {seen.right, seen.top}, {seen.left, seen.top}};
        for (uint32_t i = 0; i < seen.plane_count; ++i)
            cut(window.outline, lines.line(flood.planes()[seen.first_plane + i]));
        for (glm::dvec2& corner : window.outline)
            corner = {0.5 * (corner.x + 1) * view.width, 0.5 * (1 - corner.y) * view.height};
        out.push_back(std::move(window));
    }
    return out;
}

}  // namespace sightline::cli
