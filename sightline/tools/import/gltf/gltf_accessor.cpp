// Decodes accessors: normalised and quantised components, strides, sparse replacements.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "sightline/tools/import/gltf/gltf_draco.h"

namespace sightline::tools::gltf {
namespace {

constexpr uint64_t kMostZeros = 1 << 20;  // elements of an accessor that has no bytes to show for them

static_assert(std::endian::native == std::endian::little, "glTF's buffers are little-endian");

// Calls `use` with a value of the component's C++ type.
template <class Use>
void withType(Component component, Use&& use) {
    switch (component) {
        case Component::kByte:
            use(int8_t{});
            break;
        case Component::kUnsignedByte:
            use(uint8_t{});
            break;
        case Component::kShort:
            use(int16_t{});
            break;
        case Component::kUnsignedShort:
            use(uint16_t{});
            break;
        case Component::kUnsignedInt:
            use(uint32_t{});
            break;
        case Component::kFloat:
            use(float{});
            break;
    }
}

template <class From>
float toFloat(From value, bool normalized) {
    if constexpr (std::is_same_v<From, float>) {
        return value;
    } else {
        if (!normalized) return static_cast<float>(value);
        constexpr double kMost = std::numeric_limits<From>::max();
        return static_cast<float>(std::max(static_cast<double>(value) / kMost, -1.0));
    }
}

// Converts the elements of one run, calling convert(value) for each component.
template <class To, class Convert>
void decodeRun(Document& document, const Elements& elements, uint64_t count, uint32_t components, To* out,
               Convert&& convert) {
    if (!elements.view || count == 0) return;
    if (const auto stream = document.views[*elements.view].stream) unpackDraco(document, *stream);
    const Bytes bytes = viewBytes(document, *elements.view);
    const uint32_t stride = document.views[*elements.view].stride;
    withType(elements.component, [&](auto zero) {
        using From = decltype(zero);
        const size_t step = stride ? stride : components * sizeof(From);
        const unsigned char* from = bytes.data() + elements.offset;
        for (uint64_t i = 0; i < count; ++i, from += i < count ? step : 0)
            for (uint32_t c = 0; c < components; ++c) {
                From value;
                std::memcpy(&value, from + c * sizeof(From), sizeof(From));
                *out++ = convert(value);
            }
    });
}

template <class To, class Convert>
std::vector<To> decode(Document& document, uint32_t index, Convert&& convert) {
    const Accessor& accessor = document.accessors[index];
    const std::string place = accessorPlace(document, index);
    const uint32_t components = accessor.components;
    if (!accessor.elements.view && accessor.count > kMostZeros)
        fail(place, "count {} without a bufferView is more than {}", accessor.count, kMostZeros);
    document.budget.charge(accessor.count, components * sizeof(To), place);
    std::vector<To> out(accessor.count * components);
    decodeRun(document, accessor.elements, accessor.count, components, out.data(), convert);
    if (!accessor.sparse) return out;

    const Sparse& sparse = *accessor.sparse;
    document.budget.charge(sparse.count, sizeof(uint32_t) + components * sizeof(To), place);
    std::vector<uint32_t> places(sparse.count);
    decodeRun(document, sparse.indices, sparse.count, 1, places.data(),
              [](auto value) { return static_cast<uint32_t>(value); });
    std::vector<To> values(sparse.count * components);
    decodeRun(document, sparse.values, sparse.count, components, values.data(), convert);
    for (size_t i = 0; i < places.size(); ++i) {
        if (places[i] >= accessor.count)
            fail(place + ".sparse", "index {} is out of range of {} elements", places[i], accessor.count);
        std::copy_n(values.begin() + static_cast<ptrdiff_t>(i * components), components,
                    out.begin() + static_cast<ptrdiff_t>(size_t(places[i]) * components));
    }
    return out;
}

void checkComponents(const Accessor& accessor, uint32_t components, const char* what, const std::string& place) {
    if (accessor.components != components)
        fail(place, "{} needs {} components an element, not {}", what, components, accessor.components);
}

}  // namespace

std::vector<float> decodeFloats(Document& document, uint32_t index, uint32_t components, const char* what) {
    const Accessor& accessor = document.accessors[index];
    const std::string place = accessorPlace(document, index);
    checkComponents(accessor, components, what, place);
    if (accessor.elements.component == Component::kUnsignedInt) fail(place, "{} cannot be 32-bit integers", what);
    const bool normalized = accessor.normalized;
    std::vector<float> out =
        decode<float>(document, index, [normalized](auto value) { return toFloat(value, normalized); });
    for (size_t i = 0; i < out.size(); ++i)
        if (!std::isfinite(out[i])) fail(place, "{} {} is not finite", what, i / components);
    return out;
}

std::vector<uint32_t> decodeIntegers(Document& document, uint32_t index, uint32_t components, const char* what) {
    const Accessor& accessor = document.accessors[index];
    const std::string place = accessorPlace(document, index);
    checkComponents(accessor, components, what, place);
    const Component kind = accessor.elements.component;
    if (kind != Component::kUnsignedByte && kind != Component::kUnsignedShort && kind != Component::kUnsignedInt)
        fail(place, "{} is not of unsigned integers", what);
    return decode<uint32_t>(document, index, [](auto value) { return static_cast<uint32_t>(value); });
}

}  // namespace sightline::tools::gltf
