// Cuts the edges of a cluster at the near plane and beside the image, in doubles.
// SPDX-License-Identifier: MIT
#include "bench/onepass/edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sightline::bench {
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

/// Where the boundary of a group meets the near plane.
struct CutPoint {
    double x, y, r;
    int group;
    bool leaves;  ///< the boundary, counter-clockwise, goes behind it here
};

}  // namespace

bool cutEdges(const ObjectFrame& frame, const ExactImage& image, double near_w, const PlaneMesh& mesh,
              const PlaneMesh::Cluster& cluster, const int8_t* turn, float width, float height, EdgeList& edges,
              GroupRect* rects, float& nearest) {
    static thread_local std::vector<CutPoint> cuts;
    const double *x = image.x, *y = image.y, *w = image.w;
    double r[256], least = 1e300;
    // Vertices are rounded to floats around the centre, and may lie off their planes, along which groups are closed.
    const double off = 0x1p-23 * cluster.radius + 2.0 * cluster.thick;
    const double lengths = std::max(frame.length_x, frame.length_y), length_w = frame.length_w;
    const auto offOf = [&](double px, double py, double pw) {
        return off * (lengths + std::max(std::abs(px), std::abs(py)) * length_w) / pw + 1e-3;
    };
    for (uint32_t i = 0; i < cluster.vertices; ++i) {
        r[i] = offOf(x[i], y[i], w[i]);
        least = std::min(least, w[i]);
    }
    nearest = static_cast<float>((1 + 1e-5) / std::max(least - off * length_w, near_w));
    cuts.clear();
    std::fill(rects, rects + cluster.groups, GroupRect());
    for (uint32_t e = cluster.first_edge; e < cluster.first_edge + cluster.edges; ++e) {
        const int a = mesh.from[e], b = mesh.to[e], left = mesh.left[e], right = mesh.right[e];
        const int change = turn[left] - turn[right];
        const bool before_a = w[a] >= near_w, before_b = w[b] >= near_w;
        if ((turn[left] == 0 && turn[right] == 0) || (!before_a && !before_b)) continue;
        const auto note = [&](double px, double py, double pr) {
            for (const int group : {left, right})
                if (turn[group] != 0)
                    rects[group].grow(static_cast<float>(px), static_cast<float>(py), static_cast<float>(pr));
        };
        if (before_a) note(x[a], y[a], r[a]);
        if (before_b) note(x[b], y[b], r[b]);
        if (before_a && before_b) {
            if (change != 0) addClipped(edges, x[a], y[a], x[b], y[b], std::max(r[a], r[b]), change, width, height);
            continue;
        }
        const double s = (w[a] - near_w) / (w[a] - w[b]);
        const double qx = (x[a] * w[a] + s * (x[b] * w[b] - x[a] * w[a])) / near_w,
                     qy = (y[a] * w[a] + s * (y[b] * w[b] - y[a] * w[a])) / near_w, qr = offOf(qx, qy, near_w);
        note(qx, qy, qr);
        if (change != 0 && before_a) addClipped(edges, x[a], y[a], qx, qy, std::max(r[a], qr), change, width, height);
        if (change != 0 && before_b) addClipped(edges, qx, qy, x[b], y[b], std::max(r[b], qr), change, width, height);
        // Along the group on the left the edge runs counter-clockwise, along the one on the right against it.
        if (turn[left] != 0) cuts.push_back({qx, qy, qr, left, before_a});
        if (turn[right] != 0) cuts.push_back({qx, qy, qr, right, before_b});
    }
    std::sort(cuts.begin(), cuts.end(), [](const CutPoint& p, const CutPoint& q) {
        return p.group != q.group ? p.group < q.group : p.leaves > q.leaves;
    });
    for (size_t i = 0; i < cuts.size();) {
        size_t end = i, leaves = 0;
        for (; end < cuts.size() && cuts[end].group == cuts[i].group; ++end) leaves += cuts[end].leaves;
        if (2 * leaves != end - i) return false;
        // All of a group's lie on one line, so that it does not matter which is joined to which.
        for (size_t k = 0; k < leaves; ++k) {
            const CutPoint &from = cuts[i + k], &to = cuts[i + leaves + k];
            addClipped(edges, from.x, from.y, to.x, to.y, std::max(from.r, to.r), turn[from.group], width, height);
        }
        i = end;
    }
    return !edges.full;
}

}  // namespace sightline::bench
