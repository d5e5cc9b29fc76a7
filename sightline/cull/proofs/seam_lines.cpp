// Whether two faces meet in a line: by exact predicates on where their corners stand in the world.
// SPDX-License-Identifier: MIT
//
// T. J. Dekker. A Floating-Point Technique for Extending the Available Precision. 1971.
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cull/occluder_volumes.h"
#include "sightline/math/exact_product.h"

namespace sightline {
namespace {

/// a + b, if that is a number of its own.
bool addExactly(double a, double b, double& sum) {
    sum = a + b;
    const double of_b = sum - a;
    return a == sum - of_b && b == of_b && std::isfinite(sum);
}

/// Carries corners through a transform without rounding; false where that cannot be done.
class ExactPlace {
public:
    explicit ExactPlace(const glm::dmat4& transform) : transform_(transform) {
        for (int row = 0; row < 3; ++row) {
            int terms = 0;
            for (int column = 0; column < 3; ++column) {
                const double factor = transform[column][row];
                if (factor == 0) continue;
                axis_[row] = column;
                plain_ = plain_ && std::abs(factor) == 1 && ++terms == 1;
            }
            plain_ = plain_ && terms == 1;
        }
    }
    bool operator()(const glm::dvec3& from, glm::dvec3& to) const {
        if (!plain_) return false;
        for (int row = 0; row < 3; ++row)
            if (!addExactly(transform_[axis_[row]][row] * from[axis_[row]], transform_[3][row], to[row])) return false;
        return true;
    }

private:
    const glm::dmat4& transform_;
    int axis_[3] = {};
    bool plain_ = true;
};

/// The corners of a face where they stand.
struct Outline {
    uint32_t count = 0;
    glm::dvec3 corner[OccluderVolume::kMaxSides];

    template <class Place>
    bool set(const VolumeParts& parts, const VolumeFace& face, const Place& place) {
        if (face.count > OccluderVolume::kMaxSides) return false;
        for (count = 0; count < face.count; ++count)
            if (!place(parts.corners[parts.outline[face.first + count]], corner[count])) return false;
        return true;
    }
};

/// Whether c lies exactly on the line through a and b.
bool isOnLine(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    glm::dvec3 u, v;
    for (int k = 0; k < 3; ++k)
        if (!addExactly(b[k], -a[k], u[k]) || !addExactly(c[k], -a[k], v[k])) return false;
    for (int k = 0; k < 3; ++k)
        if (!equalProducts(u[k], v[(k + 1) % 3], u[(k + 1) % 3], v[k])) return false;
    return true;
}

}  // namespace

bool findSeam(const VolumeParts& one, const glm::dmat4& transform, const VolumeParts& other,
              const glm::dmat4& other_transform, VolumeSeam& seam) {
    SIGHTLINE_DEBUG_ASSERT(seam.face[0] < one.faces.size() && seam.face[1] < other.faces.size());
    const VolumeFace &f = one.faces[seam.face[0]], &g = other.faces[seam.face[1]];
    const auto as_it_is = [](const glm::dvec3& from, glm::dvec3& to) {
        to = from;
        return true;
    };
    Outline a, b;
    const bool known = transform == other_transform
                           ? a.set(one, f, as_it_is) && b.set(other, g, as_it_is)
                           : a.set(one, f, ExactPlace(transform)) && b.set(other, g, ExactPlace(other_transform));
    if (!known) return false;
    for (seam.side[0] = 0; seam.side[0] < a.count; ++seam.side[0]) {
        const glm::dvec3 &p = a.corner[seam.side[0]], &q = a.corner[(seam.side[0] + 1) % a.count];
        for (seam.side[1] = 0; seam.side[1] < b.count; ++seam.side[1]) {
            const glm::dvec3 &r = b.corner[seam.side[1]], &s = b.corner[(seam.side[1] + 1) % b.count];
            if (glm::dot(q - p, s - r) < 0 && isOnLine(p, q, r) && isOnLine(p, q, s)) return true;
        }
    }
    return false;
}

}  // namespace sightline
