// The law of the volumes: from no point of a hidden box does a line reach the eye past the occluder's drawn front faces.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occluder_volumes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/tree/bvh.h"
#include "tests/support/meshes.h"
#include "tests/support/targets.h"
#include "tests/support/views.h"

namespace sightline {
namespace {

using Real = long double;
using Real3 = glm::vec<3, Real, glm::defaultp>;

View viewAt(const glm::dvec3& eye, const glm::dvec3& target, double near) {
    return test::viewAt(eye, target, {.degrees = 68, .width = 1920, .height = 1280, .z_near = near});
}

struct MeshData : test::TestMesh {
    bool double_sided = false;

    Occluder prepared() const {
        const std::vector<uint8_t> both(indices.size() / 3, double_sided);
        return prepareOccluder(view(), {}, both);
    }
};

/// A wall in the plane z = 0 that faces z, in cells; bent by `bend`.
MeshData wall(uint32_t columns, uint32_t rows, float width, float height, float bend = 0) {
    MeshData mesh;
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x) {
            const float u = float(x) / float(columns) - 0.5f, v = float(y) / float(rows) - 0.5f;
            mesh.positions.push_back({width * u, height * v, bend * (u * u - v * v)});
        }
    mesh.addGrid(columns + 1, rows + 1);
    return mesh;
}

MeshData box(float x, float y, float z, bool inward = false) {
    const glm::vec3 half(0.5f * x, 0.5f * y, 0.5f * z);
    MeshData mesh{test::boxMesh(-half, half)};
    if (inward) std::reverse(mesh.indices.begin(), mesh.indices.end());
    return mesh;
}

/// A closed prism over a regular polygon.
MeshData prism(uint32_t sides, float radius, float height) {
    MeshData mesh;
    for (uint32_t k = 0; k < sides; ++k) {
        const float angle = 6.2831853f * float(k) / float(sides);
        for (const float y : {-0.5f, 0.5f})
            mesh.positions.push_back({radius * std::cos(angle), height * y, -radius * std::sin(angle)});
    }
    for (uint32_t k = 0; k < sides; ++k) {
        const uint32_t n = (k + 1) % sides;
        mesh.fan({2 * k, 2 * n, 2 * n + 1, 2 * k + 1});
        if (k > 0 && n > 0) {
            mesh.fan({1, 2 * k + 1, 2 * n + 1});
            mesh.fan({0, 2 * n, 2 * k});
        }
    }
    return mesh;
}

MeshData randomMesh(Random& random) {
    const auto side = [&] { return float(random.uniform(0.5, 4)); };
    MeshData mesh;
    switch (random.below(8)) {
        case 0: {
            for (int k = 0; k < 3; ++k) mesh.positions.push_back({side(), side(), side()});
            mesh.fan({0, 1, 2});
            break;
        }
        case 1:
            mesh = wall(1, 1, side(), side());
            break;
        case 2:
            mesh = wall(1 + uint32_t(random.below(9)), 1 + uint32_t(random.below(9)), side(), side());
            break;
        case 3:
            mesh = wall(4, 4, side(), side(), float(random.uniform(-1e-3, 1e-3)));
            break;
        case 4:
            mesh = box(side(), side(), side(), random.below(4) == 0);
            break;
        case 5:
            mesh = prism(3 + uint32_t(random.below(12)), side(), side());
            break;
        case 6:
            mesh = prism(16 + uint32_t(random.below(32)), side(), side());
            break;
        default: {  // any triangles: what is joined to bodies is not convex
            for (int k = 0; k < 12; ++k) mesh.positions.push_back({side(), side(), side()});
            for (int k = 0; k < 10; ++k) {
                const uint32_t a = uint32_t(random.below(12)), b = uint32_t(random.below(12)),
                               c = uint32_t(random.below(12));
                if (a != b && b != c && c != a) mesh.fan({a, b, c});
            }
        }
    }
    mesh.double_sided = random.below(4) == 0;
    return mesh;
}

glm::dmat4 randomTransform(Random& random, double scale) {
    glm::dmat4 t(1.0);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) t[column][row] = random.uniform(-1, 1);
    if (random.below(2)) {  // rigid
        glm::dvec3 x = glm::normalize(glm::dvec3(t[0])), y = glm::normalize(glm::cross(x, glm::dvec3(t[1])));
        t[0] = glm::dvec4(x, 0), t[1] = glm::dvec4(y, 0), t[2] = glm::dvec4(glm::cross(x, y), 0);
        if (random.below(3) == 0) t[2] = -t[2];  // mirrored
    }
    for (int column = 0; column < 3; ++column) t[column] *= scale;
    return t;
}

/// The eye's rays, by the definition of clip space, in extended precision.
struct Oracle {
    Real3 eye{0}, direction{0};
    glm::vec<4, Real, glm::defaultp> near{0};
    bool perspective = true;
    std::vector<Real3> corners;  ///< of the triangles, in world space
    bool flips = false, double_sided = false;

    Oracle(const View& view, const MeshData& mesh, const glm::dmat4& transform) {
        Real rows[4][4] = {};  // projection * view
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                for (int k = 0; k < 4; ++k) rows[r][c] += Real(view.projection[k][r]) * Real(view.view[c][k]);
        perspective = !isOrthographic(view);
        const auto normal = [&](int r) { return Real3(rows[r][0], rows[r][1], rows[r][2]); };
        if (perspective) {  // where x, y and w vanish
            const Real3 a = normal(0), b = normal(1), c = normal(3);
            const Real det = glm::dot(a, glm::cross(b, c));
            eye =
                -(rows[0][3] * glm::cross(b, c) + rows[1][3] * glm::cross(c, a) + rows[3][3] * glm::cross(a, b)) / det;
        } else {
            direction = glm::cross(normal(0), normal(1));
            direction = direction / glm::length(direction);
            if (glm::dot(direction, normal(2)) < 0) direction = -direction;
        }
        for (int c = 0; c < 4; ++c) near[c] = rows[2][c] + rows[3][c];
        for (uint32_t index : mesh.indices) {
            const glm::vec3& p = mesh.positions[index];
            Real3 q(0);
            for (int row = 0; row < 3; ++row)
                q[row] = Real(transform[0][row]) * p.x + Real(transform[1][row]) * p.y + Real(transform[2][row]) * p.z +
                         Real(transform[3][row]);
            corners.push_back(q);
        }
        flips = glm::determinant(glm::dmat3(transform)) < 0;
        double_sided = mesh.double_sided;
    }

    Real nearAt(const Real3& q) const { return near.x * q.x + near.y * q.y + near.z * q.z + near.w; }

    /// Whether the part of the line to the eye that is drawn meets a drawn face.
    bool hides(const Real3& p) const {
        const Real3 back = perspective ? p - eye : direction;  // along the ray
        for (size_t i = 0; i + 2 < corners.size(); i += 3) {
            const Real3 a = corners[i] - p, b = corners[i + 1] - p, c = corners[i + 2] - p;
            const Real u = glm::dot(back, glm::cross(b, c)), v = glm::dot(back, glm::cross(c, a)),
                       w = glm::dot(back, glm::cross(a, b));
            const Real sum = u + v + w, size = std::abs(u) + std::abs(v) + std::abs(w);
            // A ray through a side that two triangles share may miss both by rounding.
            const Real tiny = 1e-15L * size;
            const bool all = std::min({u, v, w}) >= -tiny, none = std::max({u, v, w}) <= tiny;
            if (!(all || none) || std::abs(sum) <= tiny) continue;
            const bool front = (sum < 0) != flips;
            if (!front && !double_sided) continue;
            const Real3 hit = (u * corners[i] + v * corners[i + 1] + w * corners[i + 2]) / sum;
            const Real along = glm::dot(hit - p, back);
            if (along >= 0 || (perspective && glm::dot(hit - eye, back) <= 0)) continue;
            if (nearAt(hit) >= 0) return true;
        }
        return false;
    }
};

/// An occluder, a view of it, and the boxes around.
struct Case {
    MeshData mesh;
    glm::dmat4 transform{1.0};
    View view;
    BvhNode node{};
    glm::dvec3 origin{0.0};

    Case(Random& random) {
        const double scale = std::pow(10.0, random.uniform(-3, 4));
        const double far = random.below(3) == 0 ? scale * std::pow(10.0, random.uniform(1, 13)) : 0.0;
        const auto unit = [&] { return test::randomVector(random, 1.0); };
        mesh = randomMesh(random);
        transform = randomTransform(random, scale);
        const glm::dvec3 place = far * unit();
        transform[3] = glm::dvec4(place, 1.0);
        glm::dvec3 middle(0.0);
        for (const glm::vec3& p : mesh.positions) middle += glm::dvec3(transform * glm::dvec4(p, 1.0));
        middle /= double(std::max<size_t>(mesh.positions.size(), 1));
        const glm::dvec3 eye = middle + scale * std::pow(10.0, random.uniform(-1, 1)) * unit();
        view.view = lookAt(eye, middle + scale * unit(), unit());
        const double near = scale * std::pow(10.0, random.uniform(-4, 0.3));
        if (random.below(4) == 0)
            view.projection = orthographic(scale * random.uniform(0.5, 20), 1.5, near, 1e3 * scale);
        else if (random.below(2)) view.projection = perspective(random.uniform(0.1, 2.5), 1.5, near);
        else view.projection = perspective(random.uniform(0.1, 2.5), 1.5, near, 1e4 * scale);
        origin = middle + scale * unit();
        const glm::dvec3 forward = isOrthographic(view) ? glm::normalize(middle - eye) : middle - eye;
        const double away = glm::length(middle - eye);
        for (int i = 0; i < 8; ++i) {
            const double behind = std::pow(10.0, random.uniform(-2, 1)) * away;
            glm::dvec3 at = middle + glm::normalize(forward) * behind + random.uniform(0, 2) * scale * unit();
            double size = scale * std::pow(10.0, random.uniform(-4, 0));
            if (i < 4) {  // at the rim of the shadow of a side
                at = rim(random, eye, behind) + away * std::pow(10.0, random.uniform(-9, -3)) * unit();
                size = scale * std::pow(10.0, random.uniform(-9, -3));
            }
            Box3d box;
            box.grow(at + size * unit());
            box.grow(at + size * unit());
            const Box3f rounded = roundOutward(box, origin);
            for (int axis = 0; axis < 3; ++axis)
                node.min[axis][i] = rounded.min[axis], node.max[axis][i] = rounded.max[axis];
            node.count[i] = 1;
        }
    }

    glm::dvec3 rim(Random& random, const glm::dvec3& eye, double behind) const {
        if (mesh.indices.empty()) return eye;
        const glm::dvec3 forward = -glm::dvec3(view.view[0][2], view.view[1][2], view.view[2][2]);
        const size_t side = random.below(mesh.indices.size()), next = side % 3 == 2 ? side - 2 : side + 1;
        const glm::dvec3 a(transform * glm::dvec4(mesh.positions[mesh.indices[side]], 1.0));
        const glm::dvec3 b(transform * glm::dvec4(mesh.positions[mesh.indices[next]], 1.0));
        const glm::dvec3 q = a + random.uniform() * (b - a);
        return q + behind * (isOrthographic(view) ? forward : glm::normalize(q - eye));
    }

    Real3 pointOf(int slot, Random& random, int which) const {
        Real3 p(0);
        for (int axis = 0; axis < 3; ++axis) {
            const Real low = node.min[axis][slot], high = node.max[axis][slot];
            const Real t = which < 8 ? Real(which >> axis & 1) : Real(random.uniform());
            p[axis] = Real(origin[axis]) + low + t * (high - low);
        }
        return p;
    }
};

/// A mesh as an occluder, placed, and looked at.
struct Placed {
    const Occluder occluder;
    const VolumeParts parts;
    const Screen screen;
    const VolumeView shared;
    const VolumePlace place;

    Placed(const MeshData& mesh, const View& view, const glm::dmat4& transform = glm::dmat4(1.0),
           const glm::dvec3& origin = glm::dvec3(0.0))
        : occluder(mesh.prepared()),
          parts(findVolumeParts(occluder)),
          screen(makeScreen(view, 640)),
          shared(makeVolumeView(view, screen, origin - screen.eye)),
          place(placeParts(shared, parts, occluder.bounds, transform)) {}
    explicit Placed(const Case& test) : Placed(test.mesh, test.view, test.transform, test.origin) {}

    OccluderVolume volume;  ///< of the part that was made last
    VolumeOutline outline;

    bool make(uint32_t part) { return makeVolume(shared, place, part, volume, outline); }
    VolumeAnswer ask(const EyeBoxes& boxes) const { return testVolume(volume, boxes, volume.allPlanes()); }
};

TEST(OccluderVolumes, HideNothingThatAPointSeesPastTheOccluder) {
    Random random(33);
    uint64_t asked = 0, hidden = 0, volumes = 0, reaching = 0;
    for (uint32_t round = 0; asked < 1000000; ++round) {
        const Case test(random);
        Placed placed(test);
        ASSERT_TRUE(placed.shared.usable);
        const EyeBoxes boxes = eyeBoxes(test.node, test.origin - placed.screen.eye);
        const Oracle oracle(test.view, test.mesh, test.transform);
        bool across = false;
        for (const Real3& corner : oracle.corners) across |= oracle.nearAt(corner) < 0;
        if (placed.parts.parts.empty()) asked += 8;
        for (uint32_t part = 0; part < placed.parts.parts.size(); ++part) {
            asked += 8;
            if (!placed.make(part)) continue;
            ++volumes;
            const VolumeAnswer answer = placed.ask(boxes);
            EXPECT_EQ(answer.hidden & answer.outside, 0u);
            for (int slot = 0; slot < 8; ++slot) {
                if (!(answer.hidden >> slot & 1)) continue;
                ++hidden;
                reaching += across;
                for (int which = 0; which < 12; ++which)
                    ASSERT_TRUE(oracle.hides(test.pointOf(slot, random, which)))
                        << "round " << round << " part " << part << " slot " << slot << " point " << which;
            }
        }
    }
    RecordProperty("volumes", std::to_string(volumes));
    RecordProperty("hidden", std::to_string(hidden));
    EXPECT_GT(volumes, 50000u);
    EXPECT_GT(hidden, 30000u);
    EXPECT_GT(reaching, 2000u) << "occluders that reach across the near plane";
}

/// Aimed at the edges of the volume: boxes without extent, ever closer to a side.
TEST(OccluderVolumes, AreAsTightAsFloatAllows) {
    const MeshData mesh = wall(1, 1, 2, 2);
    for (const double far : {0.0, 1e6}) {
        View view;
        view.view = lookAt(glm::dvec3(far, 0, 2), glm::dvec3(far, 0, 0), {0, 1, 0});
        view.projection = perspective(1.5, 1.0, 0.1);
        glm::dmat4 transform(1.0);
        transform[3][0] = far;
        Placed placed(mesh, view, transform, glm::dvec3(far, 0, 0));
        ASSERT_TRUE(placed.make(0));
        EXPECT_EQ(placed.volume.planes, 5u);
        // At z = -2 the shadow reaches to 2; the wall itself stands at 0.
        const auto hides = [&](double x, double z) {
            EyeBoxes boxes;
            for (int i = 0; i < 8; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    boxes.min[axis][i] = boxes.max[axis][i] = axis == 0 ? float(x) : axis == 1 ? 0.5f : float(z - 2);
            return placed.ask(boxes).hidden == 0xff;
        };
        EXPECT_TRUE(hides(1.9999, -2) && hides(-1.9999, -2));
        EXPECT_FALSE(hides(2, -2) || hides(-2, -2)) << "equality is visible";
        EXPECT_TRUE(hides(0, -1e-4));
        EXPECT_FALSE(hides(0, 0) || hides(0, 1e-3));
    }
}

TEST(OccluderVolumes, InheritPlanesWithoutLoss) {
    Random random(5);
    int compared = 0;
    for (int round = 0; round < 3000; ++round) {
        const Case test(random);
        Placed placed(test);
        const EyeBoxes boxes = eyeBoxes(test.node, test.origin - placed.screen.eye);
        if (placed.parts.parts.empty() || !placed.make(0)) continue;
        EyeBoxes whole;  // slot 0 holds all eight
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 8; ++i) {
                whole.min[axis][i] = *std::min_element(boxes.min[axis], boxes.min[axis] + 8);
                whole.max[axis][i] = *std::max_element(boxes.max[axis], boxes.max[axis] + 8);
            }
        const VolumeAnswer parent = placed.ask(whole);
        const VolumeAnswer all = placed.ask(boxes);
        if (parent.hidden) { EXPECT_EQ(all.hidden, 0xffu); }
        if (parent.outside) { EXPECT_EQ(all.outside, 0xffu); }
        const bool known = !((parent.hidden | parent.outside) & 1);
        const VolumeAnswer some =
            testVolume(placed.volume, boxes, known ? parent.planes[0] : placed.volume.allPlanes());
        if (!parent.outside) { EXPECT_EQ(some.hidden, all.hidden); }
        ++compared;
    }
    EXPECT_GT(compared, 1000);
}

TEST(OccluderVolumes, AreTheSameOnEveryInstructionSet) {
    std::vector<VolumeAnswer> expected;
    const int targets = test::forEachTarget([&](const std::string& target) {
        Random random(9);
        std::vector<VolumeAnswer> answers;
        for (int round = 0; round < 500; ++round) {
            const Case test(random);
            Placed placed(test);
            if (placed.parts.parts.empty() || !placed.make(0)) continue;
            answers.push_back(placed.ask(eyeBoxes(test.node, test.origin - placed.screen.eye)));
        }
        if (expected.empty()) expected = answers;
        ASSERT_EQ(answers.size(), expected.size());
        for (size_t i = 0; i < answers.size(); ++i) {
            EXPECT_EQ(answers[i].hidden, expected[i].hidden) << target;
            EXPECT_EQ(answers[i].outside, expected[i].outside) << target;
            for (int box = 0; box < 8; ++box) {
                if ((answers[i].outside | answers[i].hidden) >> box & 1) continue;
                EXPECT_EQ(answers[i].planes[box], expected[i].planes[box]) << target;
            }
        }
    });
    EXPECT_GE(targets, 1);
    EXPECT_GT(expected.size(), 200u);
}

TEST(OccluderVolumes, KeepWhatIsNotANumber) {
    const View view = viewAt({0, 0, 2}, {0, 0, 0}, 0.1);
    Placed placed(wall(1, 1, 2, 2), view);
    ASSERT_TRUE(placed.make(0));
    EyeBoxes boxes;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) boxes.min[axis][i] = boxes.max[axis][i] = axis == 2 ? -5.0f : 0.0f;
    ASSERT_EQ(placed.ask(boxes).hidden, 0xffu);
    const float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
    boxes.min[0][0] = none;
    boxes.max[1][1] = none;
    boxes.max[0][2] = infinite;
    boxes.min[2][3] = -infinite;
    boxes.min[0][4] = -infinite, boxes.max[0][4] = infinite;
    EXPECT_EQ(placed.ask(boxes).hidden, 0xe0u);
    glm::dmat4 flat(1.0);
    flat[2] = glm::dvec4(0.0);
    EXPECT_FALSE(placeParts(placed.shared, placed.parts, placed.occluder.bounds, flat).usable)
        << "a transform without volume";
    flat[2][2] = none;
    EXPECT_FALSE(placeParts(placed.shared, placed.parts, placed.occluder.bounds, flat).usable);
}

/// How many volumes of the mesh hide a box.
int hiddenBehind(const MeshData& mesh, const View& view, const glm::dvec3& low, const glm::dvec3& high,
                 const glm::dmat4& transform = glm::dmat4(1.0)) {
    Placed placed(mesh, view, transform);
    EyeBoxes boxes;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            boxes.min[axis][i] = float(low[axis] - placed.screen.eye[axis]);
            boxes.max[axis][i] = float(high[axis] - placed.screen.eye[axis]);
        }
    int hiding = 0;
    for (uint32_t part = 0; part < placed.parts.parts.size(); ++part) {
        if (!placed.shared.usable || !placed.make(part)) continue;
        hiding += placed.ask(boxes).hidden == 0xff;
    }
    return hiding;
}

TEST(OccluderVolumes, CountOnlyWhatIsDrawnBeyondTheNearPlane) {
    const MeshData plain = wall(1, 1, 20, 20);  // at z = 0
    EXPECT_EQ(hiddenBehind(plain, viewAt({0, 0, 1}, {0, 0, -9}, 0.5), {-1, -1, -6}, {1, 1, -5}), 1);
    EXPECT_EQ(hiddenBehind(plain, viewAt({0, 0, 1}, {0, 0, -9}, 1.5), {-1, -1, -6}, {1, 1, -5}), 0) << "cut away";
    EXPECT_EQ(hiddenBehind(plain, viewAt({0, 0, 1}, {0, 0, -9}, 1.0), {-1, -1, -6}, {1, 1, -5}), 0) << "touched";
    EXPECT_EQ(hiddenBehind(plain, viewAt({0, 0, -1}, {0, 0, -9}, 0.1), {-1, -1, -6}, {1, 1, -5}), 0)
        << "behind the eye";
    // Along the wall: it reaches behind the eye, and hides what lies ahead.
    const View along = viewAt({-5, 0, 0.5}, {5, 0, 0.5}, 0.1);
    EXPECT_EQ(hiddenBehind(plain, along, {2, -1, -3}, {3, 1, -2}), 1);
    // The same line of sight meets the wall nearer than the near plane, where it is not drawn.
    EXPECT_EQ(hiddenBehind(plain, viewAt({-5, 0, 0.5}, {5, 0, 0.5}, 2.5), {2, -1, -3}, {3, 1, -2}), 0);
    EXPECT_EQ(hiddenBehind(plain, viewAt({-5, 0, 0.5}, {5, 0, 0.5}, 2.5), {4, -1, -0.3}, {4.5, 1, -0.2}), 1);
}

TEST(OccluderVolumes, HideOnTheFrontAloneUnlessBothSidesAreDrawn) {
    MeshData mesh = wall(1, 1, 4, 4);
    const View before = viewAt({0, 0, 3}, {0, 0, 0}, 0.1), behind = viewAt({0, 0, -3}, {0, 0, 0}, 0.1);
    EXPECT_EQ(hiddenBehind(mesh, before, {-1, -1, -2}, {1, 1, -1}), 1);
    EXPECT_EQ(hiddenBehind(mesh, behind, {-1, -1, 1}, {1, 1, 2}), 0);
    EXPECT_EQ(hiddenBehind(mesh, before, {-1, -1, 1}, {1, 1, 2}), 0) << "in front of it";
    mesh.double_sided = true;
    EXPECT_EQ(hiddenBehind(mesh, behind, {-1, -1, 1}, {1, 1, 2}), 1);
    EXPECT_EQ(hiddenBehind(mesh, before, {-1, -1, -2}, {1, 1, -1}), 1);
    mesh.double_sided = false;
    glm::dmat4 mirror(1.0);
    mirror[0][0] = -1.0;  // the front stays before
    EXPECT_EQ(hiddenBehind(mesh, before, {-1, -1, -2}, {1, 1, -1}, mirror), 1);
    EXPECT_EQ(hiddenBehind(box(4, 4, 1), before, {-1, -1, -3}, {1, 1, -2}, mirror), 2) << "the box, and its one face";
    mirror[0][0] = 1.0, mirror[2][2] = -1.0;  // the front goes behind
    EXPECT_EQ(hiddenBehind(mesh, before, {-1, -1, -2}, {1, 1, -1}, mirror), 0);
    EXPECT_EQ(hiddenBehind(mesh, behind, {-1, -1, 1}, {1, 1, 2}, mirror), 1);
}

/// What stands before one half of a bent wall and behind the other.
TEST(OccluderVolumes, LieBehindAllOfABentFace) {
    const float bend = 5e-4f;
    const MeshData mesh = wall(4, 4, 2, 2, bend);
    ASSERT_EQ(findVolumeParts(mesh.prepared()).parts.size(), 1u);
    const View view = viewAt({0, 0, 2}, {0, 0, 0}, 0.1);
    const double z = -bend / 8;  // the wall stands at -bend / 4 there
    EXPECT_EQ(hiddenBehind(mesh, view, {-0.01, 0.97, z}, {0.01, 0.98, z}), 0);
    EXPECT_EQ(hiddenBehind(mesh, view, {-0.01, 0.97, -bend}, {0.01, 0.98, -bend}), 1);
}

TEST(OccluderVolumes, NeedAnEyeWhereTheRaysMeet) {
    View view = viewAt({0, 0, 3}, {0, 0, 0}, 0.1);
    view.projection[3][0] = 0.25;  // a second eye, moved in the projection
    EXPECT_FALSE(makeVolumeView(view, makeScreen(view, 640), glm::dvec3(0.0)).usable);
    view = viewAt({0, 0, 3}, {0, 0, 0}, 0.1);
    view.projection[2][2] = -view.projection[2][2];  // reversed: what is called near is far
    view.projection[3][2] = -view.projection[3][2];
    EXPECT_FALSE(makeVolumeView(view, makeScreen(view, 640), glm::dvec3(0.0)).usable);
}

TEST(VolumeParts, JoinAWallAndABox) {
    VolumeParts parts = findVolumeParts(wall(7, 5, 3, 2).prepared());
    ASSERT_EQ(parts.parts.size(), 1u);
    EXPECT_EQ(parts.faces[0].count, 4u) << "corners between others on a line go";
    EXPECT_NEAR(parts.faces[0].area, 6, 1e-6);
    EXPECT_LT(parts.faces[0].reach, 1e-12);
    parts = findVolumeParts(box(2, 3, 4).prepared());
    ASSERT_EQ(parts.parts.size(), 7u);
    EXPECT_EQ(parts.parts[0].face_count, 6u);
    EXPECT_EQ(parts.parts[0].edge_count, 12u);
    for (const VolumeEdge& edge : parts.edges) EXPECT_NE(edge.right, VolumeEdge::kNone);
    for (size_t i = 1; i < parts.parts.size(); ++i) EXPECT_EQ(parts.parts[i].body, 0u);
    parts = findVolumeParts(box(2, 3, 4, true).prepared());
    ASSERT_EQ(parts.parts.size(), 6u) << "a room seen from inside is no body";
    parts = findVolumeParts(prism(10, 2, 3).prepared());
    EXPECT_EQ(parts.parts[0].face_count, 12u);
    EXPECT_TRUE(findVolumeParts(Occluder()).parts.empty());
}

TEST(VolumeParts, MakeOneVolumeOfABoxWithTheSilhouetteOfThreeFaces) {
    const View view = viewAt({4, 3, 5}, {0, 0, 0}, 0.1);
    Placed placed(box(2, 2, 2), view);
    ASSERT_TRUE(placed.make(0));
    EXPECT_EQ(placed.outline.count, 6u);
    EXPECT_EQ(placed.volume.planes, 9u);
    EXPECT_GT(visiblePixels(placed.shared, placed.outline), 1000);
    // More than any face hides by itself.
    EXPECT_EQ(hiddenBehind(box(2, 2, 2), view, {-3.6, -3.1, -4.5}, {-2.4, -1.4, -3}), 1);
    glm::dmat4 mirror(1.0);
    mirror[0][0] = -1.0;
    EXPECT_EQ(hiddenBehind(box(2, 2, 2), view, {-3.6, -3.1, -4.5}, {-2.4, -1.4, -3}, mirror), 1);
}

TEST(VolumeParts, CutTheCornersOfAnOutlineWithTooMany) {
    const View view = viewAt({0, 20, 0.1}, {0, 0, 0}, 0.1);
    Placed placed(prism(40, 2, 3), view);
    double most = 0;
    for (uint32_t part = 0; part < placed.parts.parts.size(); ++part) {
        if (!placed.make(part)) continue;
        if (placed.outline.count > OccluderVolume::kMaxSides)
            most = std::max(most, visiblePixels(placed.shared, placed.outline));
        EXPECT_LE(placed.volume.planes, OccluderVolume::kMaxPlanes);
    }
    EXPECT_GT(most, 0);
    EXPECT_GE(hiddenBehind(prism(40, 2, 3), view, {-1.5, -5, -1.5}, {1.5, -4, 1.5}), 1);
}

}  // namespace
}  // namespace sightline
