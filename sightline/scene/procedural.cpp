// Procedural scenes by their specification: city:SEED:OBJECTS, made:NAME.
// SPDX-License-Identifier: MIT
#include "sightline/scene/procedural.h"

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "sightline/scene/city.h"
#include "sightline/scene/made.h"

namespace sightline {
namespace {

constexpr std::string_view kCity = "city", kMade = "made";
constexpr uint64_t kMostObjects = 10'000'000;

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

}  // namespace

bool isProcedural(const std::string& spec) { return begins(spec, kCity) || begins(spec, kMade); }

Result<Scene> makeProcedural(const std::string& spec) {
    if (begins(spec, kMade)) return makeMade(spec);
    if (!begins(spec, kCity)) return usage(spec, "not a procedural scene; there are city:SEED:OBJECTS and made:NAME");
    const std::string_view rest = std::string_view(spec).substr(kCity.size() + 1);
    const size_t colon = rest.find(':');
    if (colon == std::string_view::npos) return usage(spec, "the number of objects is missing: city:SEED:OBJECTS");
    const std::optional<uint64_t> seed = parseNumber(rest.substr(0, colon));
    if (!seed) return usage(spec, "the seed is not a number from 0 to 2^64 - 1");
    const std::optional<uint64_t> objects = parseNumber(rest.substr(colon + 1));
    if (!objects || *objects < 1 || *objects > kMostObjects)
        return usage(spec, fmt::format("the number of objects is not a number from 1 to {}", kMostObjects));
    Scene scene = makeCity(*seed, static_cast<uint32_t>(*objects));
    scene.name = spec;
    return scene;
}

}  // namespace sightline
