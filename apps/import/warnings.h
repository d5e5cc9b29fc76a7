// What Assimp says of a file that it nevertheless reads: what is missing or was left out.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::import {
using namespace tools;

/// Listens from its construction on; one at a time.
class Warnings {
public:
    Warnings();
    ~Warnings();
    Warnings(const Warnings&) = delete;
    Warnings& operator=(const Warnings&) = delete;

    /// Takes down one line, if it tells of geometry or materials that are not there.
    void hear(std::string line);
    /// A note for each kind of thing that is missing, up to eight, with how often.
    void send(SceneStreamWriter& out) const;

private:
    std::map<std::string, uint64_t> heard_;
};

}  // namespace sightline::import
