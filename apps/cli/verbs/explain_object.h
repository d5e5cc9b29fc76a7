// Why one object is kept or culled, along a path: for a reader, and as JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_frame.h"
#include "sightline/base/result.h"
#include "sightline/geom/view.h"
#include "sightline/query/explain/explain.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::cli {
using namespace tools;

/// The objects that share the key that a word names: the key itself; else the path or the name of an object, exactly;
/// else a part of just one path, in any case of letters. Errors (kUsage): there is none; there are several, of which
/// the first ten are named.
Result<std::vector<uint32_t>> findObjects(const Scene& scene, const std::string& word);

/// What a pixel shows.
struct Layer {
    uint32_t object = 0;          ///< index into Scene::objects
    double depth = 0;             ///< along the direction of view  [world units]
    bool shines_through = false;  ///< a surface that hides nothing: blended, masked or transmissive
};

/// The surfaces at the middle of a pixel, front to back, each object once; at most so many. Opaque ones are the reference
/// renderer's, and end nothing; those that shine through are a ray's.
/// @param x,y  whole pixels from the left and the top, inside the viewport
std::vector<Layer> layersAt(const Scene& scene, const View& view, uint32_t x, uint32_t y, size_t most);

/// "object 4711 'Floor 3/Desk'", or "object 4711"; the path as a terminal may show it, of a very long one the end.
std::string titleOf(const Scene& scene, uint32_t object);
/// "'Floor 3/Desk'", or "object 4711".
std::string callOf(const Scene& scene, uint32_t object);

/// What `explain` is asked.
struct ExplainOptions : RunOptions {
    std::string object, frame = "0", at, picture, outside;
    bool all_frames = false;  ///< from `frame`
    uint32_t first_frame = 0;
    bool has_pixel = false;  ///< from `at`
    uint32_t x = 0, y = 0;
    uint32_t top = 10;
};

/// What the witnesses say of an object.
struct Sighting {
    bool seen = false;
    double x = 0, y = 0;  ///< [pixels from the left and the top]
    std::string witness;  ///< "rays", "id-buffer" or "proof"
    uint64_t rays = 0;
    bool proved_hidden = false;    ///< by exact arithmetic: no point of it is visible
    std::vector<uint32_t> hiders;  ///< then: the objects whose shadows the proof took
    bool by_named = false;         ///< even if the hiders that the explanation names, and it itself, hid alone
};

/// A part of an object that hides another by its shadow.
struct ShadowCaster {
    uint32_t object = 0;              ///< index into Scene::objects
    std::vector<glm::dvec3> outline;  ///< as the eye sees it
};

/// One object in one frame.
struct ObjectAnswer {
    uint32_t frame = 0;
    uint32_t object = 0;  ///< index into Scene::objects
    Explanation why;
    std::optional<Sighting> sighting;
    uint8_t eye = 0;    ///< of two, kLeftEye or kRightEye; 0: there is one
    bool kept = false;  ///< by a query that remembers, unasked or for want of a certificate: `why` culls it
    std::vector<ShadowCaster> shadows;  ///< of what is occluded, if they were sought and found: they hide all of it
};

/// The scene as a world that can be asked.
struct AskedScene {
    const Scene& scene;
    LoadedWorld loaded;
    Snapshot now;
    std::vector<std::string> cells;  ///< names, by number; empty: not known

    AskedScene(const Scene& scene, const RunOptions& options);
    /// @param loaded  of this scene
    AskedScene(const Scene& scene, LoadedWorld loaded);
    /// Scene::objects' index of an object of the world.
    static uint32_t objectOf(ObjectId id) { return id.index - 1; }
    std::string nameOf(ObjectId id) const { return callOf(scene, objectOf(id)); }
};

/// "'hall', 'study', cell 7": by their names where they have some, at most eight.
std::string cellNames(const AskedScene& asked, std::span<const uint32_t> cells, const char* between);

/// A view, and whose it is: ObjectAnswer::eye.
struct EyeView {
    View view;
    uint8_t eye = 0;
};
/// Both eyes', the left one's first; or the only one's.
std::vector<EyeView> eyesOfFrame(const CameraFrame& camera, const RunOptions& options);

/// Lets the witnesses look for an object, kept or culled.
/// @param named  objects that are said to hide it; empty: that is not asked
Sighting lookFor(const Scene& scene, const View& view, uint32_t object, std::vector<uint32_t> named,
                 const RunOptions& options);
/// The hiders that an explanation names, as objects of the scene; none if they are no sufficient set.
std::vector<uint32_t> namedHiders(const Explanation& why);

/// The answer in sentences, at most 100 characters a line.
std::string answerText(const AskedScene& asked, const ObjectAnswer& answer);
/// Whose frame it is and where its eye stands, at most 100 characters a line.
std::string frameLine(const Scene& scene, const ExplainOptions& options, size_t frames, const View& view);
nlohmann::ordered_json cameraJson(const Scene& scene, const ExplainOptions& options, const View& view);
/// The answer in one line of at most 100 characters.
std::string answerLine(const AskedScene& asked, const ObjectAnswer& answer);
nlohmann::ordered_json answerJson(const AskedScene& asked, const ObjectAnswer& answer);

/// What a path has to tell of its scene; see tools/report/run/insight.h.
std::string pathText(const Scene& scene, const CullRun& run, uint32_t top);
nlohmann::ordered_json pathJson(const Scene& scene, const CullRun& run);

}  // namespace sightline::cli
