// An object asked of the depth tiles by its own triangles: the second look.
// SPDX-License-Identifier: MIT
#include "sightline/cull/triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/cull/occlusion.h"

namespace sightline {
namespace {

constexpr double kWorstPosition = 0.125;  // [pixels]: known less exactly, it is visible

/// Clip coordinates of a vertex, up to the division.
struct Homogeneous {
    double x, y, w, d, near;
};

Homogeneous project(const Screen& object, double x, double y, double z) {
    const auto row = [&](const glm::dvec4& r) { return r.x * x + r.y * y + r.z * z + r.w; };
    return {row(object.x), row(object.y), row(object.w), row(object.d), row(object.near)};
}

/// Corners of a polygon on the screen.
struct Corners {
    static constexpr int kMost = 6;  // the near plane may cross all four sides of a quadrangle that is not quite flat
    double x[kMost], y[kMost], d[kMost];
    int count = 0;
};

/// Cuts a polygon at the near plane, the guard before it, so that nothing that is drawn is cut off. False if it cannot
/// be said where its corners lie.
bool clipAtNear(const Screen& object, const Homogeneous* corner, int count, Corners& out) {
    const double guard = -object.near_guard;
    const auto emit = [&](const Homogeneous& p) {
        if (!(p.w > 0.0)) return false;
        SIGHTLINE_DEBUG_ASSERT(out.count < Corners::kMost);
        const int i = out.count++;
        out.x[i] = p.x / p.w;
        out.y[i] = p.y / p.w;
        out.d[i] = p.d / p.w;
        return true;
    };
    SIGHTLINE_DEBUG_ASSERT(count == 3 || count == 4);
    out.count = 0;
    for (int i = 0; i < count; ++i) {
        const Homogeneous &a = corner[i], &b = corner[i + 1 < count ? i + 1 : 0];
        const bool a_in = a.near >= guard, b_in = b.near >= guard;
        if (a_in && !emit(a)) return false;
        if (a_in == b_in) continue;
        const Homogeneous &in = a_in ? a : b, &beyond = a_in ? b : a;
        const double t = (in.near - guard) / (in.near - beyond.near);
        const auto mix = [t](double p, double q) { return p + t * (q - p); };
        if (!emit({mix(in.x, beyond.x), mix(in.y, beyond.y), mix(in.w, beyond.w), mix(in.d, beyond.d), guard}))
            return false;
    }
    return true;
}

OccludeeBox boxOf(const OccludeePlace& place, const OccluderCluster& cluster) {
    return boxAt(place, {glm::dvec3(cluster.bounds.min), glm::dvec3(cluster.bounds.max)});
}

/// One cluster on its way to the tiles.
struct ClusterWalk {
    const OccludeePlace& place;
    const Occluder& shape;
    const OccluderCluster& cluster;
    double position_error = 0, depth_error = 0;
    const OccludeeBox box;
    OccludeeVertices vertices;

    ClusterWalk(const OccludeePlace& at, const Occluder& of, uint32_t index)
        : place(at), shape(of), cluster(of.clusters[index]), box(boxOf(at, cluster)) {}

    /// False if its place is known too badly.
    bool begin(double w) {
        w = std::max(w, place.screen.near_w);
        if (!(w > 0.0)) return false;
        position_error = place.positionError(w);
        depth_error = place.depthError(w);
        if (!(position_error < kWorstPosition)) return false;
        SIGHTLINE_DEBUG_ASSERT(cluster.vertex_count <= OccluderCluster::kMaxVertices);
        const size_t first = cluster.first_vertex;
        SIGHTLINE_DEBUG_ASSERT(first + (cluster.vertex_count + 7u) / 8 * 8 <= shape.x.size());
        projectOccludee(place.screen, shape.x.data() + first, shape.y.data() + first, shape.z.data() + first,
                        cluster.vertex_count, vertices);
        return true;
    }

    /// Whether a polygon surely lies beside the columns that matter.
    bool liesBeside(const DepthTiles& tiles, const OccluderPolygon& polygon) const;
    Sight polygon(const OccluderPolygon& polygon, OccludeePolygon& out) const;

private:
    Sight clipped(const OccluderPolygon& polygon, bool both, OccludeePolygon& out) const;
    Sight make(const double* x, const double* y, const double* d, int count, bool both, OccludeePolygon& out) const;
};

/// kOutside also for what is surely turned away, and so not drawn.
Sight ClusterWalk::make(const double* x, const double* y, const double* d, int count, bool both,
                        OccludeePolygon& out) const {
    SIGHTLINE_DEBUG_ASSERT(count >= 3);
    if (!both) {
        double perimeter = 0, widest = -std::numeric_limits<double>::infinity();
        for (int i = 0; i < count; ++i) {
            const int j = i + 1 < count ? i + 1 : 0;
            perimeter += std::abs(x[j] - x[i]) + std::abs(y[j] - y[i]);
        }
        // A quadrangle that is not quite flat is turned away if both of its triangles are.
        for (int i = 2; i < count; ++i) {
            const double area2 = (x[i - 1] - x[0]) * (y[i] - y[0]) - (x[i] - x[0]) * (y[i - 1] - y[0]);
            widest = std::max(widest, place.reverse ? -area2 : area2);
        }
        if (widest < -4.0 * (position_error + 0x1p-16) * perimeter) return Sight::kOutside;
    }
    return makeOccludeePolygon(x, y, d, count, position_error, depth_error, place.screen.width, place.screen.height,
                               out);
}

Sight ClusterWalk::clipped(const OccluderPolygon& polygon, bool both, OccludeePolygon& out) const {
    if (!place.clips) return Sight::kVisible;
    Homogeneous corner[4];
    const int count = polygon.corners();
    for (int k = 0; k < count; ++k) {
        const size_t at = size_t{cluster.first_vertex} + polygon.vertex[k];
        corner[k] = project(place.screen, shape.x[at], shape.y[at], shape.z[at]);
    }
    Corners corners;
    if (!clipAtNear(place.screen, corner, count, corners)) return Sight::kVisible;
    if (corners.count < 3) return Sight::kOutside;
    return make(corners.x, corners.y, corners.d, corners.count, both, out);
}

bool ClusterWalk::liesBeside(const DepthTiles& tiles, const OccluderPolygon& polygon) const {
    const double reach = position_error + 1.0;  // far more than what makeOccludeePolygon() adds
    const double left = 8.0 * tiles.first_column - reach, right = 8.0 * tiles.end_column + reach;
    bool all_left = true, all_right = true;  // neither where a corner has no image
    for (int k = 0; k < polygon.corners(); ++k) {
        const double x = vertices.x[polygon.vertex[k]];
        all_left &= x < left;
        all_right &= x > right;
    }
    return all_left || all_right;
}

Sight ClusterWalk::polygon(const OccluderPolygon& polygon, OccludeePolygon& out) const {
    double x[4], y[4], d[4];
    const int count = polygon.corners();
    int before = 0, behind = 0;
    for (int k = 0; k < count; ++k) {
        SIGHTLINE_DEBUG_ASSERT(polygon.vertex[k] < cluster.vertex_count);
        x[k] = vertices.x[polygon.vertex[k]];
        y[k] = vertices.y[polygon.vertex[k]];
        d[k] = vertices.d[polygon.vertex[k]];
        before += std::isnan(x[k]);
        behind += d[k] == OccludeeVertices::kBehind;
    }
    if (behind == count) return Sight::kOutside;
    return before ? clipped(polygon, polygon.double_sided, out) : make(x, y, d, count, polygon.double_sided, out);
}

/// Gathers the clusters that their boxes leave undecided, nearest first. Returns the polygons in them; `in_view` is set
/// if one was hidden.
uint64_t gatherClusters(DepthTiles& tiles, const OccludeePlace& place, const Occluder& shape,
                        Array<ClusterLook>& clusters, bool& in_view) {
    uint64_t polygons = 0;
    clusters.clear();
    const uint32_t count = static_cast<uint32_t>(shape.clusters.size());
    ScreenAnswer eight;
    for (uint32_t c = 0; c < count; ++c) {
        ClusterLook look{c, std::numeric_limits<float>::infinity(), 0};
        if (count > 1) {
            if (c % 8 == 0) eight = projectClusters(place.screen, shape, c);
            BoxAnswer box(eight, static_cast<int>(c % 8));
            if (box.outside) continue;
            if (!box.doubt) {
                const OccludeeBox bounds = boxOf(place, shape.clusters[c]);
                if (!tiles.clip(box.rect) || isHidden(tiles, box.rect, Seams::kLeave, &bounds)) {
                    in_view = true;
                    continue;
                }
                look.nearness = box.rect.nearness;
                look.w = place.screen.perspective ? 1.0 / box.rect.nearness : 0.0;
            }
        }
        clusters.push_back(look);
        polygons += shape.clusters[c].polygon_count;
    }
    std::sort(clusters.begin(), clusters.end(), [](const ClusterLook& a, const ClusterLook& b) {
        return a.nearness != b.nearness ? a.nearness > b.nearness : a.cluster < b.cluster;
    });
    return polygons;
}

/// The least w of what may be drawn of a cluster, 0 if that is not known; less than 0: it lies outside of the view.
double leastW(const OccludeePlace& place, const Occluder& shape, uint32_t cluster) {
    SIGHTLINE_DEBUG_ASSERT(cluster < shape.clusters.size());
    if (shape.clusters.size() == 1) return 0.0;
    const BoxAnswer box(projectClusters(place.screen, shape, cluster), 0);
    if (box.outside) return -1.0;
    return box.doubt || !place.screen.perspective ? 0.0 : 1.0 / box.rect.nearness;
}

/// Whether a polygon shows an open pixel, or is in doubt: a look would end at it, if it did not end before.
bool isOpenStill(DepthTiles& tiles, const OccludeePlace& place, const Occluder& shape, const OpenPolygon& open) {
    const double w = leastW(place, shape, open.cluster);
    if (w < 0.0) return false;
    ClusterWalk walk(place, shape, open.cluster);
    if (open.polygon >= walk.cluster.polygon_count) return false;
    if (!walk.begin(w)) return true;
    const OccluderPolygon& polygon = shape.polygons[walk.cluster.first_polygon + open.polygon];
    if (tiles.end_column - tiles.first_column < tiles.columns && walk.liesBeside(tiles, polygon)) return false;
    OccludeePolygon occludee;
    const Sight made = walk.polygon(polygon, occludee);
    if (made == Sight::kVisible) return true;
    if (made == Sight::kOutside || !tiles.clip(occludee.rect)) return false;
    const Cover cover = lookAt(tiles, occludee, &walk.box);
    return cover == Cover::kOpen || (cover == Cover::kUndecided && !resolveHidden(tiles, occludee, &walk.box));
}

/// Whether no edge has the whole view on its outer side: together with the rectangle, whether a polygon meets the view.
bool meetsView(const OccludeePolygon& polygon, const Screen& screen) {
    for (int i = 0; i < polygon.edges; ++i) {
        const double x = polygon.a[i] > 0 ? screen.width : 0.0, y = polygon.b[i] > 0 ? screen.height : 0.0;
        if (polygon.a[i] * x + polygon.b[i] * y + polygon.c[i] < -polygon.slack) return false;
    }
    return true;
}

/// Whether a polygon lies in the view that is turned away, and so is not drawn. No polygon that would be drawn does.
bool showsBack(const OccludeePlace& place, const Occluder& shape, std::span<const ClusterLook> clusters) {
    OccludeePolygon occludee;
    for (const ClusterLook& next : clusters) {
        ClusterWalk walk(place, shape, next.cluster);
        if (!walk.begin(next.w)) return false;
        for (uint32_t p = 0; p < walk.cluster.polygon_count; ++p) {
            OccluderPolygon polygon = shape.polygons[walk.cluster.first_polygon + p];
            if (polygon.double_sided) continue;
            polygon.double_sided = true;
            const Sight made = walk.polygon(polygon, occludee);
            if (made == Sight::kVisible || (made == Sight::kOccluded && meetsView(occludee, place.screen))) return true;
        }
    }
    return false;
}

}  // namespace

Sight askTriangles(DepthTiles& tiles, const OccludeePlace& place, const Occluder& shape, TriangleScratch& scratch,
                   TriangleLook& look) {
    look.polygons = 0;
    if (look.first.cluster < shape.clusters.size() && look.most_polygons > 0) {
        look.by_first = isOpenStill(tiles, place, shape, look.first);
        look.open = look.first;
        look.polygons = look.by_first;
        if (look.by_first) return Sight::kVisible;
    }
    bool in_view = false, beside = false, beyond = false;
    const uint64_t polygons = gatherClusters(tiles, place, shape, scratch.clusters, in_view);
    look.spent = polygons > look.most_polygons;
    if (look.spent) return Sight::kVisible;
    scratch.undecided.clear();
    scratch.names.clear();
    const bool part = tiles.end_column - tiles.first_column < tiles.columns;
    OccludeePolygon occludee;
    for (const ClusterLook& next : scratch.clusters) {
        look.open.cluster = next.cluster;
        ClusterWalk walk(place, shape, next.cluster);
        look.in_doubt = !walk.begin(next.w);
        if (look.in_doubt) return Sight::kVisible;
        for (uint32_t p = 0; p < walk.cluster.polygon_count; ++p) {
            look.open.polygon = p;
            ++look.polygons;
            const OccluderPolygon& polygon = shape.polygons[walk.cluster.first_polygon + p];
            if (part && walk.liesBeside(tiles, polygon)) {
                beside = true;
                continue;
            }
            const Sight made = walk.polygon(polygon, occludee);
            look.in_doubt = made == Sight::kVisible;
            if (look.in_doubt) return made;
            if (made == Sight::kOutside) {
                beyond = true;
                continue;
            }
            if (!tiles.clip(occludee.rect)) {
                beside = true;
                continue;
            }
            const Cover cover = lookAt(tiles, occludee, &walk.box);
            in_view |= cover != Cover::kOutside;
            if (cover == Cover::kOpen) return Sight::kVisible;
            if (cover != Cover::kUndecided) continue;
            scratch.undecided.push_back(occludee);
            scratch.names.push_back(look.open);
        }
    }
    SIGHTLINE_DEBUG_ASSERT(scratch.undecided.size() == scratch.names.size());
    // Only if nothing is open for good are seams worth resolving.
    for (size_t i = 0; i < scratch.undecided.size(); ++i) {
        look.open = scratch.names[i];
        const OccludeeBox box = boxOf(place, shape.clusters[look.open.cluster]);
        if (!resolveHidden(tiles, scratch.undecided[i], &box)) return Sight::kVisible;
    }
    look.away = beyond && !in_view && showsBack(place, shape, scratch.clusters);
    return in_view || beside ? Sight::kOccluded : Sight::kOutside;
}

bool isOpen(DepthTiles& tiles, const OccludeePlace& place, const Occluder& shape, const OpenPolygon& polygon) {
    SIGHTLINE_DEBUG_ASSERT(polygon.cluster < shape.clusters.size());
    SIGHTLINE_DEBUG_ASSERT(polygon.polygon < shape.clusters[polygon.cluster].polygon_count);
    ClusterWalk walk(place, shape, polygon.cluster);
    OccludeePolygon occludee;
    if (!walk.begin(0.0)) return true;
    const Sight made = walk.polygon(shape.polygons[walk.cluster.first_polygon + polygon.polygon], occludee);
    return made == Sight::kVisible || (made == Sight::kOccluded && !isPolygonHidden(tiles, occludee, &walk.box));
}

bool forTriangles(const OccludeePlace& place, const Occluder& shape, PolygonSink& sink) {
    OccludeePolygon occludee;
    for (uint32_t c = 0; c < shape.clusters.size(); ++c) {
        ClusterWalk walk(place, shape, c);
        if (!walk.begin(0.0)) return false;
        for (uint32_t p = 0; p < walk.cluster.polygon_count; ++p) {
            const Sight made = walk.polygon(shape.polygons[walk.cluster.first_polygon + p], occludee);
            if (made == Sight::kVisible) return false;
            if (made == Sight::kOccluded && !sink.take(occludee)) return false;
        }
    }
    return true;
}

}  // namespace sightline
