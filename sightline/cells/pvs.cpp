// What may be seen from where the eye is: the rows of visibility of the cells that it may be in, together.
// SPDX-License-Identifier: MIT
#include "sightline/cells/pvs.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {

bool startCells(const PortalGraph& graph, const View& view, Array<uint32_t>& cells) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    const glm::dvec3 eye = eyePosition(view);
    const glm::dmat4 back = glm::inverse(view.projection * glm::dmat4(glm::dmat3(view.view)));
    const double wide_x = 1.0 + 2.0 * view.jitter / view.width, wide_y = 1.0 + 2.0 * view.jitter / view.height;
    glm::dvec3 points[std::max(5u, ViewOutline::kMost)];
    uint32_t count = 0;
    double farthest = 0;
    for (const double x : {-wide_x, wide_x})
        for (const double y : {-wide_y, wide_y}) {
            const glm::dvec4 corner = back * glm::dvec4(x, y, -1.0, 1.0);
            points[count++] = eye + glm::dvec3(corner) / corner.w;
            farthest = std::max(farthest, glm::length(glm::dvec3(corner) / corner.w));
        }
    if (!isOrthographic(view)) points[count++] = eye;
    if (view.through.count > 0) count = view.through.count;  // sight lines begin there
    for (uint32_t i = 0; i < view.through.count; ++i) points[i] = view.through.points[i];
    if (view.eye_radius > 0.0 && view.through.count == 0)
        return graph.cellsAround({&eye, 1}, view.eye_radius + 1.000001 * farthest, cells);
    return graph.cellsAround({points, count}, view.eye_radius, cells);
}

void PotentiallyVisible::clear() {
    start_.clear();
    known_ = false;
}

bool PotentiallyVisible::update(const PortalGraph& graph, const RowSource& source, std::span<const uint32_t> start) {
    if (known_ && std::equal(start.begin(), start.end(), start_.begin(), start_.end())) return false;
    const size_t words = (source.columns() + 63) / 64;
    start_.assign(start.begin(), start.end());
    row_.resize(words);
    union_.assign(words, 0);
    known_ = !start.empty();
    uint32_t last = PortalGraph::kNoCell;
    for (size_t i = 0; i < start.size(); ++i)
        SIGHTLINE_DEBUG_ASSERT(start[i] < graph.cells() && (i == 0 || start[i - 1] < start[i]));
    for (const uint32_t cell : start) {
        const uint32_t row = graph.rowOf(cell);
        if (row == PortalGraph::kNoCell) {
            known_ = false;
            break;
        }
        if (row == last) continue;
        last = row;
        source.row(row, row_);
        for (size_t i = 0; i < words; ++i) union_[i] |= row_[i];
    }
    return true;
}

}  // namespace sightline
