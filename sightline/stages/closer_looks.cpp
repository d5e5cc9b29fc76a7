// The closer looks at objects that their boxes' rectangles would keep: by the boxes' faces, and at the end by triangles.
// SPDX-License-Identifier: MIT
#include "sightline/cull/shapes.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {
namespace {

/// What a closer look says. Without the frustum stage, what lies outside of the view is kept. What a strip finds outside
/// may lie in another: to the strip it is hidden.
TurnAnswer settle(const Frame& frame, const TraversalState& state, Look look, Sight sight) {
    if (sight == Sight::kVisible || (sight == Sight::kOutside && !frame.uses(Stage::kFrustum))) return {.look = look};
    const bool outside = sight == Sight::kOutside && state.part.whole();
    return {.culled = true, .stage = outside ? Stage::kFrustum : Stage::kOcclusion, .look = look};
}

}  // namespace

/// An object of which a polygon was open last is likely to be visible still. Its faces are then not worth asking: they
/// are open wherever a polygon is.
TurnAnswer cullByFaces(const Frame& frame, TraversalState& state, const Pending& entry) {
    const Look by_box = frame.settings.faces && entry.testable ? Look::kFaces : Look::kBox;
    if (entry.kind != Pending::Kind::kObject) return {};
    const ObjectRecord& object = frame.world->objectAt(entry.index);
    const bool in_layers = object.layers & frame.view.layers;
    const bool again =
        frame.settings.second_look && object.shape.index != 0 && in_layers && !frame.mayBeCoarse(entry.index);
    const bool was_open = again && !frame.settings.stateless && state.openAt(entry.index).cluster != OpenPolygon::kNone;
    if (frame.settings.faces && in_layers && !was_open) {
        const OccludeePlace place = makeOccludeePlace(frame.screen, object.transform, object.bounds);
        ++state.stats.faces_tested;
        const TurnAnswer answer = settle(frame, state, Look::kFaces, askBox(state.tiles, place, object.bounds));
        state.stats.faces_culled += answer.culled;
        if (answer.culled) return answer;
    }
    // Its triangles are asked once all is drawn: an object whose box is near may well be hidden by what is met later.
    if (again) {
        state.second.push_back({entry, static_cast<uint32_t>(state.visible.size()), was_open});
        return {.look = Look::kTriangles};
    }
    return {.look = by_box};
}

namespace {

/// Notes which polygon of the object at a place is open.
void note(const Frame& frame, TraversalState& state, uint32_t place, const OpenPolygon& open) {
    if (place >= state.open_at.size())
        state.open_at.resize(frame.world->placed.size(), OpenPolygon{OpenPolygon::kNone});
    state.open_at[place] = open;
}

}  // namespace

/// Objects that are culled here were drawn, and may have hidden others. That is sound: along each ray the nearest point
/// of all that was drawn has nothing in front of it, so that its object is kept, and it hides what they hid.
TurnAnswer cullByTriangles(const Frame& frame, TraversalState& state, const SecondLook& kept) {
    const ObjectRecord& object = frame.world->objectAt(kept.entry.index);
    const OccludeePlace place = makeOccludeePlace(frame.screen, object.transform, object.bounds);
    TriangleLook look;
    look.most_polygons = frame.settings.second_look_polygons - state.stats.second_look_polygons;
    if (!frame.settings.stateless) look.first = state.openAt(kept.entry.index);
    ++state.stats.second_looks;
    const Sight sight =
        askTriangles(state.tiles, place, *frame.world->occluders[object.shape.index], state.looks, look);
    state.stats.second_look_polygons += look.polygons;
    state.stats.second_look_spent |= look.spent;
    if (!frame.settings.stateless) {
        const bool open = sight == Sight::kVisible && !look.spent;
        note(frame, state, kept.entry.index, open ? look.open : OpenPolygon{OpenPolygon::kNone});
    }
    TurnAnswer answer = settle(frame, state, Look::kTriangles, sight);
    state.stats.second_look_culled += answer.culled;
    if (!answer.culled && frame.settings.faces && kept.skips_faces && !look.by_first) {
        ++state.stats.faces_tested;
        const TurnAnswer by_faces = settle(frame, state, Look::kFaces, askBox(state.tiles, place, object.bounds));
        state.stats.faces_culled += by_faces.culled;
        if (by_faces.culled) return by_faces;
    }
    if (!answer.culled && look.spent) answer.look = Look::kBox;
    return answer;
}

}  // namespace sightline::detail
