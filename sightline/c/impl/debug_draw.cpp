// Debug drawing of the C interface: boxes, and the frustum, as lines.
// SPDX-License-Identifier: MIT
#include "sightline/c/debug_draw.h"

#include <cmath>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/query_handle.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/world/world_state.h"

using namespace sightline;
using c::fail;

namespace {

enum Color : uint32_t {
    kWhite = 0xffffff,
    kGreen = 0x40c040,
    kRed = 0xd04040,
    kYellow = 0xd0c040,
    kGrey = 0x808080,
    kBlue = 0x4060d0,
    kMagenta = 0xd040d0,
    kOrange = 0xe08020,
};

/// The twelve edges of eight corners: bit 0 of a corner is x, bit 1 y, bit 2 z.
void drawEdges(const slDebugDraw& draw, const glm::dvec3 (&corners)[8], uint32_t color) {
    for (int from = 0; from < 8; ++from)
        for (int axis = 0; axis < 3; ++axis) {
            const int to = from | 1 << axis;
            if (to == from) continue;
            const glm::dvec3 &a = corners[from], &b = corners[to];
            const double line[2][3] = {{a.x, a.y, a.z}, {b.x, b.y, b.z}};
            draw.line(draw.user, line[0], line[1], color);
        }
}

void drawObject(const slDebugDraw& draw, const detail::ObjectRecord& object, uint32_t color) {
    if (!object.bounds.finite() || object.bounds.empty()) return;
    glm::dvec3 corners[8];
    for (int i = 0; i < 8; ++i) {
        const glm::dvec4 corner((i & 1 ? object.bounds.max : object.bounds.min).x,
                                (i & 2 ? object.bounds.max : object.bounds.min).y,
                                (i & 4 ? object.bounds.max : object.bounds.min).z, 1.0);
        corners[i] = glm::dvec3(object.transform * corner);
    }
    drawEdges(draw, corners, color);
}

void drawFrustum(const slDebugDraw& draw, const View& view) {
    if (!isUsable(view)) return;
    const glm::dmat4 back = glm::inverse(view.projection * view.view);
    const auto at = [&](double x, double y, double z) {
        const glm::dvec4 point = back * glm::dvec4(x, y, z, 1.0);
        return glm::dvec3(point) / point.w;
    };
    glm::dvec3 corners[8];
    for (int i = 0; i < 8; ++i) {
        const double x = i & 1 ? 1.0 : -1.0, y = i & 2 ? 1.0 : -1.0;
        // An infinite far plane is drawn where its depth is a thousandth short of it.
        corners[i] = at(x, y, i & 4 ? 1.0 : -1.0);
        if (const bool finite = glm::length(corners[i]) < 1e30; !finite) corners[i] = at(x, y, 0.999);
    }
    drawEdges(draw, corners, kWhite);
}

uint32_t colorOf(uint8_t reason) {
    switch (static_cast<Stage>(reason - 1)) {
        case Stage::kPvs:
        case Stage::kPortals:
            return kYellow;
        case Stage::kFrustum:
        case Stage::kFacing:
            return kGrey;
        case Stage::kVolumes:
        case Stage::kOcclusion:
            return kRed;
        default:
            return kBlue;
    }
}

}  // namespace

slStatus slDrawAnswer(const slQuery* query, const slSnapshot* snapshot, const slView* view, uint32_t what,
                      const slDebugDraw* draw) {
    const slLog log = query ? query->log() : slLog{};
    if (!query || !snapshot || !draw || !draw->line) return fail(log, SL_BAD_ARGUMENT, __func__, "a pointer is null");
    View to;
    if (const slStatus status = c::toView(view, log, __func__, to)) return status;
    if (snapshot->snapshot.objectCount() != query->objects)
        return fail(log, SL_BAD_ARGUMENT, __func__, "the snapshot is not that of the last answer");
    if (what & SL_DRAW_FRUSTUM) drawFrustum(*draw, to);
    if (!(what & (SL_DRAW_VISIBLE | SL_DRAW_CULLED))) return SL_OK;
    query->reasons.resize(query->objects);
    query->query.reasons(query->reasons);
    const detail::SnapshotState& state = snapshot->snapshot.state();
    for (uint32_t item = 0; item < query->objects; ++item) {
        const uint8_t reason = query->reasons[item];
        if (reason == 0 && what & SL_DRAW_VISIBLE) drawObject(*draw, state.object(item), kGreen);
        if (reason > 0 && reason <= kStageCount && what & SL_DRAW_CULLED)
            drawObject(*draw, state.object(item), colorOf(reason));
    }
    return SL_OK;
}

slStatus slDrawExplanation(const slSnapshot* snapshot, const slExplanation* explanation, const slDebugDraw* draw) {
    if (!snapshot || !explanation || !draw || !draw->line)
        return fail({}, SL_BAD_ARGUMENT, __func__, "a pointer is null");
    const detail::SnapshotState& state = snapshot->snapshot.state();
    const auto drawOne = [&](slObjectId id, uint32_t color) {
        const uint32_t row = state.find(c::id(id));
        if (row != detail::IdSlot::kNowhere) drawObject(*draw, state.objects[row], color);
    };
    drawOne(explanation->object.id, kMagenta);
    const uint32_t told = std::min<uint32_t>(explanation->hider_count, SL_MOST_HIDERS);
    for (uint32_t i = 0; i < told; ++i) drawOne(explanation->hiders[i].object.id, kOrange);
    return SL_OK;
}
