// Back faces by the classes of their normals: a mask of all classes that are surely seen from the back, one operation a triangle.
// SPDX-License-Identifier: MIT
#include "sightline/studies/facing/normal_masks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "sightline/base/assert.h"
#include "sightline/cull/answer_bits.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/facing/normal_masks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// @param blocks  of 16 bytes, that the mask has
/// @param count   a multiple of 64
void normalMaskKernel(const uint8_t* HWY_RESTRICT byte, const uint8_t* HWY_RESTRICT bit, size_t count,
                      const uint8_t* HWY_RESTRICT mask, int blocks, uint8_t* HWY_RESTRICT back) {
#if HWY_TARGET == HWY_SCALAR  // it has no tables
    (void)blocks;
    for (size_t i = 0; i < count; i += 8) {
        uint32_t found = 0;
        for (size_t k = 0; k < 8; ++k) found |= uint32_t{(mask[byte[i + k]] & bit[i + k]) != 0} << k;
        back[i / 8] = static_cast<uint8_t>(found);
    }
#else
    const hn::CappedTag<uint8_t, 64> d;
    const auto high = hn::Set(d, 0x70);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto at = hn::LoadU(d, byte + i);
        auto found = hn::Zero(d);
        for (int block = 0; block < blocks; ++block) {
            // All but this block's numbers become at least 0x80, for which the look-up gives 0.
            const auto moved = hn::SaturatedAdd(hn::Sub(at, hn::Set(d, static_cast<uint8_t>(16 * block))), high);
            const auto here = hn::And(moved, hn::Set(d, 0x8f));
            found = hn::Or(found, hn::TableLookupBytesOr0(hn::LoadDup128(d, mask + 16 * block), here));
        }
        hn::StoreMaskBits(d, hn::Ne(hn::And(found, hn::LoadU(d, bit + i)), hn::Zero(d)), back + i / 8);
    }
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies {
namespace {

HWY_EXPORT(normalMaskKernel);

/// Which grid normals a ray goes along with: per face of the cube and row, a bit per column.
struct RayBits {
    uint32_t rows[6][NormalClasses::kMaxCells + 1];
};

RayBits bitsOf(const glm::dvec3& ray, double error, int cells) {
    RayBits bits;
    double borders[NormalClasses::kMaxCells + 1];
    for (int i = 0; i <= cells; ++i) borders[i] = classBorder(i, cells);
    const double length = glm::length(ray);
    // A normal's direction is known to 2^-29, which its class's borders are off by, and some more where the largest
    // component is divided by.
    const double doubt = (0x1p-25 + 2.0 * error) * length;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double ahead = (face % 2 ? -ray[axis] : ray[axis]) - doubt;
        const double across = ray[(axis + 1) % 3], up = ray[(axis + 2) % 3];
        for (int row = 0; row <= cells; ++row) {
            const double base = ahead + borders[row] * up;
            const bool first = base + borders[0] * across > 0.0, last = base + borders[cells] * across > 0.0;
            uint32_t word = first ? (2u << cells) - 1 : 0;  // most rows are of one kind
            if (first != last) {
                word = 0;
                for (int column = 0; column <= cells; ++column)
                    word |= uint32_t{base + borders[column] * across > 0.0} << column;
            }
            bits.rows[face][row] = word;
        }
    }
    return bits;
}

/// The mask of what lies between four rays.
NormalMask maskBetween(const RayBits* const (&rays)[4], int cells) {
    NormalMask mask;
    for (int face = 0; face < 6; ++face) {
        const auto along = [&](int row) {
            uint32_t all = ~0u;
            for (const RayBits* ray : rays) all &= ray->rows[face][row];
            return all & all >> 1;  // both columns' borders
        };
        uint32_t below = along(0);
        for (int row = 0; row < cells; ++row) {
            const uint32_t above = along(row + 1);
            uint32_t word = below & above & ((1u << cells) - 1);
            for (; word; word &= word - 1) {
                const int number = (face * cells + row) * cells + std::countr_zero(word);
                mask.bytes[static_cast<size_t>(number >> 3)] |= static_cast<uint8_t>(1u << (number & 7));
            }
            below = above;
        }
    }
    return mask;
}

/// Sectors are made as much wider than they are, in sides of the window, so that a point that is found to be in one is.
constexpr double kWider = 1e-7;

}  // namespace

NormalMask makeNormalMask(const CornerRays& rays, FrontFace front, int cells) {
    SIGHTLINE_ASSERT(cells >= 1 && cells <= NormalClasses::kMaxCells);
    if (!rays.known()) return {};
    RayBits bits[4];
    for (int i = 0; i < 4; ++i)
        bits[i] = bitsOf(front == FrontFace::kClockwise ? -rays.ray[i] : rays.ray[i], rays.error, cells);
    return maskBetween({&bits[0], &bits[1], &bits[2], &bits[3]}, cells);
}

SectorMasks::SectorMasks(const View& view, const glm::dmat4& transform, FrontFace front, int cells, int sectors)
    : sectors_(sectors),
      to_clip_(view.projection * view.view * transform),
      outer_(1.0 + 2.0 * view.jitter / glm::dvec2(view.width, view.height)) {
    SIGHTLINE_ASSERT(cells >= 1 && cells <= NormalClasses::kMaxCells && sectors >= 1 && sectors <= 16);
    masks_.resize(static_cast<size_t>(sectors * sectors));
    View still = view;
    still.jitter = 0;
    const CornerRays whole = cornerRays(still, transform);
    if (!whole.known()) return;
    const glm::dvec2 wider = view.jitter / glm::dvec2(view.width, view.height);  // of the window's sides
    double longest = 0;
    for (const glm::dvec3& ray : whole.ray) longest = std::max(longest, glm::length(ray));
    const auto border = [&](size_t i, double outer) {
        const double at = static_cast<double>(i) / sectors;
        return i == 0 ? at - outer : i == static_cast<size_t>(sectors) ? at + outer : at;
    };
    // Lines of sight are affine in the place in the window.
    const size_t lines = static_cast<size_t>(sectors) + 1;
    std::vector<RayBits> bits(lines * lines);
    for (size_t row = 0; row < lines; ++row)
        for (size_t column = 0; column < lines; ++column) {
            const double x = border(column, wider.x), y = border(row, wider.y);
            const glm::dvec3 low = glm::mix(whole.ray[0], whole.ray[1], x);
            const glm::dvec3 high = glm::mix(whole.ray[3], whole.ray[2], x);
            const glm::dvec3 ray = glm::mix(low, high, y);
            const double share = longest / glm::length(ray);
            const double error = (4.0 * whole.error * (1.0 + wider.x + wider.y) + 4.0 * kWider) * share;
            bits[row * lines + column] = bitsOf(front == FrontFace::kClockwise ? -ray : ray, error, cells);
        }
    for (size_t row = 0; row + 1 < lines; ++row)
        for (size_t column = 0; column + 1 < lines; ++column) {
            const RayBits* const first = &bits[row * lines + column];
            masks_[row * static_cast<size_t>(sectors) + column] =
                maskBetween({first, first + 1, first + lines, first + lines + 1}, cells);
        }
}

SectorMasks::Range SectorMasks::sectorsOf(const Box3f& box) const {
    Range range{{0, 0}, {sectors_ - 1, sectors_ - 1}};
    const glm::dvec3 from(box.min), side = glm::dvec3(box.max) - from;
    const glm::dvec3 largest = glm::max(glm::abs(glm::dvec3(box.min)), glm::abs(glm::dvec3(box.max)));
    const glm::dvec4 corner = to_clip_ * glm::dvec4(from, 1.0);
    const glm::dvec4 step[3] = {side.x * to_clip_[0], side.y * to_clip_[1], side.z * to_clip_[2]};
    glm::dvec4 size = glm::abs(to_clip_[3]);  // of the terms that are summed
    for (int axis = 0; axis < 3; ++axis) size += 2.0 * largest[axis] * glm::abs(to_clip_[axis]);
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300}, nearest = 1e300;
    for (int i = 0; i < 8; ++i) {
        glm::dvec4 clip = corner;
        for (int axis = 0; axis < 3; ++axis)
            if (i >> axis & 1) clip += step[axis];
        if (!(clip.w > 1e-6 * size.w)) return range;  // nor where a number is none
        nearest = std::min(nearest, clip.w);
        const double scale = 1.0 / clip.w;
        for (int k = 0; k < 2; ++k) {
            const double at = clip[k] * scale;
            low[k] = std::min(low[k], at), high[k] = std::max(high[k], at);
        }
    }
    const double rounding = 0x1p-46 * (size.x + size.y) / nearest;
    if (!(rounding < 1.0)) return range;
    for (int k = 0; k < 2; ++k) {
        const auto sectorAt = [&](double at) {
            return static_cast<int>(std::floor(std::clamp(0.5 * (at + 1.0), -1.0, 2.0) * sectors_));
        };
        const double doubt = rounding + 1e-6 * (1.0 + std::abs(low[k]) + std::abs(high[k]));
        // What the jitter may bring into view is seen in the outermost sectors, whose masks have been widened by it.
        if (high[k] + doubt < -outer_[k] || low[k] - doubt > outer_[k]) return {{1, 1}, {0, 0}};
        range.first[k] = std::clamp(sectorAt(low[k] - doubt), 0, sectors_ - 1);
        range.last[k] = std::clamp(sectorAt(high[k] + doubt), 0, sectors_ - 1);
    }
    return range;
}

int SectorMasks::sectorOf(const glm::vec3& point) const {
    const glm::dvec3 p(point);
    const glm::dvec4 clip = to_clip_ * glm::dvec4(p, 1.0);
    glm::dvec4 size = glm::abs(to_clip_[3]);
    for (int axis = 0; axis < 3; ++axis) size += glm::abs(to_clip_[axis] * p[axis]);
    // Each sum is off by 2^-50 of its terms, and the place by that over w.
    const double doubt = 0x1p-49 * (size.x + size.y + size.w);
    if (!(doubt < 0.25 * kWider * clip.w)) return -1;
    const double x = clip.x / clip.w, y = clip.y / clip.w;
    if (!(std::abs(x) <= 1.0 && std::abs(y) <= 1.0)) return -1;
    const auto step = [&](double at) {
        return std::clamp(static_cast<int>(std::floor(0.5 * (at + 1.0) * sectors_)), 0, sectors_ - 1);
    };
    return step(y) * sectors_ + step(x);
}

NormalMask SectorMasks::maskOf(const Box3f& box) const {
    const Range range = sectorsOf(box);
    NormalMask all;
    all.bytes.fill(0xff);
    for (int row = range.first[1]; row <= range.last[1]; ++row)
        for (int column = range.first[0]; column <= range.last[0]; ++column) {
            const NormalMask& one = mask(column, row);
            for (size_t i = 0; i < all.bytes.size(); ++i) all.bytes[i] &= one.bytes[i];
        }
    return all;
}

size_t findBackFaces(const NormalClasses& classes, size_t first, size_t count, const NormalMask& mask,
                     std::span<uint8_t> back) {
    const size_t padded = (count + 63) / 64 * 64;
    SIGHTLINE_ASSERT(first % 64 == 0 && first + count <= classes.count && back.size() >= padded / 8);
    const int blocks = (6 * classes.cells * classes.cells + 127) / 128;
    HWY_DYNAMIC_DISPATCH(normalMaskKernel)
    (classes.byte.data() + first, classes.bit.data() + first, padded, mask.bytes.data(), blocks, back.data());
    size_t found = 0;
    for (size_t i = 0; i < padded / 64; ++i) {
        uint64_t word;
        std::memcpy(&word, back.data() + 8 * i, 8);
        if (64 * i + 64 > count) {
            word &= (uint64_t{1} << count % 64) - 1;
            std::memcpy(back.data() + 8 * i, &word, 8);
        }
        found += static_cast<size_t>(sightline::detail::countBits(word));
    }
    return found;
}

size_t findBackFaces(const NormalClasses& classes, const NormalMask& mask, std::span<uint8_t> back) {
    return findBackFaces(classes, 0, classes.count, mask, back);
}

}  // namespace sightline::studies
#endif  // HWY_ONCE
