// The law of proofs by several shadows: where nothing of a body is left, no line from the eye reaches it.
// SPDX-License-Identifier: MIT
#include "sightline/cull/proofs/uncovered.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline {
namespace {

using Real = long double;
using Real3 = glm::vec<3, Real, glm::defaultp>;

/// A mesh that stands somewhere, as an occluder and as triangles.
struct Hider {
    test::TestMesh mesh;
    glm::dmat4 transform{1.0};
    bool double_sided = false;
    Occluder occluder;
    VolumeParts parts;

    void prepare() {
        const std::vector<uint8_t> both(mesh.indices.size() / 3, double_sided);
        occluder = prepareOccluder(mesh.view(), {}, both);
        parts = findVolumeParts(occluder);
    }
};

/// Of what the eye sees: which triangles lie on a line, by their definition, in extended precision.
struct Truth {
    Real3 eye;
    std::vector<Real3> corners;
    std::vector<uint8_t> both;

    void add(const Hider& hider) {
        const bool flips = glm::determinant(glm::dmat3(hider.transform)) < 0;
        for (size_t i = 0; i < hider.mesh.indices.size(); ++i) {
            const size_t at = flips && i % 3 ? i - i % 3 + 3 - i % 3 : i;
            const glm::vec3& p = hider.mesh.positions[hider.mesh.indices[at]];
            Real3 q(0);
            for (int row = 0; row < 3; ++row)
                q[row] = Real(hider.transform[0][row]) * p.x + Real(hider.transform[1][row]) * p.y +
                         Real(hider.transform[2][row]) * p.z + Real(hider.transform[3][row]);
            corners.push_back(q);
            if (i % 3 == 2) both.push_back(hider.double_sided);
        }
    }
    /// Whether a front lies between the eye and a point.
    bool hides(const Real3& p) const {
        const Real3 way = p - eye;
        for (size_t t = 0; t < both.size(); ++t) {
            const Real3 a = corners[3 * t] - eye, b = corners[3 * t + 1] - eye, c = corners[3 * t + 2] - eye;
            const Real u = glm::dot(way, glm::cross(c, b)), v = glm::dot(way, glm::cross(a, c)),
                       w = glm::dot(way, glm::cross(b, a));
            const Real tiny = 1e-16L * (std::abs(u) + std::abs(v) + std::abs(w));
            const bool front = std::min({u, v, w}) >= -tiny, back = std::max({u, v, w}) <= tiny;
            if (!front && !(back && both[t])) continue;
            const Real3 normal = glm::cross(b - a, c - a);
            const Real at_eye = -glm::dot(normal, a), at_p = glm::dot(normal, way - a);
            if ((at_eye > 0 && at_p < 0) || (both[t] && at_eye < 0 && at_p > 0)) return true;
        }
        return false;
    }
};

struct Tries {
    int whole = 0, proved = 0, seams = 0;
};

/// Holds a body against all volumes of the hiders, and what that says against the truth.
void hold(Random& random, const std::vector<Hider>& hiders, const View& view, const std::vector<glm::dvec3>& body,
          bool box, Tries& tries) {
    const Screen screen = makeScreen(view, 384);
    const VolumeView volumes = makeVolumeView(view, screen, -screen.eye);
    const ImageFrame frame = makeImageFrame(screen);
    if (!frame.usable) return;
    Truth truth{Real3(screen.eye), {}, {}};
    std::vector<VolumePlace> places;
    for (const Hider& hider : hiders) {
        truth.add(hider);
        places.push_back(placeParts(volumes, hider.parts, hider.occluder.bounds, hider.transform));
    }
    std::vector<glm::dvec3> relative;
    for (const glm::dvec3& p : body) relative.push_back(p - screen.eye);
    Uncovered rest;
    if (!rest.begin(volumes, frame, relative.data(), static_cast<uint32_t>(relative.size()), volumes.place_error, box))
        return;
    ++tries.whole;
    Shadow shadow;
    VolumeOutline outline;
    for (size_t i = 0; i < hiders.size() && !rest.nothing(); ++i)
        for (uint32_t part = 0; part < hiders[i].parts.partCount() && !rest.nothing(); ++part)
            if (makeVolume(volumes, places[i], part, shadow.volume, outline) && makeShadow(frame, shadow)) {
                if (part % 2) rest.remove(shadow);
                else rest.take(shadow);
            }
    for (size_t i = 0; i < hiders.size() && !rest.nothing(); ++i)
        for (size_t k = 0; k < hiders.size() && !rest.nothing(); ++k)
            for (uint32_t f = 0; f < hiders[i].parts.faces.size(); ++f)
                for (uint32_t g = 0; g < hiders[k].parts.faces.size(); ++g) {
                    VolumeSeam seam{{f, g}, {}};
                    if (rest.nothing() || (i == k && f == g)) continue;
                    if (!findSeam(hiders[i].parts, hiders[i].transform, hiders[k].parts, hiders[k].transform, seam))
                        continue;
                    if (!makeSeamVolume(volumes, places[i], places[k], seam, shadow.volume)) continue;
                    if (makeShadow(frame, shadow)) tries.seams += rest.remove(shadow) > 0;
                }
    if (!rest.nothing()) return;
    ++tries.proved;
    const auto inView = [&](const glm::dvec3& p) {
        const glm::dvec4 q(p - screen.eye, 1.0);
        const double w = glm::dot(screen.w, q), x = glm::dot(screen.x, q), y = glm::dot(screen.y, q);
        return glm::dot(screen.near, q) > 0 && x > 0 && x < screen.width * w && y > 0 && y < screen.height * w;
    };
    for (int sample = 0; sample < 200; ++sample) {
        glm::dvec3 p(0.0);
        if (sample < int(body.size())) {
            p = body[static_cast<size_t>(sample)];
        } else {
            double sum = 0;
            for (const glm::dvec3& corner : body) {
                const double weight = random.below(3) ? std::pow(random.uniform(), 4.0) : 0.0;
                p += weight * corner;
                sum += weight;
            }
            if (!(sum > 0)) continue;
            p /= sum;
        }
        if (inView(p)) { EXPECT_TRUE(truth.hides(Real3(p))) << p.x << " " << p.y << " " << p.z; }
    }
}

std::vector<glm::dvec3> boxAround(const glm::dvec3& middle, const glm::dvec3& half) {
    std::vector<glm::dvec3> corners;
    for (uint32_t i = 0; i < 8; ++i) corners.push_back(Box3d{middle - half, middle + half}.corner(i));
    return corners;
}

/// A rectangle in the plane z = 0 that faces z.
Hider panel(float x0, float y0, float x1, float y1) {
    Hider hider;
    hider.mesh.positions = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
    hider.mesh.fan({0, 1, 2, 3});
    return hider;
}

TEST(Uncovered, PanelsThatMeetHideAsOne) {
    Tries tries, holes;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const bool hole = random.below(3) == 0;
        std::vector<Hider> hiders;
        const uint32_t missing = static_cast<uint32_t>(random.below(16));
        for (uint32_t i = 0; i < 16; ++i) {
            if (hole && i == missing) continue;
            // Either in one frame, or moved to where they are by whole units.
            const float x = float(i % 4) * 2 - 4, y = float(i / 4) * 2 - 4;
            Hider hider = seed % 2 ? panel(x, y, x + 2, y + 2) : panel(0, 0, 2, 2);
            if (seed % 2 == 0) hider.transform[3] = glm::dvec4(x, y, 0, 1);
            hider.double_sided = random.below(4) == 0;
            hiders.push_back(hider);
        }
        for (Hider& hider : hiders) hider.prepare();
        const glm::dvec3 eye(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(0.5, 6));
        const View view = test::viewAt(eye, {random.uniform(-2, 2), random.uniform(-2, 2), 0},
                                       {.degrees = random.uniform(30, 120), .z_near = 0.1});
        for (int i = 0; i < 20; ++i)
            hold(random, hiders, view,
                 boxAround({random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-6, 0)},
                           test::randomVector(random, 1.5)),
                 true, hole ? holes : tries);
    }
    EXPECT_GT(tries.proved, tries.whole / 4);
    EXPECT_GT(tries.seams, 100);
    EXPECT_GT(holes.proved, 20);
    RecordProperty("proved", std::to_string(tries.proved) + " of " + std::to_string(tries.whole));
}

/// Boxes, walls and odd triangles, anywhere and however turned; bodies of few points. Mostly nothing is proved.
TEST(Uncovered, NothingIsLeftOnlyOfWhatIsHidden) {
    Tries tries;
    for (uint64_t seed = 1; seed <= 500; ++seed) {
        Random random(seed);
        std::vector<Hider> hiders(1 + random.below(5));
        const double far = random.below(4) == 0 ? 1e5 : 0;
        const glm::dvec3 place = far * test::randomUnit(random);
        for (Hider& hider : hiders) {
            const glm::vec3 half(float(random.uniform(0.5, 6)), float(random.uniform(0.5, 6)),
                                 float(random.uniform(0.05, 1)));
            hider.mesh = test::boxMesh(-half, half);
            if (random.below(5) == 0) std::reverse(hider.mesh.indices.begin(), hider.mesh.indices.end());
            if (random.below(5) == 0) hider.mesh.indices.resize(3 * (1 + random.below(12)));
            hider.double_sided = random.below(3) == 0;
            for (int column = 0; column < 3; ++column)
                hider.transform[column] += glm::dvec4(test::randomVector(random, random.below(2) ? 0.6 : 0.0), 0);
            if (random.below(4) == 0) hider.transform[0] = -hider.transform[0];
            hider.transform[3] = glm::dvec4(place + test::randomVector(random, 3.0), 1);
            hider.prepare();
        }
        const glm::dvec3 eye = place + glm::dvec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(1, 9));
        const View view =
            test::viewAt(eye, place, {.degrees = random.uniform(2, 150), .z_near = random.uniform(0.01, 2)});
        for (int i = 0; i < 12; ++i) {
            const glm::dvec3 middle =
                place + glm::dvec3(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-12, 2));
            const bool box = random.below(2);
            std::vector<glm::dvec3> body = boxAround(middle, test::randomVector(random, box ? 2.0 : 0.5));
            if (!box)
                for (uint64_t more = random.below(20); more > 0; --more)
                    body.push_back(middle + test::randomVector(random, 1.5));
            hold(random, hiders, view, body, box, tries);
        }
    }
    EXPECT_GT(tries.proved, 300);
    RecordProperty("proved", std::to_string(tries.proved) + " of " + std::to_string(tries.whole));
}

/// Boxes that are known in float alone, and reach into the image by less than that tells, or over the near plane.
TEST(Uncovered, WhatMayReachIntoTheImageIsLeft) {
    int tried = 0;
    for (uint64_t seed = 1; seed <= 4000; ++seed) {
        Random random(seed);
        const double degrees = random.uniform(1, 150), near = random.uniform(0.01, 2);
        View view = test::viewFrom({0, 0, 0}, test::randomUnit(random), {.degrees = degrees, .z_near = near});
        view.jitter = 0;
        const Screen screen = makeScreen(view, 384);
        const VolumeView volumes = makeVolumeView(view, screen, -screen.eye);
        const ImageFrame frame = makeImageFrame(screen);
        ASSERT_TRUE(frame.usable);
        // The corner of a box that is in view, by a little at most.
        const double inside = random.uniform(0, 1e-7);
        const bool by_near = random.below(4) == 0;
        const glm::dvec2 at(by_near ? random.uniform(-0.9, 0.9) : 1 - inside, random.uniform(-0.9, 0.9));
        const glm::dvec3 corner =
            frame.back * glm::dvec3(at, 1.0) * (by_near ? near * (1 + inside) : random.uniform(2.5, 60));
        const glm::dvec3 out = by_near ? -frame.w / glm::length(frame.w) : frame.x - frame.w;
        Box3d box;
        box.grow(corner);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 other = corner;
            other[axis] += std::copysign(random.uniform(0.01, 1), out[axis]);
            box.grow(other);
        }
        glm::dvec3 rounded[8];
        double error = 0;
        for (uint32_t i = 0; i < 8; ++i) {
            rounded[i] = glm::dvec3(glm::vec3(box.corner(i)));
            error =
                std::max(error, 0x1p-23 * (std::abs(rounded[i].x) + std::abs(rounded[i].y) + std::abs(rounded[i].z)));
        }
        Uncovered rest;
        if (!rest.begin(volumes, frame, rounded, 8, error, true)) continue;
        ++tried;
        EXPECT_FALSE(rest.nothing()) << "seed " << seed;
    }
    EXPECT_GT(tried, 2000);
}

TEST(ImageFrames, AreNotUsableWhereNumbersEnd) {
    for (const double scale : {1e-160, 1e-7, 1e7, 1e150}) {
        View view = test::viewFrom({0, 0, 0}, {0, 0, -1});
        view.projection[0][0] *= scale;
        view.projection[1][1] *= scale;
        EXPECT_FALSE(makeImageFrame(makeScreen(view, 384)).usable) << scale;
    }
}

TEST(Seams, AreFoundWhereSidesLieExactlyOnOneLine) {
    const auto meet = [](Hider a, Hider b) {
        a.prepare();
        b.prepare();
        VolumeSeam seam{{0, 0}, {}};
        return findSeam(a.parts, a.transform, b.parts, b.transform, seam);
    };
    EXPECT_TRUE(meet(panel(0, 0, 2, 2), panel(2, 0, 4, 2)));
    EXPECT_TRUE(meet(panel(0, 0, 2, 2), panel(2, 0.3f, 4, 1.1f))) << "a part of a side";
    EXPECT_FALSE(meet(panel(0, 0, 2, 2), panel(2.000001f, 0, 4, 2)));
    EXPECT_FALSE(meet(panel(0, 0, 2, 2), panel(0, 0, 2, 2))) << "they lie on one another";
    Hider moved = panel(0, 0, 2, 2);
    moved.transform[3].x = 2;
    EXPECT_TRUE(meet(panel(0, 0, 2, 2), moved));
    moved.transform[3].x = 2 + 1e-12;
    EXPECT_FALSE(meet(panel(0, 0, 2, 2), moved));
    moved.transform[3] = glm::dvec4(0.1, 0, 0, 1);
    Hider tenth = panel(-2, 0, 0, 2);
    tenth.transform[3] = glm::dvec4(0.1, 0, 0, 1);
    EXPECT_TRUE(meet(tenth, moved)) << "the same transform";
    tenth.transform[3].y = 1;
    EXPECT_FALSE(meet(tenth, moved)) << "0.1 is no sum of floats";
    Hider turned = panel(0, 0, 2, 2);
    turned.transform = glm::dmat4(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1);  // a quarter turn, to x from 2 to 4
    EXPECT_TRUE(meet(panel(0, 0, 2, 2), turned));
    Hider wall = panel(0, 0, 2, 2);  // folded back along x = 2
    wall.transform = glm::dmat4(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 1);
    EXPECT_TRUE(meet(panel(0, 0, 2, 2), wall));
}

}  // namespace
}  // namespace sightline
