// Clips indexed triangles at planes of clip space: trivial reject and accept by outcodes, cuts that keep shared edges.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/clip_mesh.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline::studies {
namespace {

/// Bit i: outside of plane i of `clip`; bit 16 + i: of plane i of `reject`.
using Outcode = uint32_t;
constexpr int kRejectShift = ClipVolume::kMaxPlanes;
constexpr Outcode kClipBits = (1u << kRejectShift) - 1;
/// Outside of everything: a vertex that is not finite.
constexpr Outcode kBroken = ~0u;

Outcode codeOf(const glm::dvec4& v, const ClipVolume& volume) {
    Outcode code = 0;
    for (int i = 0; i < volume.count; ++i) code |= Outcode{glm::dot(volume.planes[i], v) < 0} << i;
    return code;
}

bool isFinite(const glm::dvec4& v) {
    return std::isfinite(std::abs(v.x) + std::abs(v.y) + std::abs(v.z) + std::abs(v.w));
}

/// A polygon's vertices by number; a triangle gains at most one a plane, and one more where rounding bends it.
struct Ring {
    uint32_t vertices[3 + 2 * ClipVolume::kMaxPlanes];
    int count = 0;

    void push(uint32_t vertex) {
        if (count < static_cast<int>(std::size(vertices))) vertices[count++] = vertex;
    }
};

class Clipper {
public:
    Clipper(const ClipVolume& clip, std::vector<Outcode>& codes, ClippedMesh& out)
        : clip_(clip), codes_(codes), out_(out) {}

    /// Cuts a ring at a plane.
    void cutAt(int plane, const Ring& in, Ring& out) {
        out.count = 0;
        const Outcode bit = 1u << plane;
        uint32_t previous = in.vertices[in.count - 1];
        for (int i = 0; i < in.count; ++i) {
            const uint32_t current = in.vertices[i];
            const bool was_out = (codes_[previous] & bit) != 0, is_out = (codes_[current] & bit) != 0;
            if (!was_out && is_out) pushCrossing(plane, previous, current, out);
            if (was_out && !is_out) pushCrossing(plane, current, previous, out);
            if (!is_out) out.push(current);
            previous = current;
        }
    }

private:
    void pushCrossing(int plane, uint32_t inside, uint32_t outside, Ring& ring) {
        const glm::dvec4 from = out_.vertices[inside], to = out_.vertices[outside];
        // A side that was inherited may contradict its distance by rounding: it lies on the plane then.
        const double in_distance = std::max(glm::dot(clip_.planes[plane], from), 0.0);
        const double out_distance = std::min(glm::dot(clip_.planes[plane], to), 0.0);
        if (in_distance == 0) return;  // the inside end is the crossing
        const double t = in_distance / (in_distance - out_distance);
        const glm::dvec4 at = from + t * (to - from);
        const Outcode a = codes_[inside], b = codes_[outside];
        const Outcode code = ((codeOf(at, clip_) & (a | b)) | (a & b)) & kClipBits & ~(1u << plane);
        ring.push(static_cast<uint32_t>(out_.vertices.size()));
        out_.vertices.push_back(at);
        out_.cuts.push_back({inside, outside, t});
        codes_.push_back(code);
    }

    const ClipVolume& clip_;
    std::vector<Outcode>& codes_;
    ClippedMesh& out_;
};

void emitFan(const Ring& ring, uint32_t triangle, ClippedMesh& out) {
    if (ring.count < 3) return;
    appendFan({ring.vertices, static_cast<size_t>(ring.count)}, out.indices);
    const size_t made = static_cast<size_t>(ring.count) - 2;
    out.source.insert(out.source.end(), made, triangle);
    out.counters.produced += made;
}

}  // namespace

ClipVolume frustumVolume() { return guardBandVolume(1.0); }

ClipVolume guardBandVolume(double width) {
    ClipVolume volume;
    volume.add({0, 0, 1, 1}).add({0, 0, -1, 1});
    return volume.add({1, 0, 0, width}).add({-1, 0, 0, width}).add({0, 1, 0, width}).add({0, -1, 0, width});
}

void appendFan(std::span<const uint32_t> polygon, std::vector<uint32_t>& indices) {
    for (size_t i = 2; i < polygon.size(); ++i) indices.insert(indices.end(), {polygon[0], polygon[i - 1], polygon[i]});
}

void clipMesh(std::span<const glm::dvec4> vertices, std::span<const uint32_t> indices, const ClipVolume& reject,
              const ClipVolume& clip, ClippedMesh& out) {
    SIGHTLINE_ASSERT(reject.count <= ClipVolume::kMaxPlanes && clip.count <= ClipVolume::kMaxPlanes);
    out.vertices.assign(vertices.begin(), vertices.end());
    out.cuts.clear();
    out.indices.clear();
    out.source.clear();
    out.counters = {};
    std::vector<Outcode> codes(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i)
        codes[i] =
            isFinite(vertices[i]) ? codeOf(vertices[i], clip) | codeOf(vertices[i], reject) << kRejectShift : kBroken;
    Clipper clipper(clip, codes, out);
    ClipCounters& counters = out.counters;
    for (uint32_t triangle = 0; triangle < indices.size() / 3; ++triangle) {
        const uint32_t* corner = indices.data() + 3 * size_t{triangle};
        const Outcode a = codes[corner[0]], b = codes[corner[1]], c = codes[corner[2]];
        ++counters.triangles;
        Ring ring;
        ring.count = 3;
        std::copy(corner, corner + 3, ring.vertices);
        if ((a & b & c) != 0 || a == kBroken || b == kBroken || c == kBroken) {
            ++counters.rejected;
        } else if (((a | b | c) & kClipBits) == 0) {
            ++counters.accepted;
            counters.spared += (a | b | c) != 0;
            emitFan(ring, triangle, out);
        } else {
            ++counters.clipped;
            for (int plane = 0; plane < clip.count && ring.count > 0; ++plane) {
                if (((a | b | c) >> plane & 1u) == 0) continue;
                Ring rest;
                clipper.cutAt(plane, ring, rest);
                ring = rest;
            }
            emitFan(ring, triangle, out);
        }
    }
}

}  // namespace sightline::studies
