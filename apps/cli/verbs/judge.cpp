// The verb `judge`: what any engine says that it drew, held to the witnesses that judge our own answers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_frame.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/setting_options.h"
#include "apps/cli/verbs/summary.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/pictures/explain_picture.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/answers.h"
#include "sightline/tools/report/run/camera_json.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/suggestion.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/tools/truth/changed_pixels.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostPictures = 20;
constexpr uint8_t kNotDrawn = 1 + static_cast<uint8_t>(Stage::kOcclusion);

struct JudgeOptions : RunOptions {
    std::string answers, pictures;
};

/// The objects of a scene by their keys, and by their names and paths.
class NamedObjects {
public:
    /// @param names  whether any will be asked for
    NamedObjects(const Scene& scene, bool names) {
        for (uint32_t i = 0; i < scene.objects.size(); ++i) {
            const SceneObject& object = scene.objects[i];
            by_key_[object.key].push_back(i);
            most_key_ = std::max(most_key_, object.key);
            if (!names) continue;
            const std::string path = objectPath(scene, object);
            if (!object.name.empty()) by_name_[object.name].push_back(i);
            if (!path.empty() && path != object.name) by_name_[path].push_back(i);
        }
    }

    /// Null if there are none.
    const std::vector<uint32_t>* find(const DrawnObject& drawn) const {
        if (drawn.name.empty()) return drawn.key <= most_key_ ? found(by_key_, drawn.key) : nullptr;
        return found(by_name_, drawn.name);
    }
    std::string whyNot(const DrawnObject& drawn) const {
        if (drawn.name.empty())
            return fmt::format("no object has the key {}{}", drawn.key,
                               by_key_.empty() ? "" : fmt::format(" (the largest is {})", most_key_));
        std::vector<std::string> names;
        for (const auto& [name, objects] : by_name_) names.push_back(name);
        std::sort(names.begin(), names.end());
        return fmt::format("no object is named \"{}\"{}", shortened(oneLine(drawn.name), 200),
                           oneLine(suggestion(drawn.name, names)));
    }

private:
    template <class Map, class Key>
    static const std::vector<uint32_t>* found(const Map& map, const Key& key) {
        const auto at = map.find(key);
        return at == map.end() ? nullptr : &at->second;
    }

    std::unordered_map<uint64_t, std::vector<uint32_t>> by_key_;
    std::unordered_map<std::string, std::vector<uint32_t>> by_name_;
    uint64_t most_key_ = 0;
};

/// What a frame has besides what FrameResult tells.
struct JudgedFrame {
    std::vector<uint32_t> unsure;  ///< objects that count as drawn for a name alone that others bear as well, ascending
    uint64_t unsure_visible = 0;   ///< keys of these that are visible
    uint64_t in_view = 0;          ///< keys whose boxes reach into the view: what the frustum alone would draw
    uint64_t drawn_in_view = 0;    ///< of these, drawn
    uint64_t changed_pixels = 0;   ///< that show another object for what was missed; of two eyes the left one's
};

/// A run whose frames are those of the path; those that FILE does not answer have no reasons and no verdict.
struct Judged {
    CullRun run;
    std::vector<JudgedFrame> frames;
    std::map<std::string, uint64_t> shared;  ///< names that could mean several objects, and how many keys
    std::map<std::pair<size_t, uint32_t>, std::string> pictures;  ///< by frame and object
};

uint64_t keysAmong(const Scene& scene, const std::vector<uint32_t>& objects) {
    std::set<uint64_t> keys;
    for (const uint32_t object : objects) keys.insert(scene.objects[object].key);
    return keys.size();
}

/// Which objects a frame's words mean. A name that several objects bear means all of them; which of them was drawn is
/// certain if the frame has it as often as there are such objects.
/// @returns error (kInput): the scene has no such object
Result<std::vector<uint8_t>> readDrawn(const Scene& scene, const NamedObjects& known, const Answers& answers,
                                       const AnsweredFrame& frame, Judged& out) {
    std::vector<uint8_t> reasons(scene.objects.size(), kNotDrawn);
    std::map<std::string_view, uint64_t> times;
    std::vector<const DrawnObject*> several;  // the first of each such name
    for (const DrawnObject& drawn : frame.drawn) {
        const std::vector<uint32_t>* objects = known.find(drawn);
        if (!objects)
            return Error{Error::Kind::kInput,
                         fmt::format("{}: {}", answers.placeOf(frame, drawn), known.whyNot(drawn))};
        const bool sure = drawn.name.empty() || objects->size() == 1;
        if (sure)
            for (const uint32_t object : *objects) reasons[object] = 0;
        else if (++times[drawn.name] == 1) several.push_back(&drawn);
    }
    std::set<uint32_t> unsure;
    for (const DrawnObject* drawn : several) {
        const std::vector<uint32_t>& objects = *known.find(*drawn);
        const uint64_t keys = keysAmong(scene, objects);
        if (times[drawn->name] >= keys) {
            for (const uint32_t object : objects) reasons[object] = 0;
        } else {
            out.shared.try_emplace(drawn->name, keys);
            unsure.insert(objects.begin(), objects.end());
        }
    }
    std::vector<uint32_t>& list = out.frames[frame.frame].unsure;
    for (const uint32_t object : unsure)
        if (std::exchange(reasons[object], uint8_t{0}) != 0) list.push_back(object);
    return reasons;
}

/// The run that the answers tell of, without verdicts.
Result<Judged> readRunOf(const Scene& scene, const CameraPath& path, const Answers& answers,
                         const JudgeOptions& options) {
    const std::vector<uint32_t> key_order = orderByKey(scene);
    Judged out{newRun(scene, key_order, path, options), {}, {}, {}};
    CullRun& run = out.run;
    run.settings.stages = 0;  // nothing is said of the way to these answers
    out.frames.resize(path.frames.size());
    bool names = false;
    for (const AnsweredFrame& frame : answers.frames)
        names = names || std::any_of(frame.drawn.begin(), frame.drawn.end(),
                                     [](const DrawnObject& drawn) { return !drawn.name.empty(); });
    const NamedObjects known(scene, names);
    for (const AnsweredFrame& answered : answers.frames) {
        if (answered.frame >= path.frames.size()) {
            const std::string place =
                answered.drawn.empty() ? options.answers : answers.placeOf(answered, answered.drawn.front());
            return Error{Error::Kind::kInput, fmt::format("{}: frame {}: the path has {}, from 0", place,
                                                          answered.frame, counted(path.frames.size(), "frame"))};
        }
        FrameResult& frame = run.frames[answered.frame];
        Result<std::vector<uint8_t>> reasons = readDrawn(scene, known, answers, answered, out);
        if (!reasons) return reasons.error();
        frame.reasons = std::move(*reasons);
        if (run.stereo > 0) frame.eye_reasons[0] = frame.eye_reasons[1] = frame.reasons;
        countByKey(scene, key_order, run.settings.stages, frame);
    }
    return out;
}

/// Counts what a frame's verdict does not tell: what reaches into the view, what the missed objects would show.
void measureFrame(const SceneFacts& facts, const CullRun& run, FrameResult& frame, JudgedFrame& out) {
    const Scene& scene = facts.scene();
    const View view = viewOf(frame.camera, run);
    std::vector<SightLines> eyes{SightLines(view)};
    if (run.stereo > 0) eyes.emplace_back(shiftedEye(view, run.stereo));
    std::vector<uint32_t> in_view, drawn;
    for (uint32_t object = 0; object < scene.objects.size(); ++object) {
        const auto reaches = [&](const SightLines& sight) { return sight.touches(facts.box(object)); };
        if (std::none_of(eyes.begin(), eyes.end(), reaches)) continue;
        in_view.push_back(object);
        if (frame.reasons[object] == 0) drawn.push_back(object);
    }
    out.in_view = keysAmong(scene, in_view);
    out.drawn_in_view = keysAmong(scene, drawn);
    VerificationRow& verdict = *frame.verification;
    std::vector<uint32_t> seen;
    std::set_difference(out.unsure.begin(), out.unsure.end(), verdict.kept_unseen.begin(), verdict.kept_unseen.end(),
                        std::back_inserter(seen));
    out.unsure_visible = keysAmong(scene, seen);
    if (verdict.rows.empty()) return;
    std::vector<Drawn> shown(scene.objects.size(), Drawn::kNever);
    for (size_t object = 0; object < shown.size(); ++object)
        if (frame.reasons[object] == 0) shown[object] = Drawn::kAlways;
    for (const FalseCullRow& row : verdict.rows) shown[row.object] = Drawn::kFullOnly;
    std::vector<uint64_t> pixels(shown.size());
    out.changed_pixels = countChangedPixels(facts, view, shown, {}, pixels);
    for (FalseCullRow& row : verdict.rows) row.pixels = pixels[row.object];
}

void measure(const Scene& scene, const JudgeOptions& options, Judged& judged) {
    const SceneFacts facts(scene);
    Progress progress("comparing", "frames", judged.frames.size());
    forEach(judged.frames.size(), options.threads, [&](size_t i) {
        if (judged.run.frames[i].verification) measureFrame(facts, judged.run, judged.run.frames[i], judged.frames[i]);
        progress.step();
    });
}

/// One picture for each missed object, of those that show most.
Status drawPictures(const Scene& scene, const JudgeOptions& options, Judged& judged) {
    std::vector<std::pair<size_t, const FalseCullRow*>> rows;  // by frame
    for (size_t i = 0; i < judged.run.frames.size(); ++i)
        if (const auto& verdict = judged.run.frames[i].verification)
            for (const FalseCullRow& row : verdict->rows) rows.emplace_back(i, &row);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.second->pixels > b.second->pixels; });
    if (rows.size() > kMostPictures)
        note(fmt::format("--pictures: {} of {} missed objects, those that show most", kMostPictures, rows.size()));
    rows.resize(std::min(rows.size(), kMostPictures));
    Progress progress("drawing", "pictures", rows.size());
    for (const auto& [frame, row] : rows) {
        View view = viewOf(judged.run.frames[frame].camera, judged.run);
        Emphasis emphasis;
        emphasis.object = row->object;
        emphasis.has_pixel = true;
        emphasis.x = row->x;
        emphasis.y = row->y;
        const std::string file = fmt::format("{}/missed-{:04}-{}.png", options.pictures, frame, row->key);
        if (Status written = writeFileAside(file, encodePng(explainPicture(scene, view, emphasis))); !written)
            return written;
        judged.pictures[{frame, row->object}] = file;
        progress.step();
    }
    return success();
}

/// "2, 5, 7 to 9" of the frames that were not judged.
std::string rangesOf(const std::vector<size_t>& numbers) {
    std::vector<std::string> parts;
    for (size_t i = 0; i < numbers.size();) {
        size_t end = i;
        while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
        parts.push_back(end == i ? fmt::format("{}", numbers[i])
                                 : fmt::format("{} {} {}", numbers[i], end == i + 1 ? "and" : "to", numbers[end]));
        i = end + 1;
    }
    constexpr size_t kMost = 20;
    if (parts.size() > kMost) parts.resize(kMost), parts.emplace_back("...");
    return joined(parts, ", ");
}

/// Frames of the path of which FILE says nothing.
std::vector<size_t> missingFrames(const Judged& judged, const Answers& answers) {
    std::set<size_t> there;
    for (const AnsweredFrame& frame : answers.frames) there.insert(frame.frame);
    std::vector<size_t> out;
    for (size_t i = 0; i < judged.frames.size(); ++i)
        if (!there.contains(i)) out.push_back(i);
    return out;
}

struct Totals {
    uint64_t in_view = 0, drawn_in_view = 0, unsure_visible = 0, changed_pixels = 0;
};

Totals totalsOf(const Judged& judged) {
    Totals sum;
    for (const JudgedFrame& frame : judged.frames) {
        sum.in_view += frame.in_view;
        sum.drawn_in_view += frame.drawn_in_view;
        sum.unsure_visible += frame.unsure_visible;
        sum.changed_pixels += frame.changed_pixels;
    }
    return sum;
}

/// Of so many drawn; infinite if none of several is visible.
double overEstimate(uint64_t drawn, uint64_t visible) {
    Verification one;
    one.reported = drawn;
    one.exactly_visible = visible;
    return one.overEstimate();
}

void tellRest(std::FILE* out, const Judged& judged, const Answers& answers, const JudgeOptions& options) {
    const auto sum = sumVerification(judged.run);
    const Totals totals = totalsOf(judged);
    if (sum)
        tell(out, fmt::format("in view      {} of {} drawn; the frustum alone would draw {}: over-estimate {:.3f}\n",
                              grouped(totals.drawn_in_view), grouped(sum->reported), grouped(totals.in_view),
                              overEstimate(totals.in_view, sum->exactly_visible)));
    if (sum && sum->false_culls > 0)
        tell(out, fmt::format("changed      {} show something else for want of what was missed\n",
                              counted(totals.changed_pixels, "pixel")));
    if (const std::vector<size_t> missing = missingFrames(judged, answers); !missing.empty())
        tell(out, fmt::format("missing      {} that {} does not have: {}\n", counted(missing.size(), "frame"),
                              oneLine(options.answers), rangesOf(missing)));
    if (judged.shared.empty()) return;
    const auto& [name, keys] = *judged.shared.begin();
    tell(out,
         fmt::format("not judged   {} visible objects, each drawn only if a shared name means it: {}, as \"{}\" of {} "
                     "objects. Call them by their keys to have them judged\n",
                     grouped(totals.unsure_visible), counted(judged.shared.size(), "such name"),
                     shortened(oneLine(name), 80), keys));
}

Json overEstimateJson(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json proofsJson(const ProofCounts& proofs) {
    return {{"not_drawn_hidden", proofs.culled_hidden},
            {"not_drawn_undecided", proofs.culled_undecided},
            {"drawn_hidden", proofs.kept_hidden},
            {"drawn_undecided", proofs.kept_undecided}};
}

Json frameJson(const Scene& scene, const Judged& judged, size_t i) {
    const FrameResult& frame = judged.run.frames[i];
    const VerificationRow& verdict = *frame.verification;
    const JudgedFrame& more = judged.frames[i];
    Json out = {{"frame", i}, {"camera", cameraJson(frame.camera)}};
    out["drawn"] = frame.visible.size();
    out["drawn_in_view"] = more.drawn_in_view;
    out["exactly_visible"] = verdict.exactly_visible;
    out["over_estimate"] = overEstimateJson(overEstimate(frame.visible.size(), verdict.exactly_visible));
    out["frustum_alone"] = more.in_view;
    out["false_culls"] = verdict.false_culls;
    out["changed_pixels"] = more.changed_pixels;
    if (!more.unsure.empty()) out["visible_by_shared_name"] = more.unsure_visible;
    if (verdict.proofs) out["proofs"] = proofsJson(*verdict.proofs);
    out["samples"] = verdict.rays;
    out["id_samples"] = verdict.id_samples;
    out["list"] = Json::array();
    for (const FalseCullRow& row : verdict.rows) {
        const SceneObject& object = scene.objects[row.object];
        Json missed = {{"key", row.key},          {"name", object.name},    {"path", objectPath(scene, object)},
                       {"pixel", {row.x, row.y}}, {"witness", row.witness}, {"pixels", row.pixels.value_or(0)}};
        if (const auto at = judged.pictures.find({i, row.object}); at != judged.pictures.end())
            missed["picture"] = at->second;
        out["list"].push_back(std::move(missed));
    }
    return out;
}

std::string judgeJson(const Scene& scene, const Judged& judged, const Answers& answers, const JudgeOptions& options) {
    const CullRun& run = judged.run;
    Json out;
    out["schema"] = "sightline.judge/1";
    out["scene"] = {
        {"file", run.scene}, {"objects", run.objects}, {"instances", run.instances}, {"triangles", run.triangles}};
    out["answers"] = options.answers;
    out["width"] = run.width;
    out["height"] = run.height;
    out["jitter"] = run.jitter;
    if (run.stereo > 0) out["stereo"] = run.stereo;
    out["frames"] = Json::array();
    for (size_t i = 0; i < run.frames.size(); ++i)
        if (run.frames[i].verification) out["frames"].push_back(frameJson(scene, judged, i));
    out["missing_frames"] = missingFrames(judged, answers);
    out["shared_names"] = Json::array();
    for (const auto& [name, keys] : judged.shared) out["shared_names"].push_back({{"name", name}, {"objects", keys}});
    if (const auto sum = sumVerification(run)) {
        const Totals totals = totalsOf(judged);
        Json& verdict = out["verdict"];
        verdict["false_culls"] = sum->false_culls;
        verdict["drawn"] = sum->reported;
        verdict["drawn_in_view"] = totals.drawn_in_view;
        verdict["not_drawn"] = sum->culled;
        verdict["exactly_visible"] = sum->exactly_visible;
        verdict["over_estimate"] = overEstimateJson(sum->overEstimate());
        verdict["frustum_alone"] = {
            {"drawn", totals.in_view},
            {"over_estimate", overEstimateJson(overEstimate(totals.in_view, sum->exactly_visible))}};
        verdict["changed_pixels"] = totals.changed_pixels;
        verdict["visible_by_shared_name"] = totals.unsure_visible;
        if (sum->proofs) verdict["proofs"] = proofsJson(*sum->proofs);
        verdict["samples"] = sum->rays;
        verdict["id_samples"] = sum->id_samples;
    }
    return jsonText(out, 1) + "\n";
}

/// Takes from the answers what the command line does not say: cameras, size, eyes, sections.
Result<CameraPath> settleViews(const Command& verb, const Scene& scene, const Answers& answers, JudgeOptions& options) {
    const PathChoice& choice = options.choice;
    const bool asked = !choice.file.empty() || !options.eye.empty() || !options.path.empty() ||
                       choice.walk.frames > 0 || choice.seeded;
    if (verb.count("--size") == 0 && answers.width) {
        options.width = *answers.width;
        options.height = *answers.height;
    }
    if (options.stereo == 0) options.stereo = answers.stereo;
    if (options.sections.count == 0)
        for (const glm::dvec4& plane : answers.sections)
            if (!options.sections.add(plane))
                return Error{Error::Kind::kInput,
                             fmt::format("{}: sections: more than {}", options.answers, ViewPlanes::kMost)};
    if (!asked && answers.cameras.frames.empty())
        return usageError(fmt::format("--cameras is required: {} has no cameras", oneLine(options.answers)));
    if (!asked) return answers.cameras;
    if (!answers.cameras.frames.empty())
        note(oneLine(options.answers) + ": its cameras are not used: the command line names others");
    return loadPath(scene, options);
}

Status checkOutputs(const JudgeOptions& options) {
    ApartFiles files = filesRead(options);
    files.read("--answers", options.answers);
    files.write("--json", options.json);
    if (!options.pictures.empty()) files.write("--pictures", options.pictures + "/missed-0000-0.png");
    if (!files.status()) return files.status();
    if (!options.pictures.empty())
        if (Status made = makeDirectory(options.pictures); !made) return made;
    return canWriteFiles({options.json});
}

/// The whole verb. Returns the exit code.
Result<int> runJudge(const Command& verb, JudgeOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    const Result<std::string> text = readTextFile(options.answers);
    if (!text) return text.error();
    const Result<Answers> answers = parseAnswers(*text, options.answers);
    if (!answers) return answers.error();
    if (Status good = checkOutputs(options); !good) return good.error();
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    const Result<CameraPath> path = settleViews(verb, *scene, *answers, options);
    if (!path) return path.error();
    Result<Judged> judged = readRunOf(*scene, *path, *answers, options);
    if (!judged) return judged.error();

    stopGently();
    verifyPath(*scene, options, judged->run);
    const size_t done = judgedFrames(judged->run), wanted = answers->frames.size();
    if (done == 0) return reportInterruption("no frame", false);
    measure(*scene, options, *judged);
    if (!options.pictures.empty())
        if (Status drawn = drawPictures(*scene, options, *judged); !drawn) return drawn.error();
    std::FILE* const out = options.json == "-" ? stderr : stdout;
    printVerdicts(out, judged->run);
    tellRest(out, *judged, *answers, options);
    tellFalseCulls(*scene, judged->run);
    if (!options.json.empty())
        if (Status written = writeText(options.json, judgeJson(*scene, *judged, *answers, options)); !written)
            return written.error();
    const int exit_code =
        done == wanted ? kDone : reportInterruption(fmt::format("{} of {} frames", done, wanted), true);
    return sumVerification(judged->run)->false_culls > 0 ? kAnswerIsNo : exit_code;
}

}  // namespace

void addJudge(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "judge");
    const auto options = std::make_shared<JudgeOptions>();
    options->jitter = 0;  // nobody else promises to hold under a shift of the image
    options->lines_are_hidden = true;
    addCameraOptions(*verb, *options, "the frames");
    verb->add_option("--answers", options->answers,
                     "what was drawn in each frame, as JSON or CSV: docs/judging.md, or cull --json")
        ->required()
        ->type_name("ANSWERS");
    verb->add_option(
            "--pictures", options->pictures,
            "write a picture of each missed object, of the 20 that show most: in blue, with a ring at the pixel")
        ->type_name("DIR");
    addSectionOptions(*verb, *options);
    addStereoOption(*verb, *options);
    addWitnessOptions(*verb, *options);
    verb->callback([verb, options, &exit_code] {
        const Result<int> done = runJudge(*verb, *options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
