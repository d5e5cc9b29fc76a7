// Procedural scenes by their specification: NAME:SEED:SIZE.
// SPDX-License-Identifier: MIT
#include "sightline/scene/procedural.h"

#include <charconv>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "sightline/scene/city.h"

namespace sightline {
namespace {

constexpr std::string_view kCity = "city";
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

}  // namespace

bool isProcedural(const std::string& spec) {
    return spec.size() > kCity.size() && spec.compare(0, kCity.size(), kCity) == 0 && spec[kCity.size()] == ':';
}

Result<Scene> makeProcedural(const std::string& spec) {
    if (!isProcedural(spec)) return usage(spec, "not a procedural scene; there is city:SEED:OBJECTS");
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
