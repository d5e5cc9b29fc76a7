// Lets a script for Node.js read IFC, by web-ifc, and takes its place until it ends.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace sightline::import {

/// Runs ifc/read_ifc.mjs, which lies beside this program, and ends this process as the script has ended: with its exit
/// code, by its signal, or with kImportOutOfMemory where it lacked memory. The script writes the stream to standard output.
/// Returns only where it cannot be run: what is missing and what to do, without the file's name.
/// @param memory  that the script may have: private memory  [bytes]; 0: no limit
std::string readWithNode(const std::string& file, const std::string& suffix, uint64_t memory);

}  // namespace sightline::import
