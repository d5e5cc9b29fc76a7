// A chain of coarser levels of a mesh, as plain data.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/geom/lod.h"

namespace sightline {

/// Triangles of a part in a level.
struct LodPart {
    uint32_t first = 0, count = 0;  ///< triangles: places in LodChain::indices / 3
};

/// Levels of one mesh. Plain data; prepare/lod/lod_chain.h makes it.
struct LodChain {
    /// Finest first: the mesh itself, with no error. Triangles fall, and errors rise, each above the last one.
    Array<LodLevel> levels;
    /// Of the mesh's own vertices: those of all levels but the first, one after the other, each in the order of its
    /// parts.
    Array<uint32_t> indices;
    Array<LodPart> ranges;  ///< [size: (levels - 1) * parts], level by level
    uint32_t parts = 0;

    explicit LodChain(Memory* memory = defaultMemory()) : levels(memory), indices(memory), ranges(memory) {}

    /// @param level  > 0: the mesh itself is drawn by its own index buffer
    LodPart range(uint32_t level, uint32_t part) const { return ranges[size_t{level - 1} * parts + part]; }
    std::span<const uint32_t> indicesOf(uint32_t level, uint32_t part) const {
        const LodPart range = this->range(level, part);
        return std::span(indices).subspan(3 * size_t{range.first}, 3 * size_t{range.count});
    }
};

}  // namespace sightline
