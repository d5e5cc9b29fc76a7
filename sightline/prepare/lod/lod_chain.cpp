// Makes a chain of coarser levels of a mesh, each with the proved error that it has against the mesh itself.
// SPDX-License-Identifier: MIT
//
// Michael Garland, Paul Heckbert. Surface Simplification Using Quadric Error Metrics. 1997.
// David Luebke, Martin Reddy, Jonathan Cohen, Amitabh Varshney, Benjamin Watson, Robert Huebner. Level of Detail for 3D
// Graphics. 2002.
#include "sightline/prepare/lod/lod_chain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/assert.h"
#include "sightline/prepare/lod/part_simplifier.h"
#include "sightline/prepare/welder.h"

namespace sightline {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Triangles by places of their parts.
using Simplified = std::vector<std::vector<uint32_t>>;

size_t trianglesOf(const Simplified& parts) {
    size_t count = 0;
    for (const auto& part : parts) count += part.size() / 3;
    return count;
}

struct Level {
    LodLevel record;
    std::vector<uint32_t> indices;
    std::vector<LodPart> ranges;  ///< of these
};

class ChainMaker {
public:
    ChainMaker(const MeshView& mesh, std::span<const MeshPart> parts, const LodChainSettings& settings)
        : mesh_(mesh), settings_(settings), seen_(mesh.positions.size(), 0) {
        finest_.ranges.reserve(parts.size());
        for (const MeshPart& part : parts) {
            SIGHTLINE_ASSERT(size_t{part.first} + part.count <= mesh.triangles());
            const auto own = mesh.indices.subspan(3 * size_t{part.first}, 3 * size_t{part.count});
            finest_.ranges.push_back({static_cast<uint32_t>(finest_.indices.size() / 3), part.count});
            finest_.indices.insert(finest_.indices.end(), own.begin(), own.end());
        }
        for (const uint32_t vertex : finest_.indices) SIGHTLINE_ASSERT(vertex < mesh.positions.size());
        count(finest_);
    }

    /// Coarser levels, finest first, as they come; and the mesh itself before them.
    std::vector<Level> make() {
        std::vector<Level> levels;
        const DistanceSurface surface({mesh_.positions, finest_.indices});
        levels.push_back(finest_);
        if (!surface.finite() || surface.triangles() == 0) return levels;
        diagonal_ = glm::length(surface.box().size());
        prepareParts();
        bool sloppy = false;
        while (levels.size() < settings_.levels && levels.back().record.triangles >= settings_.fewest_triangles) {
            const size_t last = levels.back().record.triangles;
            const auto target = static_cast<size_t>(static_cast<double>(last) * settings_.share);
            const auto most = static_cast<size_t>(static_cast<double>(last) * (1 - settings_.least_saving));
            Simplified simpler;
            if (!sloppy) simpler = collapse(target);
            if (sloppy || trianglesOf(simpler) > most) {
                if (!settings_.sloppy) break;
                sloppy = true;
                simpler = merge(last);
            }
            if (trianglesOf(simpler) > most || trianglesOf(simpler) == 0) break;
            Level level = levelOf(simpler);
            const DistanceSurface coarse({mesh_.positions, level.indices});
            level.record.error = surfaceDistance(coarse, surface, settings_.distance).upper;
            if (!(level.record.error <= settings_.most_error * diagonal_)) break;
            levels.push_back(std::move(level));
        }
        dropBeaten(levels);
        return levels;
    }

private:
    void prepareParts() {
        std::vector<uint32_t> place(mesh_.positions.size(), 0);
        std::vector<glm::vec3> places;
        Welder welder(places);
        for (const uint32_t vertex : finest_.indices) place[vertex] = welder.number(mesh_.positions[vertex]);
        // A part that shares a place with another one keeps its borders.
        constexpr uint32_t kNobody = ~uint32_t{0};
        std::vector<uint32_t> owner(places.size(), kNobody);
        std::vector<uint8_t> touches(finest_.ranges.size(), 0);
        for (uint32_t part = 0; part < finest_.ranges.size(); ++part)
            for (const uint32_t vertex : indicesOf(part)) {
                uint32_t& first = owner[place[vertex]];
                if (first == kNobody) first = part;
                if (first != part) touches[first] = touches[part] = 1;
            }
        for (uint32_t part = 0; part < finest_.ranges.size(); ++part)
            parts_.emplace_back(mesh_, indicesOf(part), place, touches[part] != 0);
    }

    std::span<const uint32_t> indicesOf(uint32_t part) const {
        const LodPart& range = finest_.ranges[part];
        return std::span(finest_.indices).subspan(3 * size_t{range.first}, 3 * size_t{range.count});
    }

    Simplified collapseTo(double error) const {
        Simplified out;
        for (const PartSimplifier& part : parts_) out.push_back(part.collapse(0, error));
        return out;
    }

    /// Each level is made from the mesh itself: from level to level corners of flat parts are lost.
    ///
    /// One part: as many triangles as wanted. Several: the error, the same for all, that leaves about so many.
    Simplified collapse(size_t target) {
        if (parts_.size() == 1) return {parts_[0].collapse(target, kNoLimit)};
        // Half as many triangles of a smooth surface err twice as much.
        double low = error_, high = std::max(2 * error_, 0x1p-20 * diagonal_);
        Simplified best = collapseTo(high);
        while (trianglesOf(best) > target && high < diagonal_) {
            low = high;
            high *= error_ > 0 ? 2 : 4;
            best = collapseTo(high);
        }
        for (int i = 0; i < 2 && low > 0 && trianglesOf(best) < target - target / 4; ++i) {
            const double middle = std::sqrt(low) * std::sqrt(high);
            Simplified simpler = collapseTo(middle);
            if (trianglesOf(simpler) > target) {
                low = middle;
            } else {
                high = middle;
                best = std::move(simpler);
            }
        }
        error_ = high;
        return best;
    }

    Simplified merge(size_t last) const {
        Simplified out;
        for (const PartSimplifier& part : parts_) {
            const double share = static_cast<double>(last) / finest_.record.triangles * settings_.share;
            out.push_back(part.merge(static_cast<size_t>(std::ceil(share * static_cast<double>(part.triangles())))));
        }
        return out;
    }

    Level levelOf(const Simplified& parts) {
        Level level;
        for (size_t part = 0; part < parts.size(); ++part) {
            const auto first = static_cast<uint32_t>(level.indices.size() / 3);
            parts_[part].writeCorners(parts[part], level.indices);
            level.ranges.push_back({first, static_cast<uint32_t>(level.indices.size() / 3) - first});
        }
        count(level);
        return level;
    }

    /// Triangles, and vertices that they name.
    void count(Level& level) {
        level.record.triangles = static_cast<uint32_t>(level.indices.size() / 3);
        for (const uint32_t vertex : level.indices) {
            level.record.vertices += seen_[vertex] == 0;
            seen_[vertex] = 1;
        }
        for (const uint32_t vertex : level.indices) seen_[vertex] = 0;
    }

    /// Leaves out what a coarser level is better than.
    void dropBeaten(std::vector<Level>& levels) const {
        double least = kNoLimit;  // of the coarser levels
        for (size_t i = levels.size(); i-- > 1;) {
            const double error = levels[i].record.error;
            const double as_known = (1 + settings_.distance.relative) * error + settings_.distance.absolute * diagonal_;
            if (least <= as_known) levels.erase(levels.begin() + static_cast<ptrdiff_t>(i));
            else least = error;
        }
    }

    const MeshView& mesh_;
    const LodChainSettings& settings_;
    std::vector<uint8_t> seen_;  ///< per vertex; all 0 between calls
    Level finest_;
    double diagonal_ = 0;
    double error_ = 0;  ///< that all parts were allowed in the last level
    std::vector<PartSimplifier> parts_;
};

}  // namespace

LodChain makeLods(const MeshView& mesh, std::span<const MeshPart> parts, const LodChainSettings& settings,
                  Memory* memory) {
    SIGHTLINE_ASSERT(settings.levels >= 1 && settings.levels <= kMostLods);
    SIGHTLINE_ASSERT(settings.share > 0 && settings.share < 1);
    const MeshPart whole{0, static_cast<uint32_t>(mesh.triangles())};
    if (parts.empty()) parts = {&whole, 1};
    const std::vector<Level> levels = ChainMaker(mesh, parts, settings).make();
    LodChain chain(memory);
    chain.parts = static_cast<uint32_t>(parts.size());
    for (size_t i = 0; i < levels.size(); ++i) {
        chain.levels.push_back(levels[i].record);
        if (i == 0) continue;
        const auto first = static_cast<uint32_t>(chain.indices.size() / 3);
        for (const LodPart& range : levels[i].ranges) chain.ranges.push_back({first + range.first, range.count});
        chain.indices.insert(chain.indices.end(), levels[i].indices.begin(), levels[i].indices.end());
    }
    return chain;
}

}  // namespace sightline
