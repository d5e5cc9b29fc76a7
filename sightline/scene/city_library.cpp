// The city's stock: materials, and the meshes that its objects are instances of. It depends on the seed alone.
// SPDX-License-Identifier: MIT
#include "sightline/scene/city_library.h"

namespace sightline::city {

std::vector<Material> makeMaterials() {
    std::vector<Material> materials(kMaterialCount);
    const auto set = [&](MaterialId id, const char* name, float r, float g, float b) -> Material& {
        materials[id].name = name;
        materials[id].base_color = {r, g, b, 1.0f};
        return materials[id];
    };
    set(kAsphalt, "asphalt", 0.22f, 0.22f, 0.24f);
    set(kPaving, "paving", 0.62f, 0.60f, 0.56f);
    set(kLawnGreen, "lawn", 0.38f, 0.55f, 0.27f);
    set(kSand, "sand plaster", 0.87f, 0.78f, 0.62f);
    set(kRose, "rose plaster", 0.83f, 0.62f, 0.54f);
    set(kBrick, "brick", 0.62f, 0.32f, 0.25f);
    set(kStone, "stone", 0.71f, 0.68f, 0.61f);
    set(kOchre, "ochre plaster", 0.85f, 0.66f, 0.36f);
    set(kGrey, "grey render", 0.58f, 0.60f, 0.63f);
    set(kWhite, "white render", 0.91f, 0.90f, 0.87f);
    set(kShade, "niche", 0.34f, 0.33f, 0.34f);
    set(kTiles, "roof tiles", 0.64f, 0.30f, 0.20f);
    set(kSlate, "slate", 0.31f, 0.34f, 0.39f);
    set(kGravel, "gravel roof", 0.53f, 0.51f, 0.48f);
    set(kTrim, "trim", 0.93f, 0.90f, 0.83f);
    Material& glass = set(kGlass, "glass", 0.55f, 0.70f, 0.78f);
    glass.base_color.a = 0.35f;
    glass.alpha_mode = AlphaMode::kBlend;
    set(kMetal, "painted metal", 0.18f, 0.24f, 0.22f);
    set(kWood, "wood", 0.52f, 0.36f, 0.22f);
    set(kBark, "bark", 0.36f, 0.28f, 0.21f);
    set(kLeaf, "leaves", 0.33f, 0.52f, 0.20f);
    set(kDarkLeaf, "dark leaves", 0.20f, 0.40f, 0.19f);
    for (const MaterialId leaf : {kLeaf, kDarkLeaf}) {
        materials[leaf].alpha_mode = AlphaMode::kMask;
        materials[leaf].double_sided = true;
    }
    set(kRed, "red paint", 0.72f, 0.13f, 0.12f);
    set(kBlue, "blue paint", 0.15f, 0.28f, 0.58f);
    set(kSilver, "silver paint", 0.75f, 0.76f, 0.78f);
    set(kBlack, "black paint", 0.10f, 0.10f, 0.12f);
    set(kRubber, "rubber", 0.08f, 0.08f, 0.08f);
    set(kMesh, "fence", 0.25f, 0.33f, 0.28f).double_sided = true;
    set(kBoard, "sign board", 0.85f, 0.80f, 0.25f).double_sided = true;
    set(kCloth, "awning cloth", 0.70f, 0.22f, 0.20f).double_sided = true;
    set(kCopper, "copper", 0.36f, 0.62f, 0.54f);
    set(kLight, "lamp glass", 0.98f, 0.95f, 0.80f);
    set(kPaint, "road paint", 0.95f, 0.95f, 0.93f).double_sided = true;
    return materials;
}

Library makeLibrary(uint64_t seed) {
    Library library;
    library.materials = makeMaterials();
    addItems(library);
    addBuildings(library, Random(mixSeed(seed, 0x6c696272617279ull)));
    return library;
}

}  // namespace sightline::city
