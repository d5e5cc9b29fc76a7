// What of a map's faces hides: by names and flags of each game, and by what the tree says.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_surface.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace sightline::tools {
namespace {

using namespace std::string_view_literals;

/// '*' and '!' are liquids, '{' is cut out; the others are not drawn as they look, or not at all.
bool seenThroughByName(std::string_view name, bool half_life) {
    constexpr std::array kPrefixes = {"*"sv,          "!"sv,      "{"sv,         "sky"sv,      "trigger"sv,
                                      "aaatrigger"sv, "clip"sv,   "skip"sv,      "hint"sv,     "origin"sv,
                                      "null"sv,       "nodraw"sv, "waterskip"sv, "lavaskip"sv, "slimeskip"sv};
    std::string low(name);
    std::transform(low.begin(), low.end(), low.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    if (half_life && (low.starts_with("water") || low.starts_with("laser"))) return true;  // drawn as liquids are
    return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                       [&](std::string_view prefix) { return low.starts_with(prefix); });
}

/// A face parts two contents, the same two everywhere. Close behind the middle of each triangle of its fan must be
/// what is solid.
bool solidBehind(const QuakeMapFile& map, const QuakeFace& face) {
    const glm::vec3* const points = map.points.data() + face.first_point;
    glm::dvec3 area(0);
    for (uint32_t i = 1; i + 1 < face.point_count; ++i)
        area += glm::cross(glm::dvec3(points[i]) - glm::dvec3(points[0]),
                           glm::dvec3(points[i + 1]) - glm::dvec3(points[0]));
    if (!(glm::length(area) > 0)) return false;
    const glm::dvec3 normal = glm::normalize(area);
    for (uint32_t i = 1; i + 1 < face.point_count; ++i) {
        const glm::dvec3 middle = (glm::dvec3(points[0]) + glm::dvec3(points[i]) + glm::dvec3(points[i + 1])) / 3.0;
        for (const double depth : {0.03125, 0.25})  // [world units]: past the rounding of points and planes
            if (map.tree.contents[leafAt(map.tree, middle - depth * normal)] != LeafContents::kSolid) return false;
    }
    return true;
}

QuakeSurface firstSurface(const QuakeMapFile& map, const QuakeFace& face) {
    constexpr uint32_t kSpecial = 1;  // without light: liquids and skies
    const QuakeTexture& texture = map.textures[face.texture];
    const bool seen_through = (texture.surface_flags & kSpecial) != 0 ||
                              seenThroughByName(texture.name, map.format == QuakeFormat::kHalfLife);
    if (seen_through) return QuakeSurface::kSeeThrough;
    if (face.model != 0) return QuakeSurface::kMovable;
    return solidBehind(map, face) ? QuakeSurface::kSolid : QuakeSurface::kSeeThrough;
}

QuakeSurface secondSurface(const QuakeMapFile& map, const QuakeFace& face) {
    constexpr uint32_t kSky = 4, kWarp = 8, kTrans33 = 0x10, kTrans66 = 0x20, kNoDraw = 0x80, kHint = 0x100,
                       kSkip = 0x200,
                       kAlphaTest = 0x2000000;  // of later engines
    const uint32_t flags = map.textures[face.texture].surface_flags;
    if (flags & (kNoDraw | kHint | kSkip) && !(flags & kSky)) return QuakeSurface::kNotDrawn;
    if (flags & (kSky | kWarp | kTrans33 | kTrans66 | kAlphaTest)) return QuakeSurface::kSeeThrough;
    return face.model == 0 ? QuakeSurface::kSolid : QuakeSurface::kMovable;
}

QuakeSurface thirdSurface(const QuakeMapFile& map, const QuakeFace& face) {
    constexpr uint32_t kSky = 4, kNoDraw = 0x80, kHint = 0x100, kSkip = 0x200, kNonSolid = 0x4000;
    constexpr uint32_t kSolid = 1, kLava = 8, kSlime = 16, kWater = 32, kFog = 64, kTranslucent = 0x20000000;
    const QuakeTexture& texture = map.textures[face.texture];
    if (texture.surface_flags & (kNoDraw | kHint | kSkip) && !(texture.surface_flags & kSky))
        return QuakeSurface::kNotDrawn;
    if (texture.surface_flags & (kSky | kNonSolid)) return QuakeSurface::kSeeThrough;
    if (texture.contents & (kLava | kSlime | kWater | kFog | kTranslucent)) return QuakeSurface::kSeeThrough;
    if (face.kind == QuakeFace::Kind::kPatch) return QuakeSurface::kCurved;
    if (!(texture.contents & kSolid) || face.kind != QuakeFace::Kind::kPolygon) return QuakeSurface::kSeeThrough;
    return face.model == 0 ? QuakeSurface::kSolid : QuakeSurface::kMovable;
}

}  // namespace

QuakeSurface quakeSurface(const QuakeMapFile& map, const QuakeFace& face) {
    if (face.kind == QuakeFace::Kind::kNothing) return QuakeSurface::kNotDrawn;
    if (map.format == QuakeFormat::kQuake3) return thirdSurface(map, face);
    return map.format == QuakeFormat::kQuake2 ? secondSurface(map, face) : firstSurface(map, face);
}

}  // namespace sightline::tools
