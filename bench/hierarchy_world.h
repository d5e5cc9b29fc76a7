// What a world's commits cost while its objects come, move and go, and what queries of it cost then.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "bench/table.h"

namespace sightline::bench {

/// @param world  its name in the table
void addWorld(Table& table, const std::string& world, uint32_t count, int repeat);

}  // namespace sightline::bench
