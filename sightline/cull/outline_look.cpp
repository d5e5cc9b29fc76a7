// An object asked of the depth tiles by the outlines of its clusters: the second look.
// SPDX-License-Identifier: MIT
#include "sightline/cull/outline_look.h"

#include <algorithm>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/buffer/ask/occludee_box.h"
#include "sightline/buffer/draw/outline.h"

namespace sightline {
namespace {

OccludeeBox boxOf(const OccluderInstance& instance, uint32_t cluster) {
    const Box3f& box = instance.occluder->clusters[cluster].bounds;
    return OccludeeBox(instance.screen, {glm::dvec3(box.min), glm::dvec3(box.max)},
                       {0.0, instance.pixel_error, instance.depth_error});
}

/// Ends with the first pixel that is open whatever the seams are.
struct OpenFinder : OutlineSink {
    DepthTiles& tiles;
    const OccludeeBox& box;
    Array<UndecidedPixels>& undecided;
    const uint32_t cluster;
    bool open = false, met = false;

    OpenFinder(DepthTiles& in, const OccludeeBox& around, Array<UndecidedPixels>& left, uint32_t of)
        : tiles(in), box(around), undecided(left), cluster(of) {}

    bool take(uint32_t tile, uint64_t mask, float nearness) override {
        met = true;
        const uint64_t left = openPixels(tiles, tile, mask, nearness, Seams::kLeave, &box);
        open = left & ~undecidedSeams(tiles, tile);
        if (left && !open) undecided.push_back({tile, cluster, left, nearness});
        return !open;
    }
};

/// Ends at once.
struct AnyPixel : OutlineSink {
    bool met = false;
    bool take(uint32_t, uint64_t, float) override {
        met = true;
        return false;
    }
};

/// Gathers the clusters that their boxes leave undecided, nearest first. Returns the polygons in them; `in_view` is set
/// if one was hidden.
uint64_t gatherClusters(DepthTiles& tiles, const OccluderInstance& instance, Array<ClusterLook>& clusters,
                        bool& in_view) {
    const Occluder& shape = *instance.occluder;
    uint64_t polygons = 0;
    clusters.clear();
    const uint32_t count = static_cast<uint32_t>(shape.clusters.size());
    ScreenAnswer eight;
    for (uint32_t c = 0; c < count; ++c) {
        ClusterLook look{c, std::numeric_limits<float>::infinity()};
        if (count > 1) {
            if (c % 8 == 0) eight = projectClusters(instance.screen, shape, c);
            BoxAnswer box(eight, static_cast<int>(c % 8));
            if (box.outside) continue;
            if (!box.doubt) {
                const OccludeeBox bounds = boxOf(instance, c);
                if (!tiles.clip(box.rect) || isHidden(tiles, box.rect, Seams::kLeave, &bounds)) {
                    in_view = true;
                    continue;
                }
                look.nearness = box.rect.nearness;
            }
        }
        clusters.push_back(look);
        polygons += shape.clusters[c].polygon_count;
    }
    std::sort(clusters.begin(), clusters.end(), [](const ClusterLook& a, const ClusterLook& b) {
        return a.nearness != b.nearness ? a.nearness > b.nearness : a.cluster < b.cluster;
    });
    return polygons;
}

/// Whether seams leave something open.
bool isOpen(DepthTiles& tiles, const OccluderInstance& instance, const Array<UndecidedPixels>& undecided,
            OutlineLook& look) {
    for (const UndecidedPixels& next : undecided) {
        const OccludeeBox box = boxOf(instance, next.cluster);
        look.open = next.cluster;
        if (openPixels(tiles, next.tile, next.mask, next.nearness, Seams::kResolve, &box)) return true;
    }
    look.open = OutlineLook::kNone;
    return false;
}

}  // namespace

Sight askOutlines(DepthTiles& tiles, const OccluderInstance& instance, LookScratch& scratch, OutlineLook& look) {
    const Occluder& shape = *instance.occluder;
    look.polygons = 0;
    scratch.undecided.clear();
    bool in_view = false;
    const auto lookAt = [&](uint32_t cluster) {
        const OccludeeBox box = boxOf(instance, cluster);
        OpenFinder finder(tiles, box, scratch.undecided, cluster);
        look.open = cluster;
        look.polygons += shape.clusters[cluster].polygon_count;
        const Outline found = forOutline(tiles, instance.frame, shape, cluster, OutlineOf::kOpen, finder);
        look.in_doubt = !found.known;
        in_view |= finder.met || found.in_view;
        return finder.open || !found.known;
    };
    const bool has_first =
        look.first < shape.clusters.size() && shape.clusters[look.first].polygon_count <= look.most_polygons;
    if (has_first && lookAt(look.first)) return Sight::kVisible;
    const size_t of_first = scratch.undecided.size();
    const uint64_t polygons = gatherClusters(tiles, instance, scratch.clusters, in_view);
    look.polygons = 0;
    look.spent = polygons > look.most_polygons;
    if (look.spent) return Sight::kVisible;
    for (const ClusterLook& next : scratch.clusters)
        if (!(has_first && next.cluster == look.first) && lookAt(next.cluster)) return Sight::kVisible;
    SIGHTLINE_DEBUG_ASSERT(of_first <= scratch.undecided.size());
    // Only if nothing is open for good are seams worth resolving.
    if (isOpen(tiles, instance, scratch.undecided, look)) return Sight::kVisible;
    if (in_view) return Sight::kOccluded;
    // Its outlines may cross the view between their corners, where something nearer was drawn.
    const auto meetsView = [&](OutlineOf which, bool unknown) {
        AnyPixel any;
        for (const ClusterLook& next : scratch.clusters) {
            if (!forOutline(tiles, instance.frame, shape, next.cluster, which, any).known) return unknown;
            if (any.met) return true;
        }
        return false;
    };
    if (meetsView(OutlineOf::kAll, true)) return Sight::kOccluded;
    look.away = meetsView(OutlineOf::kBacks, false);
    return Sight::kOutside;
}

}  // namespace sightline
