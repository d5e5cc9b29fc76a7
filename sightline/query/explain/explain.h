// Why an object is, or is not, in a query's answer: the plane, the occluders, the place where it is seen, or the doubt.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "sightline/base/array.h"
#include "sightline/frame/size_reason.h"
#include "sightline/geom/image_rect.h"
#include "sightline/geom/lod.h"
#include "sightline/geom/view.h"
#include "sightline/query/explain/hider.h"
#include "sightline/query/explain/verdict.h"
#include "sightline/world/world.h"

namespace sightline {

/// Where an object's box lies relative to the planes of the frustum, widened by the jitter, and to those of sections
/// and window. Planes are in the order of kPlaneNames.
struct FrustumReason {
    static constexpr double kNoPlane = -std::numeric_limits<double>::infinity();
    static constexpr uint32_t kFirstSection = 6, kFirstWindow = kFirstSection + ViewPlanes::kMost;
    static constexpr uint32_t kPlanes = kFirstWindow + ViewPlanes::kMost;

    /// Per plane, how far outside of it the box's nearest corner lies; negative: how far it reaches inside; kNoPlane:
    /// the view has no such plane.  [world units]
    double outside[kPlanes];
    uint32_t plane = 0;  ///< the one that it is farthest outside of
    /// Bound on the query's own rounding at that plane: a box outside by less may be kept.  [world units]
    double rounding = 0;
    /// The planes could not decide, because of rounding; the rectangle on the screen did.
    bool by_rectangle = false;
    bool outside_any = false;  ///< the frustum stage would cull the object by itself
    /// Its box reaches into the view, but no face of it or, by a second look, none of its triangles that would be
    /// drawn.
    bool by_faces = false, by_triangles = false;

    FrustumReason() { std::fill_n(outside, kPlanes, kNoPlane); }
    double distance() const { return outside[plane]; }
};
inline constexpr const char* kPlaneNames[FrustumReason::kPlanes] = {
    "left",      "right",     "bottom",    "top",       "near",      "far",       "section 1", "section 2",
    "section 3", "section 4", "section 5", "section 6", "section 7", "section 8", "window 1",  "window 2",
    "window 3",  "window 4",  "window 5",  "window 6",  "window 7",  "window 8"};

/// What the answer would be in a world without the object's hiders.
enum class Without : uint8_t { kNotAsked, kVisible, kOccluded, kOutsideFrustum, kTooFar, kTooSmall, kFacesAway };

struct OcclusionReason {
    /// The stage that culled it. The stage of volumes has one hider: the shadow of this holds the whole box of the
    /// object.
    Stage stage = Stage::kOcclusion;
    /// A minimal sufficient set, those with the largest share first: a world of the object and these alone still hides
    /// it, and without any one of them the others of the set do not.
    Array<Hider> hiders;
    /// False if no set could be found that hides the object without the rest of the world: then the hiders are those
    /// that own pixels of its rectangle.
    bool sufficient = true;
    /// The object itself lies outside of the frustum, but was culled with a node that reaches inside. The hiders are
    /// those that own pixels of the node's rectangle.
    bool outside_too = false;
    bool by_faces = false;                 ///< its box's rectangle is open: the faces of the box are hidden
    bool by_triangles = false;             ///< that rectangle is open: its own triangles are hidden
    Without without = Without::kNotAsked;  ///< the hiders
    Array<Hider> others;                   ///< which objects would then hide it, as `hiders` do now

    explicit OcclusionReason(Memory* memory) : hiders(memory), others(memory) {}
};

/// What the stage of clusters found of an object that has some: ObjectDef::clusters.
struct ClustersReason {
    uint64_t clusters = 0;
    uint64_t back = 0;       ///< seen from their backs
    uint64_t outside = 0;    ///< of the others: outside of the view
    uint64_t hidden = 0;     ///< of the rest
    uint64_t triangles = 0;  ///< of all clusters
    uint64_t drawn = 0;      ///< triangles that are left
};

/// What the stage of levels of detail makes of an object that has some: ObjectDef::lods. It is what a first answer would
/// do, that remembers no level.
struct LodReason {
    uint32_t levels = 0;  ///< 0: the stage is not in use, or the object has no levels
    VisibleLod drawn;
    double error = 0;       ///< of the level that is drawn, in the middle of the image  [pixels]
    double next_error = 0;  ///< of the next coarser level; infinite if there is none  [pixels]
};

/// Where eye and object stand among the cells of the world, if a stage of cells is in use.
struct CellsReason {
    /// The cells that the eye may be in, and the cells that the object stands in. Where one of them is empty, the
    /// stages of cells cull nothing.
    Array<uint32_t> eye, object;
    uint32_t view_cells = 0;  ///< how many the eye may be in; 0: their rows decided nothing
    uint32_t reached = 0;     ///< how many of the object's cells are seen, in any part of the image
    /// The way to the first of these: cells, beginning with one of the eye's, and the portals between them.
    Array<uint32_t> way, portals;
    bool work_spent = false;  ///< QuerySettings::portal_work was too small: the stage of portals culled nothing

    explicit CellsReason(Memory* memory) : eye(memory), object(memory), way(memory), portals(memory) {}
};

/// Why an object is kept.
enum class KeptBecause : uint8_t {
    kOpenPixel,        ///< a pixel of its rectangle is not hidden; or of its triangles, if they were asked
    kViewNotUsable,    ///< matrices that are not finite or cannot be inverted, or no viewport: everything is kept
    kBoundsNotUsable,  ///< bounds that are empty, not finite, or too far away
    kHoldsEye,         ///< its box holds the eye
    kNearPlane,        ///< its box reaches across the near plane
    kNotProjectable,   ///< its box has no rectangle that rounding could not spoil
    kStageOff,         ///< the stage that would look at it is switched off: VisibleReason::stage
    kBudgetSpent,  ///< occluders that would hide it were not rasterized: QuerySettings::occluder_triangles; or its triangles
                   ///< were not asked: QuerySettings::second_look_polygons
};

struct VisibleReason {
    KeptBecause because = KeptBecause::kOpenPixel;
    Stage stage = Stage::kOcclusion;  ///< that is off, if kStageOff
    /// The middle of an open pixel, as far from hidden ones as can be; beyond the viewport by the jitter at most.
    /// [viewport pixels from the left and the top]
    double x = 0, y = 0;
    uint64_t open_pixels = 0, pixels = 0;  ///< that it was asked at  [pixels of the occlusion buffer]
    /// Those pixels are of the faces of its box, or of its own triangles; else of its box's rectangle.
    bool by_faces = false, by_triangles = false;
    bool second_look_spent = false;  ///< of kBudgetSpent: QuerySettings::second_look_polygons alone was too small
    bool covered = false;            ///< that pixel is covered, but not in front of the object's nearest point
    ObjectId cover;                  ///< by this object; null: by several together
    uint64_t cover_key = 0;
};

/// The answer to "why".
struct Explanation {
    Verdict verdict = Verdict::kNoSuchObject;
    ObjectId id;
    uint64_t key = 0;
    /// Objects that were culled in one step with it, itself included: the node of the hierarchy that held them.
    uint32_t together = 1;
    uint32_t width = 0, height = 0;  ///< of the viewport
    /// The query whose answer is explained kept it without a question, QuerySettings::unasked_answers; all else says what
    /// it answers when it is asked. Set by Query::explain() alone.
    bool unasked = false;
    /// The query whose answer is explained culled it by a certificate: the objects that were named. If drawing would keep
    /// it, they are its hiders, with no share. Set by Query::explain() alone.
    Array<Visible> certificate;
    bool on_screen = false;  ///< its box has an image: `rect` and `depth` hold
    ImageRect rect;          ///< of its box
    double depth = 0;        ///< of its box's nearest point, along the direction of view  [world units]
    FrustumReason frustum;   ///< not for objects in doubt
    bool cut = false;        ///< a section cuts its occluder, of which only whole clusters hide others
    SizeReason size;         ///< where a stage of distance or contribution is in use; not for objects in doubt
    OcclusionReason occlusion;
    VisibleReason visible;
    LodReason lod;            ///< of what is kept
    ClustersReason clusters;  ///< of what is kept, and of what the stage culls, with that stage
    CellsReason cells;        ///< of what has bounds, in a world with cells

    explicit Explanation(Memory* memory = defaultMemory()) : certificate(memory), occlusion(memory), cells(memory) {}
};

/// How much is asked.
struct ExplainSettings {
    bool hiders = true;   ///< name the occluders
    bool without = true;  ///< and tell what would be without them; costs O(objects log objects)
};

/// Explains the answer of one query, object by object. Each thread has its own explainer. What it says was found by
/// trying: each set of hiders was a world of its own for a query, and so was the world without them.
///
/// Costs a query and O(objects) once; an object that is kept, one more query; one that is occluded, a query and some
/// tens to hundreds of queries on worlds of a few objects.
class Explainer {
public:
    /// @param memory  outlives the explainer and its explanations
    Explainer(const Snapshot& now, const View& view, const QuerySettings& settings = {},
              Memory* memory = defaultMemory());
    /// The same, if there was an answer before: QuerySettings::hysteresis depends on it.
    /// @param last  the objects of that answer
    Explainer(const Snapshot& now, const View& view, const QuerySettings& settings, std::span<const Visible> last,
              Memory* memory = defaultMemory());
    ~Explainer();
    Explainer(Explainer&&) noexcept;
    Explainer& operator=(Explainer&&) noexcept;

    Explanation explain(ObjectId id, const ExplainSettings& asked_for = {});

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
