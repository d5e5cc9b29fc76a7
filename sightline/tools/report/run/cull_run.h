// What a cull along a camera path gave, as plain data, and its JSON form.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sightline/frame/stats.h"
#include "sightline/geom/view.h"
#include "sightline/tools/profile/middle.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tools/truth/proof_counts.h"

namespace sightline::tools {

/// One stage in one frame. Counts keys: a culled key is one all of whose objects were culled, and belongs to the
/// finest stage among them.
struct StageRow {
    uint64_t tested = 0;
    uint64_t culled = 0;
    uint64_t instances = 0;  ///< objects, not keys, that it culled
    uint64_t doubt = 0;      ///< kept because the stage could not decide; counts objects
    double microseconds = 0;
};

/// A culled object that a witness saw.
struct FalseCullRow {
    uint32_t object = 0;  ///< index into Scene::objects
    uint64_t key = 0;
    double x = 0, y = 0;  ///< [pixels from the left and the top]
    std::string witness;
    std::optional<uint64_t> pixels = {};  ///< that would show it, if they were counted
};

/// What the witnesses said about one frame. Counts keys.
struct VerificationRow {
    uint64_t false_culls = 0;  ///< keys of `rows`
    uint64_t rays = 0;         ///< aimed ones included
    uint64_t aimed_rays = 0;   ///< at culled objects
    uint64_t id_samples = 0;
    uint32_t supersampling = 0;         ///< samples of the id-buffer per pixel and axis
    uint64_t unconfirmed = 0;           ///< sightings of culled objects that exact arithmetic did not bear out
    std::optional<ProofCounts> proofs;  ///< if there were any; counts objects, of two eyes both's
    uint64_t exactly_visible = 0;       ///< none that distance or contribution culled
    uint64_t lossy_seen = 0;            ///< seen, and culled by distance or contribution: no false culls
    std::vector<FalseCullRow> rows;
    std::vector<uint32_t> kept_unseen;  ///< objects that were kept and that no witness saw, ascending
};

/// What an occluder did in one frame.
struct OccluderCredit {
    uint32_t object = 0;          ///< index into Scene::objects
    uint64_t triangles = 0;       ///< of it that were rasterized
    double hidden = 0;            ///< objects that it hid; one that several hide is shared among them
    double hidden_triangles = 0;  ///< their triangles, shared alike
};

/// What the stage of clusters did: QueryStats.
struct ClusterRow {
    uint64_t tested = 0, back = 0, outside = 0, hidden = 0;
    uint64_t whole = 0, drawn = 0;  ///< triangles of the objects that have clusters: all, and those that are left
    uint64_t draws = 0;             ///< runs of triangles
};

/// A door that a run sets.
struct DoorAsked {
    std::string name;
    double open = 1;  ///< 0: shut; 1: open
};

/// A query's settings as the tool has them: without cells, which need a file, without clusters and simpler occluders, which
/// take long to prepare, and without a memory, so that each frame stands by itself.
inline QuerySettings toolSettings() {
    QuerySettings settings;
    settings.stages = kDefaultStages & ~(kLossyStages | kCellStages | stageBit(Stage::kClusters));
    settings.occluder_error = 0;
    settings.hysteresis = 0;
    settings.stateless = true;
    return settings;
}

/// What a run asks of baked visibility.
struct VisibilityAsked {
    std::string file;  ///< empty: there is none
    std::vector<DoorAsked> doors;
};

/// What the stage of portals did: PortalStats.
struct CellRow {
    uint64_t cells = 0, portals = 0, whole = 0, too_deep = 0;
    bool known = true;  ///< false: the eye was in no cell, or the work was spent
};

/// What a renderer would submit.
struct LeftToDraw {
    uint64_t objects = 0;  ///< keys
    uint64_t triangles = 0;
};

/// Culls of a frame that rest on the same certificate. Indices into Scene::objects, ascending.
struct CertificateRow {
    std::vector<uint32_t> hiders;  ///< that are named
    std::vector<uint32_t> hidden;  ///< culled: each by these and its own triangles
};

struct FrameResult {
    CameraFrame camera;
    std::vector<uint64_t> visible;  ///< keys, ascending, each once
    std::vector<uint8_t> reasons;   ///< per object: 0 visible, else 1 + Stage  [size: Scene::objects]
    std::vector<uint8_t> eyes;      ///< of two eyes: per visible key, bit 0 if the left may see it, bit 1 the right
    std::vector<uint8_t> eye_reasons[2];  ///< of two eyes: `reasons` of each; else empty
    StageRow stages[kStageCount];
    uint64_t objects_visible = 0;  ///< objects, not keys
    uint64_t triangles = 0;        ///< of the visible objects, or of what is left of them: what a renderer would submit
    std::optional<LeftToDraw> frustum_alone;  ///< what the stage of the frustum would leave if it were the only one
    std::optional<ClusterRow> clusters;       ///< with that stage, of one eye
    std::optional<CellRow> cells;             ///< with the stage of portals, of one eye
    std::vector<uint8_t> lods;                ///< with the stage of levels of detail: per object  [size: objects, or 0]
    QueryStats stats;                         ///< of both eyes together, where there are two
    double query_microseconds = 0;            ///< median over the repeats
    std::vector<OccluderCredit> credits;      ///< of all that were rasterized, by object; empty unless asked for
    std::vector<CertificateRow> certificates;  ///< of the answer; empty unless asked for
    uint32_t thread = 0;                       ///< that answered, from 0
    double begin_microseconds = 0;             ///< when it began with this frame, since the run began
    double end_microseconds = 0;               ///< when it had done with it
    std::optional<VerificationRow> verification;
    std::optional<uint64_t> changed_pixels;  ///< that show another object for what is not conservative
    std::vector<std::string> notes;          ///< for a reader: why this frame is the slowest or the loosest of its run
};

struct CullRun {
    std::string scene;       ///< as it was named by the user
    std::string command;     ///< that repeats this run
    std::string scene_hash;  ///< hashOf() in 16 digits, where certificates are noted; else empty
    uint64_t objects = 0;    ///< distinct keys
    uint64_t instances = 0;  ///< drawn objects; more than `objects` where several share a key
    uint64_t triangles = 0;  ///< drawn if nothing were culled
    uint32_t width = 0, height = 0;
    double jitter = 0;                        ///< [pixels]
    QuerySettings settings = toolSettings();  ///< stages: those in use; hysteresis: towards the frame before
    ViewPlanes sections;                      ///< View
    VisibilityAsked visibility;
    double cluster_test = 0;    ///< FacingCost::test that clusters were prepared for, with that stage
    double corner_stretch = 1;  ///< of the first frame: how much larger an error may look in the image's corner
    double stereo = 0;          ///< distance of the two eyes  [world units]; 0: there is one
    int repeat = 1;
    bool interrupted = false;    ///< the frames after the last one here were not begun, or not finished
    uint64_t frames_wanted = 0;  ///< of the path; 0: as many as there are here
    std::vector<FrameResult> frames;
};

/// Sums over the frames of a verified run.
struct Verification {
    uint64_t false_culls = 0, rays = 0, id_samples = 0, exactly_visible = 0, reported = 0;
    uint64_t culled = 0;            ///< keys, each in each frame that was judged
    uint64_t culled_instances = 0;  ///< the same of objects: several may share a key
    uint64_t false_instances = 0;   ///< of these, those that a witness saw
    uint64_t aimed_rays = 0, unconfirmed = 0, lossy_seen = 0;
    std::optional<ProofCounts> proofs;  ///< of the frames that have some
    uint32_t least_supersampling = 0, most_supersampling = 0;
    /// Reported over exactly visible; 1 if neither saw anything.
    double overEstimate() const;
};
std::optional<Verification> sumVerification(const CullRun& run);

/// What distance and contribution culling cost, over the frames for which it was counted; none if that is none.
struct Changes {
    uint64_t changed = 0, pixels = 0;
};
std::optional<Changes> sumChanges(const CullRun& run);

/// Bits of the stages in use that cull what may be visible.
inline uint32_t lossyStages(const CullRun& run) {
    return run.settings.stages & (kLossyStages | (run.settings.portal_depth > 0 ? stageBit(Stage::kPortals) : 0));
}

/// Whether an object's reason is one of these.
inline bool isLossy(uint8_t reason, const CullRun& run) {
    return reason > 0 && reason <= kStageCount && (lossyStages(run) >> (reason - 1) & 1);
}

/// The median, of an even number the mean of the two in the middle; 0 of none. All that tells of a run uses this one.
inline double medianOf(std::vector<double> values) { return middleOf(std::move(values)); }

/// Visible keys and culled keys by stage from the objects' reasons. Writes FrameResult::visible, objects_visible,
/// triangles, and tested and culled of the stages in use.
/// @param key_order  indices of the objects sorted by key  [size: Scene::objects]
void countByKey(const Scene& scene, const std::vector<uint32_t>& key_order, uint32_t stages, FrameResult& frame);

/// Indices of the objects sorted by key, equal keys in their own order.
std::vector<uint32_t> orderByKey(const Scene& scene);
uint64_t countKeys(const Scene& scene, const std::vector<uint32_t>& key_order);

/// What a key is called: by its first object.
struct KeyName {
    uint64_t key = 0;
    std::string name;
    std::string path;  ///< objectPath()
};

/// The keys that any frame kept or a witness saw, ascending: as many as are visible, however large the scene is.
std::vector<KeyName> keyNames(const CullRun& run, const Scene& scene, const std::vector<uint32_t>& key_order);

/// Per visible key of a frame, the finest level of detail that an object of it is drawn by; empty if none were chosen.
std::vector<uint8_t> lodsByKey(const FrameResult& frame, const Scene& scene);

/// Keys that a frame kept and of which no witness saw any object, ascending.
std::vector<uint64_t> keysKeptUnseen(const FrameResult& frame, const Scene& scene);

/// The schema `sightline.cull/1`: one frame a line. Names that are not UTF-8 are mended.
std::string cullJson(const CullRun& run, const Scene& scene);

/// cullJson() without the lists of objects: `kept` of a frame counts what `visible` lists, and `notes` are there.
std::string cullJsonWithoutSets(const CullRun& run);

}  // namespace sightline::tools
