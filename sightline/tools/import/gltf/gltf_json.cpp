// Reads typed values out of untrusted JSON; every mistake names its place.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_json.h"

#include <cmath>
#include <limits>

namespace sightline::tools::gltf {
namespace {

uint64_t wholeValue(const Json& value, const char* key, const std::string& place) {
    constexpr uint64_t kMost = uint64_t(1) << 53;
    if (value.is_number_unsigned()) {
        const uint64_t number = value.get<uint64_t>();
        if (number > kMost) fail(place, "{} is too large: {}", key, number);
        return number;
    }
    if (!value.is_number()) fail(place, "{} is not a number", key);
    const double number = value.get<double>();
    if (!(number >= 0 && number <= static_cast<double>(kMost)) || number != std::floor(number))
        fail(place, "{} is not a whole number in range: {}", key, number);
    return static_cast<uint64_t>(number);
}

double finiteValue(const Json& value, const char* key, const std::string& place) {
    if (!value.is_number()) fail(place, "{} is not a number", key);
    const double number = value.get<double>();
    if (!std::isfinite(number)) fail(place, "{} is not finite", key);
    return number;
}

uint32_t indexValue(const Json& value, const char* key, size_t count, const std::string& place) {
    const uint64_t number = wholeValue(value, key, place);
    if (number >= count) fail(place, "{} {} is out of range of {}", key, number, count);
    return static_cast<uint32_t>(number);
}

}  // namespace

const Json* find(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const Json* findObject(const Json& object, const char* key, const std::string& place) {
    const Json* value = find(object, key);
    if (value && !value->is_object()) fail(place, "{} is not an object", key);
    return value;
}

const Json& table(const Json& object, const char* key, const std::string& place) {
    static const Json kEmpty = Json::array();
    const Json* value = find(object, key);
    if (!value) return kEmpty;
    if (!value->is_array()) fail(place, "{} is not an array", key);
    return *value;
}

const Json& objectAt(const Json& array, size_t index, const std::string& place) {
    const Json& value = array[index];
    if (!value.is_object()) fail(place, "is not an object");
    return value;
}

const Json* extension(const Json& object, const char* name, const std::string& place) {
    const Json* all = findObject(object, "extensions", place);
    return all ? findObject(*all, name, place) : nullptr;
}

std::optional<double> number(const Json& object, const char* key, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) return std::nullopt;
    return finiteValue(*value, key, place);
}

std::optional<uint64_t> whole(const Json& object, const char* key, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) return std::nullopt;
    return wholeValue(*value, key, place);
}

uint64_t requiredWhole(const Json& object, const char* key, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) fail(place, "{} is missing", key);
    return wholeValue(*value, key, place);
}

std::optional<uint32_t> index(const Json& object, const char* key, size_t count, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) return std::nullopt;
    return indexValue(*value, key, count, place);
}

uint32_t requiredIndex(const Json& object, const char* key, size_t count, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) fail(place, "{} is missing", key);
    return indexValue(*value, key, count, place);
}

uint32_t indexAt(const Json& array, size_t element, const char* key, size_t count, const std::string& place) {
    return indexValue(array[element], key, count, place);
}

bool flag(const Json& object, const char* key, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) return false;
    if (!value->is_boolean()) fail(place, "{} is neither true nor false", key);
    return value->get<bool>();
}

std::string text(const Json& object, const char* key, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) return {};
    if (!value->is_string()) fail(place, "{} is not a string", key);
    return value->get<std::string>();
}

bool numbers(const Json& object, const char* key, std::span<double> out, const std::string& place) {
    const Json* value = find(object, key);
    if (!value) return false;
    if (!value->is_array() || value->size() != out.size()) fail(place, "{} is not {} numbers", key, out.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = finiteValue((*value)[i], key, place);
    return true;
}

std::vector<float> floats(const Json& object, const char* key, const std::string& place) {
    std::vector<float> out;
    for (const Json& element : table(object, key, place)) {
        const double value = finiteValue(element, key, place);
        if (std::abs(value) > std::numeric_limits<float>::max()) fail(place, "{} is too large for a float", key);
        out.push_back(static_cast<float>(value));
    }
    return out;
}

}  // namespace sightline::tools::gltf
