// The truth about faces for the tests of what culls them: signs in 113 bits, and random triangles that are hard to tell.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/geom/mesh_view.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

namespace sightline::test {

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;
#else
typedef long double Quad;  // has as many bits where the other is not known
#endif

struct QuadVector {
    Quad x, y, z;
};

inline QuadVector quad(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline QuadVector operator-(const QuadVector& a, const QuadVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Quad dot(const QuadVector& a, const QuadVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline QuadVector cross(const QuadVector& a, const QuadVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Six times the volume over (eye - w * corner); positive: front. Wrong by 2^-105 of the largest terms at most, where the
/// tests that it judges allow themselves 2^-20.
inline Quad trueFacing(const QuadVector& a, const QuadVector& b, const QuadVector& c, const QuadVector& eye, double w) {
    return dot(cross(b - a, c - a), {eye.x - w * a.x, eye.y - w * a.y, eye.z - w * a.z});
}

inline Quad trueFacing(const MeshView& mesh, size_t triangle, const glm::dvec3& eye, double w) {
    const auto corner = [&](int k) { return quad(glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]])); };
    return trueFacing(corner(0), corner(1), corner(2), quad(eye), w);
}

/// Triangles of all sorts around a place: some seen nearly or exactly edge-on from the eye, some nearly lines, some without area.
inline TestMesh randomTriangles(Random& random, size_t count, const glm::dvec3& place, double size,
                                const glm::dvec3& eye) {
    TestMesh mesh;
    for (size_t i = 0; i < count; ++i) {
        const double small = size * std::ldexp(1.0, -static_cast<int>(random.below(12)));
        const glm::dvec3 a = place + randomVector(random, size), b = a + randomVector(random, small);
        glm::dvec3 c = a + randomVector(random, small);
        const uint64_t sort = random.below(8);
        if (sort == 0) c = eye + random.uniform(0.2, 2.0) * (a - eye) + random.uniform(0.0, 1.0) * (b - eye);
        if (sort == 1) c = glm::mix(a, b, random.uniform());
        if (sort == 2) c = glm::mix(a, b, random.uniform()) + randomVector(random, small * 0x1p-18);
        if (sort == 3 && i % 16 == 0) c = b;
        mesh.add(glm::vec3(a), glm::vec3(b), glm::vec3(c));
    }
    return mesh;
}

inline bool bitOf(const std::vector<uint8_t>& bits, size_t i) { return bits[i / 8] >> (i % 8) & 1; }

}  // namespace sightline::test
