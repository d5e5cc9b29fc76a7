// A checkpoint of a bake as bytes, so that another process can go on from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/base/result.h"

namespace sightline::bake {

/// A number that two bakes share only if their graphs (cells, portals and points, to the last bit) and
/// CellVisibilitySettings::farthest are the same.
uint64_t hashOf(const CellGraph& graph, double farthest = 0);

/// The bytes: small where the matrices are empty far and wide.
/// @param budget, work  CellVisibilitySettings
std::string bakeStateBytes(const CellVisibilityState& state, uint64_t graph_hash, uint64_t budget, uint64_t work = 0);

/// Whether bytes begin as a state does.
bool isBakeState(std::span<const char> bytes);

/// The state again. Errors (kInput): one line with the file: no such file, of another bake, damaged.
/// @param name      what errors call the bytes
/// @param farthest  CellVisibilitySettings
Result<CellVisibilityState> readBakeState(std::span<const char> bytes, const std::string& name, const CellGraph& graph,
                                          uint64_t budget, double farthest = 0, uint64_t work = 0);

}  // namespace sightline::bake
