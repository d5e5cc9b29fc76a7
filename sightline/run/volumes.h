// The stage of occluder volumes in a walk: chooses the few that hide most from a view, and asks them on the way down.
// SPDX-License-Identifier: MIT
//
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
#pragma once

#include <cstdint>

#include "sightline/cull/occluder_volumes.h"
#include "sightline/geom/view_limits.h"
#include "sightline/run/admission.h"
#include "sightline/run/size_stages.h"
#include "sightline/run/world_state.h"

namespace sightline::detail {

/// The volumes that may still hide a node's children: a run of VolumeStage::open.
struct VolumeRange {
    uint32_t first = 0, count = 0;
};

/// What the volumes say of a node's children.
struct VolumesAnswer {
    uint32_t hidden = 0;   ///< bit per child
    uint8_t volume[8];     ///< per hidden child: which volume holds it
    VolumeRange range[8];  ///< per child that is not hidden
};

/// The volumes of one walk. What it needs stays from walk to walk.
///
/// Candidates are found by a walk of its own over the hierarchy, the nodes first that look largest from the eye, within
/// limits that count work: so the choice is the same everywhere. Every face and every body of an object that is met gets
/// an estimate of the pixels that it may cover, its solid angle; volumes are made for the best, and of these the ones are
/// taken that hold the most objects, as far as the topmost boxes of the hierarchy tell (ground covers many pixels, and hides
/// nothing), but none whose occluder another one hides. Occluders need not be visible (OccluderVolume says why),
/// but their objects must be in the view's layers: only what is surely drawn, or hidden by what is drawn, hides.
class VolumeStage {
public:
    static constexpr uint32_t kMostVolumes = 64;
    static constexpr uint32_t kMostNodes = 32;    ///< opened while choosing
    static constexpr uint32_t kMostObjects = 64;  ///< looked at while choosing
    static constexpr uint32_t kMostOfObject = 8;  ///< parts of one object that are estimated

    explicit VolumeStage(Memory* memory)
        : volumes_(memory),
          owners_(memory),
          open_(memory),
          heap_(memory),
          places_(memory),
          candidates_(memory),
          made_(memory) {}

    /// Takes up a view.
    /// @param most  volumes [limit: kMostVolumes]
    void choose(const SnapshotState& state, const View& view, const Frustum& frustum, const Screen& screen,
                uint32_t most);
    /// No volumes.
    void clear();
    const Admission* admission = nullptr;  ///< what is not admitted hides nothing; null: all is
    const SizeStages* sizes = nullptr;     ///< what these cull hides nothing; null: there are none
    const ViewLimits* limits = nullptr;    ///< nor does what these cut or cull; null: there are none
    /// All volumes, for the root.
    VolumeRange all() const { return {0, static_cast<uint32_t>(volumes_.size())}; }
    /// @param left  bit per child that is asked about
    VolumesAnswer test(const EyeBoxes& boxes, VolumeRange range, uint32_t left);

    size_t count() const { return volumes_.size(); }
    const OccluderVolume& volume(size_t i) const { return volumes_[i]; }
    /// The hierarchy's place of the object that a volume belongs to.
    uint32_t owner(size_t volume) const { return owners_[volume]; }

private:
    /// A volume that crosses some boxes, and the planes that do.
    struct Open {
        uint32_t volume : 8;
        uint32_t planes : 24;
    };
    static_assert(OccluderVolume::kMaxPlanes <= 24 && kMostVolumes <= 256);
    struct Met {
        double pixels = 0;
        uint32_t serial = 0;
        uint32_t index = 0;  ///< node, or place of an object
        uint32_t planes = 0;
        uint8_t depth = 0;  ///< below the root; 2 stands for more
        bool leaf = false;
        bool operator<(const Met& other) const {
            return pixels != other.pixels ? pixels < other.pixels : serial > other.serial;
        }
    };
    struct Candidate {
        double pixels = 0;
        uint32_t owner = 0;  ///< index into places_
        uint32_t part = 0;
        uint32_t object = 0;  ///< place
    };
    struct Made {
        uint32_t object = 0;
        OccluderVolume volume;
        VolumeOutline outline;
    };

    void gather(const SnapshotState& state, const View& view, const Frustum& frustum, const VolumeView& shared);
    void openNode(const SnapshotState& state, const Frustum& frustum, const VolumeView& shared, const Met& from);
    void lookAt(const SnapshotState& state, const View& view, const VolumeView& shared, uint32_t place);
    void take(const VolumeView& shared, uint32_t most);
    double heldObjects(const OccluderVolume& volume) const;

    Array<OccluderVolume> volumes_;
    Array<uint32_t> owners_;  ///< per volume
    Array<Open> open_;        ///< per node that was met, one after the other; the first are all volumes
    Array<Met> heap_;
    Array<VolumePlace> places_;
    Array<Candidate> candidates_;
    Array<Made> made_;
    /// The boxes of the root's children, and of those that are nodes, of theirs; with their objects in view.
    struct Top {
        EyeBoxes boxes;
        float objects[8];
    };
    Top top_[9];
    uint32_t top_count_ = 0;
    double least_ = 0;  ///< what covers less is not worth a volume  [pixels]
    uint32_t serial_ = 0;
};

}  // namespace sightline::detail
