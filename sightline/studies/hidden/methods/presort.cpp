// Orders what is to be drawn by its depth: near to far for a z-buffer, far to near for a painter.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/presort.h"

#include <algorithm>
#include <limits>

namespace sightline::studies {
namespace {

constexpr size_t kFew = 32;            ///< so many are sorted by insertion
constexpr size_t kShortDigits = 4096;  ///< fewer than these take digits of 8 bits, whose counts are soon cleared
constexpr int kMostPasses = 4;
constexpr uint32_t kMostDigits = 1u << 11;

void sortFew(std::span<SortEntry> entries) {
    for (size_t i = 1; i < entries.size(); ++i) {
        const SortEntry entry = entries[i];
        size_t place = i;
        for (; place > 0 && entries[place - 1].key > entry.key; --place) entries[place] = entries[place - 1];
        entries[place] = entry;
    }
}

/// Sorts by bits [shift, shift + passes * digit_bits) of the keys, which differ in none above.
/// @return whether the result lies in scratch
bool sortByDigits(std::span<SortEntry> entries, std::span<SortEntry> scratch, int shift, int passes, int digit_bits) {
    const size_t count = entries.size();
    const uint32_t digits = 1u << digit_bits, mask = digits - 1;
    uint32_t places[kMostPasses][kMostDigits];
    for (int pass = 0; pass < passes; ++pass) std::fill_n(places[pass], digits, 0u);
    // All counts in one reading.
    for (const SortEntry& entry : entries)
        for (int pass = 0; pass < passes; ++pass) ++places[pass][(entry.key >> (shift + pass * digit_bits)) & mask];
    SortEntry *from = entries.data(), *to = scratch.data();
    for (int pass = 0; pass < passes; ++pass) {
        const int low = shift + pass * digit_bits;
        uint32_t* next = places[pass];
        if (next[(from[0].key >> low) & mask] == count) continue;
        uint32_t sum = 0;
        for (uint32_t digit = 0; digit < digits; ++digit) {
            const uint32_t here = next[digit];
            next[digit] = sum;
            sum += here;
        }
        for (size_t i = 0; i < count; ++i) to[next[(from[i].key >> low) & mask]++] = from[i];
        std::swap(from, to);
    }
    return from != entries.data();
}

/// @return whether the result lies in scratch
bool sortRange(std::span<SortEntry> entries, std::span<SortEntry> scratch) {
    if (entries.size() <= kFew) {
        sortFew(entries);
        return false;
    }
    uint64_t differing = 0;
    for (const SortEntry& entry : entries) differing |= entry.key ^ entries[0].key;
    const int digit_bits = entries.size() < kShortDigits ? 8 : 11;
    const int most = digit_bits == 8 ? 32 : 33, top = static_cast<int>(std::bit_width(differing));
    const int shift = std::max(top - most, 0);
    const int passes = (top - shift + digit_bits - 1) / digit_bits;
    const bool swapped = sortByDigits(entries, scratch, shift, passes, digit_bits);
    if (shift == 0) return swapped;
    const std::span<SortEntry> sorted = swapped ? scratch : entries, other = swapped ? entries : scratch;
    size_t begin = 0;
    for (size_t i = 1; i <= sorted.size(); ++i) {
        if (i < sorted.size() && sorted[i].key >> shift == sorted[begin].key >> shift) continue;
        const std::span<SortEntry> equal = sorted.subspan(begin, i - begin), room = other.subspan(begin, i - begin);
        if (equal.size() > 1 && sortRange(equal, room)) std::copy(room.begin(), room.end(), equal.begin());
        begin = i;
    }
    return swapped;
}

/// Entries must be in rising order of their surfaces.
std::vector<uint32_t> orderOf(std::vector<SortEntry>& entries, DepthOrder order) {
    std::vector<SortEntry> scratch;
    if (order == DepthOrder::kFarToNear) std::reverse(entries.begin(), entries.end());
    radixSort(entries, scratch);
    std::vector<uint32_t> places;
    places.reserve(entries.size());
    for (const SortEntry& entry : entries) places.push_back(entry.value);
    return places;
}

}  // namespace

void radixSort(std::vector<SortEntry>& entries, std::vector<SortEntry>& scratch) {
    scratch.resize(entries.size());
    if (sortRange(entries, scratch)) entries.swap(scratch);
}

std::vector<uint32_t> orderPolygons(std::span<const ScreenPolygon> polygons, DepthOrder order) {
    std::vector<SortEntry> entries(polygons.size());
    for (uint32_t i = 0; i < entries.size(); ++i) {
        const DepthPlane& depth = polygons[i].depth;
        entries[i] = {order == DepthOrder::kNearToFar ? ~sortKey(depth.high) : sortKey(depth.low), i};
    }
    return orderOf(entries, order);
}

std::vector<uint32_t> orderItems(const DrawList& list, const View& view, DepthOrder order) {
    const glm::dvec3 eye = eyePosition(view);
    const glm::dmat3 rotation(view.view);
    std::vector<SortEntry> entries(list.items().size());
    for (uint32_t i = 0; i < entries.size(); ++i) {
        const DrawItem& item = list.items()[i];
        const glm::dmat3 turn = rotation * glm::dmat3(item.transform);
        const glm::dvec3 backward(turn[0].z, turn[1].z, turn[2].z);
        const double start = (rotation * (glm::dvec3(item.transform[3]) - eye)).z;
        double farthest = std::numeric_limits<double>::infinity(), nearest = -farthest;
        for (const glm::vec3& position : item.mesh.positions) {
            const double z = glm::dot(backward, glm::dvec3(position)) + start;
            farthest = std::min(farthest, z);
            nearest = std::max(nearest, z);
        }
        if (item.mesh.positions.empty()) nearest = farthest = 0;
        entries[i] = {order == DepthOrder::kNearToFar ? ~sortKey(nearest) : sortKey(farthest), i};
    }
    return orderOf(entries, order);
}

}  // namespace sightline::studies
