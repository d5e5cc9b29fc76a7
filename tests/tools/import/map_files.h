// A small compiled map, made in every format of the Quake family: two rooms, one of them full of water, and a door.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/import/quake/quake_bsp.h"

namespace sightline::test {
using namespace tools;

constexpr QuakeFormat kQuakeFormats[] = {QuakeFormat::kQuake,    QuakeFormat::kBsp2,   QuakeFormat::kPsb2,
                                         QuakeFormat::kHalfLife, QuakeFormat::kQuake2, QuakeFormat::kQuake3};

/// An outline, z up, counter-clockwise as seen from its front, and the number of its texture.
struct MadeFace {
    std::vector<glm::vec3> points;
    int texture = 0;
};

/// What is made: x from -64 to 64, y from -32 to 32, z from 0 to 48; a sheet of water at x = 0, water behind it.
/// Leaf 1 is dry (x < 0), leaf 2 is wet. Faces 0 to 5 are walls, 6 the sheet, 7 the door's only face.
struct MadeMap {
    std::vector<MadeFace> faces;
    std::vector<std::string> textures = {"wall1", "*water", "sky4", "{fence"};
    std::string entities =
        "{\n\"classname\" \"worldspawn\"\n}\n{\n\"classname\" \"func_door\"\n\"model\" \"*1\"\n\"origin\" \"8 0 "
        "0\"\n}\n";
    std::string visibility;      ///< of the format; madeVisibility() makes it
    int32_t rows[2] = {-1, -1};  ///< Quake, Half-Life: where in it the leaves' rows begin

    MadeMap();
};

/// Each room sees itself, and the other if asked.
void madeVisibility(QuakeFormat format, bool open, MadeMap& map);

/// The bytes of a `.bsp`.
std::string mapBytes(QuakeFormat format, const MadeMap& map);

/// Where the file's list says that lump `number` lies.
struct MadeLump {
    uint32_t offset = 0, size = 0;
};
MadeLump lumpOf(const std::string& bytes, int number);

/// Overwrites a number in the bytes.
template <class T>
std::string patched(std::string bytes, size_t at, T value) {
    return bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace sightline::test
