// What of an occluder can hide things by itself: its large convex faces, and convex bodies of several faces.
// SPDX-License-Identifier: MIT
#include "sightline/cull/volume_parts.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "sightline/base/assert.h"
#include "sightline/cull/volume_faces.h"

namespace sightline {
namespace {

constexpr double kPartConvex = 1e-5;  // of the size: how far a corner may lie before another face's plane

/// Joins faces to convex bodies and lists the parts.
struct PartMaker {
    VolumeParts& out;
    Memory* memory;

    struct Side {
        uint32_t low, high, face;
        bool forward;
    };
    Array<Side> sides{memory};
    Array<Array<uint32_t>> neighbours{memory};
    Array<uint32_t> body_of{memory};  ///< per face: the part, or VolumePart::kNone

    void findNeighbours();
    bool fits(std::span<const uint32_t> faces, uint32_t face, double size) const;
    void growBodies();
    void addPart(std::span<const uint32_t> faces) { out.parts.push_back(makePart(faces)); }
    VolumePart makePart(std::span<const uint32_t> faces);
    void addEdges(VolumePart& part, std::span<const uint32_t> faces);
    void listFaces();
    std::span<const uint32_t> outlineOf(uint32_t face) const {
        return {out.outline.data() + out.faces[face].first, out.faces[face].count};
    }
};

void PartMaker::findNeighbours() {
    for (uint32_t f = 0; f < out.faces.size(); ++f) {
        const auto outline = outlineOf(f);
        for (size_t i = 0; i < outline.size(); ++i) {
            const uint32_t from = outline[i], to = outline[(i + 1) % outline.size()];
            sides.push_back({std::min(from, to), std::max(from, to), f, from < to});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face, a.forward) < std::tie(b.low, b.high, b.face, b.forward);
    });
    neighbours.resize(out.faces.size());
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side &a = sides[i], &b = sides[i + 1];
        if (a.low != b.low || a.high != b.high || a.forward == b.forward || a.face == b.face) continue;
        neighbours[a.face].push_back(b.face);
        neighbours[b.face].push_back(a.face);
    }
}

/// Whether a face can join others: each lies behind the other's plane.
bool PartMaker::fits(std::span<const uint32_t> faces, uint32_t face, double size) const {
    const auto behind = [&](uint32_t what, uint32_t plane) {
        const VolumeFace& f = out.faces[plane];
        for (uint32_t corner : outlineOf(what))
            if (glm::dot(f.normal, out.corners[corner]) > f.high + kPartConvex * size) return false;
        return true;
    };
    for (uint32_t other : faces)
        if (!behind(face, other) || !behind(other, face)) return false;
    return true;
}

/// Bodies grow from the largest face that has none, over sides, the largest neighbour first.
void PartMaker::growBodies() {
    Array<uint32_t> faces(memory), front(memory);
    for (uint32_t seed = 0; seed < out.faces.size() && out.parts.size() < VolumeParts::kMaxParts / 2; ++seed) {
        if (body_of[seed] != VolumePart::kNone) continue;
        faces.assign(1, seed);
        front.assign(neighbours[seed].begin(), neighbours[seed].end());
        Box3d box;
        for (uint32_t corner : outlineOf(seed)) box.grow(out.corners[corner]);
        size_t corners = out.faces[seed].count;
        while (!front.empty() && faces.size() < VolumePart::kMaxFaces) {
            const auto largest = std::min_element(front.begin(), front.end());  // faces lie by falling area
            const uint32_t face = *largest;
            erase(front, face);
            if (std::find(faces.begin(), faces.end(), face) != faces.end() || body_of[face] != VolumePart::kNone)
                continue;
            if (corners + out.faces[face].count > 2 * VolumeParts::kMaxCorners) continue;
            if (!fits(faces, face, glm::length(box.size()))) continue;
            faces.push_back(face);
            corners += out.faces[face].count;
            for (uint32_t corner : outlineOf(face)) box.grow(out.corners[corner]);
            front.insert(front.end(), neighbours[face].begin(), neighbours[face].end());
        }
        if (faces.size() < 2) continue;
        for (uint32_t face : faces) body_of[face] = static_cast<uint32_t>(out.parts.size());
        addPart(faces);
        SIGHTLINE_DEBUG_ASSERT(out.parts.size() <= VolumeParts::kMaxParts / 2);
    }
}

VolumePart PartMaker::makePart(std::span<const uint32_t> faces) {
    SIGHTLINE_DEBUG_ASSERT(!faces.empty() && faces.size() <= VolumePart::kMaxFaces);
    VolumePart part;
    part.first_face = static_cast<uint32_t>(out.members.size());
    part.face_count = static_cast<uint32_t>(faces.size());
    Box3d box;
    for (uint32_t face : faces) {
        out.members.push_back(face);
        part.area += out.faces[face].area;
        for (uint32_t corner : outlineOf(face)) box.grow(out.corners[corner]);
    }
    part.center = box.center();
    part.radius = 0.5 * glm::length(box.size());
    if (faces.size() > 1) {
        part.area *= 0.5;
        addEdges(part, faces);
    } else {
        part.body = body_of[faces[0]];
    }
    return part;
}

void PartMaker::addEdges(VolumePart& part, std::span<const uint32_t> faces) {
    part.first_edge = static_cast<uint32_t>(out.edges.size());
    for (uint8_t f = 0; f < faces.size(); ++f) {
        const auto outline = outlineOf(faces[f]);
        for (size_t i = 0; i < outline.size(); ++i) {
            const uint32_t from = outline[i], to = outline[(i + 1) % outline.size()];
            const auto partner = std::find_if(
                out.edges.begin() + part.first_edge, out.edges.end(),
                [&](const VolumeEdge& e) { return e.from == to && e.to == from && e.right == VolumeEdge::kNone; });
            if (partner != out.edges.end()) partner->right = f;
            else out.edges.push_back({from, to, f, VolumeEdge::kNone});
        }
    }
    part.edge_count = static_cast<uint32_t>(out.edges.size()) - part.first_edge;
}

void PartMaker::listFaces() {
    findNeighbours();
    body_of.assign(out.faces.size(), VolumePart::kNone);
    growBodies();
    for (uint32_t face = 0; face < out.faces.size(); ++face) {
        Array<VolumePart>& to = out.parts.size() < VolumeParts::kMaxParts ? out.parts : out.more;
        to.push_back(makePart(std::span(&face, 1)));
    }
}

}  // namespace

VolumeParts findVolumeParts(const Occluder& occluder, Memory* memory) {
    VolumeParts out(memory);
    findVolumeFaces(occluder, memory, out);
    PartMaker{out, memory}.listFaces();
    SIGHTLINE_DEBUG_ASSERT(out.parts.size() <= VolumeParts::kMaxParts && out.faces.size() <= VolumeParts::kMaxFaces);
    return out;
}

}  // namespace sightline
