// What stands on a procedural terrain: materials, and the meshes of trees, rocks, houses and fences.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/terrain/library.h"

#include "sightline/base/assert.h"
#include "sightline/base/random.h"
#include "sightline/tools/scene/solids.h"

namespace sightline::tools::terrain {
namespace {

using city::addBox;
using city::addPrism;
using city::addTurned;
using city::MeshBuilder;

/// A closed lump: a turned shape of which every corner is moved inward by chance.
/// @param radius  of its three axes  [metres]
void addLump(MeshBuilder& mesh, uint32_t material, const glm::dvec3& center, const glm::dvec3& radius, double rough,
             uint64_t seed) {
    constexpr int kSides = 8, kRings = 5;
    constexpr double kRadius[kRings] = {0.5, 0.87, 1, 0.87, 0.5}, kHeight[kRings] = {-0.87, -0.5, 0, 0.5, 0.87};
    const std::vector<glm::dvec2> circle = city::regularPolygon(kSides);
    Random random(seed);
    glm::dvec3 corner[kRings][kSides];
    for (int r = 0; r < kRings; ++r)
        for (int s = 0; s < kSides; ++s) {
            const double share = 1 - rough * random.uniform();
            corner[r][s] =
                center + radius * share * glm::dvec3(kRadius[r] * circle[s].y, kHeight[r], kRadius[r] * circle[s].x);
        }
    const glm::dvec3 bottom = center - glm::dvec3(0, radius.y, 0),
                     top = center + glm::dvec3(0, radius.y * (1 - 0.5 * rough), 0);
    for (int s = 0; s < kSides; ++s) {
        const int n = (s + 1) % kSides;
        mesh.triangle(material, bottom, corner[0][n], corner[0][s]);
        for (int r = 0; r + 1 < kRings; ++r) {
            mesh.triangle(material, corner[r][s], corner[r][n], corner[r + 1][n]);
            mesh.triangle(material, corner[r][s], corner[r + 1][n], corner[r + 1][s]);
        }
        mesh.triangle(material, top, corner[kRings - 1][s], corner[kRings - 1][n]);
    }
}

/// Closed cones above one another, each with an underside that rises to the trunk.
MeshBuilder conifer(int tiers, double foot, double top, double wide) {
    MeshBuilder mesh;
    addTurned(mesh, kBark, {0, 0, 0}, 6, {{0.25, -1}, {0.1875, foot + 1}, {0, top - 1}});
    const double step = (top - foot) / (tiers + 0.5);
    for (int tier = 0; tier < tiers; ++tier) {
        const double low = foot + tier * step, radius = wide * (1 - 0.8 * tier / tiers);
        addTurned(mesh, kNeedles, {0, 0, 0}, 8,
                  {{0.125, low + 0.3 * step},
                   {radius, low},
                   {0.4 * radius, low + 0.9 * step},
                   {0, tier + 1 == tiers ? top : low + 1.8 * step}});
    }
    return mesh;
}

MeshBuilder leafyTree(uint32_t bark, uint32_t leaf, double trunk, double top, double wide, uint64_t seed) {
    MeshBuilder mesh;
    addTurned(mesh, bark, {0, 0, 0}, 6,
              {{0.3125, -1}, {0.21875, 0.5}, {0.15625, trunk + 0.25 * (top - trunk)}, {0, 0.8 * top}});
    const double half = 0.5 * (top - trunk), middle = trunk + half;
    addLump(mesh, leaf, {0, middle, 0}, {wide, half, wide}, 0.25, seed);
    addLump(mesh, leaf, {0.35 * wide, middle + 0.2 * half, -0.2 * wide}, {0.6 * wide, 0.6 * half, 0.6 * wide}, 0.3,
            seed + 1);
    addLump(mesh, leaf, {-0.3 * wide, middle - 0.1 * half, 0.35 * wide}, {0.65 * wide, 0.6 * half, 0.65 * wide}, 0.3,
            seed + 2);
    return mesh;
}

MeshBuilder stones() {
    MeshBuilder mesh;
    addLump(mesh, kRock, {0, 0, 0}, {0.75, 0.5, 0.625}, 0.3, 31);
    addLump(mesh, kRock, {1, -0.0625, 0.25}, {0.5, 0.4375, 0.5}, 0.3, 32);
    addLump(mesh, kRock, {0.25, -0.125, -0.875}, {0.4375, 0.375, 0.5}, 0.3, 33);
    return mesh;
}

/// A pane in a frame, on a wall that looks along +z (or -z) or +x (or -x).
void addPane(MeshBuilder& mesh, uint32_t material, const glm::dvec3& middle, double wide, double high, bool along_x) {
    const glm::dvec3 half =
        along_x ? glm::dvec3(0.5 * wide, 0.5 * high, 0.0625) : glm::dvec3(0.0625, 0.5 * high, 0.5 * wide);
    const glm::dvec3 rim(along_x ? 0.0625 : -0.03125, 0.0625, along_x ? -0.03125 : 0.0625);
    addBox(mesh, kTimber, middle - half - rim, middle + half + rim);
    addBox(mesh, material, middle - half, middle + half);
}

/// Walls on a plinth, a gabled roof with eaves, panes and a door.
/// @param half  of the plan
MeshBuilder house(const glm::dvec2& half, double eaves, double ridge, uint32_t walls, uint32_t roof, int panes) {
    MeshBuilder mesh;
    addBox(mesh, kRock, {-half.x - 0.125, -3, -half.y - 0.125}, {half.x + 0.125, 0.375, half.y + 0.125});
    addPrism(mesh, walls, city::kAcross,
             {{-half.y, 0.25}, {half.y, 0.25}, {half.y, eaves}, {0, ridge - 0.25}, {-half.y, eaves}}, -half.x, half.x);
    const double slope = (ridge - eaves) / half.y, out = half.y + 0.625, low = eaves - 0.625 * slope;
    addPrism(mesh, roof, city::kAcross,
             {{-out, low}, {0, ridge - 0.25}, {out, low}, {out, low + 0.25}, {0, ridge}, {-out, low + 0.25}},
             -half.x - 0.5, half.x + 0.5);
    for (const double side : {-1.0, 1.0}) {
        for (int i = 0; i < panes; ++i) {
            const double x = half.x * ((2.0 * i + 1) / panes - 1);
            if (side < 0 || 2 * i + 1 != panes) addPane(mesh, kPane, {x, 1.625, side * half.y}, 0.875, 1.125, true);
        }
        if (panes > 0) addPane(mesh, kPane, {side * half.x, 1.625, 0.4 * half.y}, 0.875, 1.125, false);
        if (panes > 0) addPane(mesh, kPane, {side * half.x, eaves + 0.375, 0}, 0.75, 0.75, false);
    }
    addPane(mesh, kBoards, {0, panes > 0 ? 1.3125 : 1.625, half.y}, panes > 0 ? 1 : 2.75, panes > 0 ? 2 : 2.5, true);
    addBox(mesh, kRock, {-0.75, -1, half.y}, {0.75, 0.25, half.y + 0.75});
    if (panes > 0)
        addTurned(mesh, kRock, {0.5 * half.x, 0, -0.25 * half.y}, 4,
                  {{0.5, eaves}, {0.5, ridge + 0.625}, {0.375, ridge + 0.75}});
    return mesh;
}

}  // namespace

Pieces makeLibrary() {
    Pieces library = builtInPieces(kTerrainPieces);
    SIGHTLINE_ASSERT(library.materials.size() == kMaterialCount && library.meshes.size() == kItemCount);
    const auto put = [&](Item item, const MeshBuilder& mesh) { putShape(library.meshes[item], mesh); };
    const auto lump = [](const glm::dvec3& radius, double sunk, uint64_t seed) {
        MeshBuilder mesh;
        addLump(mesh, kRock, {0, -sunk, 0}, radius, 0.35, seed);
        return mesh;
    };
    put(kSpruce, conifer(5, 1.25, 17, 2.75));
    put(kPine, conifer(3, 5, 13, 2.5));
    put(kOak, leafyTree(kBark, kLeaf, 3, 12, 4.5, 21));
    put(kBirch, leafyTree(kBirchBark, kPaleLeaf, 3, 11, 2.25, 24));
    MeshBuilder bush;
    addLump(bush, kLeaf, {0, 0.5, 0}, {1.25, 1.125, 1.25}, 0.3, 27);
    put(kBush, bush);
    put(kBoulder, lump({2, 1.75, 1.75}, 0.25, 28));
    put(kSlabRock, lump({3.5, 1.25, 2}, 0.125, 29));
    put(kStones, stones());
    put(kHouse, house({5.5, 4}, 3.25, 6.5, kPlaster, kRoofTiles, 4));
    put(kBarn, house({8, 4.5}, 4, 7.75, kTimber, kRoofTiles, 0));
    put(kHut, house({3, 2.25}, 2.625, 4.5, kTimber, kBoards, 3));
    return library;
}

}  // namespace sightline::tools::terrain
