// SPDX-License-Identifier: MIT
#include "sightline/bake/scene_cells.h"

#include <map>
#include <utility>
#include <vector>

#include "sightline/space/cell_space_build.h"

namespace sightline {
namespace {

constexpr uint32_t kNone = ScenePortal::kNone;

/// A door for each object that shuts portals.
uint32_t doorOf(const Scene& scene, const ScenePortal& portal, std::map<uint32_t, uint32_t>& known,
                CellSpaceBuilder& builder) {
    if (portal.door >= scene.objects.size()) return CellPortal::kNone;
    const auto [place, fresh] = known.try_emplace(portal.door, CellPortal::kNone);
    const SceneObject& leaf = scene.objects[portal.door];
    if (fresh)
        if (const Result<uint32_t> door = builder.addDoor(leaf.name, leaf.key, portal.slide)) place->second = *door;
    return place->second;
}

}  // namespace

SceneCells cellsOfScene(const Scene& scene, const SceneCellSettings&) {
    CellSpaceBuilder builder;
    std::vector<uint32_t> cell_of;
    for (const SceneCell& cell : scene.cells) {
        const Result<uint32_t> made = builder.addCell(cell.name, cell.planes);
        cell_of.push_back(made ? *made : builder.outside());
    }
    std::map<uint32_t, uint32_t> doors;
    for (const ScenePortal& portal : scene.portals) {
        if (portal.cells[0] == kNone || portal.cells[1] == kNone) continue;
        const uint32_t a = cell_of[portal.cells[0]], b = cell_of[portal.cells[1]];
        if (a != b) (void)builder.addPortal(portal.name, a, b, portal.polygon, doorOf(scene, portal, doors, builder));
    }
    return {builder.take(), {}};
}

}  // namespace sightline
