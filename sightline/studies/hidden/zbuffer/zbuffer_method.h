// The z-buffer among the hidden-surface methods: tiled, many samples at once, on several threads.
// SPDX-License-Identifier: MIT
//
// Edwin Catmull. A Subdivision Algorithm for Computer Display of Curved Surfaces. 1974.
#pragma once

#include <vector>

#include "sightline/studies/hidden/method_input.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer_polygon.h"

namespace sightline::studies {

/// What a z-buffer keeps from frame to frame, so that it need not be allocated again: RenderSettings::zbuffer_memory.
/// After a frame, the depths of its image. For one frame at a time.
struct ZBufferMemory {
    DepthBuffer buffer;
    std::vector<PolygonBatch> batches;
};

/// Draws in the order of surfaces, so that of surfaces at the same depth the first stays, as long as only what is nearer
/// passes; DepthSettings::near_to_far draws in another. RenderSettings::depth says how depths are kept, tested and saved.
/// What can be told apart is up to the format: DepthCodec::stepAt(). The image and the counters are the same for any
/// number of threads and any instruction set.
///
/// Counters: fragments of polygons and tiles that the hierarchy rejects are generated only in name; they are counted as
/// generated with RenderSettings::want_counts alone, which looks for them. A fragment that the hierarchy accepts is
/// passed without being tested. Bytes of depth are counted with DepthSettings::compression: each tile is read and
/// written once for each batch of polygons that meets it (kBatchTriangles of the list), if it has to be.
///
/// A parallel view, or a format that cannot do without a far plane, has its depths fitted to the items' bounds.
///
/// O(triangles + fragments); memory: 4 bytes a sample, and 200 a polygon of a batch.
void drawZBuffer(const HiddenInput& input, HiddenImage& image);

/// Triangles that are projected before their polygons are drawn: few enough to stay in a cache.
inline constexpr size_t kBatchTriangles = 1 << 14;
/// The same with several threads, which have to wait for one another. Where bytes are counted, always the former.
inline constexpr size_t kSharedBatchTriangles = 1 << 16;

/// The codec that drawZBuffer() draws a list with.
DepthCodec depthCodecFor(const DrawList& list, const View& view, DepthFormat format);

}  // namespace sightline::studies
