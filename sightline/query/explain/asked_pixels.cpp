// The pixels that an object was asked at, and how near it may be in each: what hides these hides the object.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/asked_pixels.h"

#include <algorithm>
#include <bit>

#include "sightline/buffer/draw/outline.h"
#include "sightline/cull/occlusion.h"
#include "sightline/cull/shapes.h"
#include "sightline/query/explain/trial.h"
#include "sightline/stages/occlusion.h"

namespace sightline::detail {
namespace {

/// Takes what was asked down, pixel by pixel.
struct Painter : OutlineSink {
    AskedPixels& asked;
    bool rects = false, painted = false;
    const uint32_t stride;  ///< DepthTiles::stride

    Painter(AskedPixels& to, uint32_t tiles_stride) : asked(to), stride(tiles_stride) {}

    bool take(uint32_t tile, uint64_t mask, float nearness) override {
        const auto x0 = static_cast<int32_t>(8 * (tile % stride)), y0 = static_cast<int32_t>(8 * (tile / stride));
        for (uint64_t left = mask; left; left &= left - 1) {
            const int bit = std::countr_zero(left);
            paint(x0 + (bit & 7), y0 + (bit >> 3), nearness);
        }
        return true;
    }

    void paint(int32_t x, int32_t y, float nearness) {
        const PixelRect& rect = asked.rect;
        if (x < rect.x0 || x > rect.x1 || y < rect.y0 || y > rect.y1) return;
        float& place = asked.nearness[static_cast<size_t>(y - rect.y0) * static_cast<size_t>(rect.x1 - rect.x0 + 1) +
                                      static_cast<size_t>(x - rect.x0)];
        place = std::max(place, nearness);
        painted = true;
    }

    void take(const OccludeePolygon& polygon) {
        const PixelRect& from = polygon.rect;
        alignas(64) float nearest[64];
        for (int32_t row = from.y0 >> 3; row <= from.y1 >> 3; ++row)
            for (int32_t column = from.x0 >> 3; column <= from.x1 >> 3; ++column)
                for (uint64_t left = pixelsOf(polygon, column, row, nearest); left; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    paint(8 * column + (bit & 7), 8 * row + (bit >> 3), nearest[bit]);
                }
    }

    uint64_t pixelsOf(const OccludeePolygon& polygon, int32_t column, int32_t row, float (&nearest)[64]) const {
        if (!rects) return occludeePixels(polygon, column, row, nearest);
        std::fill_n(nearest, 64, polygon.rect.nearness);
        uint64_t bits = 0;
        for (int bit = 0; bit < 64; ++bit) {
            const int32_t x = 8 * column + (bit & 7), y = 8 * row + (bit >> 3);
            const PixelRect& rect = polygon.rect;
            if (x >= rect.x0 && x <= rect.x1 && y >= rect.y0 && y <= rect.y1) bits |= uint64_t{1} << bit;
        }
        return bits;
    }
};

bool paint(const RecordedTraversal& from, uint32_t place, Look look, AskedPixels& asked) {
    const ObjectRecord& object = from.frame.world->objectAt(place);
    DepthTiles& tiles = asked.empty;
    tiles.clear(from.frame.screen.width, from.frame.screen.height);
    Painter painter(asked, tiles.stride);
    if (look == Look::kTriangles) {
        const Occluder& shape = *from.frame.world->occluders[object.shape.index];
        const OccluderInstance instance = makeOccluderInstance(from.frame.screen, shape, object.transform);
        for (uint32_t cluster = 0; cluster < shape.clusters.size(); ++cluster)
            if (!forOutline(tiles, instance.frame, shape, cluster, OutlineOf::kAll, painter).known) return false;
        return painter.painted;
    }
    const OccludeePlace at = makeOccludeePlace(from.frame.screen, object.transform, object.bounds);
    BoxFaces faces;
    if (makeBoxFaces(at, object.bounds, faces) != Sight::kOccluded) return false;
    // What was hidden by rectangles alone may touch no pixel at all: then these are what was asked.
    for (const bool rects : {false, true}) {
        if (painter.painted) break;
        painter.rects = rects;
        for (int i = 0; i < faces.count; ++i) painter.take(faces.faces[i]);
    }
    return painter.painted;
}

/// The box of an object that a look held against planes; it stands for those of its clusters.
OccludeeBox boxFor(const RecordedTraversal& from, uint32_t place, Look look) {
    const Frame& frame = from.frame;
    if (look != Look::kBox) {
        const ObjectRecord& object = frame.world->objectAt(place);
        const OccludeePlace at = makeOccludeePlace(frame.screen, object.transform, object.bounds);
        return OccludeeBox(boxAt(at, object.bounds).image());
    }
    const LeafAnswer leaf = askLeaf(*frame.world, place, frame.view, frame.screen);
    return OccludeeBox(boxAt(frame.screen, boxOf(leaf.boxes, leaf.slot)).image());
}

}  // namespace

void AskedPixels::run(const PixelRect& around) {
    box.reset();
    rect = around;
    nearness.assign(static_cast<size_t>(rect.x1 - rect.x0 + 1) * static_cast<size_t>(rect.y1 - rect.y0 + 1),
                    rect.nearness);
}

bool AskedPixels::run(const RecordedTraversal& from, uint32_t place, Look look, const PixelRect* around) {
    const PixelRect all{0, 0, static_cast<int32_t>(from.frame.screen.width) - 1,
                        static_cast<int32_t>(from.frame.screen.height) - 1, std::numeric_limits<float>::infinity()};
    run(around ? *around : all);
    box = boxFor(from, place, look);
    if (look == Look::kBox) return around != nullptr;
    std::fill(nearness.begin(), nearness.end(), kNotAsked);
    if (paint(from, place, look, *this)) return true;
    run(around ? *around : all);
    return false;
}

}  // namespace sightline::detail
