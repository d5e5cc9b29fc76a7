// Why an object is, or is not, in a query's answer: the plane, the occluders, the place where it is seen, or the doubt.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/explain.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/stretch.h"
#include "sightline/query/answer.h"
#include "sightline/query/explain/hiders.h"
#include "sightline/query/explain/open_pixels.h"
#include "sightline/query/explain/trial.h"
#include "sightline/stages/occluder_form.h"

namespace sightline {
namespace {

using detail::LeafAnswer;
using detail::PixelOwner;
using detail::SnapshotState;
using detail::TraversalRecord;
using detail::Trial;

/// Buffer pixels to viewport pixels: the buffer holds the viewport and the jitter on every side.
ImageRect imageOf(const PixelRect& rect, const Screen& screen, const View& view) {
    const double sx = (view.width + 2.0 * view.jitter) / screen.width;
    const double sy = (view.height + 2.0 * view.jitter) / screen.height;
    ImageRect image;
    image.left = sx * rect.x0 - view.jitter;
    image.right = sx * (rect.x1 + 1) - view.jitter;
    image.top = view.height + view.jitter - sy * (rect.y1 + 1);
    image.bottom = view.height + view.jitter - sy * rect.y0;
    return image;
}

/// How far each plane has the box outside, in double; and how much rounding the query allows for.
FrustumReason planesOf(const SnapshotState& state, const Box3d& box, const View& view) {
    const Frustum frustum = makeFrustum(view);
    const ViewLimits limits = makeViewLimits(view, frustum.eye);
    FrustumReason reason;
    double best = FrustumReason::kNoPlane;
    for (uint32_t i = 0; i < frustum.count + limits.volume.count; ++i) {
        const bool added = i >= frustum.count;
        const uint32_t limit = i - frustum.count;
        const glm::dvec4& plane = added ? limits.volume.planes[limit] : frustum.planes[i];
        const uint32_t name = !added                    ? frustum.side[i]
                              : limit < limits.sections ? FrustumReason::kFirstSection + limit
                                                        : FrustumReason::kFirstWindow + (limit - limits.sections);
        double inside = plane.w, size = std::abs(plane.w);
        for (int axis = 0; axis < 3; ++axis) {
            const double low = box.min[axis] - frustum.eye[axis], high = box.max[axis] - frustum.eye[axis];
            inside += std::max(plane[axis] * low, plane[axis] * high);
            const double from_origin = std::max(std::abs(box.min[axis] - state.bvh.origin[axis]),
                                                std::abs(box.max[axis] - state.bvh.origin[axis]));
            size += std::abs(plane[axis]) * (std::max(std::abs(low), std::abs(high)) + from_origin);
        }
        reason.outside[name] = -inside;
        if (!(-inside > best)) continue;
        best = -inside;
        reason.rounding = 0x1p-18 * size;
        reason.plane = name;
    }
    return reason;
}

}  // namespace

struct Explainer::Impl {
    Impl(const Snapshot& now, const View& seen_from, const QuerySettings& how, Memory* from)
        : memory(from), snapshot(now), view(seen_from), settings(how) {}

    Memory* const memory;
    Snapshot snapshot;
    View view;
    QuerySettings settings;
    detail::Frame frame;  ///< of the view in the whole world
    detail::StageMemory stages{memory};
    Trial trial{memory};              ///< of the object, in the whole world
    detail::LastShown shown{memory};  ///< of the answer before, for QuerySettings::hysteresis
    detail::HiderSearch search{memory};
    detail::OpenPixels open{memory};
    detail::AskedPixels asked{memory};
    detail::Candidates left{memory};  ///< of a world without an object's hiders
    Owned<detail::Answer> whole;      ///< made when first needed, for what depends on all of it

    uint32_t find(ObjectId id) const;
    void explainVisible(uint32_t item, Explanation& out);
    void explainOpenPixel(Explanation& out);
    bool askAgain(uint32_t place, Explanation& out);
    KeptBecause doubtOf(const Box3d& box) const;
    void explainOccluded(uint32_t item, const PixelRect& rect, const ExplainSettings& asked_for, OcclusionReason& out);
    void tryWithout(uint32_t item, OcclusionReason& out);
    void lookWithout(const SnapshotState& others, uint32_t self, OcclusionReason& out);
    detail::Answer& wholeAnswer();
    bool lookAtLods(uint32_t item, LodReason& out);
    ClustersReason lookAtClusters(uint32_t item);
    void narrowTo(const detail::Candidates* left_of_it) { trial.candidates = search.cells = left_of_it; }
    void lookAtCells(uint32_t item, CellsReason& out) const;
    void nameVolume(const SnapshotState& state, Array<Hider>& hiders) const;
};

uint32_t Explainer::Impl::find(ObjectId id) const {
    const uint32_t row = snapshot ? snapshot.state().find(id) : detail::IdSlot::kNowhere;
    return row == detail::IdSlot::kNowhere ? PixelOwner::kNone : snapshot.state().itemOf(row);
}

/// The doubt that keeps a box without a rectangle.
KeptBecause Explainer::Impl::doubtOf(const Box3d& box) const {
    const Screen& screen = frame.screen;
    bool holds_eye = screen.perspective;
    for (int axis = 0; axis < 3; ++axis)
        holds_eye = holds_eye && box.min[axis] <= screen.eye[axis] && screen.eye[axis] <= box.max[axis];
    if (holds_eye) return KeptBecause::kHoldsEye;
    double nearest = screen.near.w, size = std::abs(screen.near.w);
    for (int axis = 0; axis < 3; ++axis) {
        const double low = screen.near[axis] * (box.min[axis] - screen.eye[axis]);
        const double high = screen.near[axis] * (box.max[axis] - screen.eye[axis]);
        nearest += std::min(low, high);
        size += std::max(std::abs(low), std::abs(high));
    }
    return nearest <= 0x1p-18 * size ? KeptBecause::kNearPlane : KeptBecause::kNotProjectable;
}

void Explainer::Impl::explainVisible(uint32_t item, Explanation& out) {
    VisibleReason& why = out.visible;
    const SnapshotState& state = snapshot.state();
    const uint32_t place = detail::hierarchyPlace(state, item);
    if (problemOf(view) != ViewProblem::kNone) {
        why.because = KeptBecause::kViewNotUsable;
    } else if (place == TraversalRecord::kNowhere) {
        why.because = KeptBecause::kBoundsNotUsable;
    } else if (!(settings.stages & stageBit(Stage::kFrustum)) && out.frustum.outside_any) {
        why.because = KeptBecause::kStageOff;
        why.stage = Stage::kFrustum;
    } else if (!(settings.stages & stageBit(Stage::kOcclusion))) {
        why.because = KeptBecause::kStageOff;
        why.stage = Stage::kOcclusion;
    } else if (!askAgain(place, out)) {
        why.because = doubtOf(detail::worldBounds(state.object(item)));
    } else {
        explainOpenPixel(out);
        if (!trial.state.stats.budget_spent && !trial.state.stats.second_look_spent) return;
        const bool looks_spent = trial.state.stats.second_look_spent;
        QuerySettings generous = settings;
        generous.second_look_polygons = ~0u;
        why.second_look_spent = looks_spent && trial.run(state, view, generous, item) == Verdict::kOccluded;
        generous.occluder_triangles = ~0u;
        if (why.second_look_spent || trial.run(state, view, generous, item) == Verdict::kOccluded)
            why.because = KeptBecause::kBudgetSpent;
    }
}

/// Finds the pixels that the traversal asked about when it kept the object; false if it was in doubt. An object whose
/// box has no image may have triangles that do.
bool Explainer::Impl::askAgain(uint32_t place, Explanation& out) {
    const TraversalRecord::Kept& kept = trial.record.kept;
    // A closer look goes beyond the window that its rectangle was cut to.
    PixelRect rect = kept.rect;
    if (kept.testable && kept.look != detail::Look::kBox)
        rect = detail::askLeaf(snapshot.state(), place, view, frame.screen).rect();
    if (!asked.run(trial, place, kept.look, kept.testable ? &rect : nullptr) && !kept.testable) return false;
    if (out.on_screen) return true;
    float nearest = detail::AskedPixels::kNotAsked;
    for (const float nearness : asked.nearness) nearest = std::max(nearest, nearness);
    if (nearest == detail::AskedPixels::kNotAsked) return false;
    const Screen& screen = frame.screen;
    out.on_screen = true;
    out.rect = imageOf(asked.rect, screen, view);
    out.depth = screen.perspective ? 1.0 / static_cast<double>(nearest) : -static_cast<double>(nearest);
    return true;
}

/// Looks for the open pixel in the depth tiles, as they were when the traversal kept the object.
void Explainer::Impl::explainOpenPixel(Explanation& out) {
    VisibleReason& why = out.visible;
    const SnapshotState& state = snapshot.state();
    DepthTiles& tiles = trial.state.tiles;
    open.run(tiles, asked);
    why.by_faces = trial.record.kept.look == detail::Look::kFaces;
    why.by_triangles = trial.record.kept.look == detail::Look::kTriangles;
    why.pixels = open.pixels;
    why.open_pixels = open.open;
    const PixelRect pixel{open.x, open.y, open.x, open.y, 0};
    const ImageRect image = imageOf(pixel, frame.screen, view);
    why.x = 0.5 * (image.left + image.right);
    why.y = 0.5 * (image.top + image.bottom);
    why.covered = open.covered;
    if (!open.covered) return;
    search.owners.run(trial, pixel);
    const PixelOwner& owner = search.owners.at(open.x, open.y);
    if (owner.owner == PixelOwner::kNone) return;
    const detail::ObjectRecord& cover = state.objectAt(trial.record.owners[owner.owner]);
    why.cover = cover.id;
    why.cover_key = cover.key;
}

void Explainer::Impl::explainOccluded(uint32_t item, const PixelRect& rect, const ExplainSettings& asked_for,
                                      OcclusionReason& out) {
    if (!asked_for.hiders) return;
    if (out.stage == Stage::kVolumes) {
        nameVolume(snapshot.state(), out.hiders);
    } else if (out.outside_too) {
        out.sufficient = false;
        search.own(snapshot.state(), item, trial, out.hiders);
    } else {
        out.sufficient = search.run(snapshot.state(), view, settings, item, trial, rect, out.hiders);
    }
    if (asked_for.without) tryWithout(item, out);
}

/// The answer itself, with levels of detail.
detail::Answer& Explainer::Impl::wholeAnswer() {
    if (whole) return *whole;
    whole = makeOwned<detail::Answer>(memory, memory);
    whole->begin(snapshot, view, settings, shown.generations());
    for (uint32_t part = 0; part < whole->parts(); ++part) whole->run(part);
    whole->finish();
    whole->refine(Stage::kLod);
    return *whole;
}

/// @returns whether the object is left out
bool Explainer::Impl::lookAtLods(uint32_t item, LodReason& out) {
    const SnapshotState& state = snapshot.state();
    if (!frame.uses(Stage::kLod)) return false;
    const detail::Answer& answer = wholeAnswer();
    const uint32_t row = state.rowOf(item);
    if (answer.lods().leftOut(row)) return true;
    const detail::HeldLods* held = state.lods[state.objects[row].lods.index].get();
    const auto& visible = answer.visible();
    const auto at = std::find_if(visible.begin(), visible.end(),
                                 [&](const Visible& object) { return object.id == state.objects[row].id; });
    if (!held || at == visible.end() || answer.lods().lods().empty()) return false;
    const auto place = static_cast<size_t>(at - visible.begin());
    out.levels = static_cast<uint32_t>(held->levels.size());
    out.drawn = answer.lods().lods()[place];
    const uint32_t where = state.bvh.placeOf(row);
    const double unit = where == PlacedBvh::kNone
                            ? std::numeric_limits<double>::infinity()
                            : largestStretch(state.objects[row].transform) *
                                  pixelsOfUnit(answer.frame().lods, answer.frame().boundsAt(where));
    const size_t next = size_t{out.drawn.level} + 1;
    out.error = out.drawn.level > 0 ? held->levels[out.drawn.level].error * unit : 0.0;
    out.next_error =
        next < held->levels.size() ? held->levels[next].error * unit : std::numeric_limits<double>::infinity();
    return false;
}

/// Of an object that is drawn by its finest level.
ClustersReason Explainer::Impl::lookAtClusters(uint32_t item) {
    const uint32_t row = snapshot.state().rowOf(item);
    if (snapshot.state().objects[row].clusters.index == 0) return {};
    wholeAnswer();
    detail::AnswerView answer = whole->view();
    const QueryStats stats = whole->clusters().look(whole->frame(), row, answer);
    return {stats.clusters_tested,
            stats.clusters_back,
            stats.clusters_outside,
            stats.clusters_hidden,
            stats.clusters_tested
                ? snapshot.state().clusters[snapshot.state().objects[row].clusters.index]->triangles.size()
                : 0,
            stats.drawn_triangles};
}

/// Where the eye and the object are, and how one is seen from the other.
void Explainer::Impl::lookAtCells(uint32_t item, CellsReason& out) const {
    const SnapshotState& state = snapshot.state();
    const uint32_t row = state.rowOf(item);
    const detail::CellLists& lists = state.cell_state.lists;
    out.eye.assign(stages.cells.start().begin(), stages.cells.start().end());
    out.view_cells = static_cast<uint32_t>(stages.cells.viewStart().size());
    out.work_spent = stages.cells.portalStats().work_spent;
    for (uint32_t cell = 0; cell < lists.first.size(); ++cell)
        for (uint32_t at = lists.first[cell]; at != detail::CellBlock::kNone; at = lists.blocks[at].next) {
            const detail::CellBlock& block = lists.blocks[at];
            if (std::find(block.row, block.row + block.used, row) != block.row + block.used) out.object.push_back(cell);
        }
    if (!stages.cells.flood()) return;
    const std::span<const SeenCell> seen = stages.cells.flood()->cells();
    uint32_t first = ~0u;
    for (const uint32_t cell : out.object) {
        const auto at = std::find_if(seen.begin(), seen.end(), [&](const SeenCell& one) { return one.cell == cell; });
        if (at == seen.end()) continue;
        ++out.reached;
        first = std::min(first, static_cast<uint32_t>(at - seen.begin()));
    }
    for (uint32_t at = first; at != ~0u && out.way.size() <= seen.size(); at = seen[at].from) {
        out.way.push_back(seen[at].cell);
        if (seen[at].from != ~0u) out.portals.push_back(seen[at].portal);
    }
    std::reverse(out.way.begin(), out.way.end());
    std::reverse(out.portals.begin(), out.portals.end());
}

/// The object whose volume culled what the trial asked for.
void Explainer::Impl::nameVolume(const SnapshotState& state, Array<Hider>& hiders) const {
    const detail::ObjectRecord& owner = state.objectAt(trial.cull.hider);
    hiders.push_back({owner.id, owner.key, 1.0});
}

/// Builds the world without the hiders and looks again.
void Explainer::Impl::tryWithout(uint32_t item, OcclusionReason& out) {
    const SnapshotState& state = snapshot.state();
    Array<uint32_t> items(memory);
    items.reserve(state.count);
    for (uint32_t i = 0; i < state.count; ++i) items.push_back(i);
    Array<uint32_t> gone(memory);
    for (const Hider& hider : out.hiders) gone.push_back(find(hider.id));
    std::sort(gone.begin(), gone.end());
    erase_if(items, [&](uint32_t i) { return std::binary_search(gone.begin(), gone.end(), i); });
    const auto others = detail::stateOfSome(state, items, memory);
    if (frame.candidates) left.takeSome(*frame.candidates, items, *others);
    if (frame.candidates) narrowTo(&left);
    const auto self = static_cast<uint32_t>(std::lower_bound(items.begin(), items.end(), item) - items.begin());
    lookWithout(*others, self, out);
    narrowTo(frame.candidates);
}

/// @param others  the world without the hiders
/// @param self    the object there
void Explainer::Impl::lookWithout(const SnapshotState& others, uint32_t self, OcclusionReason& out) {
    const Verdict verdict = trial.run(others, view, settings, self);
    out.without = verdict == Verdict::kOccluded         ? Without::kOccluded
                  : verdict == Verdict::kOutsideFrustum ? Without::kOutsideFrustum
                  : verdict == Verdict::kFacesAway      ? Without::kFacesAway
                  : verdict == Verdict::kTooFar         ? Without::kTooFar
                  : verdict == Verdict::kTooSmall       ? Without::kTooSmall
                                                        : Without::kVisible;
    if (verdict != Verdict::kOccluded) return;
    if (trial.cull.stage == Stage::kVolumes) return nameVolume(others, out.others);
    const uint32_t place = detail::hierarchyPlace(others, self);
    const LeafAnswer leaf = detail::askLeaf(others, place, view, trial.frame.screen);
    if (leaf.beyond_plane || leaf.outside()) return search.own(others, self, trial, out.others);
    search.run(others, view, settings, self, trial, trial.frame.inWindow(place, leaf.rect()), out.others);
}

Explainer::Explainer(const Snapshot& now, const View& view, const QuerySettings& settings, Memory* memory)
    : impl_(makeOwned<Impl>(memory, now, view, settings, memory)) {
    impl_->frame.begin(now, view, settings);
    detail::choosePvs(impl_->frame, impl_->stages);
    detail::choosePortals(impl_->frame, impl_->stages);
    impl_->narrowTo(impl_->frame.candidates);
}
Explainer::Explainer(const Snapshot& now, const View& view, const QuerySettings& settings,
                     std::span<const Visible> last, Memory* memory)
    : Explainer(now, view, settings, memory) {
    impl_->shown.mark(last, detail::remembersShown(view, settings));
    impl_->trial.shown = impl_->search.trial.shown = impl_->shown.generations();
}
Explainer::~Explainer() = default;
Explainer::Explainer(Explainer&&) noexcept = default;
Explainer& Explainer::operator=(Explainer&&) noexcept = default;

Explanation Explainer::explain(ObjectId id, const ExplainSettings& asked_for) {
    Impl& impl = *impl_;
    Explanation out(impl.memory);
    const uint32_t item = impl.find(id);
    if (item == PixelOwner::kNone) return out;
    const SnapshotState& state = impl.snapshot.state();
    const detail::ObjectRecord& object = state.object(item);
    out.id = object.id;
    out.key = object.key;
    out.width = impl.view.width;
    out.height = impl.view.height;
    if (!(object.layers & impl.view.layers)) {
        out.verdict = Verdict::kOutsideLayers;
        return out;
    }
    const uint32_t place = detail::hierarchyPlace(state, item);
    const detail::Frame& frame = impl.frame;
    const bool admitted = place == TraversalRecord::kNowhere || frame.isCandidate(place);
    const bool by_cells = state.cell_state.cells && (stagesInUse(impl.view, impl.settings) & kCellStages);
    if (by_cells && place != TraversalRecord::kNowhere) impl.lookAtCells(item, out.cells);
    if (!admitted) {
        out.verdict = frame.candidates->stageOf(place) == Stage::kPvs ? Verdict::kNotInPvs : Verdict::kNoWindow;
        return out;
    }
    out.verdict = impl.trial.run(state, impl.view, impl.settings, item);
    PixelRect rect;
    if (frame.usable && place != TraversalRecord::kNowhere) {
        const Screen& screen = frame.screen;
        const LeafAnswer leaf = detail::askLeaf(state, place, impl.view, screen);
        out.on_screen = !leaf.doubt() && !leaf.outside();
        const Box3d box = detail::worldBounds(object);
        out.frustum = planesOf(state, box, impl.view);
        out.cut = object.occluder.index != 0 &&
                  !isWhole(frame.limits, *state.occluders[object.occluder.index], object.transform);
        if (stagesInUse(impl.view, impl.settings) & kLossyStages) out.size = impl.trial.frame.sizes.reasonFor(place);
        out.frustum.outside_any = leaf.beyond_plane || leaf.outside();
        out.frustum.by_rectangle = leaf.outside() && !leaf.beyond_plane;
        if (out.on_screen) {
            out.rect = imageOf(leaf.rect(), screen, impl.view);
            rect = impl.trial.frame.inWindow(place, leaf.rect());
            out.depth =
                screen.perspective ? 1.0 / static_cast<double>(rect.nearness) : -static_cast<double>(rect.nearness);
        }
    }
    const bool by_frustum = out.verdict == Verdict::kOutsideFrustum;
    if (by_frustum || out.verdict == Verdict::kOccluded) {
        const detail::Look look = impl.trial.cull.look;
        (by_frustum ? out.frustum.by_faces : out.occlusion.by_faces) = look == detail::Look::kFaces;
        (by_frustum ? out.frustum.by_triangles : out.occlusion.by_triangles) = look == detail::Look::kTriangles;
    }
    if (out.verdict == Verdict::kVisible && impl.lookAtLods(item, out.lod)) {
        out.verdict = Verdict::kNoTime;
        return out;
    }
    if (out.verdict == Verdict::kVisible && out.lod.drawn.level == 0) out.clusters = impl.lookAtClusters(item);
    if (out.clusters.clusters > 0 && out.clusters.drawn == 0) {
        out.verdict = Verdict::kNoCluster;
        return out;
    }
    if (out.verdict == Verdict::kVisible) impl.explainVisible(item, out);
    else out.together = static_cast<uint32_t>(impl.trial.frame.countObjects(impl.trial.cull.places));
    out.occlusion.outside_too = out.verdict == Verdict::kOccluded && out.frustum.outside_any;
    if (out.verdict == Verdict::kOccluded) out.occlusion.stage = impl.trial.cull.stage;
    if (out.verdict == Verdict::kOccluded) impl.explainOccluded(item, rect, asked_for, out.occlusion);
    return out;
}

}  // namespace sightline
