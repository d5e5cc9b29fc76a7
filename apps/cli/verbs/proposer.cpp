// What a renderer that asks its GPU tells the query: which objects of an answer the image of that frame does not show.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/proposer.h"

#include "sightline/tools/truth/id_buffer.h"

namespace sightline::cli {

void Proposer::propose(const View& view, const std::vector<uint8_t>& reasons, Query& query) {
    hidden_.clear();
    shown_.assign(ids_.size(), 0);
    proposed_.resize(ids_.size());
    if (isUsable(view)) {
        const SightLines sight(view);
        drawIdBuffer(facts_, view, sight, {.supersampling = 1},
                     [&](uint32_t object, const glm::dvec2&) { shown_[object] = 1; });
        for (size_t object = 0; object < ids_.size(); ++object) {
            proposed_[object] = !shown_[object] && (proposed_[object] || reasons[object] == 0);
            if (proposed_[object]) hidden_.push_back(ids_[object]);
        }
    }
    query.propose(hidden_);
}

}  // namespace sightline::cli
