// Whose turn it is to be asked: nodes and objects that were kept before are kept for a few answers without a question.
// SPDX-License-Identifier: MIT
//
// Jiri Bittner, Michael Wimmer, Harald Piringer, Werner Purgathofer. Coherent Hierarchical Culling: Hardware Occlusion
// Queries Made Useful. 2004.
#pragma once

#include <cstdint>

#include "sightline/frame/frame.h"
#include "sightline/frame/pending.h"

namespace sightline::detail {

/// What a traversal remembers of each node and each object: when it was asked last, and what it answered. An answer may
/// stand while the eye has moved little for the distance, or for the size of what stands around it, and layers, sections and stages are the same; each time it is
/// found again it may stand twice as long.
///
/// To keep what is not asked is sound, whatever is remembered. So what has moved to another place of the hierarchy
/// meanwhile, or is seen in quite another view, costs some objects that are hidden, and nothing else.
class Turns {
public:
    explicit Turns(Memory* memory) : objects_(memory), nodes_(memory) {}

    /// Takes up a view. Nothing stands in parallel views, and with QuerySettings::stateless.
    /// @param by_proofs  hidden is what is proved so: answers may stand longer, for questions are the greater part of the work
    void begin(const Frame& frame, bool by_proofs);
    /// Whether a node or an object may be kept without a question.
    bool mayStand(const Pending& entry) const;
    /// Notes what was found of a node or an object that was asked.
    void note(const Pending& entry, bool kept);
    /// Whether the object at a place of the hierarchy was kept without a question, if the last answer kept it.
    bool wasUnasked(uint32_t place) const;

private:
    static constexpr uint32_t kEyes = 64;  ///< answers of which the eye is remembered

    struct Turn {
        uint16_t answer = 0;  ///< that asked it: the lower half of its number
        uint8_t wait = 0;     ///< answers for which it may stand, and up to twice as many: that spreads the questions
        bool kept = false;
    };

    Array<Turn> objects_, nodes_;  ///< by place; by node
    glm::dvec3 eyes_[kEyes] = {};  ///< by the number of the answer
    uint32_t answer_ = 0;
    uint32_t since_ = 0;  ///< the answer from which on the same was asked for
    uint32_t layers_ = 0, stages_ = 0;
    ViewPlanes sections_;
    bool by_proofs_ = false;
    double little_ = 0;  ///< the way that an eye may go, as a part of the distance or of the size
    uint32_t most_ = 0;  ///< answers that any may stand; 0: nothing is remembered
    size_t places_ = 0, node_count_ = 0;
};

}  // namespace sightline::detail
