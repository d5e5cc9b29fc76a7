// The verb `explain`: why an object is, or is not, in the visible set; and what a whole path tells of a scene.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/explain_object.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/query/explain/shadows.h"
#include "sightline/query/query.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/pictures/explain_picture.h"
#include "sightline/tools/report/pictures/shadow_picture.h"
#include "sightline/tools/report/run/explain_text.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

bool readNumber(std::string_view text, uint32_t& out) {
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), out);
    return fault == std::errc() && end == text.data() + text.size();
}

/// Reads --frame and --at, and refuses what does not go together.
Status readQuestion(const Command& verb, ExplainOptions& options) {
    options.all_frames = options.frame == "all";
    if (!options.all_frames && !readNumber(options.frame, options.first_frame))
        return usageError(fmt::format("--frame {}: neither a number nor \"all\"", options.frame));
    options.has_pixel = verb.count("--at") > 0;
    if (options.has_pixel) {
        const std::string_view text = options.at;
        const size_t comma = text.find(',');
        if (comma == std::string_view::npos || !readNumber(text.substr(0, comma), options.x) ||
            !readNumber(text.substr(comma + 1), options.y) || options.x >= options.width || options.y >= options.height)
            return usageError(
                fmt::format("--at {}: not X,Y of a pixel of {}x{}", options.at, options.width, options.height));
    }
    const bool object = verb.count("--object") > 0;
    if (object && options.has_pixel) return usageError("--at excludes --object");
    if (options.all_frames && options.has_pixel) return usageError("--at needs one --frame");
    for (const auto& [option, file] : {std::pair("-o", &options.picture), std::pair("--outside", &options.outside)})
        if (*file == "-") return usageError(fmt::format("{} -: a picture needs a file", option));
        else if (!file->empty() && (options.all_frames || (!object && !options.has_pixel)))
            return usageError(fmt::format("{} needs an --object or a pixel, and one --frame", option));
    if (!options.settings.stateless && options.stereo > 0) return usageError("--remember: not for two eyes");
    if (!options.settings.stateless && !object && !options.has_pixel)
        return usageError("--remember needs an --object or a pixel");
    if (!object && !options.has_pixel && verb.count("--frame") > 0)
        return usageError("--frame needs an --object or a pixel");
    return success();
}

Status checkExplainOutputs(const ExplainOptions& options) {
    ApartFiles files = filesRead(options);
    files.write("--json", options.json);
    files.write("-o", options.picture);
    files.write("--outside", options.outside);
    if (!files.status()) return files.status();
    return canWriteFiles({options.json, options.picture, options.outside});
}

Status writeJson(const ExplainOptions& options, const Scene& scene, const Json& body) {
    if (options.json.empty()) return success();
    Json out;
    out["schema"] = "sightline.explain/1";
    out["scene"] = {{"file", options.scene.title()},
                    {"objects", countKeys(scene, orderByKey(scene))},
                    {"triangles", drawnTriangles(scene)}};
    out["width"] = options.width;
    out["height"] = options.height;
    out.update(body);
    return writeText(options.json, jsonText(out, 1) + "\n");
}

std::FILE* readerOf(const ExplainOptions& options) { return options.json == "-" ? stderr : stdout; }

/// Adds an object to those that are drawn in colour.
void addOnce(std::vector<uint32_t>& objects, uint32_t object) {
    if (std::find(objects.begin(), objects.end(), object) == objects.end()) objects.push_back(object);
}

Status writePictures(const ExplainOptions& options, const AskedScene& asked, const View& view,
                     const ObjectAnswer& answer) {
    std::vector<uint32_t> occluders;
    std::vector<std::vector<glm::dvec3>> outlines;
    for (const Hider& hider : answer.why.occlusion.hiders) addOnce(occluders, AskedScene::objectOf(hider.id));
    for (const ShadowCaster& caster : answer.shadows) {
        addOnce(occluders, caster.object);
        outlines.push_back(caster.outline);
    }
    Emphasis emphasis;
    emphasis.object = answer.object;
    emphasis.occluders = occluders;
    emphasis.outlines = outlines;
    if (answer.why.verdict == Verdict::kVisible && answer.why.visible.because == KeptBecause::kOpenPixel) {
        emphasis.has_pixel = true;
        emphasis.x = answer.why.visible.x;
        emphasis.y = answer.why.visible.y;
    }
    if (!options.picture.empty())
        if (Status done = writeFileAside(options.picture, encodePng(explainPicture(asked.scene, view, emphasis)));
            !done)
            return done;
    if (options.outside.empty()) return success();
    if (outlines.empty()) {
        fmt::print(readerOf(options), "{}: not written: {}\n", options.outside,
                   answer.why.verdict != Verdict::kOccluded ? "occlusion did not cull the object"
                   : isOrthographic(view)                   ? "shadows are not sought in parallel views"
                                                            : "no shadows were found that hide all of it");
        return success();
    }
    return writeFileAside(options.outside, encodePng(shadowPicture(PictureMaker(asked.scene), view, emphasis)));
}

/// Whether witnesses have a say: not of what lies outside, nor of what was left out although it may be seen.
bool saysMore(Verdict verdict, const QuerySettings& settings) {
    if (verdict == Verdict::kNoTime || (verdict == Verdict::kNoWindow && settings.portal_depth > 0)) return false;
    return verdict != Verdict::kNoSuchObject && verdict != Verdict::kOutsideLayers &&
           verdict != Verdict::kOutsideFrustum && verdict != Verdict::kTooFar && verdict != Verdict::kTooSmall;
}

/// A query that remembers is asked the frames in order; else each stands by itself.
class FrameAsker {
public:
    FrameAsker(const ExplainOptions& options, const AskedScene& asked) : options_(options), asked_(asked) {}

    /// Takes up a frame, after those before it.
    void ask(const CameraFrame& camera) {
        const View view = viewOf(camera, options_);
        explainer_.reset();
        if (options_.settings.stateless) return;
        kept_.clear();
        for (const Visible& v : query_.visible(asked_.now, view, options_.settings).objects)
            kept_.insert(AskedScene::objectOf(v.id));
    }
    /// @param closely  with what would be without its occluders, and with its shadows
    ObjectAnswer answer(uint32_t frame, uint32_t object, const EyeView& eye, bool closely) {
        const ObjectId id = asked_.loaded.ids[object];
        ObjectAnswer answer;
        answer.frame = frame;
        answer.object = object;
        answer.eye = eye.eye;
        if (!options_.settings.stateless) {
            answer.why = query_.explain(asked_.now, eye.view, id, options_.settings);
            answer.kept = kept_.count(object) > 0 && answer.why.verdict != Verdict::kVisible;
        } else {
            if (!explainer_ || explained_ != eye.eye) explainer_.emplace(asked_.now, eye.view, options_.settings);
            explained_ = eye.eye;
            answer.why = explainer_->explain(id, {true, closely});
        }
        if (closely && (answer.why.verdict == Verdict::kOccluded || !answer.why.certificate.empty()))
            addShadows(eye.view, id, answer);
        return answer;
    }

private:
    void addShadows(const View& view, ObjectId id, ObjectAnswer& answer) const {
        Array<HiderOutline> outlines;
        Array<glm::dvec3> corners;
        if (!query_.certificateOf(id, outlines, corners))
            findShadows(asked_.now, view, id, options_.settings, outlines, corners);
        for (const HiderOutline& outline : outlines) {
            const auto first = corners.begin() + outline.first;
            answer.shadows.push_back({AskedScene::objectOf(outline.object.id), {first, first + outline.count}});
        }
    }

    const ExplainOptions& options_;
    const AskedScene& asked_;
    Query query_;
    std::set<uint32_t> kept_;  ///< of the frame
    std::optional<Explainer> explainer_;
    uint8_t explained_ = 0;  ///< whose eye's
};

/// The object, or those that share its key, in one frame.
Status explainInFrame(const ExplainOptions& options, const AskedScene& asked, FrameAsker& asker,
                      const CameraFrame& camera, const std::vector<uint32_t>& objects, Json& body) {
    constexpr size_t kMost = 5;  // of those that share a key
    for (const EyeView& eye : eyesOfFrame(camera, options)) {
        for (size_t i = 0; i < std::min(objects.size(), kMost); ++i) {
            const uint32_t object = objects[i];
            ObjectAnswer answer = asker.answer(options.first_frame, object, eye, true);
            if (isUsable(eye.view) && saysMore(answer.why.verdict, options.settings))
                answer.sighting = lookFor(asked.scene, eye.view, object, namedHiders(answer.why), options);
            fmt::print(readerOf(options), "{}", answerText(asked, answer));
            body["answers"].push_back(answerJson(asked, answer));
            if (i == 0 && eye.eye != kRightEye)
                if (Status drawn = writePictures(options, asked, eye.view, answer); !drawn) return drawn;
        }
    }
    if (objects.size() > kMost)
        fmt::print(readerOf(options), "and {} more objects with the key {}\n", objects.size() - kMost,
                   asked.scene.objects[objects.front()].key);
    return success();
}

/// One line a frame and eye. Of objects that share a key: the first, and how many there are.
/// @returns the exit code
int explainInAll(const ExplainOptions& options, const AskedScene& asked, const CameraPath& path,
                 const std::vector<uint32_t>& objects, Json& body) {
    const uint32_t object = objects.front();
    fmt::print(readerOf(options), "{}\n", shortened(titleOf(asked.scene, object), 100));
    if (objects.size() > 1) fmt::print(readerOf(options), "the first of {} objects with this key\n", objects.size());
    stopGently();
    FrameAsker asker(options, asked);
    uint32_t done = 0;
    for (; done < path.frames.size() && !interrupted(); ++done) {
        asker.ask(path.frames[done]);
        for (const EyeView& eye : eyesOfFrame(path.frames[done], options)) {
            const ObjectAnswer answer = asker.answer(done, object, eye, false);
            fmt::print(readerOf(options), "{}", answerLine(asked, answer));
            body["answers"].push_back(answerJson(asked, answer));
        }
    }
    if (done == path.frames.size()) return kDone;
    return reportInterruption(fmt::format("{} of {} frames", done, path.frames.size()), done > 0);
}

/// What lies at a pixel, front to back, and why the first of it is kept.
Status explainPixel(const ExplainOptions& options, const AskedScene& asked, FrameAsker& asker,
                    const CameraFrame& camera, Json& body) {
    constexpr size_t kMost = 16;
    const View view = viewOf(camera, options);
    const std::vector<Layer> layers = layersAt(asked.scene, view, options.x, options.y, kMost);
    std::FILE* const out = readerOf(options);
    body["pixel"] = {options.x, options.y};
    if (layers.empty()) {
        fmt::print(out, "pixel ({}, {}): nothing{}\n", options.x, options.y,
                   options.picture.empty() && options.outside.empty() ? "" : ", so that no picture is written");
        return success();
    }
    if (layers.front().shines_through)
        fmt::print(out, "pixel ({}, {}): what is in front shines through\n", options.x, options.y);
    if (Status done = explainInFrame(options, asked, asker, camera, {layers.front().object}, body); !done) return done;
    if (layers.size() > 1) fmt::print(out, "behind it, at pixel ({}, {}):\n", options.x, options.y);
    for (size_t i = 1; i < layers.size(); ++i) {
        const uint32_t object = layers[i].object;
        const ObjectAnswer answer = asker.answer(options.first_frame, object, {view, 0}, false);
        const std::string line = fmt::format(
            "{:>10} units  {:<10} {}{}", readable(layers[i].depth),
            answer.kept || answer.why.verdict == Verdict::kVisible ? "kept" : verdictName(answer.why.verdict),
            layers[i].shines_through ? "see-through: " : "", titleOf(asked.scene, object));
        fmt::print(out, "{}\n", shortened(line, 100));
        body["answers"].push_back(answerJson(asked, answer));
    }
    return success();
}

Status explainPath(const ExplainOptions& options, const Scene& scene, const CameraPath& path, int& exit_code) {
    const CullRun run = cullPath(scene, path, options);
    exit_code = exitCodeOf(run, path.frames.size(), false);
    if (run.frames.empty()) return success();
    fmt::print(readerOf(options), "{}", pathText(scene, run, options.top));
    return writeJson(options, scene, pathJson(scene, run));
}

Status explainObjects(const ExplainOptions& options, const Scene& scene, const CameraPath& path, int& exit_code) {
    Json body;
    body["answers"] = Json::array();
    Result<std::vector<uint32_t>> objects = std::vector<uint32_t>();
    if (!options.has_pixel) objects = findObjects(scene, options.object);
    if (!objects) return objects.error();
    const AskedScene asked(scene, options);
    if (options.all_frames) {
        exit_code = explainInAll(options, asked, path, *objects, body);
    } else {
        const CameraFrame& camera = path.frames[options.first_frame];
        const View view = viewOf(camera, options);
        fmt::print(readerOf(options), "{}", frameLine(scene, options, path.frames.size(), view));
        body["camera"] = cameraJson(scene, options, view);
        FrameAsker asker(options, asked);
        const uint32_t first = options.settings.stateless ? options.first_frame : 0;
        for (uint32_t i = first; i <= options.first_frame; ++i) asker.ask(path.frames[i]);
        Status done = options.has_pixel ? explainPixel(options, asked, asker, camera, body)
                                        : explainInFrame(options, asked, asker, camera, *objects, body);
        if (!done) return done;
    }
    return writeJson(options, scene, body);
}

Status runExplain(const Command& verb, ExplainOptions& options, int& exit_code) {
    if (Status good = finish(verb, options); !good) return good;
    if (Status good = readQuestion(verb, options); !good) return good;
    Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened;
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (!options.all_frames)
        if (Status there = checkFrame(options.first_frame, path->frames.size()); !there) return there;
    if (Status writable = checkExplainOutputs(options); !writable) return writable;
    prepareLods(*scene, options);
    options.credits = true;
    if (verb.count("--object") == 0 && !options.has_pixel) return explainPath(options, *scene, *path, exit_code);
    return explainObjects(options, *scene, *path, exit_code);
}

}  // namespace

void addExplain(Command& tool, int& exit_code) {
    Command verb = tool.add_subcommand("explain", "why an object is, or is not, in the visible set");
    const auto options = std::make_shared<ExplainOptions>();
    options->repeat = 1;
    addSceneOptions(*verb, *options);
    addStereoOption(*verb, *options);
    addRememberOption(*verb, *options);
    verb->add_option("--object", options->object,
                     "its key, its name or path, or a part that only it has; without: what the whole path tells")
        ->type_name("K");
    verb->add_option("--frame", options->frame, "of the path, from 0; all: one line a frame")
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--at", options->at, "the object at this pixel, and what lies behind it")->type_name("X,Y");
    verb->add_option("-o,--output", options->picture, "draw the frame: the object's box, its occluders, the rest pale")
        ->type_name("FILE.png");
    verb->add_option("--outside", options->outside,
                     "draw from the side how the object lies in the shadows of those that hide it")
        ->type_name("FILE.png");
    verb->add_option("--top", options->top, "how many rows the lists of the whole path have")
        ->check(Range{1u, 1000000u})
        ->type_name("N")
        ->capture_default_str();
    verb->callback([verb, options, &exit_code] {
        exit_code = kDone;
        const Status done = runExplain(*verb, *options, exit_code);
        if (!done) exit_code = report(done.error());
    });
}

}  // namespace sightline::cli
