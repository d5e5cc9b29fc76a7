// The bytes of a checkpoint: a header with the hashes, the counters, and the matrices run by run.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/bake_state.h"

#include <bit>
#include <cstring>
#include <vector>

#include "sightline/bake/flow/bit_runs.h"
#include "sightline/bake/flow/thin_cells.h"
#include "sightline/base/bytes.h"
#include "sightline/base/random.h"

namespace sightline::bake {
namespace {

constexpr uint64_t kMagic = 0x33656b6162736c73ull;  // "slsbake3"

void putMatrix(ByteWriter& out, const BitMatrix& matrix) {
    for (size_t r = 0; r < matrix.rows(); ++r) putBits(out, matrix.row(r));
}

bool takeMatrix(ByteCursor& in, BitMatrix& matrix) {
    for (size_t r = 0; r < matrix.rows(); ++r)
        if (!takeBits(in, matrix.row(r), matrix.columns())) return false;
    return true;
}

Error wrong(const std::string& name, const char* what) { return {Error::Kind::kInput, name + ": " + what}; }

}  // namespace

uint64_t hashOf(const CellGraph& graph, double farthest) {
    const auto bytesOf = [](const auto& list) {
        return std::span<const char>(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
    };
    uint64_t hash = mixSeed(contentHash(bytesOf(graph.points)), graph.cells);
    for (const CellPortal& portal : graph.portals) {
        hash = mixSeed(hash, uint64_t{portal.cells[0]} << 32 | portal.cells[1]);
        hash = mixSeed(hash, uint64_t{portal.first} << 32 | portal.count);
    }
    return farthest > 0 ? mixSeed(hash, std::bit_cast<uint64_t>(farthest)) : hash;
}

std::string bakeStateBytes(const CellVisibilityState& state, uint64_t graph_hash, uint64_t budget, uint64_t work) {
    Array<char> bytes;
    ByteWriter out(bytes);
    out.put(kMagic);
    out.put(graph_hash);
    out.put(budget);
    out.put(work);
    out.put(state.flowed);
    out.put(state.over_budget);
    out.put(state.steps);
    out.put(state.work);
    out.put(state.empty_chains);
    for (const uint32_t p : state.order) out.put(p);
    putMatrix(out, state.may);
    putMatrix(out, state.witnessed);
    putMatrix(out, state.reached);
    out.put(contentHash(bytes));
    return {bytes.begin(), bytes.end()};
}

/// One of an older form is one, too: it is passed over, and no stranger's file.
bool isBakeState(std::span<const char> bytes) { return (ByteCursor(bytes).take<uint64_t>() ^ kMagic) << 8 == 0; }

Result<CellVisibilityState> readBakeState(std::span<const char> bytes, const std::string& name, const CellGraph& graph,
                                          uint64_t budget, double farthest, uint64_t work) {
    constexpr size_t kHead = 9 * 8, kEnd = 8;
    const ThinMerged thin = mergeThinCells(graph);
    const CellGraph& baked = thin.any ? thin.graph : graph;
    const size_t ways = 2 * baked.portals.size();
    ByteCursor in(bytes);
    if (bytes.size() < kHead + kEnd || in.take<uint64_t>() != kMagic) return wrong(name, "no state of a bake");
    ByteCursor end(bytes.last(kEnd));
    if (end.take<uint64_t>() != contentHash(bytes.first(bytes.size() - kEnd))) return wrong(name, "damaged");
    if (in.take<uint64_t>() != hashOf(graph, farthest)) return wrong(name, "the state of another bake");
    const uint64_t its_budget = in.take<uint64_t>(), its_work = in.take<uint64_t>();
    if (its_budget != budget || its_work != work) return wrong(name, "the state of a bake with another budget");
    CellVisibilityState state;
    state.flowed = in.take<uint64_t>();
    state.over_budget = in.take<uint64_t>();
    state.steps = in.take<uint64_t>();
    state.work = in.take<uint64_t>();
    state.empty_chains = in.take<uint64_t>();
    if (state.flowed > ways || in.left() < 4 * ways) return wrong(name, "damaged");
    std::vector<uint8_t> seen(ways, 0);
    for (size_t i = 0; i < ways; ++i) {
        const uint32_t p = in.take<uint32_t>();
        if (p >= ways || seen[p]++) return wrong(name, "damaged");
        state.order.push_back(p);
    }
    state.may = BitMatrix(ways, ways);
    state.witnessed = BitMatrix(baked.cells, baked.cells);
    state.reached = BitMatrix(baked.cells, baked.cells);
    for (BitMatrix* matrix : {&state.may, &state.witnessed, &state.reached})
        if (!takeMatrix(in, *matrix)) return wrong(name, "damaged");
    if (in.left() != kEnd) return wrong(name, "damaged");
    return state;
}

}  // namespace sightline::bake
