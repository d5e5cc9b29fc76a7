// Cuts the edges of a cluster at the near plane and beside the image, in doubles.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/draw/edges.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

/// Adds an edge whose corners may lie anywhere. What lies above and below the image is left out; what lies beside it goes
/// straight up there, which counts alike for what is in the image.
void addClipped(EdgeList& edges, double x0, double y0, double x1, double y1, double r, int change, double width,
                double height) {
    const double low = -2, high = height + 2, left = -16, right = width + 16;
    if ((y0 < low && y1 < low) || (y0 > high && y1 > high)) return;
    const double fx = x0, fy = y0;
    const auto clip = [&](double& x, double& y) {
        const double to = y < low ? low : y > high ? high : y;
        if (to == y) return;
        x = fx + (x1 - fx) * ((to - fy) / (y1 - fy));
        y = to;
    };
    double bx = x1, by = y1;
    clip(bx, by);
    clip(x0, y0);
    x1 = bx;
    y1 = by;
    double ends[4] = {0, 1, 1, 1};
    int count = 1;
    for (const double side : {left, right})
        if ((x0 < side) != (x1 < side)) ends[count++] = (side - x0) / (x1 - x0);
    if (count == 3 && ends[1] > ends[2]) std::swap(ends[1], ends[2]);
    ends[count++] = 1;
    for (int i = 0; i + 1 < count; ++i) {
        const double s = ends[i], t = ends[i + 1];
        double xa = x0 + s * (x1 - x0), xb = t == 1 ? x1 : x0 + t * (x1 - x0);
        const double ya = y0 + s * (y1 - y0), yb = t == 1 ? y1 : y0 + t * (y1 - y0), middle = 0.5 * (xa + xb);
        if (middle < left) xa = xb = left;
        if (middle > right) xa = xb = right;
        edges.add(static_cast<float>(xa), static_cast<float>(ya), static_cast<float>(xb), static_cast<float>(yb),
                  static_cast<float>(r), change);
    }
}

/// Where an edge meets the near plane.
struct CutPoint {
    double x, y, r;
};

/// The cut edges of a part.
class Cutter {
public:
    Cutter(const ObjectFrame& frame, const ExactImage& image, const Occluder& occluder, const PlaneMesh::Part& part,
           const int8_t* turn, float width, float height, float reach, EdgeList& edges, GroupRect* rects)
        : frame_(frame),
          image_(image),
          occluder_(occluder),
          part_(part),
          turn_(turn),
          width_(width),
          height_(height),
          reach_(double{reach} + 1e-3),
          edges_(edges),
          rects_(rects) {}

    bool run() {
        if (!frame_.clips) return false;
        std::fill(rects_, rects_ + part_.groups, GroupRect());
        const PlaneMesh& mesh = occluder_.planes;
        for (uint32_t i = 0; i < part_.vertices && is_known_; ++i) {
            const uint8_t v = mesh.source[part_.first_vertex + i];
            if (image_.near[v] >= 0) note(image_.x[v], image_.y[v], image_.w[v]);
        }
        const uint8_t* const source = &mesh.source[part_.first_vertex];
        for (uint32_t e = part_.first_edge; e < part_.first_edge + part_.edges && is_known_; ++e)
            add(source[mesh.from[e]], source[mesh.to[e]], mesh.left[e], mesh.right[e]);
        const OccluderCluster& cluster = occluder_.clusters[part_.cluster];
        for (uint32_t p = 0; p < part_.polygons && is_known_; ++p) {
            const uint8_t group = mesh.group_of[part_.first_group_of + p];
            const OccluderPolygon& polygon = occluder_.polygons[cluster.first_polygon + part_.first_polygon + p];
            if (turn_[group] == 0) continue;
            close(polygon.vertex[0], polygon.vertex[1], polygon.vertex[2], group);
            if (polygon.corners() == 4) close(polygon.vertex[0], polygon.vertex[2], polygon.vertex[3], group);
        }
        return is_known_ && !edges_.full;
    }
    double leastW() const { return least_w_; }

private:
    /// @returns how far a point's image may be off  [pixels]
    double note(double x, double y, double w) {
        constexpr double kFarthest = 0x1p40;  // [pixels]
        const double off = frame_.place_error;
        // Where the near plane is oblique, what is before it may be behind the eye.
        is_known_ &= w > 2 * off * frame_.length_w && std::abs(x) + std::abs(y) < kFarthest;
        least_w_ = std::min(least_w_, w);
        const double lengths = std::max(frame_.length_x, frame_.length_y);
        return off * (lengths + std::max(std::abs(x), std::abs(y)) * frame_.length_w) / w + reach_;
    }

    CutPoint at(int v) { return {image_.x[v], image_.y[v], note(image_.x[v], image_.y[v], image_.w[v])}; }
    /// The same in both directions.
    CutPoint cut(int before, int behind) {
        const double *x = image_.x, *y = image_.y, *w = image_.w, *near = image_.near;
        const double s = near[before] / (near[before] - near[behind]), cw = w[before] + s * (w[behind] - w[before]);
        const double cx = (x[before] * w[before] + s * (x[behind] * w[behind] - x[before] * w[before])) / cw,
                     cy = (y[before] * w[before] + s * (y[behind] * w[behind] - y[before] * w[before])) / cw;
        return {cx, cy, note(cx, cy, cw)};
    }

    void grow(int group, const CutPoint& p) {
        if (turn_[group] != 0)
            rects_[group].grow(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.r));
    }
    void add(const CutPoint& from, const CutPoint& to, int change) {
        if (change != 0)
            addClipped(edges_, from.x, from.y, to.x, to.y, std::max(from.r, to.r), change, width_, height_);
    }

    void add(int a, int b, int left, int right) {
        const bool before_a = image_.near[a] >= 0, before_b = image_.near[b] >= 0;
        if ((turn_[left] == 0 && turn_[right] == 0) || (!before_a && !before_b)) return;
        const CutPoint from = before_a ? at(a) : cut(b, a), to = before_b ? at(b) : cut(a, b);
        for (const int group : {left, right}) {
            grow(group, from);
            grow(group, to);
        }
        add(from, to, turn_[left] - turn_[right]);
    }

    /// Along the near plane from where a triangle's boundary, counter-clockwise, goes behind it to where it comes back.
    void close(int a, int b, int c, int group) {
        const int corner[3] = {a, b, c};
        int before = 0;
        for (const int v : corner) before += image_.near[v] >= 0;
        if (before == 0 || before == 3) return;
        CutPoint leaves{}, returns{};
        for (int k = 0; k < 3; ++k) {
            const int u = corner[k], v = corner[(k + 1) % 3];
            const bool before_u = image_.near[u] >= 0, before_v = image_.near[v] >= 0;
            if (before_u && !before_v) leaves = cut(u, v);
            if (!before_u && before_v) returns = cut(v, u);
        }
        grow(group, leaves);
        grow(group, returns);
        add(leaves, returns, turn_[group]);
    }

    const ObjectFrame& frame_;
    const ExactImage& image_;
    const Occluder& occluder_;
    const PlaneMesh::Part& part_;
    const int8_t* const turn_;
    const double width_, height_, reach_;
    EdgeList& edges_;
    GroupRect* const rects_;
    double least_w_ = 1e300;
    bool is_known_ = true;
};

}  // namespace

bool cutEdges(const ObjectFrame& frame, const ExactImage& image, const Occluder& occluder, const PlaneMesh::Part& part,
              const int8_t* turn, float width, float height, float reach, EdgeList& edges, GroupRect* rects,
              float& nearest) {
    Cutter cutter(frame, image, occluder, part, turn, width, height, reach, edges, rects);
    if (!cutter.run()) return false;
    nearest = static_cast<float>((1 + 1e-5) / (cutter.leastW() - frame.place_error * frame.length_w));
    return true;
}

}  // namespace sightline
