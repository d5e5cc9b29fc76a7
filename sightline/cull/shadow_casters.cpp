// Which casters can darken a visible receiver: a mask of the receivers as a light sees them, with their farthest depth.
// SPDX-License-Identifier: MIT
#include "sightline/cull/shadow_casters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// All below is in double; this is far above what its steps round by, and far below a texel.
constexpr double kCasterRounding = 1e-9;
constexpr uint32_t kBlock = 8;

double slack(double a, double b) { return kCasterRounding * (std::abs(a) + std::abs(b)); }

glm::dvec3 cornerOf(const Box3d& box, int corner) {
    return {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z};
}

}  // namespace

LightGrid makeLightGrid(const View& light) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(light));
    LightGrid grid;
    grid.width = light.width;
    grid.height = light.height;
    grid.perspective = !isOrthographic(light);
    grid.eye = eyePosition(light);
    // Relative to the eye the view is a pure rotation; only a parallel projection's own shift is left.
    const glm::dmat4 m = light.projection * glm::dmat4(glm::dmat3(light.view));
    const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
    const glm::dvec2 half(0.5 * light.width, 0.5 * light.height);
    grid.rows[0] = half.x * (row(0) + row(3));
    grid.rows[1] = half.y * (row(1) + row(3));
    grid.rows[2] = row(3);
    glm::dvec3 third = glm::dvec3(row(3));
    if (!grid.perspective) {
        for (glm::dvec4& r : grid.rows) r /= m[3][3];
        const glm::dvec3 across = glm::cross(glm::dvec3(row(0)), glm::dvec3(row(1)));
        const bool ahead = glm::dot(across, glm::dvec3(row(2))) * m[3][3] >= 0;
        grid.toward = (ahead ? 1.0 : -1.0) * glm::normalize(across);
        third = grid.toward;
    }
    const glm::dmat3 rows = glm::transpose(glm::dmat3(glm::dvec3(grid.rows[0]), glm::dvec3(grid.rows[1]), third));
    const glm::dmat3 inverse = glm::inverse(rows);
    grid.step[0] = inverse[0];
    grid.step[1] = inverse[1];
    grid.start = grid.perspective ? inverse[2] : -(inverse[0] * grid.rows[0].w + inverse[1] * grid.rows[1].w);
    return grid;
}

void ReceiverMask::begin(const LightGrid& grid, double spread, double bias) {
    SIGHTLINE_DEBUG_ASSERT(spread >= 0 && bias >= 0 && grid.width > 0 && grid.height > 0);
    grid_ = grid;
    spread_ = spread;
    bias_ = bias;
    receivers_ = 0;
    farthest_.assign(size_t{grid.width} * grid.height, kInfinity);
    const size_t across = (grid.width + kBlock - 1) / kBlock, up = (grid.height + kBlock - 1) / kBlock;
    blocks_.assign(across * up, kInfinity);
}

/// At depth w along a ray of direction s, n.(w s) + d >= 0 is n.s + d / w >= 0; in a parallel view n.(p + t toward) + d
/// is n.p + d - (n.toward) (-t).
ReceiverMask::Along ReceiverMask::along(const glm::dvec4& plane) const {
    const glm::dvec3 n(plane);
    Along out;
    out.constant = glm::dot(n, grid_.start) + (grid_.perspective ? 0.0 : plane.w);
    out.right = glm::dot(n, grid_.step[0]);
    out.up = glm::dot(n, grid_.step[1]);
    out.slope = grid_.perspective ? plane.w : -glm::dot(n, grid_.toward);
    return out;
}

uint32_t ReceiverMask::planesOf(const Box3d& box, Along* planes) const {
    uint32_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 low(0.0), high(0.0);
        low[axis] = 1.0;
        high[axis] = -1.0;
        low.w = -(box.min[axis] - grid_.eye[axis]);
        high.w = box.max[axis] - grid_.eye[axis];
        planes[count++] = along(low);
        planes[count++] = along(high);
    }
    return count;
}

/// The texels that the image of a box may touch: all of them, if the box reaches the plane of the light.
ReceiverMask::Rect ReceiverMask::rectOf(const Box3d& box, double spread) const {
    glm::dvec2 low(kInfinity), high(-kInfinity);
    double nearest = -kInfinity;
    bool across = false;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p = cornerOf(box, corner) - grid_.eye;
        double w = 1.0;
        if (grid_.perspective) {
            w = glm::dot(glm::dvec3(grid_.rows[2]), p) + grid_.rows[2].w;
            across |= !(w > kCasterRounding * glm::length(p));
            nearest = std::max(nearest, 1.0 / w);
        } else {
            nearest = std::max(nearest, -glm::dot(grid_.toward, p));
        }
        for (int axis = 0; axis < 2; ++axis) {
            const double at = (glm::dot(glm::dvec3(grid_.rows[axis]), p) + grid_.rows[axis].w) / w;
            low[axis] = std::min(low[axis], at);
            high[axis] = std::max(high[axis], at);
        }
    }
    Rect rect;
    rect.nearest = across ? kInfinity : nearest;
    const auto texel = [](double at, uint32_t size) {  // one beside the image stands for all that lie beyond
        return static_cast<int32_t>(std::floor(std::clamp(at, -1.0, static_cast<double>(size))));
    };
    const double wide = spread + kCasterRounding * (grid_.width + grid_.height);
    if (across) {
        rect.x1 = static_cast<int32_t>(grid_.width) - 1;
        rect.y1 = static_cast<int32_t>(grid_.height) - 1;
        return rect;
    }
    rect.x0 = std::max(0, texel(low.x - wide, grid_.width));
    rect.y0 = std::max(0, texel(low.y - wide, grid_.height));
    rect.x1 = std::min(static_cast<int32_t>(grid_.width) - 1, texel(high.x + wide, grid_.width));
    rect.y1 = std::min(static_cast<int32_t>(grid_.height) - 1, texel(high.y + wide, grid_.height));
    return rect;
}

/// What of a convex body the rays of a texel may meet, each half space at its most permissive.
ReceiverMask::Span ReceiverMask::spanAt(std::span<const Along> planes, int32_t x, int32_t y, double spread) const {
    Span span{kInfinity, grid_.perspective ? 0.0 : -kInfinity, true};
    const double reach = 0.5 + kCasterRounding * (grid_.width + grid_.height) + spread;
    for (const Along& plane : planes) {
        const double aside = (std::abs(plane.right) + std::abs(plane.up)) * reach;
        const double most = plane.constant + plane.right * (x + 0.5) + plane.up * (y + 0.5) + aside +
                            kCasterRounding * std::abs(plane.constant);
        if (plane.slope > 0) span.farthest = std::max(span.farthest, -most / plane.slope);
        else if (plane.slope < 0) span.nearest = std::min(span.nearest, -most / plane.slope);
        else if (most < 0) span.any = false;
    }
    span.any &= !(span.nearest < span.farthest - slack(span.nearest, span.farthest));
    return span;
}

void ReceiverMask::addReceiver(const Box3d& box, std::span<const glm::dvec4> cuts) {
    SIGHTLINE_ASSERT(cuts.size() + 6 <= kMostPlanes);
    if (!box.finite() || box.empty()) {  // it may be anywhere
        ++receivers_;
        std::fill(farthest_.begin(), farthest_.end(), grid_.perspective ? 0.0 : -kInfinity);
        return;
    }
    SIGHTLINE_DEBUG_ASSERT(farthest_.size() == size_t{grid_.width} * grid_.height);
    Along planes[kMostPlanes];
    uint32_t count = planesOf(box, planes);
    for (const glm::dvec4& cut : cuts) planes[count++] = along(cut);
    SIGHTLINE_DEBUG_ASSERT(count <= kMostPlanes);
    const Rect rect = rectOf(box, spread_);
    bool any = false;
    for (int32_t y = rect.y0; y <= rect.y1; ++y)
        for (int32_t x = rect.x0; x <= rect.x1; ++x) {
            const Span span = spanAt({planes, count}, x, y, spread_);
            if (!span.any) continue;
            any = true;
            double farthest = span.farthest;
            // In perspective 1 / (w + bias).
            if (grid_.perspective) farthest = farthest > 0 ? farthest / (1.0 + bias_ * farthest) : 0.0;
            else farthest -= bias_;
            double& texel = farthest_[static_cast<size_t>(y) * grid_.width + static_cast<size_t>(x)];
            texel = std::min(texel, farthest);
        }
    receivers_ += any;
}

void ReceiverMask::finish() {
    const uint32_t across = (grid_.width + kBlock - 1) / kBlock;
    for (uint32_t y = 0; y < grid_.height; ++y)
        for (uint32_t x = 0; x < grid_.width; ++x) {
            double& block = blocks_[size_t{y / kBlock} * across + x / kBlock];
            block = std::min(block, farthest_[size_t{y} * grid_.width + x]);
        }
}

CasterAnswer ReceiverMask::ask(const Box3d& box) const {
    if (!box.finite() || box.empty()) return CasterAnswer::kMayDarken;
    Along planes[6];
    planesOf(box, planes);
    const Rect rect = rectOf(box, 0);
    CasterAnswer answer = CasterAnswer::kBesideReceivers;
    for (int32_t y = rect.y0; y <= rect.y1; ++y)
        for (int32_t x = rect.x0; x <= rect.x1; ++x) {
            const double farthest = farthest_[static_cast<size_t>(y) * grid_.width + static_cast<size_t>(x)];
            if (farthest == kInfinity) continue;
            const Span span = spanAt(planes, x, y, 0);
            if (!span.any) continue;
            if (span.nearest >= farthest - slack(span.nearest, farthest)) return CasterAnswer::kMayDarken;
            answer = CasterAnswer::kBehindReceivers;
        }
    return answer;
}

bool ReceiverMask::mayHoldCaster(const Box3d& box) const {
    if (!box.finite() || box.empty()) return true;
    const Rect rect = rectOf(box, 0);
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0) return false;
    const uint32_t across = (grid_.width + kBlock - 1) / kBlock, block = kBlock;
    for (uint32_t y = static_cast<uint32_t>(rect.y0) / block; y <= static_cast<uint32_t>(rect.y1) / block; ++y)
        for (uint32_t x = static_cast<uint32_t>(rect.x0) / block; x <= static_cast<uint32_t>(rect.x1) / block; ++x) {
            const double farthest = blocks_[size_t{y} * across + x];
            if (farthest < kInfinity && rect.nearest >= farthest - slack(rect.nearest, farthest)) return true;
        }
    return false;
}

double ReceiverMask::coverage() const {
    const auto open = std::count(farthest_.begin(), farthest_.end(), kInfinity);
    const auto all = static_cast<double>(std::max<size_t>(farthest_.size(), 1));
    return 1.0 - static_cast<double>(open) / all;
}

}  // namespace sightline
