// What a z-buffer is told: its format, its tests, its shaders, and which of its shortcuts it may take.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {

/// What a shader does beside giving a colour.
enum class ShaderKind : uint8_t {
    kPlain,         ///< nothing: a fragment can be tested before it is shaded
    kDiscards,      ///< may drop fragments: they can be tested before, but written only afterwards
    kWritesDepth,   ///< gives the depth itself: nothing can be tested before, one by one or by tiles
    kWritesFarther  ///< gives a depth that is promised to be no nearer: what is hidden already can be dropped before
};

/// Shaders, called from several threads at once.
struct DepthShader {
    ShaderKind kind = ShaderKind::kPlain;
    /// kDiscards: false drops the fragment. Null keeps all.
    bool (*keeps)(uint32_t surface, int32_t row, int32_t sample) = nullptr;
    /// kWritesDepth and kWritesFarther (which take the farther of both): the new nearness. Null keeps the old.
    double (*nearness)(uint32_t surface, int32_t row, int32_t sample, double nearness) = nullptr;
};

struct DepthSettings {
    DepthFormat format = DepthFormat::kReversedFloat;
    std::optional<DepthComparison> comparison;  ///< empty: the format's, what is nearer
    std::optional<uint32_t> clear_value;        ///< as memory holds it (DepthCodec::pattern); empty: the far value
    bool write = true;                          ///< false: depths stay as they are
    double offset_factor = 0;  ///< moves polygons away from the eye by so many times their steepest slope ...
    double offset_units = 0;   ///< ... and so many of the smallest differences
    DepthShader shader;
    bool early_test = true;  ///< before shading, as far as the shader allows
    bool hierarchy = true;   ///< reject and accept whole polygons and tiles; only where an early test is allowed
    bool fast_clear = true;  ///< clear by a state per tile
    bool near_to_far =
        false;  ///< draw items by their nearest points, nearest first: a painter's order turned about. Of
                ///< surfaces at the same depth, the first in this order stays
    bool compression = false;  ///< keep tiles compressed between batches of polygons: saves bytes, not time
};

}  // namespace sightline::studies
