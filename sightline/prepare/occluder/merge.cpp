// Merges polygons that lie exactly in one plane into larger triangles and convex quadrangles.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/merge.h"

#include <algorithm>
#include <numeric>

#include "sightline/prepare/occluder/exact.h"
#include "sightline/prepare/occluder/quads.h"
#include "sightline/prepare/occluder/side_pairs.h"

namespace sightline {
namespace {

constexpr int kMostRounds = 64;
constexpr size_t kMostTried = 4;  // of those that share a side

struct Merge {
    double length;
    uint32_t a, b;  ///< polygons, a < b
    PatchPolygon merged;
};

class Merger {
public:
    Merger(Patchwork& patchwork, bool by_mesh)
        : patchwork_(patchwork),
          polygons_(patchwork.polygons),
          by_mesh_(by_mesh),
          gone_(polygons_.size(), 0),
          flat_(polygons_.size(), 1),
          active_(polygons_.size()) {
        std::iota(active_.begin(), active_.end(), 0u);
        for (uint32_t i = 0; i < polygons_.size(); ++i)
            if (polygons_[i].corners == 4) flat_[i] = areCoplanar(at(i, 0), at(i, 1), at(i, 2), at(i, 3));
    }

    void run() {
        for (int round = 0; round < kMostRounds; ++round) {
            findMerges();
            if (merges_.empty()) break;
            std::sort(merges_.begin(), merges_.end(), [](const Merge& p, const Merge& q) {
                return p.length != q.length ? p.length > q.length : p.a != q.a ? p.a < q.a : p.b < q.b;
            });
            std::vector<uint8_t> taken(polygons_.size(), 0);
            for (const Merge& merge : merges_) {
                if (taken[merge.a] || taken[merge.b]) continue;
                taken[merge.a] = taken[merge.b] = 1;
                polygons_[merge.a] = merge.merged;
                gone_[merge.b] = 1;
            }
            std::erase_if(active_, [&](uint32_t i) { return gone_[i]; });
        }
        size_t kept = 0;
        for (size_t i = 0; i < polygons_.size(); ++i)
            if (!gone_[i]) polygons_[kept++] = polygons_[i];
        polygons_.resize(kept);
    }

private:
    const glm::vec3& at(uint32_t polygon, int corner) const {
        return patchwork_.positions[polygons_[polygon].vertex[corner % polygons_[polygon].corners]];
    }

    /// Finds what can be merged now, and keeps those polygons active that may take part later: they have a neighbour in
    /// their plane, or a side that nobody shares yet.
    void findMerges() {
        merges_.clear();
        if (active_.size() == polygons_.size()) sides_ = sortedSides(patchwork_);
        else sortActiveSides();
        std::vector<uint8_t> stays(polygons_.size(), 0);
        forSharedSides(std::span<const PatchSide>(sides_), [&](std::span<const PatchSide> shared) {
            if (shared.size() == 1) stays[shared[0].polygon] = 1;
            for (size_t i = 0; i < shared.size(); ++i)
                for (size_t j = i + 1; j < std::min(shared.size(), i + kMostTried); ++j) {
                    if (!liesInOnePlane(shared[i], shared[j])) continue;
                    stays[shared[i].polygon] = stays[shared[j].polygon] = 1;
                    tryMerge(shared[i], shared[j]);
                }
        });
        std::erase_if(active_, [&](uint32_t i) { return !stays[i]; });
    }

    void sortActiveSides() {
        sides_.clear();
        for (uint32_t i : active_) {
            const PatchPolygon& p = polygons_[i];
            for (uint8_t k = 0; k < p.corners; ++k) {
                const uint32_t from = p.vertex[k], to = p.vertex[(k + 1) % p.corners];
                sides_.push_back({std::min(from, to), std::max(from, to), i, k, from < to});
            }
        }
        std::sort(sides_.begin(), sides_.end(), [](const PatchSide& a, const PatchSide& b) {
            return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.polygon < b.polygon;
        });
    }

    bool liesInOnePlane(const PatchSide& a, const PatchSide& b) const {
        const PatchPolygon &p = polygons_[a.polygon], &q = polygons_[b.polygon];
        if (!flat_[a.polygon] || !flat_[b.polygon]) return false;
        if (a.forward == b.forward || p.double_sided != q.double_sided || (by_mesh_ && p.mesh != q.mesh)) return false;
        return areCoplanar(at(a.polygon, a.corner), at(a.polygon, a.corner + 1), at(a.polygon, a.corner + 2),
                           at(b.polygon, b.corner + 2)) &&
               smoothness(patchwork_, a, b) > 0;
    }

    void tryMerge(const PatchSide& a, const PatchSide& b) {
        const PatchPolygon &p = polygons_[a.polygon], &q = polygons_[b.polygon];
        // p's corners from the shared side's end to its beginning, then q's that lie between.
        uint32_t loop[6];
        int count = 0;
        for (int k = 0; k < p.corners; ++k) loop[count++] = p.vertex[(a.corner + 1 + k) % p.corners];
        for (int k = 1; k + 1 < q.corners; ++k) loop[count++] = q.vertex[(b.corner + 1 + k) % q.corners];
        Merge merge{0, std::min(a.polygon, b.polygon), std::max(a.polygon, b.polygon), polygons_[a.polygon]};
        merge.merged.mesh = std::min(p.mesh, q.mesh);
        int corners = 0;
        for (int k = 0; k < count; ++k) {
            const auto& before = patchwork_.positions[loop[(k + count - 1) % count]];
            const auto& after = patchwork_.positions[loop[(k + 1) % count]];
            const bool of_side = k == 0 || k == p.corners - 1;
            if (of_side && liesBetween(patchwork_.positions[loop[k]], before, after)) continue;
            if (corners == 4) return;
            merge.merged.vertex[corners++] = loop[k];
        }
        merge.merged.corners = static_cast<uint8_t>(corners);
        glm::dvec3 v[4];
        for (int k = 0; k < corners; ++k) v[k] = patchwork_.positions[merge.merged.vertex[k]];
        if (corners == 4 && !isConvex(v, normalOf(patchwork_, a.polygon))) return;
        const glm::dvec3 along = glm::dvec3(patchwork_.positions[a.high]) - glm::dvec3(patchwork_.positions[a.low]);
        merge.length = glm::dot(along, along);
        merges_.push_back(merge);
    }

    Patchwork& patchwork_;
    std::vector<PatchPolygon>& polygons_;
    bool by_mesh_;
    std::vector<uint8_t> gone_;     ///< per polygon: has become part of another
    std::vector<uint8_t> flat_;     ///< per polygon: exactly
    std::vector<uint32_t> active_;  ///< polygons that may still be merged
    std::vector<PatchSide> sides_;
    std::vector<Merge> merges_;
};

}  // namespace

void mergeCoplanar(Patchwork& patchwork, bool by_mesh) { Merger(patchwork, by_mesh).run(); }

}  // namespace sightline
