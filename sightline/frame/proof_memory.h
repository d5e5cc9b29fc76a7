// The certificates of a query: which parts of which objects hid each node and each object, and when to rest on them.
// SPDX-License-Identifier: MIT
//
// Satyan Coorg, Seth Teller. Temporally Coherent Conservative Visibility. 1996.
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
// Tom Hudson, Dinesh Manocha, Jonathan Cohen, Ming Lin, Kenneth Hoff, Hansong Zhang. Accelerated Occlusion Culling Using
// Shadow Frusta. 1997.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/cull/occluder_volumes.h"
#include "sightline/cull/proofs/image_frame.h"
#include "sightline/cull/proofs/uncovered.h"
#include "sightline/frame/frame.h"
#include "sightline/frame/pending.h"
#include "sightline/frame/stats.h"

namespace sightline::detail {

/// A part of an object that hides others, as VolumeParts::part() counts them.
struct HidingPart {
    static constexpr uint32_t kNone = ~0u;
    ObjectId object;
    uint32_t part = 0;
    ObjectId other;  ///< of a seam: a face of this object meets a face of that one
    uint32_t other_part = kNone;
    bool operator==(const HidingPart&) const = default;
};

/// Parts that together hid a node or an object.
struct Certificate {
    static constexpr uint32_t kMost = 12;
    uint32_t count = 0;
    bool closely = false;    ///< of an object: polygon by polygon
    uint32_t hiders[kMost];  ///< of ProofMemory

    std::span<const uint32_t> all() const {
        SIGHTLINE_DEBUG_ASSERT(count <= kMost);
        return {hiders, count};
    }
};

/// What one traversal remembers of who hid what, and what it has made for the view at hand.
///
/// Nothing here is trusted. A certificate is a guess whom to ask first: who hides, where it stands, and what it hides is
/// found anew for each view. So it does no harm where a node or a place holds something else by now.
class ProofMemory {
public:
    /// How an answer finds what is hidden.
    enum class Way : uint8_t {
        kTiles,         ///< by drawing
        kTilesAndSeek,  ///< the same; then certificates are sought for what is hidden
        kProofs,        ///< by certificates alone: nothing is drawn
    };

    static constexpr uint32_t kMostSought = 32;  ///< for one view

    explicit ProofMemory(Memory* memory)
        : of_node_(memory),
          of_place_(memory),
          seen_node_(memory),
          seen_place_(memory),
          certificates_(memory),
          free_(memory),
          hiders_(memory),
          number_(memory),
          shadows_(memory),
          nodes_(memory),
          faces_(memory),
          places_(memory),
          hidden(memory),
          culled(memory),
          proposed_(memory),
          found_nodes_(memory),
          found_places_(memory) {}

    /// Takes up a view, and decides how it is answered.
    /// @param proposed  objects that somebody else takes to be hidden; others are passed over
    void begin(const Frame& frame, std::span<const ObjectId> proposed = {});
    Way way() const { return way_; }
    /// Whether answers for this view may rest on certificates.
    bool possible() const { return possible_; }
    /// Takes over what another memory found for its last view: who hides what has no certificate here. From then on the
    /// other one is a teacher: it draws each view, and seeks certificates for all that it finds hidden. This one is taught:
    /// for some answers it seeks nothing, and draws nothing but at a cut. O(what was found).
    void learn(ProofMemory& teacher);
    /// Whether another memory draws for this one.
    bool taught() const { return isBefore(taught_until_); }
    /// No certificate is sought, or no more, for something in this view, which is kept. If that happens too often, it is
    /// answered by drawing.
    void passOver(size_t visible) {
        ++passed_over_;
        if (taught() && passed_over_ > 64 + visible / 2) way_ = Way::kTiles;
        if (!taught() && passed_over_ > 16 + visible / 8) way_ = Way::kTilesAndSeek;
    }
    /// What was found to be hidden by drawing, where certificates are sought.
    struct Hidden {
        Box3f box;
        uint32_t index = 0;
        Pending::Kind kind = Pending::Kind::kNode;
        PlaceRange below;
    };

    /// What this answer culled, and by which certificate.
    struct Culled {
        PlaceRange places;
        Certificate certificate;
    };

    /// Whether the certificate of a node or an object holds; what does not hold is forgotten.
    bool holds(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box);
    bool hasCertificate(Pending::Kind kind, uint32_t index) const;
    /// Names who may hide a node or an object together, from wherever that is known; of more than Certificate::kMost the
    /// first.
    void propose(const Frame& frame, Pending::Kind kind, uint32_t index, std::span<const HidingPart> parts,
                 bool closely = false);
    /// What is proposed and has a certificate, or may be worth the search for one. Where it was sought in vain, nobody
    /// seeks again for some answers.
    bool isProposed(const Pending& entry) const;
    /// Whether what is proposed has a certificate that holds, or one is found, within a budget.
    bool proveProposed(const Frame& frame, const Pending& entry);
    /// Looks for a certificate: by the parts that hid something just now, then by rays.
    /// @param closely  polygon by polygon, too: of what is surely hidden, or was hidden just now
    bool seek(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, bool closely);
    /// Looks for certificates for all that is `hidden`, within a budget, and decides how the next view is answered. After
    /// a cut nobody looks: what is found helps if views follow one another.
    void seekAll(const Frame& frame, const QueryStats& stats, size_t visible);
    /// A view was answered: compares the work of both ways, and decides how the next one is.
    void noteAnswered(const QueryStats& stats, size_t visible);

    /// Of the last certificate that held or was found, if it names nobody: whether the middle of a face of the
    /// object that it culls lies in the view, and looks away. It decides nothing but what is told.
    bool looksAway(const Frame& frame, const Pending& entry) const;

    /// The parts whose shadows hid a node or an object by the last certificate that held or was found; good until the
    /// next call.
    Certificate certificateOf(Pending::Kind kind, uint32_t index) const;
    HidingPart hider(uint32_t number) const {
        SIGHTLINE_DEBUG_ASSERT(number < hiders_.size());
        return hiders_[number].part;
    }
    /// Calls visit(object, part) for each part that a certificate names, and the object that it is of; of a seam both.
    template <class Visitor>
    void forEachNamed(const Frame& frame, const Certificate& certificate, Visitor visit) const {
        const auto name = [&](ObjectId object, uint32_t part) {
            const uint32_t at = frame.world->placeOf(object);
            if (at != PlacedBvh::kNone && part != HidingPart::kNone) visit(frame.world->placed[at].visible, part);
        };
        for (const uint32_t number : certificate.all()) {
            const HidingPart part = hider(number);
            name(part.object, part.part);
            name(part.other, part.other_part);
        }
    }
    /// Where a part stands, as the eye of the view at hand sees it: corners relative to the eye.
    /// @returns false if it hides nothing in this view
    bool outlineOf(const Frame& frame, ObjectId object, uint32_t part, VolumeOutline& outline) const;

    uint32_t proposalsTried() const { return proposals_tried_; }
    uint32_t sought = 0;  ///< for this view; without proposals
    uint32_t found = 0;
    uint64_t rays = 0;
    uint64_t cuts() const { return rest_.cuts() - cuts_before_; }
    uint64_t polygons = 0;  ///< of occludees that were turned towards the eye or away from it

private:
#ifdef SIGHTLINE_DEBUG_ASSERTS
    friend void validateProofs(const ProofMemory& proofs);
#endif
    bool teaches() const { return isBefore(teaches_until_); }
    bool isBefore(uint32_t answer) const { return static_cast<int32_t>(answer - answer_) > 0; }

    static constexpr uint32_t kNone = ~0u;
    static constexpr uint32_t kPlaces = 256;  ///< objects whose place in the view is remembered
    static constexpr uint32_t kLast = 4;
    static constexpr uint32_t kMostPolygons = 48;   ///< of an object that is one body
    static constexpr uint32_t kMostClusters = 128;  ///< of an object; one of more is one body, by its box
    /// Answers until what was sought in vain is sought again: twice as many each time.
    static constexpr uint32_t kShortestRest = 16, kLongestRest = 256;
    static constexpr uint32_t kFailed = 1u << 31;   ///< with the answer in which nothing was found
    static constexpr uint32_t kClosely = 1u << 30;  ///< with kFailed: polygon by polygon
    static constexpr uint32_t kTaught = 128;        ///< answers for which what was learned may do

    struct Proposal {
        uint32_t answer = 0;  ///< the last for which the object was proposed
        uint32_t again = 0;   ///< from which on a certificate is sought again; 0: always
        uint32_t rest = 0;    ///< how long nobody sought, the last time
    };
    struct Hider {
        HidingPart part;
        uint32_t answer = 0;  ///< for which `shadow` was made
        uint32_t shadow = kNone;
    };
    /// An object that may hide, as this view has it.
    struct Place {
        uint32_t answer = 0, place = kNone;
        bool hides = false;
        const HeldOccluder* occluder = nullptr;
        VolumePlace at;
    };
    /// What of a node or an object is held against shadows at once.
    struct Body {
        enum Form : uint8_t {
            kWhole,    ///< the box around all of it: for single shadows
            kBox,      ///< the box around a cluster
            kHull,     ///< of the polygons that may face the eye
            kPolygon,  ///< one of these
        };
        uint32_t first = 0, end = 0;  ///< clusters of the object's shape
        Form form = kHull;
        uint32_t polygon = 0;
    };
    /// Its corners, relative to the eye.
    struct Corners {
        glm::dvec3 at[Uncovered::kMostCorners];
        uint32_t count = 0;  ///< 0: nothing of it faces the eye
        double error = 0;    ///< no corner lies elsewhere by more
        bool box = true;     ///< they are those of a box
    };
    struct Hit {
        double t;
        uint32_t place, part;
    };

    Array<uint32_t>& numbers(Pending::Kind kind) { return kind == Pending::Kind::kNode ? of_node_ : of_place_; }
    const Array<uint32_t>& numbers(Pending::Kind kind) const {
        return kind == Pending::Kind::kNode ? of_node_ : of_place_;
    }
    void forget(Pending::Kind kind, uint32_t index);
    void handDown(const Frame& frame, uint32_t node, const Certificate& certificate);
    void note(const Frame& frame, std::span<const ObjectId> proposed);
    void makeRoom(Pending::Kind kind, size_t size);
    void makeRoom(const Frame& frame, Pending::Kind kind, uint32_t index);
    Array<uint32_t>& seen(Pending::Kind kind) { return kind == Pending::Kind::kNode ? seen_node_ : seen_place_; }
    bool isStillSeen(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box);
    bool noteFailed(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, bool closely);
    bool hasFailed(Pending::Kind kind, uint32_t index) const;
    void write(Pending::Kind kind, uint32_t index, const Certificate& certificate);
    uint32_t numberOf(const HidingPart& part);
    const Shadow* shadowOf(const Frame& frame, uint32_t hider);
    bool makeVolumeOf(const Frame& frame, const HidingPart& part, OccluderVolume& volume);
    bool take(const Frame& frame, const HidingPart& part, Certificate& certificate);
    double shareOf(const Frame& frame, uint32_t hider, const Certificate& certificate);
    bool takeHit(const Frame& frame, double enters, Certificate& certificate);
    bool takeSeam(const Frame& frame, Certificate& certificate);
    const Place& placeAt(const Frame& frame, uint32_t place);
    void lookAt(const Frame& frame, uint32_t place, Place& out) const;
    const Occluder* shapeAt(const Frame& frame, uint32_t place) const;
    uint32_t clustersOf(const Frame& frame, Pending::Kind kind, uint32_t index) const;
    template <class Try>
    bool forEachBody(const Frame& frame, Pending::Kind kind, uint32_t index, bool closely, Try hides) const;
    void takeUpObject(const Frame& frame, uint32_t place, const Body& body);
    void takeUp(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, const Body& body);
    bool hiddenBy(const Frame& frame, const Certificate& certificate, const Body& body);
    bool hiddenByLast(const Frame& frame, Certificate& out);
    bool isCovered(const Frame& frame, const Certificate& certificate, Pending::Kind kind, uint32_t index,
                   const Box3f& box);
    bool seekBody(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, const Body& body,
                  Certificate& out);
    uint32_t seekBelow(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box);
    void rest();
    double workOf(const QueryStats& stats) const;
    void noteTaught(const QueryStats& stats, size_t visible);
    void shoot(const Frame& frame, const glm::dvec3& direction, double far);
    void meet(const Frame& frame, uint32_t place, const glm::dvec3& direction, double far);
    void clear();

    Array<uint32_t> of_node_, of_place_;      ///< 1 + index into certificates_, or kFailed; 0: none
    Array<uint32_t> seen_node_, seen_place_;  ///< where on its box it was seen: a ray met nobody before; 0: not known
    Array<Certificate> certificates_;
    Array<uint32_t> free_;
    Array<Hider> hiders_;
    Array<uint32_t> number_;  ///< a hash table of 1 + index into hiders_
    Array<Shadow> shadows_;
    Array<uint32_t> nodes_;
    Array<uint32_t> faces_;
    Array<Place> places_;  ///< [size: kPlaces]
    Hit hits_[16];
    uint32_t hit_count_ = 0;
    glm::dvec3 last_ray_{0.0};  ///< that met nobody: to where it enters the box; 0: none, or the eye is in the box
    uint32_t last_[kLast] = {kNone, kNone, kNone, kNone};
    Certificate latest_;  ///< that was found
    Corners corners_;     ///< of the body at hand
    Uncovered rest_;      ///< and what is left of it
    VolumeView view_;
    ImageFrame image_;

    Way way_ = Way::kTiles;
    bool possible_ = false;  ///< for this view
    bool looks_away_ = false;
    uint64_t cuts_before_ = 0;  ///< Uncovered::cuts() at the start of the answer
    uint32_t passed_over_ = 0;
    bool spent_ = false;  ///< certificates were not sought for all
    uint32_t answer_ = 0;
    uint32_t answers_ = 0;     ///< by certificates, since something was drawn
    uint32_t rest_until_ = 0;  ///< the answer up to which certificates are not sought: they did not do
    uint32_t rest_for_ = 0;
    uint32_t drawn_ = 0;                      ///< views in turn for which certificates were not sought to the end
    uint64_t drawn_visible_ = 0;              ///< of the last answer that was drawn
    double drawn_work_ = 0, proof_work_ = 0;  ///< of an answer, about  [microseconds]
    double expected_work_ = 0;                ///< of an answer that rests on what has been found so far
    bool next_by_proofs_ = false;
    uint32_t layers_ = 0, stages_ = 0;
    uint32_t proposals_tried_ = 0;                            ///< in this answer
    uint64_t rays_of_proposals_ = 0, cuts_of_proposals_ = 0;  ///< of all of them: whichever way is taken

public:
    Array<Hidden> hidden;
    Array<Culled> culled;

private:
    Array<Proposal> proposed_;                    ///< by place; empty: nothing was ever proposed
    Array<uint32_t> found_nodes_, found_places_;  ///< of a teacher: what has a certificate that held for its last view
    uint32_t teaches_until_ = 0;                  ///< the answer from which on nobody learns from it any more
    uint32_t taught_until_ = 0;                   ///< the answer from which on nobody draws for this one
    uint32_t alone_until_ = 0;  ///< and up to which it goes on by itself: what it was taught did not do
    uint32_t alone_for_ = 0;    ///< how long that is
    uint32_t taught_ = 0;       ///< answers since then that rest on what was taught
    /// Of an answer, about: what was kept by this one and by the teacher, and whether this one drew.
    double kept_here_ = 0, kept_there_ = 0, drew_here_ = 0;
};

}  // namespace sightline::detail
