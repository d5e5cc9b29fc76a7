// Which of several polygons that share a side are joined there: those that go on most smoothly.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/side_pairs.h"

#include <algorithm>

namespace sightline {
namespace {

constexpr uint32_t kMostCompared = 8;

/// Pairs by falling smoothness; takes what it pairs out of both lists.
void pairSmoothest(const Patchwork& patchwork, std::span<const PatchSide> shared, std::vector<uint32_t>& forward,
                   std::vector<uint32_t>& backward, std::vector<SidePair>& pairs) {
    while (!forward.empty() && !backward.empty()) {
        size_t best_f = 0, best_b = 0;
        double best = -2.0;
        for (size_t f = 0; f < forward.size(); ++f)
            for (size_t b = 0; b < backward.size(); ++b) {
                const double smooth = smoothness(patchwork, shared[forward[f]], shared[backward[b]]);
                if (smooth <= best) continue;
                best = smooth;
                best_f = f;
                best_b = b;
            }
        pairs.push_back({forward[best_f], backward[best_b]});
        forward.erase(forward.begin() + static_cast<ptrdiff_t>(best_f));
        backward.erase(backward.begin() + static_cast<ptrdiff_t>(best_b));
    }
}

}  // namespace

glm::dvec3 normalOf(const Patchwork& patchwork, uint32_t polygon) {
    const PatchPolygon& p = patchwork.polygons[polygon];
    const auto at = [&](int k) { return glm::dvec3(patchwork.positions[p.vertex[k]]); };
    const glm::dvec3 n = glm::cross(at(1) - at(0), at(2) - at(0));
    const double length = glm::length(n);
    return length > 0 ? n / length : glm::dvec3(0.0);
}

double smoothness(const Patchwork& patchwork, const PatchSide& a, const PatchSide& b) {
    return glm::dot(normalOf(patchwork, a.polygon), normalOf(patchwork, b.polygon));
}

void pairSides(const Patchwork& patchwork, std::span<const PatchSide> shared, std::vector<SidePair>& pairs) {
    pairs.clear();
    if (shared.size() == 2 && shared[0].forward != shared[1].forward) {
        pairs.push_back({shared[0].forward ? 0u : 1u, shared[0].forward ? 1u : 0u});
        return;
    }
    std::vector<uint32_t> forward, backward;
    for (uint32_t i = 0; i < shared.size(); ++i) (shared[i].forward ? forward : backward).push_back(i);
    if (std::max(forward.size(), backward.size()) <= kMostCompared)
        pairSmoothest(patchwork, shared, forward, backward, pairs);
    const size_t both = std::min(forward.size(), backward.size());
    for (size_t i = 0; i < both; ++i) pairs.push_back({forward[i], backward[i]});
    for (size_t i = both; i < forward.size(); ++i) pairs.push_back({forward[i], SidePair::kNone});
    for (size_t i = both; i < backward.size(); ++i) pairs.push_back({SidePair::kNone, backward[i]});
}

}  // namespace sightline
