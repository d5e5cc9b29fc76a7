// The closer looks at objects that their boxes' rectangles would keep: by the boxes' faces, and at the end by their outlines.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/cull/shapes.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {
namespace {

/// What a closer look says. Without the frustum stage, what lies outside of the view is kept. What a strip finds outside
/// may lie in another: to the strip it is hidden.
/// @param away  its faces in the view look away
TurnAnswer settle(const Frame& frame, const TraversalState& state, Look look, Sight sight, bool away = false) {
    if (sight == Sight::kVisible || (sight == Sight::kOutside && !frame.uses(Stage::kFrustum))) return {.look = look};
    const bool outside = sight == Sight::kOutside && state.part.whole();
    const Stage stage = away ? Stage::kFacing : outside ? Stage::kFrustum : Stage::kOcclusion;
    return {.culled = true, .stage = stage, .look = look};
}

}  // namespace

namespace {

/// Of what is smaller in the image, in pixels of the buffer, a closer look tells hardly more than the box.
constexpr int64_t kLeastLook = 64;

bool isTiny(const Pending& entry) {
    const PixelRect& rect = entry.rect;
    return entry.testable && int64_t{rect.x1 - rect.x0 + 1} * (rect.y1 - rect.y0 + 1) < kLeastLook;
}

// What is noted of an object that was hidden, in place of an open cluster.
constexpr uint32_t kHiddenByFaces = OutlineLook::kNone - 1, kHiddenByTriangles = OutlineLook::kNone - 2;

/// What the last look at the object at a place found.
uint32_t lastLook(const Frame& frame, const TraversalState& state, uint32_t place) {
    return frame.settings.stateless ? OutlineLook::kNone : state.openAt(place);
}

/// Notes what was found of the object at a place.
void note(const Frame& frame, TraversalState& state, uint32_t place, uint32_t open) {
    if (frame.settings.stateless) return;
    SIGHTLINE_DEBUG_ASSERT(place < frame.world->placed.size());
    if (place >= state.open_at.size()) state.open_at.resize(frame.world->placed.size(), OutlineLook::kNone);
    state.open_at[place] = open;
}

TurnAnswer askFaces(const Frame& frame, TraversalState& state, const OccludeePlace& place, const Box3d& bounds) {
    ++state.stats.faces_tested;
    const TurnAnswer answer = settle(frame, state, Look::kFaces, askBox(state.tiles, place, bounds));
    state.stats.faces_culled += answer.culled;
    return answer;
}

}  // namespace

/// Where triangles will be asked, faces are worth asking only if they decided last time: they are open wherever a
/// polygon is.
TurnAnswer cullByFaces(const Frame& frame, TraversalState& state, const Pending& entry) {
    const Look by_box = frame.settings.faces && entry.testable && !isTiny(entry) ? Look::kFaces : Look::kBox;
    if (entry.kind != Pending::Kind::kObject) return {};
    SIGHTLINE_DEBUG_ASSERT(entry.index < frame.world->placed.size());
    const ObjectRecord& object = frame.world->objectAt(entry.index);
    const bool in_layers = object.layers & frame.view.layers;
    const bool closer = in_layers && !isTiny(entry);
    const bool again =
        frame.settings.second_look && object.shape.index != 0 && closer && !frame.mayBeCoarse(entry.index);
    const bool by_faces = lastLook(frame, state, entry.index) == kHiddenByFaces;
    const bool asks_faces = frame.settings.faces && closer && (!again || by_faces);
    if (asks_faces) {
        const OccludeePlace place = makeOccludeePlace(frame.screen, object.transform, object.bounds);
        const TurnAnswer answer = askFaces(frame, state, place, object.bounds);
        if (answer.culled) return answer;
    }
    // Its triangles are asked once all is drawn: an object whose box is near may well be hidden by what is met later.
    if (again) {
        state.second.push_back(
            {entry, static_cast<uint32_t>(state.visible.size()), frame.settings.faces && !asks_faces});
        return {.look = Look::kTriangles};
    }
    return {.look = by_box};
}

/// Objects that are culled here were drawn, and may have hidden others. That is sound: along each ray the nearest point
/// of all that was drawn has nothing in front of it, so that its object is kept, and it hides what they hid.
TurnAnswer cullByTriangles(const Frame& frame, TraversalState& state, const SecondLook& kept) {
    SIGHTLINE_DEBUG_ASSERT(kept.entry.kind == Pending::Kind::kObject && kept.visible < state.visible.size());
    const ObjectRecord& object = frame.world->objectAt(kept.entry.index);
    SIGHTLINE_DEBUG_ASSERT(object.shape.index > 0 && object.shape.index < frame.world->occluders.size());
    const OccludeePlace place = makeOccludeePlace(frame.screen, object.transform, object.bounds);
    OutlineLook look;
    SIGHTLINE_DEBUG_ASSERT(state.stats.second_look_polygons <= frame.settings.second_look_polygons);
    look.most_polygons = frame.settings.second_look_polygons - state.stats.second_look_polygons;
    const uint32_t last = lastLook(frame, state, kept.entry.index);
    look.first = last;
    ++state.stats.second_looks;
    const OccluderInstance instance =
        makeOccluderInstance(frame.screen, *frame.world->occluders[object.shape.index], object.transform);
    const Sight sight = askOutlines(state.tiles, instance, state.looks, look);
    SIGHTLINE_DEBUG_ASSERT(look.spent || look.polygons <= look.most_polygons);
    state.stats.second_look_polygons += look.polygons;
    state.stats.second_look_spent |= look.spent;
    TurnAnswer answer = settle(frame, state, Look::kTriangles, sight, look.away);
    state.stats.second_look_culled += answer.culled;
    uint32_t found = OutlineLook::kNone;
    if (answer.culled) {
        // Which of both looks is to be taken the next time: faces are cheaper, and come before the object is drawn.
        const bool known = !kept.faces_left || last == kHiddenByTriangles || frame.settings.stateless;
        const bool by_faces = !known && askFaces(frame, state, place, object.bounds).culled;
        found = by_faces ? kHiddenByFaces : kHiddenByTriangles;
    } else if (kept.faces_left && (look.spent || look.in_doubt)) {
        answer = askFaces(frame, state, place, object.bounds);
        if (answer.culled) found = kHiddenByFaces;
    } else if (!look.spent) {
        found = look.open;
    }
    note(frame, state, kept.entry.index, found);
    if (!answer.culled && look.spent) answer.look = Look::kBox;
    return answer;
}

}  // namespace sightline::detail
