// The directory of a .bsp. The formats' numbers of lumps and sizes of records stand in one table.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_lumps.h"

#include <cmath>
#include <cstring>
#include <string_view>

namespace sightline::tools::quake {
namespace {

constexpr size_t kKinds = static_cast<size_t>(Lump::kCount);

struct Layout {
    const char* name;
    size_t lumps;
    std::array<int8_t, kKinds> numbers;
    std::array<uint8_t, kKinds> strides;  ///< [bytes]; 1: no records
};

constexpr const char* kNames[kKinds] = {"entities", "planes",     "textures", "vertices",    "visibility",
                                        "nodes",    "texinfo",    "faces",    "leaves",      "leaf faces",
                                        "edges",    "face edges", "models",   "mesh indices"};

constexpr std::array<int8_t, kKinds> kQuakeNumbers = {0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 12, 13, 14, -1};

// By QuakeFormat.  entities planes textures vertices visibility nodes texinfo faces leaves leaf-faces edges face-edges
// models mesh-indices
constexpr Layout kLayouts[] = {
    {"Quake (version 29)", 15, kQuakeNumbers, {1, 20, 1, 12, 1, 24, 40, 20, 28, 2, 4, 4, 64, 1}},
    {"Quake (BSP2)", 15, kQuakeNumbers, {1, 20, 1, 12, 1, 44, 40, 28, 44, 4, 8, 4, 64, 1}},
    {"Quake (2PSB)", 15, kQuakeNumbers, {1, 20, 1, 12, 1, 32, 40, 28, 32, 4, 8, 4, 64, 1}},
    {"Half-Life (version 30)", 15, kQuakeNumbers, {1, 20, 1, 12, 1, 24, 40, 20, 28, 2, 4, 4, 64, 1}},
    {"Quake 2 (IBSP 38)",
     19,
     {0, 1, -1, 2, 3, 4, 5, 6, 8, 9, 11, 12, 13, -1},
     {1, 20, 1, 12, 1, 28, 76, 20, 28, 2, 4, 4, 48, 1}},
    {"Quake 3 (IBSP 46)",
     17,
     {0, 2, 1, 10, 16, 3, -1, 13, 4, 5, -1, -1, 7, 11},
     {1, 16, 72, 44, 1, 36, 1, 104, 48, 4, 1, 1, 40, 4}},
};

const Layout& layoutOf(QuakeFormat format) { return kLayouts[static_cast<size_t>(format)]; }

QuakeFormat formatOf(Bytes bytes) {
    ByteCursor head = cursorOf(bytes);
    const std::string_view magic(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), 4));
    const auto first = head.take<uint32_t>(), second = head.take<uint32_t>();
    if (bytes.size() >= 8) {
        if (magic == "BSP2") return QuakeFormat::kBsp2;
        if (magic == "2PSB") return QuakeFormat::kPsb2;
        if (first == 29) return QuakeFormat::kQuake;
        if (first == 30) return QuakeFormat::kHalfLife;
        if (magic == "IBSP" && second == 38) return QuakeFormat::kQuake2;
        if (magic == "IBSP" && second == 46) return QuakeFormat::kQuake3;
        if (magic == "IBSP" || magic == "VBSP" || magic == "RBSP" || magic == "FBSP")
            fail("", "is a map of another format ({} version {})", magic, second);
    }
    fail("", "is no compiled map of Quake, Half-Life, Quake 2 or Quake 3");
}

}  // namespace

Directory readDirectory(Bytes bytes) {
    Directory out;
    out.format = formatOf(bytes);
    const Layout& layout = layoutOf(out.format);
    out.numbers = layout.numbers;
    out.table = out.format == QuakeFormat::kQuake2 || out.format == QuakeFormat::kQuake3 ? 8 : 4;
    if (bytes.size() < out.table + 8 * layout.lumps) fail("", "truncated: it ends within its list of lumps");
    ByteCursor cursor = cursorOf(bytes.subspan(out.table));
    for (size_t i = 0; i < layout.lumps; ++i) {
        const LumpPlace place{cursor.take<uint32_t>(), cursor.take<uint32_t>()};
        if (place.size > 0 && place.offset + place.size > bytes.size())
            fail("", "truncated: lump {} ends at byte {} of {}", i, place.offset + place.size, bytes.size());
        out.lumps.push_back(place);
    }
    // Blue Shift's maps are Half-Life's but for the order of the first two.
    if (out.format == QuakeFormat::kHalfLife && out.lumps[1].size > 0 && bytes[out.lumps[1].offset] == '{')
        std::swap(out.numbers[0], out.numbers[1]);
    return out;
}

Bytes lumpBytes(Bytes bytes, const Directory& directory, Lump lump) {
    const int number = directory.number(lump);
    if (number < 0 || directory.lumps[static_cast<size_t>(number)].size == 0) return {};
    const LumpPlace& place = directory.lumps[static_cast<size_t>(number)];
    return bytes.subspan(place.offset, place.size);
}

Records lumpRecords(Bytes bytes, const Directory& directory, Lump lump) {
    const auto kind = static_cast<size_t>(lump);
    const Bytes part = lumpBytes(bytes, directory, lump);
    const size_t stride = layoutOf(directory.format).strides[kind];
    if (part.size() % stride != 0)
        fail("", "its {} take {} bytes, which is no multiple of {}", kNames[kind], part.size(), stride);
    return {part, kNames[kind], stride};
}

glm::vec3 takePoint(ByteCursor& cursor, const char* place, uint64_t index) {
    constexpr float kFarthest = 1e9f;  // [world units]
    const float x = cursor.take<float>(), y = cursor.take<float>(), z = cursor.take<float>();
    for (const float value : {x, y, z})
        if (!(std::abs(value) <= kFarthest)) fail(at(place, index), "a number that is not finite or beyond 1e9");
    return {x, z, 0 - y};
}

}  // namespace sightline::tools::quake

namespace sightline::tools {

const char* quakeFormatName(QuakeFormat format) { return quake::layoutOf(format).name; }

}  // namespace sightline::tools
