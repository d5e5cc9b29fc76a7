// Orders what is to be drawn by its depth: near to far for a z-buffer, far to near for a painter.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/presort.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sightline {
namespace {

constexpr int kDigitBits = 11;
constexpr uint32_t kDigits = 1u << kDigitBits;
constexpr int kPasses = (64 + kDigitBits - 1) / kDigitBits;

uint32_t digitOf(uint64_t key, int pass) { return static_cast<uint32_t>(key >> (pass * kDigitBits)) & (kDigits - 1); }

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
    const size_t count = entries.size();
    scratch.resize(count);
    // All histograms in one reading.
    std::vector<std::array<uint32_t, kDigits>> histograms(kPasses);
    for (std::array<uint32_t, kDigits>& histogram : histograms) histogram.fill(0);
    for (const SortEntry& entry : entries)
        for (int pass = 0; pass < kPasses; ++pass) ++histograms[pass][digitOf(entry.key, pass)];
    for (int pass = 0; pass < kPasses && count > 1; ++pass) {
        std::array<uint32_t, kDigits>& next = histograms[pass];
        if (next[digitOf(entries[0].key, pass)] == count) continue;
        uint32_t sum = 0;
        for (uint32_t& place : next) {
            const uint32_t here = place;
            place = sum;
            sum += here;
        }
        for (const SortEntry& entry : entries) scratch[next[digitOf(entry.key, pass)]++] = entry;
        entries.swap(scratch);
    }
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

}  // namespace sightline
