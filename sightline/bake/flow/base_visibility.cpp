// Floods the portals in front of each portal, then removes what the other direction rules out.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/base_visibility.h"

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/bake/flow/base_visibility.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef SIGHTLINE_BAKE_FLOW_BASE_VISIBILITY_ONCE
#define SIGHTLINE_BAKE_FLOW_BASE_VISIBILITY_ONCE
namespace sightline::bake::detail {

/// Spheres and planes of all portals, number by number, for vectors.
struct FloodPlaces {
    static constexpr size_t kBeyond = 8;  ///< vectors may reach this far beyond the last

    explicit FloodPlaces(const FlowPortals& all) : directed(all) {
        for (std::vector<double>* list : {&x, &y, &z, &radius, &nx, &ny, &nz, &offset, &above})
            list->reserve(all.size() + kBeyond);
        for (const FlowPortal& portal : all.portals) {
            x.push_back(portal.center.x);
            y.push_back(portal.center.y);
            z.push_back(portal.center.z);
            radius.push_back(portal.radius);
            nx.push_back(portal.normal.x);
            ny.push_back(portal.normal.y);
            nz.push_back(portal.normal.z);
            offset.push_back(portal.offset);
            above.push_back(portal.above);
        }
        for (std::vector<double>* list : {&x, &y, &z, &radius, &nx, &ny, &nz, &offset, &above})
            list->resize(all.size() + kBeyond);
    }

    const FlowPortals& directed;
    std::vector<double> x, y, z, radius;
    std::vector<double> nx, ny, nz, offset, above;
};

/// The scratch memory of a thread.
struct FloodScratch {
    std::vector<uint8_t> seen;    ///< per cell
    std::vector<uint32_t> cells;  ///< the flood has reached them and not left them yet
};

/// Whether some point of q lies above p, or below it if the sign is -1.
inline bool reachesAbove(const FlowPortals& directed, const FlowPortal& p, uint32_t q, double sign) {
    for (const glm::dvec3& point : directed.outline(q))
        if (sign * p.height(point) > p.above) return true;
    return false;
}

}  // namespace sightline::bake::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::bake::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Tests portals by their bounding spheres first, and by their corners where the spheres do not decide.
void flood(const detail::FloodPlaces& places, uint32_t p, detail::FloodScratch& scratch, std::span<uint64_t> row) {
    const hn::CappedTag<double, 8> d;
    const FlowPortals& directed = places.directed;
    const FlowPortal& source = directed.portals[p];
    const auto nx = hn::Set(d, source.normal.x), ny = hn::Set(d, source.normal.y), nz = hn::Set(d, source.normal.z),
               offset = hn::Set(d, source.offset);
    const auto x = hn::Set(d, source.center.x), y = hn::Set(d, source.center.y), z = hn::Set(d, source.center.z),
               radius = hn::Set(d, source.radius);
    const auto least = hn::Set(d, source.above);
    const auto heightOf = [](auto ax, auto ay, auto az, auto w, auto bx, auto by, auto bz) {
        return hn::Add(hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz)), w);
    };
    scratch.seen.assign(directed.cells(), 0);
    scratch.cells.assign(1, source.to);
    scratch.seen[source.to] = 1;
    while (!scratch.cells.empty()) {
        const uint32_t cell = scratch.cells.back();
        scratch.cells.pop_back();
        const uint32_t end = directed.first_of_cell[cell + 1];
        for (uint32_t i = directed.first_of_cell[cell]; i < end; i += static_cast<uint32_t>(hn::Lanes(d))) {
            const auto other = hn::LoadU(d, places.radius.data() + i), lowest = hn::LoadU(d, places.above.data() + i);
            const auto above = heightOf(nx, ny, nz, offset, hn::LoadU(d, places.x.data() + i),
                                        hn::LoadU(d, places.y.data() + i), hn::LoadU(d, places.z.data() + i));
            const auto behind =
                hn::Neg(heightOf(hn::LoadU(d, places.nx.data() + i), hn::LoadU(d, places.ny.data() + i),
                                 hn::LoadU(d, places.nz.data() + i), hn::LoadU(d, places.offset.data() + i), x, y, z));
            const auto may = hn::And(hn::FirstN(d, end - i), hn::And(hn::Gt(hn::Add(above, other), least),
                                                                     hn::Gt(hn::Add(behind, radius), lowest)));
            // The center is above, so that the sphere need not be asked.
            const auto sure = hn::And(hn::Gt(above, least), hn::Gt(behind, lowest));
            uint8_t may_bits[8] = {}, sure_bits[8] = {};
            hn::StoreMaskBits(d, may, may_bits);
            hn::StoreMaskBits(d, sure, sure_bits);
            for (uint32_t left = may_bits[0]; left; left &= left - 1) {
                const uint32_t bit = static_cast<uint32_t>(std::countr_zero(left)), q = i + bit;
                const FlowPortal& next = directed.portals[q];
                // Both lie in one plane: a line that has crossed it does not cross it again.
                if (next.sheet == source.sheet) continue;
                if (!(sure_bits[0] >> bit & 1) &&
                    !(detail::reachesAbove(directed, source, q, 1) && detail::reachesAbove(directed, next, p, -1)))
                    continue;
                row[q / 64] |= uint64_t(1) << (q % 64);
                if (scratch.seen[next.to]) continue;
                scratch.seen[next.to] = 1;
                scratch.cells.push_back(next.to);
            }
        }
    }
}

}  // namespace sightline::bake::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::bake {

HWY_EXPORT(flood);

namespace {

constexpr uint32_t kTask = 16;    // portals
constexpr uint32_t kSlice = 512;  // portals between two words to the caller

/// Transposes a block of 64 x 64 bits.
/// Henry Warren. Hacker's Delight. 2002.
void transpose(uint64_t block[64]) {
    uint64_t mask = 0x00000000ffffffffull;
    for (int width = 32; width != 0; width >>= 1, mask ^= mask << width)
        for (int k = 0; k < 64; k = ((k | width) + 1) & ~width) {
            const uint64_t swap = ((block[k] >> width) ^ block[k | width]) & mask;
            block[k] ^= swap << width;
            block[k | width] ^= swap;
        }
}

/// Calls work(first, end) for runs of portals.
/// @returns false if it was stopped
template <class Work>
bool forPortals(const FlowPortals& directed, const BaseSettings& settings, Work&& work) {
    const uint32_t count = directed.size();
    for (uint32_t begin = 0; begin < count; begin += kSlice) {
        const uint32_t end = std::min(count, begin + kSlice);
        runJobs(settings.jobs, (end - begin + kTask - 1) / kTask, [&](uint32_t task) {
            if (settings.stop && settings.stop->asks()) return;
            const uint32_t first = begin + task * kTask;
            work(first, std::min(end, first + kTask));
        });
        if (settings.stop && settings.stop->stopped()) return false;
        if (settings.tell) settings.tell(end, count);
    }
    return true;
}

/// out[q][p] = in[reverse of p][reverse of q], for all p and q.
BitMatrix reversed(const FlowPortals& directed, const BitMatrix& in, const BaseSettings& settings) {
    const uint32_t count = directed.size();
    const size_t words = in.wordsPerRow();
    // Sorts the rows by their reverses, transposes all by blocks, and sorts the rows by their reverses again.
    BitMatrix turned(count, count);
    uint64_t block[64];
    for (size_t i = 0; i < words; ++i) {
        if (settings.stop && settings.stop->asks()) break;
        for (size_t j = 0; j < words; ++j) {
            bool any = false;
            for (uint32_t k = 0; k < 64; ++k) {
                const size_t p = i * 64 + k;
                block[k] = p < count ? in.row(directed.portals[p].reverse)[j] : 0;
                any |= block[k] != 0;
            }
            if (!any) continue;
            transpose(block);
            for (uint32_t k = 0; k < 64; ++k) {
                const size_t q = j * 64 + k;
                if (q < count) turned.row(directed.portals[q].reverse)[i] = block[k];
            }
        }
    }
    return turned;
}

/// Of each portal the portals that leave the cell behind it and may follow: what a flood along steps asks, close together
/// in memory, where whole rows are not.
class NextSteps {
public:
    NextSteps(const FlowPortals& directed, const BitMatrix& may) : directed_(directed), first_(directed.size() + 1, 0) {
        for (uint32_t p = 0; p < directed.size(); ++p) {
            const auto [begin, end] = rangeOf(p);
            first_[p] = static_cast<uint32_t>(words_.size());
            for (uint32_t w = begin / 64; w * 64 < end; ++w) {
                uint64_t next = may.row(p)[w];
                if (w == begin / 64) next &= ~uint64_t(0) << (begin % 64);
                if (w == end / 64) next &= ~(~uint64_t(0) << (end % 64));
                words_.push_back(next);
            }
        }
    }

    /// Replaces a row by the part of it that steps within it reach from p.
    /// @param stack  scratch memory
    void keepReached(uint32_t p, std::span<uint64_t> row, std::span<uint64_t> reached,
                     std::vector<uint32_t>& stack) const {
        std::fill(reached.begin(), reached.end(), 0);
        for (stack.assign(1, p); !stack.empty();) {
            const uint32_t r = stack.back();
            stack.pop_back();
            const uint64_t* next = words_.data() + first_[r];
            const auto [begin, end] = rangeOf(r);
            for (uint32_t w = begin / 64; w * 64 < end; ++w) {
                uint64_t fresh = *next++ & row[w] & ~reached[w];
                reached[w] |= fresh;
                for (; fresh; fresh &= fresh - 1)
                    stack.push_back(w * 64 + static_cast<uint32_t>(std::countr_zero(fresh)));
            }
        }
        std::copy(reached.begin(), reached.end(), row.begin());
    }

private:
    struct Range {
        uint32_t begin = 0, end = 0;
    };
    Range rangeOf(uint32_t p) const {
        const uint32_t cell = directed_.portals[p].to;
        return {directed_.first_of_cell[cell], directed_.first_of_cell[cell + 1]};
    }

    const FlowPortals& directed_;
    std::vector<uint32_t> first_;
    std::vector<uint64_t> words_;
};

}  // namespace

BitMatrix baseVisibility(const FlowPortals& directed, const BaseSettings& settings) {
    const uint32_t count = directed.size();
    BitMatrix may(count, count);
    const detail::FloodPlaces places(directed);
    forPortals(directed, settings, [&](uint32_t first, uint32_t end) {
        detail::FloodScratch scratch;
        for (uint32_t p = first; p < end; ++p) HWY_DYNAMIC_DISPATCH(flood)(places, p, scratch, may.row(p));
    });
    return may;
}

void tightenBase(const FlowPortals& directed, BitMatrix& may, const BaseSettings& settings) {
    {
        const BitMatrix turned = reversed(directed, may, settings);
        if (settings.stop && settings.stop->stopped()) return;
        for (uint32_t p = 0; p < directed.size(); ++p) {
            const std::span<uint64_t> row = may.row(p);
            const std::span<const uint64_t> other = turned.row(p);
            for (size_t w = 0; w < row.size(); ++w) row[w] &= other[w];
        }
    }
    const NextSteps steps(directed, may);
    forPortals(directed, settings, [&](uint32_t first, uint32_t end) {
        std::vector<uint64_t> reached(may.wordsPerRow());
        std::vector<uint32_t> stack;
        for (uint32_t p = first; p < end; ++p) steps.keepReached(p, may.row(p), reached, stack);
    });
}

}  // namespace sightline::bake
#endif  // HWY_ONCE
