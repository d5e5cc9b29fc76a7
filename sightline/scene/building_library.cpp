// What a procedural building is furnished with: materials, and the meshes that its objects are instances of.
// SPDX-License-Identifier: MIT
#include "sightline/scene/building_library.h"

#include "sightline/base/assert.h"

namespace sightline::building {

std::vector<Material> makeMaterials() {
    std::vector<Material> materials(kMaterialCount);
    const auto set = [&](MaterialId id, const char* name, float r, float g, float b) -> Material& {
        materials[id].name = name;
        materials[id].base_color = {r, g, b, 1.0f};
        return materials[id];
    };
    set(kGravel, "gravel", 0.55f, 0.53f, 0.50f);
    set(kStone, "stone cladding", 0.66f, 0.63f, 0.57f);
    set(kConcrete, "concrete", 0.60f, 0.60f, 0.60f);
    set(kRender, "render", 0.86f, 0.80f, 0.68f);
    set(kWhite, "white paint", 0.93f, 0.93f, 0.91f);
    set(kCream, "cream paint", 0.92f, 0.87f, 0.76f);
    set(kTile, "wall tiles", 0.80f, 0.88f, 0.90f);
    set(kDarkTile, "floor tiles", 0.36f, 0.41f, 0.45f);
    set(kTerrazzo, "terrazzo", 0.72f, 0.68f, 0.64f);
    set(kLinoleum, "linoleum", 0.45f, 0.52f, 0.47f);
    set(kCarpet, "carpet", 0.34f, 0.38f, 0.47f);
    set(kParquet, "parquet", 0.60f, 0.43f, 0.27f);
    Material& glass = set(kGlass, "glass", 0.62f, 0.76f, 0.82f);
    glass.base_color.a = 0.25f;
    glass.alpha_mode = AlphaMode::kBlend;
    set(kFrameGrey, "window frame", 0.33f, 0.35f, 0.38f);
    set(kDoorWood, "door", 0.66f, 0.47f, 0.29f);
    set(kOak, "oak", 0.62f, 0.47f, 0.30f);
    set(kBeech, "beech", 0.80f, 0.65f, 0.46f);
    set(kSteel, "steel", 0.56f, 0.58f, 0.61f);
    set(kChrome, "chrome", 0.78f, 0.80f, 0.82f);
    set(kBlackPlastic, "black plastic", 0.12f, 0.12f, 0.13f);
    set(kGreyPlastic, "grey plastic", 0.70f, 0.70f, 0.68f);
    set(kScreenBlack, "screen", 0.05f, 0.08f, 0.13f);
    set(kFabricBlue, "blue fabric", 0.20f, 0.32f, 0.55f);
    set(kFabricRed, "red fabric", 0.62f, 0.20f, 0.18f);
    set(kFabricGrey, "grey fabric", 0.38f, 0.38f, 0.40f);
    set(kCeramic, "ceramic", 0.96f, 0.96f, 0.97f);
    set(kPaper, "paper", 0.97f, 0.96f, 0.92f);
    set(kCardboard, "cardboard", 0.70f, 0.55f, 0.37f);
    set(kBookRed, "red books", 0.58f, 0.16f, 0.14f);
    set(kBookGreen, "green books", 0.18f, 0.40f, 0.24f);
    set(kBookBlue, "blue books", 0.17f, 0.27f, 0.50f);
    set(kBookYellow, "yellow books", 0.84f, 0.68f, 0.22f);
    Material& leaf = set(kLeaf, "leaves", 0.22f, 0.46f, 0.20f);
    leaf.alpha_mode = AlphaMode::kMask;
    leaf.double_sided = true;
    set(kSoil, "soil", 0.25f, 0.18f, 0.13f);
    set(kTerracotta, "terracotta", 0.70f, 0.38f, 0.26f);
    set(kLampShade, "lamp", 0.98f, 0.95f, 0.80f);
    set(kMirror, "mirror", 0.72f, 0.80f, 0.84f);
    set(kSignGreen, "exit sign", 0.05f, 0.55f, 0.30f);
    set(kSignalRed, "signal red", 0.75f, 0.10f, 0.09f);
    set(kPanelBlue, "solar cells", 0.10f, 0.14f, 0.32f);
    set(kBark, "bark", 0.36f, 0.28f, 0.21f);
    set(kGrass, "hedge", 0.26f, 0.45f, 0.22f);
    return materials;
}

Library makeLibrary() {
    Library library;
    library.materials = makeMaterials();
    addFurniture(library.meshes);
    addWetRooms(library.meshes);
    addEquipment(library.meshes);
    addFittings(library.meshes);
    addOutdoorItems(library.meshes);
    SIGHTLINE_ASSERT(library.meshes.size() == kItemCount);
    return library;
}

city::Frame fifthFrame(int fifth) {
    constexpr double kCos[] = {1, 0.30901699437494742, -0.80901699437494742, -0.80901699437494742, 0.30901699437494742};
    constexpr double kSin[] = {0, 0.95105651629515357, 0.58778525229247313, -0.58778525229247313, -0.95105651629515357};
    const glm::dvec3 outward(kCos[fifth], 0, kSin[fifth]), up(0, 1, 0);
    return {{0, 0, 0}, outward, up, glm::cross(outward, up)};
}

void addPlant(city::MeshBuilder& mesh, double pot, double height, double spread, int leaves) {
    const double rim = 1.75 * pot;
    addTurned(mesh, kTerracotta, {0, 0, 0}, 12,
              {{0.75 * pot, 0}, {pot, rim}, {1.0625 * pot, rim}, {1.0625 * pot, rim + 0.03125}});
    addTurned(mesh, kSoil, {0, 0, 0}, 8, {{0.8125 * pot, 0.03125}, {0.875 * pot, rim + 0.046875}});
    addTurned(mesh, kBark, {0, 0, 0}, 6, {{0.02, rim}, {0.012, 0.75 * height}});
    // Each leaf is folded along its middle.
    for (int i = 0; i < leaves; ++i) {
        const city::Frame frame = fifthFrame((2 * i) % 5);
        const double share = static_cast<double>(i) / leaves, foot = rim + 0.05 + share * 0.6 * (height - rim);
        const double reach = spread * (1 - 0.5 * share), rise = 0.3 * (height - rim) * (0.5 + share);
        const double turn = i % 3 * 0.25 - 0.25;  // so that leaves of one direction fan out
        const glm::dvec3 out = frame.u + frame.w * turn, wide = frame.w * (0.22 * reach);
        const glm::dvec3 root(0, foot, 0), tip = out * reach + glm::dvec3(0, foot + 0.6 * rise, 0);
        const glm::dvec3 middle = out * (0.5 * reach) + glm::dvec3(0, foot + rise, 0), sag(0, 0.05 * reach, 0);
        mesh.triangle(kLeaf, root, middle - wide + sag, middle);
        mesh.triangle(kLeaf, root, middle, middle + wide + sag);
        mesh.triangle(kLeaf, middle, middle - wide + sag, tip);
        mesh.triangle(kLeaf, middle, tip, middle + wide + sag);
    }
}

void shelve(Shelf& meshes, Item item, const char* name, const city::MeshBuilder& mesh) {
    SIGHTLINE_ASSERT(meshes.size() == item);
    meshes.push_back(mesh.finish(name));
}

}  // namespace sightline::building
