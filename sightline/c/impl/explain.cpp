// Explanations of the C interface, as numbers and as a sentence.
// SPDX-License-Identifier: MIT
#include "sightline/c/explain.h"

#include <algorithm>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/query_handle.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/query/explain/explain.h"

using namespace sightline;
using c::fail;

namespace {

const char* wordsOf(KeptBecause because) {
    switch (because) {
        case KeptBecause::kOpenPixel:
            return "nothing hides a pixel of it";
        case KeptBecause::kViewNotUsable:
            return "the view cannot be used, so that everything is kept";
        case KeptBecause::kBoundsNotUsable:
            return "its bounds are empty, not finite or too far away";
        case KeptBecause::kHoldsEye:
            return "the eye is inside of its box";
        case KeptBecause::kNearPlane:
            return "its box reaches across the near plane";
        case KeptBecause::kNotProjectable:
            return "its box cannot be projected without too much rounding";
        case KeptBecause::kStageOff:
            return "the stage that would look at it is switched off";
        case KeptBecause::kBudgetSpent:
            return "a limit of work was spent: occluder_triangles or second_look_polygons of the settings";
    }
    return "";
}

/// Adds to a text that may be too short for it, and counts what it would take.
struct Text {
    char* out;
    size_t capacity, length = 0;

    __attribute__((format(printf, 2, 3))) void add(const char* format, ...) {
        va_list arguments;
        va_start(arguments, format);
        const size_t room = length < capacity ? capacity - length : 0;
        const int added = std::vsnprintf(room ? out + length : nullptr, room, format, arguments);
        va_end(arguments);
        if (added > 0) length += static_cast<size_t>(added);
    }
};

void addHiders(Text& text, const slExplanation& why) {
    const uint32_t told = std::min<uint32_t>(why.hider_count, SL_MOST_HIDERS);
    for (uint32_t i = 0; i < told; ++i) {
        text.add("%s%" PRIu64,
                 i == 0         ? (told > 1 ? "objects " : "object ")
                 : i + 1 < told ? ", "
                                : " and ",
                 why.hiders[i].object.key);
        if (!why.proved) text.add(" (%.0f %%)", 100.0 * why.hiders[i].share);
    }
    if (told < why.hider_count) text.add(" and %u more", why.hider_count - told);
}

}  // namespace

slStatus slQueryExplain(const slQuery* query, const slSnapshot* snapshot, const slView* view,
                        const slQuerySettings* settings, slObjectId id, slExplanation* explanation_out) {
    const slLog log = query ? query->log() : slLog{};
    if (!query || !snapshot || !explanation_out) return fail(log, SL_BAD_ARGUMENT, __func__, "a pointer is null");
    View to;
    QuerySettings how;
    if (const slStatus status = c::toView(view, log, __func__, to)) return status;
    if (const slStatus status = c::toSettings(settings, log, __func__, how)) return status;
    const Explanation why = query->query.explain(snapshot->snapshot, to, c::id(id), how);
    slExplanation out{};
    out.verdict = static_cast<slVerdict>(why.verdict);
    out.object = {why.key, id};
    out.together = why.together;
    out.unasked = why.unasked;
    out.on_screen = why.on_screen;
    out.rect = c::rect(why.rect);
    out.depth = why.depth;
    if (why.verdict == Verdict::kOutsideFrustum) {
        out.plane = kPlaneNames[why.frustum.plane];
        out.plane_distance = why.frustum.distance();
    }
    if (why.verdict == Verdict::kOccluded) {
        const Array<Hider>& hiders = why.occlusion.hiders;
        out.hider_count = static_cast<uint32_t>(hiders.size());
        for (size_t i = 0; i < std::min<size_t>(hiders.size(), SL_MOST_HIDERS); ++i)
            out.hiders[i] = {{hiders[i].key, c::id(hiders[i].id)}, hiders[i].share};
        out.sufficient = why.occlusion.sufficient;
    }
    out.proved = why.verdict == Verdict::kOccluded && !why.certificate.empty() && why.occlusion.hiders[0].share == 0;
    if (why.verdict == Verdict::kVisible) {
        out.because = wordsOf(why.visible.because);
        out.open_pixel = why.visible.because == KeptBecause::kOpenPixel;
        out.x = why.visible.x;
        out.y = why.visible.y;
    }
    *explanation_out = out;
    return SL_OK;
}

size_t slExplanationWords(const slExplanation* why, char* text_out, size_t capacity) {
    Text text{text_out, text_out ? capacity : 0};
    if (!why) {
        text.add("there is no explanation");
        return text.length + 1;
    }
    if (why->verdict == SL_NO_SUCH_OBJECT) {
        text.add("there is no such object");
        return text.length + 1;
    }
    text.add("object %" PRIu64 " is ", why->object.key);
    switch (why->verdict) {
        case SL_NO_SUCH_OBJECT:
            break;
        case SL_OUTSIDE_LAYERS:
            text.add("in none of the view's layers");
            break;
        case SL_VISIBLE:
            text.add("kept: %s", why->because ? why->because : "");
            if (why->open_pixel) text.add(", at (%.1f, %.1f)", why->x, why->y);
            if (why->unasked) text.add("; the last answer kept it without asking");
            break;
        case SL_OUTSIDE_FRUSTUM:
            text.add("culled by frustum: it lies %g beyond the %s plane", why->plane_distance,
                     why->plane ? why->plane : "");
            break;
        case SL_OCCLUDED:
            text.add("culled by occlusion: it lies behind ");
            addHiders(text, *why);
            if (!why->sufficient) text.add(", and is hidden only with the rest of the world there");
            break;
        case SL_TOO_FAR:
            text.add("culled by distance, although it may be visible");
            break;
        case SL_TOO_SMALL:
            text.add("culled by contribution, although it may be visible");
            break;
        case SL_NO_CLUSTER:
            text.add("culled by clusters: none of them is left");
            break;
        case SL_NO_TIME:
            text.add("culled by the budget, although it may be visible");
            break;
        case SL_NOT_IN_PVS:
            text.add("culled by pvs: it is seen from nowhere in the cells of the eye");
            break;
        case SL_NO_WINDOW:
            text.add("culled by portals: it lies beside every window into its cells");
            break;
        case SL_FACES_AWAY:
            text.add("culled by facing: its faces in the view look away, and are drawn from their fronts alone");
            break;
    }
    return text.length + 1;
}
