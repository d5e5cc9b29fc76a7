// Procedural scenes by their specification: city:SEED:OBJECTS, building:SEED:FLOORS, terrain:SEED:SIZE, made:NAME.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/procedural.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/made.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline::tools {
namespace {

constexpr std::string_view kMade = "made";

/// A scene that a seed and a size make: name:SEED:SIZE.
struct WorldMaker {
    std::string_view name, size;  ///< as in the specification
    std::string_view size_in_words;
    uint64_t least, most;  ///< limits of the size
    Scene (*make)(uint64_t seed, uint32_t size);
};

constexpr std::array<WorldMaker, 3> kWorldMakers{{
    {"city", "OBJECTS", "number of objects", 1, 10'000'000, makeCity},
    {"building", "FLOORS", "number of floors", 1, 200, makeBuilding},
    {"terrain", "SIZE", "number of samples along a side", 16, 8192, makeTerrain},
}};

Error usage(const std::string& spec, const std::string& what) {
    return {Error::Kind::kUsage, fmt::format("{}: {}", spec, what)};
}

/// The whole text as a decimal number that fits.
std::optional<uint64_t> parseNumber(std::string_view text) {
    uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end) return std::nullopt;
    return number;
}

/// True if the text begins with the name and a colon.
bool begins(std::string_view spec, std::string_view name) {
    return spec.size() > name.size() && spec.substr(0, name.size()) == name && spec[name.size()] == ':';
}

Result<Scene> makeMade(const std::string& spec) {
    if (std::optional<Scene> scene = makeMadeScene(std::string_view(spec).substr(kMade.size() + 1)))
        return std::move(*scene);
    std::string names;
    for (const MadeScene& made : madeScenes()) names += (names.empty() ? "" : ", ") + std::string(made.name);
    return usage(spec, fmt::format("there is no such made scene (there are: {})", names));
}

Result<Scene> makeSeeded(const std::string& spec, const WorldMaker& maker) {
    const std::string_view rest = std::string_view(spec).substr(maker.name.size() + 1);
    const size_t colon = rest.find(':');
    if (colon == std::string_view::npos)
        return usage(spec, fmt::format("the {} is missing: {}:SEED:{}", maker.size_in_words, maker.name, maker.size));
    const std::optional<uint64_t> seed = parseNumber(rest.substr(0, colon));
    if (!seed) return usage(spec, "the seed is not a number from 0 to 2^64 - 1");
    const std::optional<uint64_t> size = parseNumber(rest.substr(colon + 1));
    if (!size || *size < maker.least || *size > maker.most)
        return usage(spec,
                     fmt::format("the {} is not a number from {} to {}", maker.size_in_words, maker.least, maker.most));
    Scene scene = maker.make(*seed, static_cast<uint32_t>(*size));
    scene.name = spec;
    return scene;
}

}  // namespace

bool isProcedural(const std::string& spec) {
    if (begins(spec, kMade)) return true;
    return std::any_of(kWorldMakers.begin(), kWorldMakers.end(),
                       [&](const WorldMaker& maker) { return begins(spec, maker.name); });
}

Result<Scene> makeProcedural(const std::string& spec) {
    if (begins(spec, kMade)) return makeMade(spec);
    for (const WorldMaker& maker : kWorldMakers)
        if (begins(spec, maker.name)) return makeSeeded(spec, maker);
    std::string names;
    for (const WorldMaker& maker : kWorldMakers) names += fmt::format("{}:SEED:{}, ", maker.name, maker.size);
    return usage(spec, fmt::format("not a procedural scene (there are {}made:NAME)", names));
}

}  // namespace sightline::tools
