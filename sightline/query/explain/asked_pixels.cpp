// The pixels that an object was asked at, and how near it may be in each: what hides these hides the object.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/asked_pixels.h"

#include <algorithm>
#include <bit>

#include "sightline/cull/shapes.h"
#include "sightline/query/explain/trial.h"
#include "sightline/stages/occlusion.h"

namespace sightline::detail {
namespace {

/// Takes polygons down, pixel by pixel.
struct Painter : PolygonSink {
    AskedPixels& asked;
    bool rects = false, painted = false;

    explicit Painter(AskedPixels& to) : asked(to) {}

    bool take(const OccludeePolygon& polygon) override {
        const PixelRect &from = polygon.rect, &rect = asked.rect;
        alignas(64) float nearest[64];
        for (int32_t row = from.y0 >> 3; row <= from.y1 >> 3; ++row)
            for (int32_t column = from.x0 >> 3; column <= from.x1 >> 3; ++column)
                for (uint64_t left = pixelsOf(polygon, column, row, nearest); left; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    const int32_t x = 8 * column + (bit & 7), y = 8 * row + (bit >> 3);
                    if (x < rect.x0 || x > rect.x1 || y < rect.y0 || y > rect.y1) continue;
                    float& place =
                        asked.nearness[static_cast<size_t>(y - rect.y0) * static_cast<size_t>(rect.x1 - rect.x0 + 1) +
                                       static_cast<size_t>(x - rect.x0)];
                    place = std::max(place, nearest[bit]);
                    painted = true;
                }
        return true;
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
    const OccludeePlace at = makeOccludeePlace(from.frame.screen, object.transform, object.bounds);
    Painter painter(asked);
    BoxFaces faces;
    if (look == Look::kFaces && makeBoxFaces(at, object.bounds, faces) != Sight::kOccluded) return false;
    // What was hidden by rectangles alone may touch no pixel at all: then these are what was asked.
    for (const bool rects : {false, true}) {
        if (painter.painted) break;
        painter.rects = rects;
        if (look == Look::kTriangles && !forTriangles(at, *from.frame.world->occluders[object.shape.index], painter))
            return false;
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
