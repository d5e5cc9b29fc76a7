// Reads typed values out of untrusted JSON; every mistake names its place.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sightline/tools/import/gltf/gltf_fault.h"

namespace sightline::tools::gltf {

using Json = nlohmann::json;

/// The member of an object, or null if it has none (or is no object).
const Json* find(const Json& object, const char* key);

/// The member of an object, which must be an object itself, or null if there is none.
const Json* findObject(const Json& object, const char* key, const std::string& place);

/// The member of an object, which must be an array; an empty one if there is none.
const Json& table(const Json& object, const char* key, const std::string& place = "");

/// An element of an array, which must be an object.
const Json& objectAt(const Json& array, size_t index, const std::string& place);

/// `object.extensions.name`, or null.
const Json* extension(const Json& object, const char* name, const std::string& place);

/// A finite number; none if the member is absent.
std::optional<double> number(const Json& object, const char* key, const std::string& place);

/// A whole number that is not negative and is exact in a double [limit: <= 2^53].
std::optional<uint64_t> whole(const Json& object, const char* key, const std::string& place);
uint64_t requiredWhole(const Json& object, const char* key, const std::string& place);

/// An index into a table of `count` elements.
std::optional<uint32_t> index(const Json& object, const char* key, size_t count, const std::string& place);
uint32_t requiredIndex(const Json& object, const char* key, size_t count, const std::string& place);

/// The same for an element of an array of indices.
uint32_t indexAt(const Json& array, size_t element, const char* key, size_t count, const std::string& place);

bool flag(const Json& object, const char* key, const std::string& place);

/// Empty if the member is absent.
std::string text(const Json& object, const char* key, const std::string& place);

/// Fills `out` from an array of exactly that many finite numbers; false if the member is absent.
bool numbers(const Json& object, const char* key, std::span<double> out, const std::string& place);

/// An array of any number of floats; empty if the member is absent.
std::vector<float> floats(const Json& object, const char* key, const std::string& place);

}  // namespace sightline::tools::gltf
