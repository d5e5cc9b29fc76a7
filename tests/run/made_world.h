// Worlds of boxes for the laws of the query, and what an exact z-buffer sees of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/hidden/zbuffer.h"
#include "sightline/prepare/occluder.h"
#include "sightline/run/query.h"

namespace sightline::test {

/// Boxes of one shared unit cube, some of which hide.
struct MadeWorld {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    std::vector<glm::dmat4> transforms;
    std::vector<uint8_t> hides;
    std::vector<ObjectId> ids;
    World world = World::create(worldDef());
    OccluderId cube;
    bool shapes = false;  ///< objects are also asked by their triangles

    static WorldDef worldDef() {
        WorldDef def;
        def.volumes = true;
        return def;
    }

    MadeWorld() {
        for (int i = 0; i < 8; ++i) positions.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2)});
        const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (const auto& f : faces)
            for (int k : {0, 1, 2, 0, 2, 3}) indices.push_back(f[k]);
        cube = world.addOccluder(prepareOccluder({positions, indices}));
    }

    ObjectId add(const glm::dvec3& low, const glm::dvec3& high, bool hiding = true, uint32_t layers = 1) {
        glm::dmat4 t(1.0);
        for (int axis = 0; axis < 3; ++axis) t[axis][axis] = high[axis] - low[axis];
        t[3] = glm::dvec4(low, 1.0);
        return add(t, hiding, layers);
    }

    ObjectId add(const glm::dmat4& transform, bool hiding, uint32_t layers = 1) {
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform = transform;
        def.key = transforms.size();
        def.occluder = hiding ? cube : OccluderId();
        def.shape = shapes ? cube : OccluderId();
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
        const std::vector<uint8_t> no(indices.size() / 3, 0);
        for (size_t i = 0; i < transforms.size(); ++i) {
            DrawItem item;
            item.mesh = {positions, indices};
            if (!hides[i]) item.writes_depth = no;
            item.transform = transforms[i];
            item.id = static_cast<uint32_t>(i);
            items.push_back(item);
        }
        ZBufferSettings settings;
        settings.samples = samples;
        settings.offset = offset;
        std::vector<uint8_t> seen = renderZBuffer(items, view, settings).seen;
        seen.resize(transforms.size(), 0);
        return seen;
    }
};

inline std::vector<uint64_t> keysOf(const VisibleSet& set) {
    std::vector<uint64_t> keys;
    for (const Visible& v : set.objects) keys.push_back(v.key);
    return keys;
}

}  // namespace sightline::test
