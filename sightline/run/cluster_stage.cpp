// The last stage of a query: of kept objects only the clusters that face the eye, lie in the view and are not hidden.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
#include "sightline/run/cluster_stage.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "sightline/cull/facing_clusters.h"
#include "sightline/geom/depth_order.h"

namespace sightline::detail {
namespace {

/// Eight clusters' bounds from one on.
EyeBoxes boundsOf(const DrawClusters& clusters, size_t first) {
    EyeBoxes boxes;
    for (int axis = 0; axis < 3; ++axis) {
        std::copy_n(clusters.row(DrawClusters::kMin + axis) + first, 8, boxes.min[axis]);
        std::copy_n(clusters.row(DrawClusters::kMax + axis) + first, 8, boxes.max[axis]);
    }
    return boxes;
}

bool isInUse(const SnapshotState* now, const View& view) {
    return now && now->clusters.size() > 1 && (stagesInUse(view) & stageBit(Stage::kClusters)) && isUsable(view) &&
           runsOutward(view);
}

uint64_t countBits(std::span<const uint8_t> bytes) {
    uint64_t count = 0;
    for (const uint8_t byte : bytes) count += static_cast<uint64_t>(std::popcount(byte));
    return count;
}

/// Whether nothing of a box is cut open, by the near plane or by a section, so that the eye is outside of what is in it.
/// @param object  the view's buffer seen from the box's space; null: there is none
bool seesOutside(const Box3f& box, const Screen* object, const View& view) {
    if (!object || view.sections.count > 0) return false;
    Screen guarded = *object;
    guarded.near.w -= 2.0 * guarded.near_guard;
    const BoxAnswer answer = projectBox(guarded, box);
    return !answer.doubt && !answer.outside;
}

}  // namespace

/// Leaves those of which some triangle may be seen from its front.
void ClusterStage::findFacing(const DrawClusters& clusters, const ObjectRecord& object, const View& view,
                              const Screen* screen, QueryStats& stats) {
    const size_t count = clusters.count();
    // The facing tests write whole sixteens.
    left_.assign((std::max(count, clusters.facing.count()) + 15) / 16 * 2, 0);
    findBackClusters(clusters.facing, facingEye(view, object.transform), kAllFacingTests, left_);
    for (const ClosedClusters& solid : clusters.closed) {
        if (seesOutside(solid.box, screen, view)) continue;
        for (uint32_t i = solid.first; i < solid.first + solid.count; ++i)
            left_[i / 8] &= static_cast<uint8_t>(~(1u << i % 8));
    }
    stats.clusters_back += countBits(left_);
    for (uint8_t& byte : left_) byte = static_cast<uint8_t>(~byte);
    for (size_t i = count; i < 8 * left_.size(); ++i) left_[i / 8] &= static_cast<uint8_t>(~(1u << i % 8));
}

/// Of these those that lie in the view and are not hidden.
void ClusterStage::findSeen(const DrawClusters& clusters, const View& view, const Screen* screen, DepthTiles* tiles,
                            QueryStats& stats) {
    if (!screen) return;
    const bool frustum = view.stages & stageBit(Stage::kFrustum), occlusion = view.stages & stageBit(Stage::kOcclusion);
    if (!frustum && !occlusion) return;
    for (size_t byte = 0; 8 * byte < clusters.count(); ++byte) {
        if (left_[byte] == 0) continue;
        const ScreenAnswer on_screen = projectBoxes(*screen, boundsOf(clusters, 8 * byte));
        for (uint32_t bits = left_[byte]; bits; bits &= bits - 1) {
            const int which = std::countr_zero(bits);
            const uint8_t bit = static_cast<uint8_t>(1u << which);
            if (on_screen.outside & bit) {
                if (!frustum) continue;
                ++stats.clusters_outside;
            } else {
                PixelRect rect = on_screen.rects[which];
                if (!occlusion || on_screen.doubt & bit || !tiles->clip(rect)) continue;
                if (!isHidden(*tiles, rect, Seams::kLeave)) continue;
                ++stats.clusters_hidden;
            }
            left_[byte] &= static_cast<uint8_t>(~bit);
        }
    }
}

/// Writes the runs of those that are left.
void ClusterStage::addRanges(const DrawClusters& clusters, uint32_t gap, uint32_t visible, QueryStats& stats) {
    const size_t begin = ranges_.size();
    for (size_t i = 0; i < clusters.count(); ++i) {
        if (!(left_[i / 8] >> i % 8 & 1)) continue;
        const uint32_t first = clusters.first[i], end = clusters.first[i + 1], part = clusters.part[i];
        if (ranges_.size() > begin) {
            DrawRange& last = ranges_.back();
            if (last.part == part && first - (last.first + last.count) <= gap) {
                last.count = end - last.first;
                continue;
            }
        }
        ranges_.push_back({visible, first, end - first, part});
    }
    for (size_t i = begin; i < ranges_.size(); ++i) stats.drawn_triangles += ranges_[i].count;
    stats.draw_ranges += ranges_.size() - begin;
}

/// @returns whether something is left of the object
bool ClusterStage::select(const DrawClusters& clusters, const ObjectRecord& object, const View& view,
                          const Buffer& buffer, uint32_t visible, QueryStats& stats) {
    stats.clusters_tested += clusters.count();
    Screen placed;
    if (buffer.screen) placed = objectScreen(*buffer.screen, object.transform);
    const Screen* const screen = buffer.screen ? &placed : nullptr;
    findFacing(clusters, object, view, screen, stats);
    findSeen(clusters, view, screen, buffer.tiles, stats);
    if (countBits(left_) == 0) return false;
    stats.cluster_triangles += clusters.triangles.size();
    addRanges(clusters, view.cluster_gap, visible, stats);
    return true;
}

ClusterStage::Buffer ClusterStage::bufferOf(BinnedWalk& walk) {
    return walk.bins() == 1 ? Buffer{&walk.screen(), walk.tiles()} : Buffer();
}

ClustersReason ClusterStage::look(const SnapshotState& now, uint32_t row, const View& view, BinnedWalk& walk) {
    ClustersReason reason;
    const ObjectRecord& object = now.objects[row];
    if (object.clusters.index == 0 || !isInUse(&now, view)) return reason;
    const DrawClusters& clusters = *now.clusters[object.clusters.index];
    const size_t before = ranges_.size();
    QueryStats stats;
    select(clusters, object, view, bufferOf(walk), 0, stats);
    ranges_.resize(before);
    reason.clusters = stats.clusters_tested;
    reason.back = stats.clusters_back;
    reason.outside = stats.clusters_outside;
    reason.hidden = stats.clusters_hidden;
    reason.triangles = clusters.triangles.size();
    reason.drawn = stats.drawn_triangles;
    return reason;
}

void ClusterStage::run(const SnapshotState* now, const View& view, BinnedWalk& walk) {
    ranges_.clear();
    culled_.clear();
    if (!isInUse(now, view)) return;
    const auto start = std::chrono::steady_clock::now();
    const Buffer buffer = bufferOf(walk);
    Array<Visible>& visible = walk.visible();
    size_t left = 0;
    for (const Visible& v : visible) {
        const uint32_t row = now->find(v.id);
        const ObjectRecord& object = now->objects[row];
        const DrawClusters* clusters = now->clusters[object.clusters.index].get();
        if (clusters && !select(*clusters, object, view, buffer, static_cast<uint32_t>(left), walk.stats))
            culled_.push_back(row);
        else visible[left++] = v;
    }
    visible.resize(left);
    StageStats& stage = walk.stats.stages[static_cast<int>(Stage::kClusters)];
    stage.culled = culled_.size();
    walk.stats.visible -= culled_.size();
    const auto took = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start);
    walk.stats.nanoseconds += static_cast<uint64_t>(took.count());
    if (view.time_stages) stage.nanoseconds = static_cast<uint64_t>(took.count());
}

void ClusterStage::reasons(const SnapshotState& now, std::span<uint8_t> reasons) const {
    for (const uint32_t row : culled_) reasons[now.itemOf(row)] = 1 + static_cast<uint8_t>(Stage::kClusters);
}

}  // namespace sightline::detail
