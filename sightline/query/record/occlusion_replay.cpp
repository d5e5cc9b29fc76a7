// Does again what a recorded frame did to its occlusion buffer, compares the answers, and takes the time.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/occlusion_replay.h"

#include <bit>
#include <chrono>
#include <cstdio>

namespace sightline {
namespace {

using Clock = std::chrono::steady_clock;

uint64_t since(Clock::time_point start) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
}

/// The index into the list of its kind that a call stands for.
uint64_t indexInKind(const TileLog& asked, uint64_t call) {
    uint64_t index = 0;
    for (uint64_t i = 0; i < call; ++i) index += asked.calls[i] == asked.calls[call];
    return index;
}

}  // namespace

OcclusionReplay::OcclusionReplay(const OcclusionRecording& recording, Memory* memory)
    : recording_(recording),
      screen_(makeScreen(recording.view, recording.settings.occlusion_size)),
      instances_(memory),
      boxes_(memory),
      tiles_(memory) {
    instances_.reserve(recording.instances.size());
    for (const auto& instance : recording.instances)
        instances_.push_back(makeOccluderInstance(screen_, recording.occluders[instance.occluder], instance.transform));
    boxes_.reserve(recording.draws.size());
    for (const auto& draw : recording.draws) {
        const OccluderInstance& instance = instances_[draw.instance];
        const ScreenAnswer eight = projectClusters(instance.screen, *instance.occluder, draw.cluster);
        boxes_.emplace_back(eight, 0);
    }
}

void OcclusionReplay::clearTiles() {
    tiles_.clear(screen_.width, screen_.height,
                 recording_.settings.masked ? OcclusionDetail::kMasked : OcclusionDetail::kFull);
    tiles_.gap = recording_.settings.close_gaps;
}

void OcclusionReplay::drawOne(uint64_t index, ReplayAnswer& answer) {
    const auto& draw = recording_.draws[index];
    if (boxes_[index].outside) return;
    answer.triangles += drawOccluder(tiles_, instances_[draw.instance], draw.cluster, boxes_[index]);
}

ReplayAnswer OcclusionReplay::run() {
    ReplayAnswer answer;
    const TileLog& asked = recording_.asked;
    uint64_t draw = 0, rect = 0, tile = 0, nearness = 0;
    float nearest[64] = {};
    const auto compare = [&](bool same, uint64_t call) {
        if (same) return;
        if (answer.differences++ == 0) answer.different = call;
    };
    // A box knows what it was told of planes, so it stays while the tests that follow ask about it.
    OccludeeBox box{OccludeeBox::Image()};
    uint32_t known = TileLog::kNoBox;
    const auto boxAt = [&](uint32_t index) -> const OccludeeBox* {
        if (index == TileLog::kNoBox) return nullptr;
        if (index != known) box = OccludeeBox(asked.boxes[known = index]);
        return &box;
    };
    const auto start = Clock::now();
    clearTiles();
    for (uint64_t call = 0; call < asked.calls.size(); ++call) {
        if (asked.calls[call] == TileLog::Call::kDraw) {
            drawOne(draw++, answer);
        } else if (asked.calls[call] == TileLog::Call::kRect) {
            const TileLog::RectTest& test = asked.rects[rect++];
            const bool hidden = isHidden(tiles_, test.rect, test.seams, boxAt(test.box));
            answer.hidden += hidden;
            compare(hidden == test.hidden, call);
        } else {
            const TileLog::TileTest& test = asked.tiles[tile++];
            for (uint64_t left = test.window; left; left &= left - 1)
                nearest[std::countr_zero(left)] = asked.nearest[nearness++];
            const uint32_t place = test.tile / tiles_.columns * tiles_.stride + test.tile % tiles_.columns;
            compare(openPixels(tiles_, place, test.window, nearest, test.seams, boxAt(test.box)) == test.open, call);
        }
    }
    answer.nanoseconds = since(start);
    return answer;
}

uint64_t OcclusionReplay::draw() {
    ReplayAnswer ignored;
    const auto start = Clock::now();
    clearTiles();
    for (uint64_t index = 0; index < recording_.draws.size(); ++index) drawOne(index, ignored);
    return since(start);
}

std::string describeTest(const OcclusionRecording& recording, uint64_t call) {
    const TileLog& asked = recording.asked;
    const uint64_t index = indexInKind(asked, call);
    char text[160];
    if (asked.calls[call] == TileLog::Call::kRect) {
        const TileLog::RectTest& test = asked.rects[index];
        std::snprintf(text, sizeof text, "the rectangle (%d, %d) to (%d, %d) at nearness %.9g: %s", test.rect.x0,
                      test.rect.y0, test.rect.x1, test.rect.y1, static_cast<double>(test.rect.nearness),
                      test.hidden ? "hidden" : "open");
    } else {
        const TileLog::TileTest& test = asked.tiles[index];
        const uint32_t columns = makeScreen(recording.view, recording.settings.occlusion_size).width / 8;
        std::snprintf(text, sizeof text, "%d pixels of the tile at (%u, %u): %d open", std::popcount(test.window),
                      8 * (test.tile % columns), 8 * (test.tile / columns), std::popcount(test.open));
    }
    return text;
}

}  // namespace sightline
