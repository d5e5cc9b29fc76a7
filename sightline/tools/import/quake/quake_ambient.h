// Levels of ambient sounds in the leaves of a Quake map: where water, the sky or lava is in sight, it is heard.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/result.h"

namespace sightline::tools {

/// Which textures sound: by the beginnings of their names, in any case of letters.
struct AmbientSounds {
    bool water = true;  ///< "*water", "*04water"
    bool sky = true;    ///< "sky"
    bool slime = true;  ///< "*slime": it sounds as water does
    bool lava = true;   ///< "*lava"
};

/// Sets the levels in all leaves, as the tool of the game's makers does: of a sound 255 if a leaf that is seen, or the
/// leaf itself, has a face of such a texture, else 0; the level of slime is always 0. Quake alone (version 29, BSP2,
/// 2PSB): other maps stay as they are.
/// @param bytes  of a `.bsp`
/// @param seen   [clusters x clusters]
/// @returns how many leaves have some. Errors: of parseQuakeBsp(); rows of another size (kInput).
Result<uint64_t> writeAmbientLevels(std::vector<unsigned char>& bytes, const std::string& name, const BitMatrix& seen,
                                    const AmbientSounds& sounds = {});

}  // namespace sightline::tools
