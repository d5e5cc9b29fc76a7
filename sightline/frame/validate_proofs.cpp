// Whether a query's certificates name what there is: in debug builds, after each answer.
// SPDX-License-Identifier: MIT
#include "sightline/frame/validate_proofs.h"

#ifdef SIGHTLINE_DEBUG_ASSERTS

#include <bit>

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

/// How many hiders there are, for certificates that name them by number.
void validateCertificate(const Certificate& certificate, size_t hiders) {
    SIGHTLINE_DEBUG_ASSERT(certificate.count <= Certificate::kMost);
    for (const uint32_t hider : certificate.all()) SIGHTLINE_DEBUG_ASSERT(hider < hiders);
}

}  // namespace

void validateProofs(const ProofMemory& proofs) {
    const size_t hiders = proofs.hiders_.size(), certificates = proofs.certificates_.size();
    for (const Certificate& certificate : proofs.certificates_) validateCertificate(certificate, hiders);
    validateCertificate(proofs.latest_, hiders);
    for (const uint32_t last : proofs.last_) SIGHTLINE_DEBUG_ASSERT(last == ProofMemory::kNone || last < hiders);

    // Each certificate belongs to one node or object, or is free.
    uint64_t count = proofs.free_.size(), sum = 0;
    for (const uint32_t free : proofs.free_) {
        SIGHTLINE_DEBUG_ASSERT(free < certificates);
        sum += free;
    }
    for (const Array<uint32_t>* numbers : {&proofs.of_node_, &proofs.of_place_})
        for (const uint32_t number : *numbers) {
            if (number == 0 || (number & ProofMemory::kFailed)) continue;
            SIGHTLINE_DEBUG_ASSERT(number <= certificates);
            ++count;
            sum += number - 1;
        }
    SIGHTLINE_DEBUG_ASSERT(count == certificates);
    SIGHTLINE_DEBUG_ASSERT(2 * sum == uint64_t{certificates} * (certificates > 0 ? certificates - 1 : 0));
    SIGHTLINE_DEBUG_ASSERT(proofs.seen_node_.size() >= proofs.of_node_.size());
    SIGHTLINE_DEBUG_ASSERT(proofs.seen_place_.size() >= proofs.of_place_.size());

    SIGHTLINE_DEBUG_ASSERT(proofs.number_.empty() || std::has_single_bit(proofs.number_.size()));
    SIGHTLINE_DEBUG_ASSERT(2 * hiders <= proofs.number_.size());
    size_t numbered = 0;
    for (const uint32_t number : proofs.number_) {
        SIGHTLINE_DEBUG_ASSERT(number <= hiders);
        numbered += number != 0;
    }
    SIGHTLINE_DEBUG_ASSERT(numbered == hiders);
    for (const ProofMemory::Hider& hider : proofs.hiders_)
        SIGHTLINE_DEBUG_ASSERT(hider.answer != proofs.answer_ || hider.shadow == ProofMemory::kNone ||
                               hider.shadow < proofs.shadows_.size());

    SIGHTLINE_DEBUG_ASSERT(proofs.places_.empty() || proofs.places_.size() == ProofMemory::kPlaces);
    SIGHTLINE_DEBUG_ASSERT(proofs.hit_count_ <= std::size(proofs.hits_));
    SIGHTLINE_DEBUG_ASSERT(proofs.way_ == ProofMemory::Way::kTiles || proofs.possible_);
    SIGHTLINE_DEBUG_ASSERT(proofs.found <= proofs.sought + proofs.proposals_tried_);
    for (const ProofMemory::Hidden& one : proofs.hidden) SIGHTLINE_DEBUG_ASSERT(one.kind != Pending::Kind::kCluster);
    for (const ProofMemory::Culled& one : proofs.culled) {
        SIGHTLINE_DEBUG_ASSERT(one.places.count > 0 && one.places.empty < one.places.count);
        validateCertificate(one.certificate, hiders);
    }
    for (const ProofMemory::Proposal& one : proofs.proposed_)
        SIGHTLINE_DEBUG_ASSERT(one.rest == 0 ||
                               (one.rest >= ProofMemory::kShortestRest && one.rest <= ProofMemory::kLongestRest));
}

}  // namespace sightline::detail

#endif
