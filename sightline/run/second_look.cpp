// Closer looks at objects that their boxes' rectangles would keep: by the boxes' faces, and at the end by triangles.
// SPDX-License-Identifier: MIT
#include "sightline/cull/shapes.h"
#include "sightline/run/walk.h"

namespace sightline::detail {

/// Whether the object will be asked by its triangles before the answer is given.
bool Walk::hasSecondLook(const ObjectRecord& object) const {
    return view.second_look && uses(Stage::kOcclusion) && object.shape.index != 0 && (object.layers & view.layers);
}

/// Culls an object by what a closer look found; returns whether it did. Without the frustum stage, what lies outside of
/// the view is kept. What a bin finds outside may lie in another: to the bin it is hidden.
bool Walk::settle(const Pending& entry, Look look, Sight sight, uint64_t& count) {
    if (sight == Sight::kVisible || (sight == Sight::kOutside && !uses(Stage::kFrustum))) return false;
    ++count;
    const bool outside = sight == Sight::kOutside && !isPart();
    cull(entry.below, outside ? Stage::kFrustum : Stage::kOcclusion, &entry.rect);
    if (record) {
        record->culls.back().look = look;
        record->culls.back().boxed = entry.testable;
    }
    return true;
}

/// Asks an object by the faces of its box, and lines it up for the second look. True if it was culled.
bool Walk::lookCloser(const Pending& entry) {
    const ObjectRecord& object = state().objectAt(entry.index);
    if (view.faces && (object.layers & view.layers)) {
        const OccludeePlace place = makeOccludeePlace(screen, object.transform, object.bounds);
        ++stats.faces_tested;
        if (view.balance_bins) countWork(entry.rect, entry.testable, 800.0);
        if (settle(entry, Look::kFaces, askBox(tiles, place, object.bounds), stats.faces_culled)) return true;
    }
    // Its triangles are asked once all is drawn: an object whose box is near may well be hidden by what is met later.
    if (hasSecondLook(object)) second.push_back({entry, static_cast<uint32_t>(visible.size())});
    return false;
}

/// The second look, at all that was kept and has a shape.
///
/// Objects that are culled here were drawn, and may have hidden others. That is sound: along each ray the nearest point
/// of all that was drawn has nothing in front of it, so that its object is kept, and it hides what they hid.
void Walk::lookAgain() {
    size_t gone = 0;
    for (const SecondLook& next : second) {
        const ObjectRecord& object = state().objectAt(next.entry.index);
        const OccludeePlace place = makeOccludeePlace(screen, object.transform, object.bounds);
        TriangleLook look;
        look.most_polygons = view.second_look_polygons - stats.second_look_polygons;
        ++stats.second_looks;
        const Sight sight = askTriangles(tiles, place, *state().occluders[object.shape.index], looks, look);
        stats.second_look_polygons += look.polygons;
        if (view.balance_bins) countWork(next.entry.rect, next.entry.testable, 300.0 + 100.0 * look.polygons);
        stats.second_look_spent |= look.spent;
        if (settle(next.entry, Look::kTriangles, sight, stats.second_look_culled)) {
            visible[next.visible].id = ObjectId();
            ++gone;
        } else if (record) {
            noteKept(next.entry, look.spent ? Look::kBox : Look::kTriangles);
        }
        if (record && record->stopped) break;
    }
    if (!gone) return;
    size_t left = 0;
    for (size_t i = 0; i < visible.size(); ++i) {
        if (visible[i].id == ObjectId()) continue;
        if (isPart()) kept[left] = kept[i];
        visible[left++] = visible[i];
    }
    visible.resize(left);
    if (isPart()) kept.resize(left);
}

}  // namespace sightline::detail
