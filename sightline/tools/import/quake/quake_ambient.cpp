// Finds which leaves hold faces that sound, and tells all leaves that see them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_ambient.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <string_view>

#include <fmt/core.h>

#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/import/quake/quake_lumps.h"

namespace sightline::tools {

using namespace quake;

namespace {

/// Places of the levels in a leaf, from its fourth byte from behind.
enum Level : uint32_t { kWater, kSky, kSlime, kLava, kLevels };

bool begins(std::string_view name, std::string_view word) {
    return name.size() >= word.size() && std::equal(word.begin(), word.end(), name.begin(), [](char a, char b) {
               return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
           });
}

/// A bit for each sound.
uint32_t soundsOf(std::string_view texture, const AmbientSounds& sounds) {
    if (begins(texture, "*water") || begins(texture, "*04water")) return sounds.water ? 1u << kWater : 0;
    if (begins(texture, "*slime")) return sounds.slime ? 1u << kWater : 0;
    if (begins(texture, "*lava")) return sounds.lava ? 1u << kLava : 0;
    if (begins(texture, "sky")) return sounds.sky ? 1u << kSky : 0;
    return 0;
}

std::vector<uint32_t> soundsOfClusters(const QuakeMapFile& map, const AmbientSounds& sounds) {
    std::vector<uint32_t> out(map.clusters, 0);
    for (size_t leaf = 0; leaf < map.faces_of_leaf.size(); ++leaf) {
        // Sounds are of leaves of the file: cluster i is leaf i + 1, whether or not it is open.
        if (leaf == 0 || leaf > map.clusters) continue;
        const QuakeLeafFaces& run = map.faces_of_leaf[leaf];
        for (uint32_t i = run.first; i < run.first + run.count; ++i)
            out[leaf - 1] |= soundsOf(map.textures[map.faces[map.leaf_faces[i]].texture].name, sounds);
    }
    return out;
}

}  // namespace

Result<uint64_t> writeAmbientLevels(std::vector<unsigned char>& bytes, const std::string& name, const BitMatrix& seen,
                                    const AmbientSounds& sounds) {
    const Result<QuakeMapFile> map = parseQuakeBsp(bytes, name);
    if (!map) return map.error();
    if (map->format != QuakeFormat::kQuake && map->format != QuakeFormat::kBsp2 && map->format != QuakeFormat::kPsb2)
        return uint64_t{0};
    if (seen.rows() != map->clusters || seen.columns() != map->clusters)
        return Error{Error::Kind::kInput,
                     fmt::format("{}: has {} clusters, the visibility {}", name, map->clusters, seen.rows())};
    const std::vector<uint32_t> own = soundsOfClusters(*map, sounds);
    const Directory directory = readDirectory(bytes);
    const size_t first = directory.lumps[static_cast<size_t>(directory.number(Lump::kLeaves))].offset;
    const size_t stride = lumpRecords(bytes, directory, Lump::kLeaves).stride();
    uint64_t some = 0;
    for (size_t cluster = 0; cluster < own.size(); ++cluster) {
        uint32_t heard = own[cluster];
        for (size_t word = 0; word < seen.wordsPerRow(); ++word)
            for (uint64_t bits = seen.row(cluster)[word]; bits != 0; bits &= bits - 1)
                heard |= own[64 * word + static_cast<size_t>(std::countr_zero(bits))];
        const size_t levels = first + (cluster + 2) * stride - kLevels;
        for (uint32_t level = 0; level < kLevels; ++level) bytes[levels + level] = (heard >> level & 1) != 0 ? 255 : 0;
        some += heard != 0;
    }
    return some;
}

}  // namespace sightline::tools
