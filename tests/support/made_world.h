// Worlds of boxes for the laws of the query, and what an exact z-buffer sees of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "tests/support/answers.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace studies;

/// Boxes of one shared unit cube, some of which hide.
struct MadeWorld {
    TestMesh mesh = boxMesh(), other;  ///< the other is drawn of objects whose shape is not the cube
    std::vector<uint8_t> is_other, other_double_sided;
    std::vector<glm::dmat4> transforms;
    std::vector<uint8_t> hides;
    std::vector<ObjectId> ids;
    World world = World::create(worldDef());
    OccluderId cube;
    bool shapes = false;         ///< objects are also asked by their triangles
    mutable ZBufferImage image;  ///< the last that was drawn

    static WorldDef worldDef() { return {.volumes = true}; }

    MadeWorld() { cube = world.addOccluder(prepareOccluder(mesh.view())); }
    MadeWorld(uint64_t seed, int count) : MadeWorld() { fill(seed, count, {0, 0, 0}); }

    ObjectId add(const glm::dvec3& low, const glm::dvec3& high, bool hiding = true, uint32_t layers = 1) {
        glm::dmat4 t(1.0);
        for (int axis = 0; axis < 3; ++axis) t[axis][axis] = high[axis] - low[axis];
        t[3] = glm::dvec4(low, 1.0);
        return add(t, hiding, layers);
    }

    /// @param of  a mesh of its own, which is also its shape
    ObjectId add(const glm::dmat4& transform, bool hiding, uint32_t layers = 1, OccluderId of = {}) {
        is_other.push_back(of != OccluderId());
        if (of == OccluderId()) of = cube;
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform = transform;
        def.key = transforms.size();
        def.occluder = hiding ? of : OccluderId();
        def.shape = shapes ? of : OccluderId();
        def.layers = layers;
        transforms.push_back(transform);
        hides.push_back(hiding);
        ids.push_back(world.add(def));
        return ids.back();
    }

    /// Walls, floors and clutter around `center`.
    void fill(uint64_t seed, int count, const glm::dvec3& center) {
        Random random(seed);
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 p =
                center + glm::dvec3(random.uniform(-20, 20), random.uniform(-5, 5), random.uniform(-20, 20));
            glm::dvec3 size(random.uniform(0.1, 1.5), random.uniform(0.1, 1.5), random.uniform(0.1, 1.5));
            if (i % 4 == 0)
                size = i % 8 ? glm::dvec3(random.uniform(3, 15), random.uniform(2, 8), 0.2)
                             : glm::dvec3(0.2, random.uniform(2, 8), random.uniform(3, 15));
            glm::dmat4 t(1.0);
            for (int axis = 0; axis < 3; ++axis) t[axis][axis] = size[axis];
            t[3] = glm::dvec4(p, 1.0);
            if (i % 3 == 0) {  // turned, sheared, mirrored
                t[0][1] = random.uniform(-0.5, 0.5);
                t[2][0] = random.uniform(-0.5, 0.5);
                if (i % 2) t[0] = -t[0];
            }
            add(t, i % 5 != 0);
        }
    }

    /// The same objects but some, for seen() alone.
    template <class Gone>
    MadeWorld without(Gone gone) const {
        MadeWorld rest;
        for (size_t i = 0; i < transforms.size(); ++i)
            if (!gone(i)) rest.add(transforms[i], hides[i] != 0);
        return rest;
    }

    /// Which objects an exact z-buffer at `samples` per pixel and axis shows.
    std::vector<uint8_t> seen(const View& view, uint32_t samples, const glm::dvec2& offset = {0, 0}) const {
        std::vector<DrawItem> items;
        const std::vector<uint8_t> no(std::max(mesh.indices.size(), other.indices.size()) / 3, 0);
        for (size_t i = 0; i < transforms.size(); ++i) {
            DrawItem item;
            item.mesh = (is_other[i] ? other : mesh).view();
            if (is_other[i]) item.double_sided = other_double_sided;
            if (!hides[i]) item.writes_depth = no;
            item.transform = transforms[i];
            item.id = static_cast<uint32_t>(i);
            items.push_back(item);
        }
        renderZBuffer(items, view, {.samples = samples, .offset = offset, .want_generated = false}, image);
        std::vector<uint8_t> seen = image.seen;
        seen.resize(transforms.size(), 0);
        return seen;
    }
};

/// Holds an answer to the z-buffer and to its own arithmetic.
inline VisibleSet expectSound(const MadeWorld& made, Query& query, const Snapshot& now, const View& view,
                              const QuerySettings& settings, const std::string& what, uint32_t samples = 3) {
    VisibleSet set = query.visible(now, view, settings);
    const std::vector<uint8_t> kept = keptOf(set, made.transforms.size()), reasons = reasonsOf(query, now);
    const std::vector<uint8_t> seen = made.seen(view, samples);
    for (size_t i = 0; i < kept.size(); ++i) {
        EXPECT_TRUE(kept[i] || !seen[i]) << what << ": object " << i << " is seen, but was culled by stage "
                                         << int(reasons[i]);
        EXPECT_EQ(kept[i] == 1, reasons[i] == 0) << what << ": object " << i;
    }
    EXPECT_EQ(accountedFor(set.stats), set.stats.objects) << what;
    EXPECT_EQ(set.stats.visible, set.objects.size()) << what;
    return set;
}

}  // namespace sightline::test
