// What watches a traversal from outside: nobody, a clock, or a recorder.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/frame/frame.h"
#include "sightline/frame/stopwatch.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/query/traversal_record.h"

namespace sightline::detail {

/// Nobody watches.
struct Unwatched {
    void begin(const Frame&, TraversalState&) {}
    bool ended() const { return false; }
    void enter() {}                                                                         ///< a stage begins
    void leave(Stage, TraversalState&) {}                                                   ///< and has answered
    void culled(const PlaceRange&, Stage, const PixelRect*, uint32_t /*hider*/) {}          ///< of eight children
    void culledInTurn(const Pending&, Stage, Look) {}                                       ///< whose turn had come
    void kept(const Pending&, Look) {}                                                      ///< an object
    void offered(uint32_t /*place*/) {}                                                     ///< an object's occluder
    void drawn(uint32_t /*instance*/, uint32_t /*cluster*/, const BoxAnswer&, uint32_t) {}  ///< triangles
};

/// Takes the time that stages need for the children of nodes.
struct Timed : Unwatched {
    Stopwatch watch;

    void enter() { watch = Stopwatch(); }
    void leave(Stage stage, TraversalState& state) { state.stats.of(stage).nanoseconds += watch.nanoseconds(); }
};

/// Writes a record, and ends the traversal where the record asks for it.
struct Recorder : Unwatched {
    TraversalRecord& record;

    explicit Recorder(TraversalRecord& to) : record(to) {}

    void begin(const Frame&, TraversalState& state) {
        record.clear();
        state.tiles.log = record.log;
    }
    bool ended() const { return record.stopped; }
    void culled(const PlaceRange& places, Stage stage, const PixelRect* rect, uint32_t hider) {
        TraversalRecord::Cull note;
        note.places = places;
        note.stage = stage;
        note.off_screen = stage == Stage::kFrustum && rect;
        if (rect) note.rect = *rect;
        note.hider = hider;
        record.culls.push_back(note);
        if (stage != Stage::kFrustum && places.holds(record.stop_at)) record.stopped = true;
    }
    void culledInTurn(const Pending& entry, Stage stage, Look look) {
        culled(entry.below, stage, &entry.rect, TraversalRecord::kNowhere);
        record.culls.back().look = look;
        record.culls.back().boxed = look == Look::kBox || entry.testable;
    }
    void kept(const Pending& entry, Look look) {
        if (entry.index != record.stop_at) return;
        record.stopped = true;
        record.kept = {entry.rect, entry.testable, look};
    }
    void offered(uint32_t place) { record.owners.push_back(place); }
    void drawn(uint32_t instance, uint32_t cluster, const BoxAnswer& box, uint32_t triangles) {
        record.draws.push_back({instance, cluster, triangles, box});
        if (record.log) record.log->noteDraw();
    }
};

}  // namespace sightline::detail
