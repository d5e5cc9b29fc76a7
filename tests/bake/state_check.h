// What must hold for whatever is read as the state of a bake: a journal of rows, the state of cells, or both.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sightline/bake/flow/bake_state.h"
#include "sightline/bake/soup/soup_cells.h"
#include "sightline/bake/view_cells/portal_rows.h"
#include "sightline/bake/view_cells/view_cells.h"
#include "sightline/base/bytes.h"
#include "tests/bake/flow/cell_worlds.h"
#include "tests/bake/marked/made_rooms.h"
#include "tests/support/line_fault.h"

namespace sightline::test {
using namespace bake;

/// A bake that is over in a few milliseconds.
struct SmallBake {
    Scene scene;
    SoupCells soup;
    CellGraph graph;

    SmallBake() {
        MarkedRooms made;  // two rooms with a hole between them, and boards
        const FlatRect section{{0, 0}, {3, 4}}, hole{{0.5, 1}, {2, 2}};
        made.room({{0, 0, 0}, {3, 3, 4}}, 2);
        made.room({{3.25, 0, 0}, {6, 3, 4}}, 1);
        made.wall(0, 3, section, -1, {hole});
        made.wall(0, 3.25, section, 1, {hole});
        for (const double x : {0.5, 3.5, 4.5, 5.5}) made.wall(0, x, {{0.2, 2.5}, {1.7, 3.5}}, x < 3 ? -1 : 1);
        scene = made.scene;
        SoupCellSettings coarse;
        coarse.smallest_occluder = 1;
        soup = cellsOfSoup(scene, coarse);
        RoomSettings rooms;
        rooms.rooms[0] = 3;
        rooms.rooms[1] = 2;
        graph = gridOfRooms(1, rooms);
    }
    /// What view cells see, with their walls and what portals take away; a journal answers what it knows, and is told the rest.
    BitMatrix rows(RowJournal& journal) const {
        ViewCellSettings settings;
        settings.most_cells = 48;
        settings.least_hidden = 0;
        settings.journal = &journal;
        ViewCells cells = viewCellsOf(scene, settings);
        std::vector<uint32_t> all(scene.objects.size());
        for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        PortalRowSettings narrowing;
        narrowing.journal = &journal;
        narrowRows(cells.tree, soup.space, scene, all, narrowing, cells.visible);
        return std::move(cells.visible);
    }
    /// The bytes at a checkpoint.
    std::string cellState(uint64_t checkpoint) const {
        std::string bytes;
        CellVisibilitySettings settings;
        settings.checkpoint = [&](const CellVisibilityState& state) {
            if (checkpoint-- == 0) bytes = bakeStateBytes(state, hashOf(graph), 0);
        };
        bakeCellVisibility(graph, settings);
        return bytes;
    }
};

inline const SmallBake& smallBake() {
    static const SmallBake bake;
    return bake;
}

/// The questions and answers of a journal.
inline std::vector<std::pair<uint64_t, std::string>> answersOf(const RowJournal& journal) {
    std::vector<std::pair<uint64_t, std::string>> answers;
    const std::string bytes = journal.bytes();
    for (size_t at = 16; at + 8 < bytes.size();) {
        ByteCursor in(std::span<const char>(bytes).subspan(at));
        const uint64_t question = in.take<uint64_t>();
        const uint32_t length = in.take<uint32_t>();
        answers.emplace_back(question, bytes.substr(at + 12, length));
        at += 12 + length;
    }
    return answers;
}

/// Empty, or what is wrong with the answer to these bytes.
inline std::string bakeStateFault(std::span<const char> bytes) {
    const SmallBake& bake = smallBake();
    std::span<const char> rest = bytes;
    const Result<RowJournal> journal = RowJournal::takenOff(rest, "x.state");
    if (!journal) return lineFault(journal.error(), "x.state");
    if (journal->size() > 0) {
        const std::string again = journal->bytes();
        std::span<const char> left = again;
        const Result<RowJournal> second = RowJournal::takenOff(left, "x.state");
        if (!second || !left.empty() || second->bytes() != again) return "a journal that was written is not read";
        // Its answers to a bake's questions: rows come out, whatever they are.
        static const auto questions = [&] {
            RowJournal all;
            bake.rows(all);
            return answersOf(all);
        }();
        const auto answers = answersOf(*journal);
        RowJournal asked;
        for (size_t i = 0; i < std::min(questions.size(), answers.size()); ++i)
            asked.add(questions[i].first, answers[i].second);
        const BitMatrix rows = bake.rows(asked);
        if (rows.rows() == 0 || rows.columns() != bake.scene.objects.size()) return "rows are missing";
    }
    if (rest.empty()) return "";
    Result<CellVisibilityState> state = readBakeState(rest, "x.state", bake.graph, 0);
    if (!state) return lineFault(state.error(), "x.state");
    const std::string again = bakeStateBytes(*state, hashOf(bake.graph), 0);
    const Result<CellVisibilityState> second = readBakeState(again, "x.state", bake.graph, 0);
    if (!second || bakeStateBytes(*second, hashOf(bake.graph), 0) != again)
        return "a state that was written is not read";
    CellVisibilitySettings settings;
    settings.resume = &*state;
    const CellVisibility seen = bakeCellVisibility(bake.graph, settings);
    return seen.visible.rows() == bake.graph.cells ? "" : "cells are missing";
}

/// Bytes that have the hashes, sizes and names that the reader asks for: what is behind these is then read, too.
inline std::string sealedState(std::span<const char> bytes) {
    std::string out(bytes.begin(), bytes.end());
    const auto put = [&](size_t at, uint64_t number) {
        for (size_t i = 0; i < 8; ++i) out[at + i] = static_cast<char>(number >> 8 * i);
    };
    const auto sealEnd = [&](size_t begin, size_t end) {
        put(end - 8, contentHash(std::span<const char>(out).subspan(begin, end - begin - 8)));
    };
    size_t begin = 0;
    if (RowJournal::begins(bytes) && out.size() >= 24) {
        ByteCursor in(bytes.subspan(8));
        const auto size = static_cast<size_t>(std::clamp<uint64_t>(in.take<uint64_t>(), 24, out.size()));
        put(8, size);
        sealEnd(0, size);
        begin = size;
    }
    if (out.size() - begin >= 64) {
        put(begin + 8, hashOf(smallBake().graph));
        put(begin + 16, 0);  // its budget
        sealEnd(begin, out.size());
    }
    return out;
}

}  // namespace sightline::test
