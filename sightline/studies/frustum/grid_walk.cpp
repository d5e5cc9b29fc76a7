// Keeps the items of a grid of loose cells that may touch a view frustum; cells out of its reach are not looked at.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cull/relative_planes.h"
#include "sightline/geom/frustum_bounds.h"
#include "sightline/math/round_outward.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/frustum/grid_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/relative_planes-inl.h"

#ifndef SIGHTLINE_STUDIES_FRUSTUM_GRID_WALK_ONCE
#define SIGHTLINE_STUDIES_FRUSTUM_GRID_WALK_ONCE
namespace sightline::studies {

/// The cells of a level that the frustum's bounds touch.
struct CellRange {
    int32_t low[3], high[3];
};

/// A query under way.
struct GridWalk {
    const Grid& grid;
    RelativePlanes planes;
    Box3f bounds;  ///< gridQueryBounds(), relative to the grid's origin
    uint32_t* kept;
    size_t count = 0;
    GridStats stats;
};

}  // namespace sightline::studies
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
using namespace sightline::HWY_NAMESPACE;

struct alignas(64) EightBoxes {
    float min[3][8] = {};
    float max[3][8] = {};
};

/// The loose bounds of cells from one to another, in a slot.
void setCells(EightBoxes& boxes, int slot, const int32_t (&first)[3], int32_t cells, double width) {
    for (int axis = 0; axis < 3; ++axis) {
        boxes.min[axis][slot] = static_cast<float>((first[axis] - Grid::kLoose) * width);
        boxes.max[axis][slot] = static_cast<float>((first[axis] + cells + Grid::kLoose) * width);
    }
}

/// Bit per box that lies beside the bounds.
uint32_t beside(const Box3f& bounds, const EightBoxes& boxes) {
    const Lanes8 d;
    uint32_t answer = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto out = hn::Lt(hn::Load(d, boxes.max[0] + i), hn::Set(d, bounds.min[0]));
        out = hn::Or(out, hn::Gt(hn::Load(d, boxes.min[0] + i), hn::Set(d, bounds.max[0])));
        for (int axis = 1; axis < 3; ++axis) {
            out = hn::Or(out, hn::Lt(hn::Load(d, boxes.max[axis] + i), hn::Set(d, bounds.min[axis])));
            out = hn::Or(out, hn::Gt(hn::Load(d, boxes.min[axis] + i), hn::Set(d, bounds.max[axis])));
        }
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, out, bits);
        answer |= uint32_t{bits[0]} << i;
    }
    return answer;
}

/// Keeps the items of a cell: all, or those that pass the planes that the cell is not inside of.
void takeCell(GridWalk& walk, uint32_t first, uint32_t active) {
    ++walk.stats.cells;
    walk.stats.inside_cells += active == 0;
    const hn::CappedTag<uint32_t, 8> d;
    for (uint32_t index = first; index != Grid::kNone;) {
        const GridChunk& chunk = walk.grid.chunk(index);
        index = chunk.next;
        uint32_t left = (1u << chunk.count) - 1;
        if (active != 0) {
            EightBoxes boxes;
            for (uint32_t lane = 0; lane < chunk.count; ++lane) {
                const GridItem& item = walk.grid.item(chunk.item[lane]);
                for (int axis = 0; axis < 3; ++axis) {
                    boxes.min[axis][lane] = item.min[axis];
                    boxes.max[axis][lane] = item.max[axis];
                }
            }
            left &= ~(testSlots(walk.planes, boxes, active).outside | beside(walk.bounds, boxes));
            walk.stats.items += chunk.count;
        }
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const uint8_t bits[8] = {static_cast<uint8_t>(left >> i)};
            walk.count +=
                hn::CompressStore(hn::Load(d, chunk.item + i), hn::LoadMaskBits(d, bits), d, walk.kept + walk.count);
        }
    }
}

/// The bits of a block's cells that are within a range, of which `first` is the block's first cell.
uint64_t cellsWithin(const CellRange& range, const int32_t (&first)[3]) {
    uint32_t along[3];
    for (int axis = 0; axis < 3; ++axis) {
        along[axis] = 0;
        for (int32_t i = 0; i < 4; ++i)
            along[axis] |= uint32_t{first[axis] + i >= range.low[axis] && first[axis] + i <= range.high[axis]} << i;
    }
    uint64_t plane = 0, cells = 0;
    for (int y = 0; y < 4; ++y)
        if (along[1] >> y & 1) plane |= uint64_t{along[0]} << (4 * y);
    for (int z = 0; z < 4; ++z)
        if (along[2] >> z & 1) cells |= plane << (16 * z);
    return cells;
}

/// Tests a block, then its cells eight at a time, then their items.
void takeBlock(GridWalk& walk, const GridBlock& block, const CellRange& range, const int32_t (&first)[3],
               double width) {
    uint64_t cells = block.used & cellsWithin(range, first);
    if (cells == 0) return;
    ++walk.stats.blocks;
    EightBoxes boxes;
    setCells(boxes, 0, first, 4, width);
    const uint32_t all = (1u << walk.planes.count) - 1;
    const SlotAnswer whole = testSlots(walk.planes, boxes, all);
    if (whole.outside & 1) return;
    const uint32_t active = planesLeft(walk.planes, whole, 0);
    while (cells != 0) {
        int32_t bits[8];
        int count = 0;
        for (; cells != 0 && count < 8; cells &= cells - 1) {
            const int bit = std::countr_zero(cells);
            const int32_t at[3] = {first[0] + (bit & 3), first[1] + (bit >> 2 & 3), first[2] + (bit >> 4)};
            if (active != 0) setCells(boxes, count, at, 1, width);
            bits[count++] = bit;
        }
        const SlotAnswer answer = active != 0 ? testSlots(walk.planes, boxes, active) : SlotAnswer{};
        for (int i = 0; i < count; ++i) {
            if (answer.outside >> i & 1) continue;
            takeCell(walk, block.first[bits[i]], active != 0 ? planesLeft(walk.planes, answer, i) : 0);
        }
    }
}

void takeLevelKernel(GridWalk& walk, const Grid::Level& level, uint32_t number, const CellRange& range) {
    const double width = walk.grid.cellWidth(number);
    int32_t low[3], high[3];
    double lookups = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::max(range.low[axis] >> 2, level.low[axis]);
        high[axis] = std::min(range.high[axis] >> 2, level.high[axis]);
        if (low[axis] > high[axis]) return;
        lookups *= high[axis] - low[axis] + 1;
    }
    if (lookups > 2.0 * static_cast<double>(level.blocks.size())) {
        // More places than blocks: their keys stand side by side, and those out of range are passed over by them.
        for (const Grid::Level::Listed& listed : level.blocks) {
            int32_t first[3];
            Grid::cellOfKey(listed.key, first);
            bool within = true;
            for (int axis = 0; axis < 3; ++axis)
                within &= first[axis] >> 2 >= low[axis] && first[axis] >> 2 <= high[axis];
            if (within) takeBlock(walk, walk.grid.block(listed.block), range, first, width);
        }
        return;
    }
    for (int32_t x = low[0]; x <= high[0]; ++x)
        for (int32_t y = low[1]; y <= high[1]; ++y)
            for (int32_t z = low[2]; z <= high[2]; ++z) {
                const uint32_t found = walk.grid.findBlock(number, {x, y, z});
                if (found != Grid::kNone) takeBlock(walk, walk.grid.block(found), range, {4 * x, 4 * y, 4 * z}, width);
            }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies {

HWY_EXPORT(takeLevelKernel);

namespace {

/// A box that holds all items.
Box3d gridBounds(const Grid& grid) {
    Box3d bounds;
    for (uint32_t number = 0; number < Grid::kLevels; ++number) {
        const Grid::Level& level = grid.level(number);
        if (level.blocks.empty()) continue;
        Box3d box;
        for (int axis = 0; axis < 3; ++axis) {
            const double width = grid.cellWidth(number);
            box.min[axis] = grid.origin()[axis] + (4.0 * level.low[axis] - 1.0) * width;
            box.max[axis] = grid.origin()[axis] + (4.0 * level.high[axis] + 5.0) * width;
        }
        bounds.grow(box);
    }
    return bounds;
}

}  // namespace

Box3d gridQueryBounds(const Frustum& frustum, const Grid& grid) {
    // The planes in float have a margin, in which an item is kept; twice that holds it for sure.
    Frustum wide = frustum;
    const glm::dvec3 shift = grid.origin() - frustum.eye;
    for (uint32_t i = 0; i < wide.count; ++i) {
        glm::dvec4& p = wide.planes[i];
        double size = std::abs(p.w) + std::abs(glm::dot(glm::dvec3(p), shift));
        for (int axis = 0; axis < 3; ++axis) size += std::abs(p[axis]) * static_cast<double>(grid.reach());
        p.w += 0x1p-18 * size;
    }
    return frustumBounds(wide, gridBounds(grid));
}

size_t cullGrid(const Frustum& frustum, const Grid& grid, std::span<uint32_t> kept, GridStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= size_t{grid.size()} + 8);
    const Box3d bounds = gridQueryBounds(frustum, grid);
    GridWalk walk{
        grid, relativePlanes(frustum, grid.origin(), grid.reach()), relativeBox(bounds, grid.origin()), kept.data(), 0,
        {}};
    for (uint32_t item : grid.unbounded()) walk.kept[walk.count++] = item;
    for (uint32_t number = 0; number < Grid::kLevels && !bounds.empty(); ++number) {
        const Grid::Level& level = grid.level(number);
        if (level.blocks.empty()) continue;
        const double width = grid.cellWidth(number);
        CellRange range;
        for (int axis = 0; axis < 3; ++axis) {
            const auto cell = [&](double at) {
                return static_cast<int32_t>(std::clamp(std::floor(at), -1.0 * Grid::kReach, Grid::kReach - 1.0));
            };
            range.low[axis] = cell(static_cast<double>(walk.bounds.min[axis]) / width - 1.0 - Grid::kLoose);
            range.high[axis] = cell(static_cast<double>(walk.bounds.max[axis]) / width + Grid::kLoose);
        }
        HWY_DYNAMIC_DISPATCH(takeLevelKernel)(walk, level, number, range);
    }
    if (stats) *stats = walk.stats;
    return walk.count;
}

}  // namespace sightline::studies
#endif  // HWY_ONCE
