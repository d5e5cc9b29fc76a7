// One frame of an occlusion scene, step by step: what is in view, drawing front to back, asking the boxes.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/flat_boxes.h"
#include "bench/occlusion_scenes.h"
#include "sightline/cull/occlusion.h"
#include "sightline/tree/bvh.h"

namespace sightline::bench {

/// The order in which a curve that fills space meets the centres of the boxes, so that neighbours lie close together.
///
/// G. M. Morton. A Computer Oriented Geodetic Data Base. 1966.
std::vector<uint32_t> mortonOrder(std::span<const Box3f> boxes);

/// A scene as a culler holds it, prepared once: occluders per batch, and its boxes in Morton order.
class OcclusionFrame {
public:
    static constexpr uint32_t kGroup = 32;  ///< boxes that are asked together first

    /// Prepares the batches as the scene says that they may be.
    explicit OcclusionFrame(const OcclusionScene& scene);

    /// What is done about a batch, and then a cluster of it, that what was drawn before hides already.
    enum class SelfTest { kYes, kNo };

    /// Takes up a view: finds the batches in its frustum, nearest first, and the boxes.
    /// @param occlusion_size  longer side of the buffer; of a smaller viewport it is its own  [pixels]
    void begin(const View& view, uint32_t occlusion_size = 8192);

    /// Clears the tiles and draws. Returns the triangles that were offered to the rasterizer.
    uint64_t rasterize(DepthTiles& tiles, SelfTest self_test = SelfTest::kYes,
                       OcclusionDetail detail = OcclusionDetail::kFull) const;

    /// Asks every box in view; hidden[i] answers for boxes()[i]. A box outside the buffer counts as hidden.
    /// @param hidden  [size: boxes().size()]
    void testFlat(DepthTiles& tiles, std::span<uint8_t> hidden) const;

    /// The same answers, but groups are asked first, and the members of those alone that are not hidden.
    void testGrouped(DepthTiles& tiles, std::span<uint8_t> hidden) const;

    /// What each box in view is to the buffer.
    std::vector<BoxAnswer> project() const;

    const Screen& screen() const { return screen_; }
    std::span<const uint32_t> batches() const { return batches_; }  ///< by the scene's numbers, nearest first
    std::span<const uint32_t> boxes() const { return boxes_; }      ///< by the scene's numbers, in Morton order
    uint64_t trianglesInView() const { return triangles_; }

private:
    void testEight(DepthTiles& tiles, const BvhNode& boxes, size_t first, std::span<uint8_t> hidden) const;

    const OcclusionScene& scene_;
    std::vector<Occluder> occluders_;  ///< per batch; or one of all
    std::vector<Box3f> own_bounds_;    ///< without rings
    std::vector<uint32_t> morton_;
    FlatBoxes flat_batches_, flat_boxes_;
    std::vector<uint32_t> batches_, boxes_;
    std::vector<uint32_t> drawn_;        ///< occluders in view, nearest first
    std::vector<BvhNode> drawn_eights_;  ///< their own bounds, eight by eight
    std::vector<BvhNode> eights_;        ///< boxes_, eight by eight, relative to nothing
    std::vector<BvhNode> groups_;        ///< their groups, eight by eight
    Screen screen_;
    uint64_t triangles_ = 0;
    glm::dmat4 identity_{1.0};
};

}  // namespace sightline::bench
