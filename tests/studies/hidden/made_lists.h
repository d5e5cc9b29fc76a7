// Lists of triangles for the laws of hidden-surface removal, and the slow truth about what they show.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/compare.h"
#include "sightline/studies/hidden/project/scan.h"
#include "sightline/studies/hidden/render.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace studies;

/// Triangles of one item, all double-sided unless it is said, in front of an eye at the origin that looks along -z.
struct MadeList : TestMesh {
    std::string name;
    std::vector<uint8_t> double_sided;

    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, bool both = true) {
        TestMesh::add(a, b, c);
        double_sided.push_back(both);
    }
    /// A strip of two triangles from a to b, `width` wide along `across`.
    void addBar(const glm::vec3& a, const glm::vec3& b, const glm::vec3& across) {
        add(a - across, b - across, b + across);
        add(a - across, b + across, a + across);
    }
    /// Refers to this object's arrays.
    std::vector<DrawItem> items() const {
        DrawItem item;
        item.mesh = view();
        item.double_sided = double_sided;
        return {item};
    }
    /// Refers to this object, which stays where it is as long as the list is in use.
    DrawList list() const {
        items_ = items();
        return DrawList(items_);
    }

private:
    mutable std::vector<DrawItem> items_;
};

inline HiddenImage emptyImage(const View& view) {
    HiddenImage image;
    image.width = view.width;
    image.height = view.height;
    image.surface.assign(size_t{view.width} * view.height, HiddenImage::kNone);
    return image;
}

/// Samples that show something.
inline uint64_t covered(const HiddenImage& image) {
    return image.surface.size() -
           static_cast<uint64_t>(std::count(image.surface.begin(), image.surface.end(), HiddenImage::kNone));
}

inline View madeView(uint32_t width = 160, uint32_t height = 120, double z_near = 0.1) {
    return viewBy(perspective(1.0, double(width) / height, z_near), width, height);
}

/// Three bars, each over the next and under the one before.
inline MadeList cyclicOverlap() {
    MadeList made;
    made.name = "cyclic overlap";
    const glm::vec3 corners[3] = {{-1, -0.7f, 0}, {1, -0.7f, 0}, {0, 1, 0}};
    for (int i = 0; i < 3; ++i) {
        glm::vec3 a = corners[i], b = corners[(i + 1) % 3];
        const glm::vec3 along = b - a;
        a -= 0.3f * along;
        b += 0.3f * along;
        a.z = -3.5f;
        b.z = -4.5f;
        const glm::vec3 across = 0.12f * glm::normalize(glm::vec3(-along.y, along.x, 0));
        made.addBar(a, b, across);
    }
    return made;
}

/// Triangles with their corners anywhere in a box.
inline MadeList trianglesIn(const Box3d& box, const char* name, uint64_t seed, int count) {
    MadeList made;
    made.name = name + std::to_string(seed);
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        glm::vec3 p[3];
        for (glm::vec3& v : p) v = glm::vec3(randomIn(random, box));
        made.add(p[0], p[1], p[2]);
    }
    return made;
}

/// Triangles that pass through one another.
inline MadeList interpenetration(uint64_t seed, int count = 24) {
    return trianglesIn({{-2, -1.5, -6}, {2, 1.5, -2}}, "interpenetration ", seed, count);
}

/// Small triangles at any depth, some before the near plane, around, and behind the eye.
inline MadeList clutter(uint64_t seed, int count, double size = 0.4) {
    MadeList made;
    made.name = "clutter " + std::to_string(seed);
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 center(random.uniform(-3, 3), random.uniform(-2.5, 2.5), random.uniform(-7, 0.5));
        glm::vec3 p[3];
        for (glm::vec3& v : p) v = glm::vec3(center + randomVector(random, size));
        made.add(p[0], p[1], p[2], i % 3 != 0);
    }
    return made;
}

/// Overlapping triangles in one plane.
inline MadeList coplanar(uint64_t seed, int count = 12) {
    return trianglesIn({{-2, -1.5, -4}, {2, 1.5, -4}}, "coplanar ", seed, count);
}

/// Long and thin ones.
inline MadeList slivers(uint64_t seed, int count = 60) {
    MadeList made;
    made.name = "slivers " + std::to_string(seed);
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const glm::vec3 a(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-6, -1));
        const glm::vec3 b(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-6, -1));
        const float thin = static_cast<float>(std::pow(10.0, random.uniform(-5, -1)));
        made.add(a, b, 0.5f * (a + b) + glm::vec3(thin, thin, thin));
    }
    return made;
}

/// Triangles with corners on both sides of the eye's plane, and a fan around the eye.
inline MadeList throughTheEye(uint64_t seed, int count = 20) {
    return trianglesIn({{-3, -3, -5}, {3, 3, 4}}, "through the eye plane ", seed, count);
}

/// All of the above.
inline std::vector<MadeList> madeLists() {
    std::vector<MadeList> lists{cyclicOverlap()};
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        lists.push_back(interpenetration(seed));
        lists.push_back(clutter(seed, 400));
        lists.push_back(coplanar(seed));
        lists.push_back(slivers(seed));
        lists.push_back(throughTheEye(seed));
    }
    return lists;
}

/// The nearest surface at each sample, found by trying all polygons in double: the truth that methods are held to. The
/// first of equals is kept.
inline HiddenImage nearestSurfaces(const DrawList& list, const View& view, const ProjectorSettings& settings = {}) {
    HiddenImage image = emptyImage(view);
    std::vector<double> nearest(image.surface.size(), -std::numeric_limits<double>::infinity());
    Projector projector(view, {view.width, view.height, 0, 1, {}}, settings);
    for (const ScreenPolygon& polygon : projectAll(list, projector))
        scanPolygon(polygon.outline(), 0, int32_t(view.height), int32_t(view.width),
                    [&](int32_t row, int32_t begin, int32_t end) {
                        for (int32_t i = begin; i < end; ++i) {
                            const size_t at = size_t(row) * view.width + size_t(i);
                            const double nearness = polygon.depth.at(row, i);
                            if (nearness <= nearest[at]) continue;
                            nearest[at] = nearness;
                            image.surface[at] = polygon.surface;
                        }
                    });
    image.counters.geometry = projector.counters();
    return image;
}

/// Holds images to the truth, but for what the bands explain.
inline void expectNoneWrong(const Agreement& agreement, const std::string& what) {
    EXPECT_TRUE(agreement.agrees()) << what << ": " << agreement.wrong << " samples, first row " << agreement.row
                                    << " sample " << agreement.sample << ": " << int32_t(agreement.found) << " for "
                                    << int32_t(agreement.expected);
}

/// Draws, and holds the image to the slow truth.
inline HiddenImage expectNearest(const DrawList& list, const View& view, const RenderSettings& settings,
                                 const std::string& what, const AgreementBands& bands = {}) {
    HiddenImage image = render(list, view, settings);
    expectNoneWrong(compareImages(list, view, nearestSurfaces(list, view), image, bands), what);
    return image;
}

}  // namespace sightline::test
