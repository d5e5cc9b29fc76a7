// What the reader of foreign formats may take: memory, time, and no longer than who asked for it.
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace sightline::import {

struct Limits {
    uint64_t memory = 0;   ///< address space [bytes]; 0: no limit
    uint64_t seconds = 0;  ///< of the processor; 0: no limit
    pid_t parent = 0;      ///< the process ends with this one; 0: with none
};

/// Sets them for this process, for good. Also: no core files, no files written, and an allocation that fails ends the
/// process with kImportOutOfMemory. Memory is not limited in builds with address or thread sanitizers, which reserve all of it.
void setLimits(const Limits& limits);

}  // namespace sightline::import
