// The triangles of a draw list in a BSP tree, which can be kept from frame to frame while some of them move.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/bsp/bsp_scene.h"

namespace sightline::studies {
namespace {

/// The triangles of those items that move, or of the others.
BspPolygons polygonsOf(const DrawList& list, const std::vector<uint8_t>& moves, bool moving) {
    BspPolygons polygons;
    std::vector<glm::dvec3> placed;
    for (size_t i = 0; i < list.items().size(); ++i) {
        if ((!moves.empty() && moves[i] != 0) != moving) continue;
        const DrawItem& item = list.items()[i];
        placed.clear();
        for (const glm::vec3& p : item.mesh.positions)
            placed.push_back(glm::dvec3(item.transform * glm::dvec4(glm::dvec3(p), 1.0)));
        for (size_t t = 0; t < item.mesh.triangles(); ++t) {
            if (!item.writes_depth.empty() && item.writes_depth[t] == 0) continue;
            const uint32_t* index = item.mesh.indices.data() + 3 * t;
            const glm::dvec3 corners[3] = {placed[index[0]], placed[index[1]], placed[index[2]]};
            polygons.add(corners, list.firstSurface(i) + static_cast<uint32_t>(t));
        }
    }
    return polygons;
}

}  // namespace

BspScene buildBspScene(const DrawList& list, std::span<const uint8_t> moves, const BspSettings& settings) {
    BspScene scene;
    scene.moves.assign(moves.begin(), moves.end());
    scene.tree = buildBsp(polygonsOf(list, scene.moves, false), settings);
    if (!scene.moves.empty()) moveItems(scene, list);
    return scene;
}

void moveItems(BspScene& scene, const DrawList& list) {
    locatePolygons(scene.tree, polygonsOf(list, scene.moves, true), scene.overlay);
}

}  // namespace sightline::studies
