// Small archives, made in memory: .pak, and .pk3 with entries as they are or deflated.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sightline::test {

struct MadeEntry {
    std::string name, bytes;
    bool deflated = true;  ///< in a .pk3
};

std::string pakBytes(const std::vector<MadeEntry>& entries);
/// @param before  what stands before the archive, as a program that unpacks itself
std::string pk3Bytes(const std::vector<MadeEntry>& entries, const std::string& before = "");

}  // namespace sightline::test
