// A view: where the eye is, how it projects, and what the caller declares about the frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <glm/glm.hpp>

namespace sightline {

/// The stages of a query, in the order in which they are applied. Their names are the names of
/// the files in cull/; volumes are occluder volumes, clusters those of objects that have some. The first two do nothing
/// in a world without cells: World::attach(). Distance and contribution are not conservative: they do nothing unless the
/// view says how far and how small.
enum class Stage : uint8_t { kPvs, kPortals, kFrustum, kDistance, kContribution, kVolumes, kOcclusion, kClusters };
inline constexpr int kStageCount = 8;
inline constexpr const char* kStageNames[kStageCount] = {"pvs",          "portals", "frustum",   "distance",
                                                         "contribution", "volumes", "occlusion", "clusters"};
inline constexpr uint32_t stageBit(Stage stage) { return 1u << static_cast<uint32_t>(stage); }
inline constexpr uint32_t kAllStages = (1u << kStageCount) - 1;
/// Those that go by the cells of the world.
inline constexpr uint32_t kCellStages = stageBit(Stage::kPvs) | stageBit(Stage::kPortals);
/// Those that cull what may be visible.
inline constexpr uint32_t kLossyStages = stageBit(Stage::kDistance) | stageBit(Stage::kContribution);
/// Those that pay in most worlds.
inline constexpr uint32_t kDefaultStages = kAllStages & ~stageBit(Stage::kVolumes);

/// How much a tile of the occlusion buffer remembers.
enum class OcclusionDetail : uint8_t {
    kMasked,  ///< where depths meet in a tile that do not fit, the farthest stands for all: smallest, but looser
    kFull,    ///< such a tile gets a depth per pixel
};

/// How much is asked of bounds that the planes of a view volume keep.
enum class Refinement : uint8_t {
    kNone,
    kCorners,         ///< all corners of the volume are beyond one face of the bound
    kSeparatingAxes,  ///< and the planes along one edge of each: exact for boxes but for rounding
};

/// How the part of the image that a cell is seen through is known.
enum class PortalWindows : uint8_t {
    kBoxes,     ///< a rectangle: the least work
    kOctagons,  ///< a rectangle with its corners cut
    kPolygons,  ///< convex polygons, one for each way through portals that leads there; tightest
};
inline constexpr const char* kWindowNames[] = {"boxes", "octagons", "polygons"};

/// A few half spaces of the world: a point p is inside of a plane if dot(n, p) + d >= 0. Normals are of any length; a plane
/// without one has everything inside or, if d < 0, nothing.
struct ViewPlanes {
    static constexpr uint32_t kMost = 8;

    glm::dvec4 planes[kMost]{};  ///< n and d
    uint32_t count = 0;          ///< [limit: <= kMost]

    /// @returns false if there is no room: nothing has changed
    bool add(const glm::dvec4& plane) {
        if (count >= kMost) return false;
        planes[count++] = plane;
        return true;
    }
    std::span<const glm::dvec4> all() const { return {planes, count}; }
};

/// A convex outline in the world that a view looks through.
struct ViewOutline {
    static constexpr uint32_t kMost = 8;

    glm::dvec3 points[kMost]{};  ///< flat, in either order of turn
    uint32_t count = 0;          ///< 0: there is none; else 3 or more  [limit: <= kMost]
};

/// One eye's view of a world for one frame.
///
/// Matrices are column-major with column vectors: clip = projection * view * world. Clip space is
/// OpenGL's: -w <= x, y, z <= w, y up, near at z = -w. The view must be rigid (rotation and
/// translation); the projection may be perspective or orthographic, off-centre, with a finite or an
/// infinite far plane. Anything that is not finite makes every object visible.
struct View {
    glm::dmat4 view{1.0};              ///< world to eye                                [rigid]
    glm::dmat4 projection{1.0};        ///< eye to clip
    uint32_t width = 1280;             ///< of the viewport                             [pixels, >= 1]
    uint32_t height = 720;             ///<                                             [pixels, >= 1]
    double jitter = 0.5;               ///< largest shift of the image that the frame may use  [pixels, 0 to 1e6]
    uint32_t layers = ~0u;             ///< objects outside these layers are neither reported nor hide
    uint32_t stages = kDefaultStages;  ///< bits of Stage: which stages may cull
    /// Stage::kPortals: how closely the part of the image is known that a cell is seen through.
    PortalWindows windows = PortalWindows::kOctagons;
    /// Portals that a sight line may pass; what is behind more is culled, although it may be visible, and counted:
    /// PortalStats::too_deep.  [0: no limit]
    uint32_t portal_depth = 0;
    uint32_t portal_work =
        1u << 16;  ///< cells that are entered at most; if they do not do, the stage keeps all  [limit]
    /// The answer holds for every eye that is as close to this one, whichever way it looks: then Stage::kPvs alone does
    /// anything.  [world units, >= 0; 0: for this eye alone]
    double eye_radius = 0;
    /// Stage::kDistance culls what lies wholly farther from the eye; in a parallel view, from the plane through the eye.
    /// Infinity: only objects with a limit of their own, ObjectLimits.  [world units; 0: the stage is off]
    double max_distance = 0;
    /// The full vertical angle that max_distance is meant for. A view that zooms in sees farther, by as much as it
    /// enlarges; one that is wider sees less far.  [radians, below pi; 0: the same in every view, as in parallel ones]
    double max_distance_fov = 0;
    /// Stage::kContribution culls an object whose image is smaller than a disk of this radius: the image of the sphere
    /// around its box, measured by its area, wherever in the image it lies. So a culled object covers pi times the
    /// square of this at most.  [pixels of the viewport; 0: the stage is off]
    double contribution = 0;
    /// What the query's last answer showed is kept by both stages until it is farther, or smaller, by this share: no
    /// object flickers at the limit. The answer then depends on the one before it.  [0 to 1; 0: no memory]
    double hysteresis = 0.1;
    uint32_t occluder_volumes = 8;           ///< that the stage of volumes chooses at most  [limit: <= 64]
    uint32_t occluder_triangles = 1u << 17;  ///< work budget: triangles that may be rasterized, nearest first  [limit]
    uint32_t occlusion_size = 640;           ///< longer side of the occlusion buffer; a viewport that is smaller
                                             ///< gets its own size  [pixels, limit: 1 to 8192]
    double occluder_error = 2.0;             ///< of the simpler occluders that may be drawn: prepareInner()
                                             ///< [pixels of the occlusion buffer; 0: none]
    bool last_visible_first = false;         ///< draw first what the query's last answer kept; see Query::visible()
    bool faces = true;                       ///< what its box's rectangle would keep is asked by the box's faces
    bool second_look = true;                 ///< and then by its own triangles: ObjectDef::shape
    uint32_t second_look_polygons = 1u << 16;  ///< work budget of that: polygons that may be asked  [limit]
    /// Runs of an object's triangles with so few between them that are culled count as one: VisibleSet::ranges, for fewer
    /// draws.  [triangles]
    uint32_t cluster_gap = 0;
    OcclusionDetail occlusion_detail = OcclusionDetail::kFull;
    /// Gaps between occluders that are narrower than this count as closed: see closedGap(). Off at 0. What is seen through
    /// such gaps alone may then be culled.  [pixels of the occlusion buffer, limit: 0 to 1/16]
    double close_gaps = 0.0;
    /// Strips side by side that the occlusion buffer is cut into, each with a walk of its own, so that several threads
    /// can share a query: Query's jobs. An object is kept that one of them keeps. The answer depends on this number, a
    /// little (no object is culled that is visible; work budgets hold for each strip), but not on who walks. One strip
    /// costs least in all.  [limit: 1 to 16]
    uint32_t bins = 1;
    /// Cut the bins where the query's last answer had equal shares of work, instead of at equal widths. Work is counted,
    /// not timed: so the same calls give the same answers.
    bool balance_bins = false;
    bool time_stages = false;  ///< fill StageStats::nanoseconds (costs some time itself)
    /// Stage::kFrustum asks more of boxes that cross two planes or more, and may lie beyond the edge where these meet.
    Refinement refinement = Refinement::kNone;
    /// Cuts the world open: what is not inside of all these planes is not drawn. Stage::kFrustum culls what lies wholly
    /// outside of one. What a plane cuts hides only by parts that it leaves whole, so that what the cut lays open is seen.
    ViewPlanes sections;
    /// Asks about a part of the world alone, as what a portal or a rectangle of the image shows: Stage::kFrustum culls what
    /// lies wholly outside of one of these planes. Nothing is cut: what reaches inside is drawn whole, and hides as ever.
    /// What is culled hides nothing. See addWindow().
    ViewPlanes window;
    /// Sight lines begin on this outline, wherever the eye is: as in a mirror, mirroredView(). The stages of cells start
    /// from the cells that it touches. Nothing is cut for its sake, and other stages do not ask for it: see `sections` and
    /// `window`.
    ViewOutline through;
};

/// Right-handed, y up in clip space; up need not be orthogonal to the direction. If up is parallel
/// to the direction, another axis is taken.
glm::dmat4 lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// @param fov_y   full vertical angle            [radians, in (0, pi)]
/// @param aspect  width / height
/// @param z_far   infinity for an infinite far plane
glm::dmat4 perspective(double fov_y, double aspect, double z_near,
                       double z_far = std::numeric_limits<double>::infinity());

/// @param height  full height of the view volume [world units]
/// z_far may be infinity, which stands for 2^31 world units here.
glm::dmat4 orthographic(double height, double aspect, double z_near, double z_far);

/// The eye of a perspective view, or, for an orthographic one, the origin of its eye space.
glm::dvec3 eyePosition(const View& view);

/// The same view from an eye so far to the right along the camera's own axis: an eye of a pair.  [world units]
View shiftedEye(const View& view, double right);

/// True if clip w is the same for all points: parallel projection.
bool isOrthographic(const View& view);

/// True if all matrices and planes are finite, the viewport has pixels, the jitter is in its range, and the projection
/// can be inverted.
bool isUsable(const View& view);

/// View::stages less those of distance and contribution, if the view does not say how far and how small; of cells, if
/// sections cut the world open; and of all that hold for one eye alone, if the view has an eye_radius.
uint32_t stagesInUse(const View& view);

/// Steps of View::close_gaps in a pixel.
inline constexpr double kGapSteps = 0x1p20;

/// View::close_gaps as it is used: between 0 and 1/16, and whole steps.
double closedGap(const View& view);

}  // namespace sightline
