// What a renderer that asks its GPU tells the query: which objects of an answer the image of that frame does not show.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/query/query.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::cli {
using namespace tools;

/// Draws an id-buffer of one sample a pixel, as a GPU does, and proposes what it does not show. That is what samples say: it
/// is no proof, and stands one frame behind.
class Proposer {
public:
    /// @param scene  outlives it
    /// @param ids    per object of the scene; outlive it
    Proposer(const Scene& scene, const std::vector<ObjectId>& ids) : facts_(scene), ids_(ids) {}

    /// Proposes to the query what its last answer kept, and the image of that frame does not show, beside what was
    /// proposed before and is still not shown.
    /// @param reasons  of that answer, as Query::reasons()
    void propose(const View& view, const std::vector<uint8_t>& reasons, Query& query);

private:
    SceneFacts facts_;
    const std::vector<ObjectId>& ids_;
    std::vector<uint8_t> shown_, proposed_;  ///< per object
    std::vector<ObjectId> hidden_;
};

}  // namespace sightline::cli
