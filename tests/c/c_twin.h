// A world made through the C interface, of the same objects as one of the library's own.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/c/sightline.h"
#include "tests/support/made_world.h"

namespace sightline::test {

/// A log that remembers.
struct Heard {
    std::vector<std::string> sentences;
    slStatus last = SL_OK;

    slLog log() {
        return {[](void* user, slStatus status, const char* sentence) {
                    static_cast<Heard*>(user)->sentences.push_back(sentence);
                    static_cast<Heard*>(user)->last = status;
                },
                this};
    }
    slHooks hooks() { return {{}, {}, log()}; }
    /// Whether the last sentence has these words.
    bool said(const std::string& words) const {
        return !sentences.empty() && sentences.back().find(words) != std::string::npos;
    }
};

inline slMesh meshOf(const TestMesh& mesh) {
    return {&mesh.positions[0].x, mesh.positions.size(), 0, mesh.indices.data(), mesh.indices.size(), 0};
}

inline slView viewOf(const View& from) {
    slView view = slDefaultView();
    std::memcpy(view.view, &from.view, sizeof view.view);
    std::memcpy(view.projection, &from.projection, sizeof view.projection);
    view.width = from.width;
    view.height = from.height;
    view.jitter = from.jitter;
    view.layers = from.layers;
    view.eye_radius = from.eye_radius;
    return view;
}

inline slOccluder* prepared(const TestMesh& mesh) {
    slOccluderDef def = slDefaultOccluderDef();
    def.mesh = meshOf(mesh);
    slOccluder* occluder = nullptr;
    EXPECT_EQ(slPrepareOccluder(&def, &occluder), SL_OK);
    return occluder;
}

/// The same objects as those of a MadeWorld.
struct CWorld {
    slWorld* world = nullptr;
    slOccluderId cube{};
    std::vector<slObjectId> ids;

    explicit CWorld(const slHooks& hooks = {}) {
        slWorldDef def = slDefaultWorldDef();
        def.hooks = hooks;
        def.volumes = true;
        EXPECT_EQ(slCreateWorld(&def, &world), SL_OK);
        slOccluder* const occluder = prepared(boxMesh());
        EXPECT_EQ(slAddOccluder(world, occluder, &cube), SL_OK);
        slDestroyOccluder(occluder);
    }
    explicit CWorld(const MadeWorld& made, const slHooks& hooks = {}) : CWorld(hooks) {
        std::vector<slObjectDef> defs(made.transforms.size(), slDefaultObjectDef());
        for (size_t i = 0; i < defs.size(); ++i) {
            defs[i].bounds = {{0, 0, 0}, {1, 1, 1}};
            std::memcpy(defs[i].transform, &made.transforms[i], sizeof defs[i].transform);
            defs[i].key = i;
            if (made.hides[i]) defs[i].occluder = cube;
            if (made.shapes) defs[i].shape = cube;
        }
        ids.resize(defs.size());
        EXPECT_EQ(slAddObjects(world, defs.data(), defs.size(), ids.data()), SL_OK);
    }
    ~CWorld() { slDestroyWorld(world); }
    CWorld(const CWorld&) = delete;
    CWorld& operator=(const CWorld&) = delete;

    slSnapshot* commit() const {
        slSnapshot* snapshot = nullptr;
        EXPECT_EQ(slCommit(world, &snapshot), SL_OK);
        return snapshot;
    }
};

/// A snapshot and a query of it.
struct CQuery {
    slSnapshot* now;
    slQuery* query = nullptr;

    explicit CQuery(const CWorld& world, const slHooks& hooks = {}) : now(world.commit()) {
        EXPECT_EQ(slCreateQuery(&hooks, &query), SL_OK);
    }
    ~CQuery() {
        slDestroyQuery(query);
        slReleaseSnapshot(now);
    }
    CQuery(const CQuery&) = delete;
    CQuery& operator=(const CQuery&) = delete;

    slVisibleSet ask(const slView& view, const slQuerySettings* settings = nullptr) const {
        slVisibleSet set{};
        EXPECT_EQ(slQueryVisible(query, now, &view, settings, &set), SL_OK);
        return set;
    }
};

inline std::vector<uint64_t> keysOf(const slVisible* objects, uint32_t count) {
    std::vector<uint64_t> keys;
    for (uint32_t i = 0; i < count; ++i) keys.push_back(objects[i].key);
    return keys;
}
inline std::vector<uint64_t> keysOf(const slVisibleSet& set) { return keysOf(set.objects, set.count); }

}  // namespace sightline::test
