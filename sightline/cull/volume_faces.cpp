// Joins an occluder's polygons to large flat, convex faces.
// SPDX-License-Identifier: MIT
#include "sightline/cull/volume_faces.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "sightline/base/assert.h"
#include "sightline/math/exact_product.h"

namespace sightline {
namespace {

constexpr uint32_t kMostPolygons = 1u << 16;  // the largest of a mesh that are looked at
constexpr double kFlat = 1e-4;                // of the size: how far a vertex may lie off the plane of its face
constexpr double kTurned = 1e-4;              // one minus the cosine between normals of joined polygons
constexpr double kConvex = 1e-5;              // of the size: how far a corner may lie outside

/// Polygons on the way to becoming a face.
struct Patch {
    Array<uint32_t> outline;
    glm::dvec3 area{0.0};  ///< the vector area: along the normal, as long as the area
    bool double_sided = false;

    explicit Patch(Memory* memory) : outline(memory) {}
    double length() const { return glm::length(area); }
};

struct Finder {
    Finder(const Occluder& from, Memory* source)
        : occluder(from), memory(source), corners(source), patches(source), patch_of(source), polygons(source) {}

    struct Polygon {
        uint32_t corner[4];
        uint8_t count;
        bool double_sided;
    };

    const Occluder& occluder;
    Memory* memory;
    Array<glm::dvec3> corners;  ///< each position once
    Array<Patch> patches;       ///< one per polygon; joined ones are left empty
    Array<uint32_t> patch_of;   ///< per polygon, with the joined ones' chain to follow
    Array<Polygon> polygons;

    uint32_t find(uint32_t patch) {
        while (patch_of[patch] != patch) patch = patch_of[patch] = patch_of[patch_of[patch]];
        return patch;
    }
    void gather();
    void weld();
    void join();
    bool tryJoin(uint32_t a, uint32_t b);
    bool isConvex(const Array<uint32_t>& outline, const glm::dvec3& normal, double slack) const;
    glm::dvec3 vectorArea(const Array<uint32_t>& outline) const;
};

/// The polygons of the occluder, the largest if there are too many, by the occluder's vertices.
void Finder::gather() {
    struct Source {
        double area;
        uint32_t cluster, polygon;
    };
    const auto at = [&](uint32_t v) { return glm::dvec3(occluder.x[v], occluder.y[v], occluder.z[v]); };
    Array<Source> sources(memory);
    for (uint32_t c = 0; c < occluder.clusters.size(); ++c) {
        const OccluderCluster& cluster = occluder.clusters[c];
        for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
            const OccluderPolygon& polygon = occluder.polygons[p];
            const auto corner = [&](int k) { return at(cluster.first_vertex + polygon.vertex[k]); };
            glm::dvec3 area = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
            if (polygon.corners() == 4) area += glm::cross(corner(2) - corner(0), corner(3) - corner(0));
            sources.push_back({glm::length(area), c, p});
        }
    }
    if (sources.size() > kMostPolygons) {
        const auto larger = [](const Source& a, const Source& b) {
            return a.area != b.area ? a.area > b.area : a.polygon < b.polygon;
        };
        std::nth_element(sources.begin(), sources.begin() + kMostPolygons, sources.end(), larger);
        sources.resize(kMostPolygons);
        std::sort(sources.begin(), sources.end(),
                  [](const Source& a, const Source& b) { return a.polygon < b.polygon; });
    }
    for (const Source& source : sources) {
        const OccluderPolygon& from = occluder.polygons[source.polygon];
        Polygon& to = polygons.emplace_back();
        to.count = static_cast<uint8_t>(from.corners());
        to.double_sided = from.double_sided;
        for (int k = 0; k < to.count; ++k)
            to.corner[k] = occluder.clusters[source.cluster].first_vertex + from.vertex[k];
    }
}

/// Each position of a corner once; and a patch for each polygon.
void Finder::weld() {
    struct Place {
        float x, y, z;
        uint32_t vertex;
        bool operator<(const Place& o) const { return std::tie(x, y, z, vertex) < std::tie(o.x, o.y, o.z, o.vertex); }
    };
    Array<Place> places(memory);
    for (const Polygon& polygon : polygons)
        for (int k = 0; k < polygon.count; ++k) {
            const uint32_t v = polygon.corner[k];
            places.push_back({occluder.x[v], occluder.y[v], occluder.z[v], v});
        }
    std::sort(places.begin(), places.end());
    Array<uint32_t> corner_of(occluder.x.size(), 0, memory);
    for (size_t i = 0; i < places.size(); ++i) {
        const Place& p = places[i];
        const bool same = i > 0 && p.x == places[i - 1].x && p.y == places[i - 1].y && p.z == places[i - 1].z;
        if (!same) corners.push_back({p.x, p.y, p.z});
        corner_of[p.vertex] = static_cast<uint32_t>(corners.size() - 1);
    }
    for (Polygon& polygon : polygons) {
        Patch& patch = patches.emplace_back(memory);
        for (int k = 0; k < polygon.count; ++k) {
            polygon.corner[k] = corner_of[polygon.corner[k]];
            patch.outline.push_back(polygon.corner[k]);
        }
        patch.area = vectorArea(patch.outline);
        patch.double_sided = polygon.double_sided;
        patch_of.push_back(static_cast<uint32_t>(patches.size() - 1));
    }
}

glm::dvec3 Finder::vectorArea(const Array<uint32_t>& outline) const {
    SIGHTLINE_DEBUG_ASSERT(outline.size() >= 3);
    glm::dvec3 sum(0.0);
    const glm::dvec3 o = corners[outline[0]];
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        sum += glm::cross(corners[outline[i]] - o, corners[outline[i + 1]] - o);
    return 0.5 * sum;
}

/// Whether every corner lies left of every side.
bool Finder::isConvex(const Array<uint32_t>& outline, const glm::dvec3& normal, double slack) const {
    const size_t count = outline.size();
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 a = corners[outline[i]], side = corners[outline[(i + 1) % count]] - a;
        const glm::dvec3 inward = glm::cross(normal, side);
        const double least = -slack * glm::length(side);
        for (size_t k = 0; k < count; ++k)
            if (glm::dot(inward, corners[outline[k]] - a) < least) return false;
    }
    return true;
}

/// Joins two patches along all of the sides that they share, if those hang together.
bool Finder::tryJoin(uint32_t a, uint32_t b) {
    SIGHTLINE_DEBUG_ASSERT(a != b && patch_of[a] == a && patch_of[b] == b);
    Patch &one = patches[a], &other = patches[b];
    if (one.double_sided != other.double_sided) return false;
    const double length_a = one.length(), length_b = other.length();
    if (!(length_a > 0 && length_b > 0)) return false;
    if (glm::dot(one.area, other.area) < (1.0 - kTurned) * length_a * length_b) return false;
    const size_t n = one.outline.size(), m = other.outline.size();
    const auto in_a = [&](size_t i) { return one.outline[i % n]; };
    const auto in_b = [&](size_t i) { return other.outline[i % m]; };
    // The first side of the chain in a, and the corner of b that ends it there.
    size_t i = 0, j = 0;
    const auto shared = [&](size_t side) {
        for (size_t k = 0; k < m; ++k)
            if (in_b(k) == in_a(side + 1) && in_b(k + 1) == in_a(side)) return k;
        return m;
    };
    while (i < n && shared(i) == m) ++i;
    if (i == n) return false;
    for (size_t back = 0; back < n && shared(i + n - 1) < m; ++back) i = (i + n - 1) % n;
    size_t chain = 0;
    while (chain < n && shared(i + chain) < m) ++chain;
    if (chain >= n || chain >= m || n + m - 2 * chain > VolumeParts::kMaxCorners) return false;
    j = (shared(i) + 1) % m;  // b's corner that equals a's corner i
    Array<uint32_t> outline(memory);
    for (size_t k = i + chain; k <= i + n; ++k) outline.push_back(in_a(k));
    for (size_t k = 1; k < m - chain; ++k) outline.push_back(in_b(j + k));
    const glm::dvec3 area = vectorArea(outline);
    const double length = glm::length(area);
    if (!(length > 0)) return false;
    const glm::dvec3 normal = area / length;
    Box3d box;
    for (uint32_t corner : outline) box.grow(corners[corner]);
    const double size = glm::length(box.size());
    const glm::dvec3 at = corners[outline[0]];
    for (uint32_t corner : outline)
        if (std::abs(glm::dot(normal, corners[corner] - at)) > kFlat * size) return false;
    if (!isConvex(outline, normal, kConvex * size)) return false;
    SIGHTLINE_DEBUG_ASSERT(outline.size() == n + m - 2 * chain);
    one.outline = std::move(outline);
    one.area = area;
    other.outline.clear();
    patch_of[b] = a;
    return true;
}

/// Joins polygons that share a side, the longest side first, until nothing can be joined.
void Finder::join() {
    struct Side {
        uint32_t low, high, polygon;
        bool forward;
    };
    struct Pair {
        double length;
        uint32_t a, b;
    };
    Array<Side> sides(memory);
    for (uint32_t p = 0; p < polygons.size(); ++p)
        for (int k = 0; k < polygons[p].count; ++k) {
            const uint32_t from = polygons[p].corner[k], to = polygons[p].corner[(k + 1) % polygons[p].count];
            sides.push_back({std::min(from, to), std::max(from, to), p, from < to});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.polygon, a.forward) < std::tie(b.low, b.high, b.polygon, b.forward);
    });
    Array<Pair> pairs(memory);
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side &a = sides[i], &b = sides[i + 1];
        if (a.low != b.low || a.high != b.high || a.forward == b.forward || a.polygon == b.polygon) continue;
        pairs.push_back({glm::length(corners[a.high] - corners[a.low]), a.polygon, b.polygon});
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
        return p.length != q.length ? p.length > q.length : std::tie(p.a, p.b) < std::tie(q.a, q.b);
    });
    // What was not convex may become so once its neighbours are joined.
    constexpr int kMostRounds = 8;
    bool changed = true;
    for (int round = 0; round < kMostRounds && changed; ++round) {
        changed = false;
        for (const Pair& pair : pairs) {
            const uint32_t a = find(pair.a), b = find(pair.b);
            if (a != b && tryJoin(a, b)) changed = true;
        }
    }
}

/// Whether b lies exactly on the segment from a to c: then the outline is the same without it.
bool isExactlyBetween(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 u = b - a, v = c - b;
    for (int k = 0; k < 3; ++k)  // Differences of floats are exact in double unless they lie 29 binary orders apart.
        if (a[k] + u[k] != b[k] || b[k] - u[k] != a[k] || b[k] + v[k] != c[k] || c[k] - v[k] != b[k]) return false;
    for (int k = 0; k < 3; ++k)
        if (!equalProducts(u[k], v[(k + 1) % 3], u[(k + 1) % 3], v[k])) return false;
    return glm::dot(u, v) > 0;
}

/// How far a vertex lies from the flat outline; negative if it lies beside it, where no bound is known.
double distanceFrom(const Array<glm::dvec3>& corners, std::span<const uint32_t> outline, const glm::dvec3& normal,
                    const glm::dvec3& v) {
    double height = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 a = corners[outline[i]], b = corners[outline[(i + 1) % outline.size()]];
        height = std::max(height, std::abs(glm::dot(normal, v - a)));
        if (glm::dot(glm::cross(normal, b - a), v - a) < 0) return -1;
    }
    return height;
}

/// Turns what was joined into faces.
struct FaceMaker {
    Finder& finder;
    VolumeParts& out;
    Array<uint32_t> kept;  ///< patches, the largest first

    void make();
    void makeFace(uint32_t patch, std::span<const uint32_t> vertices);
};

void FaceMaker::make() {
    Memory* memory = finder.memory;
    for (uint32_t p = 0; p < finder.patches.size(); ++p)
        if (finder.find(p) == p && finder.patches[p].length() > 0) kept.push_back(p);
    constexpr size_t kMostFaces = VolumeParts::kMaxFaces;
    std::sort(kept.begin(), kept.end(), [&](uint32_t a, uint32_t b) {
        const double p = finder.patches[a].length(), q = finder.patches[b].length();
        return p != q ? p > q : a < b;
    });
    kept.resize(std::min(kept.size(), kMostFaces));
    Array<uint32_t> rank(finder.patches.size(), ~0u, memory);
    for (uint32_t i = 0; i < kept.size(); ++i) rank[kept[i]] = i;
    Array<Array<uint32_t>> vertices(kept.size(), memory);
    for (uint32_t p = 0; p < finder.polygons.size(); ++p) {
        const uint32_t at = rank[finder.find(p)];
        if (at == ~0u) continue;
        const Finder::Polygon& polygon = finder.polygons[p];
        vertices[at].insert(vertices[at].end(), polygon.corner, polygon.corner + polygon.count);
    }
    out.corners = finder.corners;
    for (uint32_t i = 0; i < kept.size(); ++i) makeFace(kept[i], vertices[i]);
}

void FaceMaker::makeFace(uint32_t patch, std::span<const uint32_t> vertices) {
    const Patch& from = finder.patches[patch];
    VolumeFace face;
    face.area = from.length();
    face.normal = from.area / face.area;
    face.double_sided = from.double_sided;
    face.first = static_cast<uint32_t>(out.outline.size());
    const size_t n = from.outline.size();
    for (size_t i = 0; i < n; ++i) {
        const size_t before = out.outline.size() > face.first ? out.outline.back() : from.outline[(i + n - 1) % n];
        const uint32_t corner = from.outline[i];
        if (isExactlyBetween(out.corners[before], out.corners[corner], out.corners[from.outline[(i + 1) % n]]))
            continue;
        out.outline.push_back(corner);
        face.center += out.corners[corner];
    }
    face.count = static_cast<uint32_t>(out.outline.size()) - face.first;
    const std::span<const uint32_t> outline(out.outline.data() + face.first, face.count);
    bool sound = face.count >= 3;
    face.low = 1e300;
    face.high = -1e300;
    for (size_t i = 0; i < vertices.size() && sound; ++i) {
        const glm::dvec3& v = out.corners[vertices[i]];
        const double along = glm::dot(face.normal, v);
        const double slack = 0x1p-50 * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
        face.low = std::min(face.low, along - slack);
        face.high = std::max(face.high, along + slack);
        // Corners of the outline, and those that lay exactly on a side of it, are in its hull.
        if (std::find(from.outline.begin(), from.outline.end(), vertices[i]) != from.outline.end()) continue;
        const double distance = distanceFrom(out.corners, outline, face.normal, v);
        sound = distance >= 0;
        face.reach = std::max(face.reach, 2.0 * distance + 4.0 * slack);
    }
    if (!sound) {
        out.outline.resize(face.first);
        return;
    }
    face.center /= face.count;
    out.faces.push_back(face);
}

}  // namespace

void findVolumeFaces(const Occluder& occluder, Memory* memory, VolumeParts& out) {
    Finder finder(occluder, memory);
    finder.gather();
    finder.weld();
    finder.join();
    FaceMaker{finder, out, Array<uint32_t>(memory)}.make();
}

}  // namespace sightline
