// Which occluders hide an object: a minimal set that does so in a world of its own, and what each contributes.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/hiders.h"

#include <algorithm>

namespace sightline::detail {

/// What must be hidden so that the object is hidden: its rectangle, or what a closer look asked about.
const PixelRect& HiderSearch::ask(const Trial& decided, const PixelRect& rect) {
    const TraversalRecord::Cull& cull = decided.cull;
    if (cull.look == Look::kBox) asked.run(rect);
    else asked.run(decided, cull.places.first, cull.look, cull.boxed ? &cull.rect : nullptr);
    return asked.rect;
}

bool HiderSearch::run(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
                      const Trial& decided, const PixelRect& rect, Array<Hider>& hiders) {
    hiders.clear();
    const PixelRect& within = ask(decided, rect);
    owners.run(decided, within);
    // A volume may hide the same as the tiles, and then no occluder would own a pixel.
    QuerySettings by_tiles = settings;
    by_tiles.stages &= ~(stageBit(Stage::kVolumes) | kLossyStages);  // nor is it asked for its size by itself
    for (const bool anywhere : {false, true}) {
        collect(state, item, decided, within, anywhere);
        if (!shrink(state, view, by_tiles, item)) continue;
        share(state, view, by_tiles, item, hiders);
        return true;
    }
    reportOwners(state, hiders);
    return false;
}

void HiderSearch::own(const SnapshotState& state, uint32_t item, const Trial& decided, Array<Hider>& hiders) {
    hiders.clear();
    const PixelRect& within = ask(decided, decided.cull.rect);
    owners.run(decided, within);
    collect(state, item, decided, within, false);
    reportOwners(state, hiders);
}

/// The candidates that own pixels of the rectangle.
void HiderSearch::reportOwners(const SnapshotState& state, Array<Hider>& hiders) const {
    uint64_t owned = 0;
    for (const Candidate& candidate : candidates) owned += candidate.pixels;
    for (const Candidate& candidate : candidates) {
        if (candidate.pixels == 0) break;
        const ObjectRecord& object = state.object(candidate.item);
        hiders.push_back({object.id, object.key, static_cast<double>(candidate.pixels) / static_cast<double>(owned)});
    }
}

/// What may hide the object: the occluders drawn over its rectangle. If these do not suffice, all that were drawn: an
/// occluder that hides another one's cluster changes what is drawn.
void HiderSearch::collect(const SnapshotState& state, uint32_t item, const Trial& decided, const PixelRect& rect,
                          bool anywhere) {
    const TraversalRecord& record = decided.record;
    Array<uint8_t> over(record.owners.size(), 0, memory);
    Array<uint64_t> pixels(record.owners.size(), 0, memory);
    for (const TraversalRecord::Draw& draw : record.draws)
        if (anywhere || draw.box.doubt || overlaps(draw.box.rect, rect)) over[draw.instance] = 1;
    for (int32_t y = rect.y0; y <= rect.y1; ++y)
        for (int32_t x = rect.x0; x <= rect.x1; ++x) {
            if (asked.at(x, y) == AskedPixels::kNotAsked) continue;
            const uint32_t instance = owners.at(x, y).hiderOf(asked.at(x, y));
            if (instance != PixelOwner::kNone) ++pixels[instance];
        }
    candidates.clear();
    for (uint32_t i = 0; i < record.owners.size(); ++i) {
        // The object itself may have been drawn before a closer look culled it.
        const uint32_t drawn = state.itemAt(record.owners[i]);
        if (over[i] && drawn != item) candidates.push_back({drawn, pixels[i], i});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.pixels != b.pixels ? a.pixels > b.pixels : a.instance < b.instance;
    });
}

/// For trials in a world of some of the objects.
void HiderSearch::narrowTo(std::span<const uint32_t> items, const SnapshotState& world) {
    if (cells) some.takeSome(*cells, items, world);
    trial.candidates = cells ? &some : nullptr;
}

/// Whether a world of the object and some others occludes it.
bool HiderSearch::hides(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
                        std::span<const uint32_t> with) {
    Array<uint32_t> items(with.begin(), with.end(), memory);
    items.push_back(item);
    std::sort(items.begin(), items.end());
    const auto world = stateOfSome(state, items, memory);
    narrowTo(items, *world);
    const auto at = std::lower_bound(items.begin(), items.end(), item) - items.begin();
    return trial.run(*world, view, settings, static_cast<uint32_t>(at)) == Verdict::kOccluded;
}

bool HiderSearch::hidesFirst(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
                             size_t count) {
    set.clear();
    for (size_t i = 0; i < count; ++i) set.push_back(candidates[i].item);
    return hides(state, view, settings, item, set);
}

/// Finds a set that hides the object and of which no member can be left out; false if the candidates do not hide it.
bool HiderSearch::shrink(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item) {
    size_t count = std::min<size_t>(1, candidates.size());
    while (!hidesFirst(state, view, settings, item, count)) {
        if (count == candidates.size()) return false;
        count = std::min(2 * count, candidates.size());
    }
    // Those that own least go first. More occluders need not hide more, for they hide one another: until nothing goes.
    Array<uint32_t> without(memory);
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = set.size(); i-- > 0;) {
            without = set;
            without.erase(without.begin() + static_cast<ptrdiff_t>(i));
            if (!hides(state, view, settings, item, without)) continue;
            set = without;
            changed = true;
        }
    }
    return true;
}

/// Reports the set, with the pixels that each of it owns in the world of the set.
void HiderSearch::share(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
                        Array<Hider>& hiders) {
    Array<uint32_t> items(set.begin(), set.end(), memory);
    items.push_back(item);
    std::sort(items.begin(), items.end());
    const auto world = stateOfSome(state, items, memory);
    const auto self = static_cast<uint32_t>(std::lower_bound(items.begin(), items.end(), item) - items.begin());
    narrowTo(items, *world);
    trial.run(*world, view, settings, self);
    const uint32_t place = hierarchyPlace(*world, self);
    const PixelRect rect =
        ask(trial, trial.frame.inWindow(place, askLeaf(*world, place, view, trial.frame.screen).rect()));
    owners.run(trial, rect);
    collect(*world, self, trial, rect, true);
    uint64_t owned = 0;
    for (const Candidate& candidate : candidates) owned += candidate.pixels;
    for (const Candidate& candidate : candidates) {
        const ObjectRecord& object = world->object(candidate.item);
        const double share = owned ? static_cast<double>(candidate.pixels) / static_cast<double>(owned)
                                   : 1.0 / static_cast<double>(set.size());  // it touches no pixel
        hiders.push_back({object.id, object.key, share});
    }
}

}  // namespace sightline::detail
