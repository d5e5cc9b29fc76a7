// The verb `check`: the certificates of a run or a frame, held to exact arithmetic by somebody who has not culled.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_frame.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/bake/objects/scene_hash.h"
#include "sightline/query/record/frame_recording.h"
#include "sightline/tools/load/recorded_scene.h"
#include "sightline/tools/report/run/run_reader.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/tools/truth/cull_proof.h"

namespace sightline::cli {
using namespace tools;
namespace {

constexpr size_t kMostLines = 20;  // a run

struct CheckOptions {
    std::string file, json;
    SceneChoice scene;
    uint32_t threads = 0;
};

/// A cull that its certificate does not prove.
struct Unshown {
    uint32_t frame = 0, object = 0;
    double x = 0, y = 0;   ///< where a sight line passes all whom the certificate names  [pixels]
    bool visible = false;  ///< no other hides it there
};

struct CheckedFrame {
    uint64_t certificates = 0, named = 0, proved = 0, undecided = 0;
    std::vector<Unshown> unshown;
    bool done = false;
};

/// What is to be checked: a scene, and frames of it.
struct Checked {
    struct Frame {
        View view;
        std::vector<CertificateRow> certificates;
    };
    Scene scene;
    std::string title;  ///< of the scene
    std::vector<Frame> frames;
};

CheckedFrame checkFrameOf(const SceneFacts& facts, const Checked::Frame& frame, uint32_t number) {
    CheckedFrame out;
    CullProver prover(facts, frame.view);
    for (const CertificateRow& row : frame.certificates) {
        ++out.certificates;
        out.named += row.hiders.size();
        for (const uint32_t object : row.hidden) {
            std::vector<uint32_t> hiders = row.hiders;
            const auto at = std::lower_bound(hiders.begin(), hiders.end(), object);
            if (at == hiders.end() || *at != object)
                hiders.insert(at, object);  // of its own triangles some hide others
            const CullProof proof = prover.proveBy(object, hiders);
            if (proof.result == ProofResult::kProved) {
                ++out.proved;
                continue;
            }
            const bool visible = proof.result == ProofResult::kSeen;
            const bool by_others =
                proof.result == ProofResult::kOpen && prover.prove(object).result == ProofResult::kProved;
            if (visible || by_others) out.unshown.push_back({number, object, proof.x, proof.y, visible});
            else ++out.undecided;
        }
    }
    out.done = true;
    return out;
}

struct Sums {
    uint64_t frames = 0, certificates = 0, named = 0, proved = 0, undecided = 0;
    std::vector<Unshown> unshown;
};

Sums sumsOf(const std::vector<CheckedFrame>& frames) {
    Sums sums;
    for (const CheckedFrame& frame : frames) {
        if (!frame.done) continue;
        ++sums.frames;
        sums.certificates += frame.certificates;
        sums.named += frame.named;
        sums.proved += frame.proved;
        sums.undecided += frame.undecided;
        sums.unshown.insert(sums.unshown.end(), frame.unshown.begin(), frame.unshown.end());
    }
    return sums;
}

std::string textOf(const Sums& sums, const CheckOptions& options, const Checked& of) {
    const auto frames_with = std::count_if(of.frames.begin(), of.frames.end(),
                                           [](const Checked::Frame& frame) { return !frame.certificates.empty(); });
    std::string text = fmt::format("{}: {} frames, {} of them with certificates\n", oneLine(options.file),
                                   of.frames.size(), frames_with);
    text += fmt::format("certificates {:>10}  naming {:.1f} objects each\n", grouped(sums.certificates),
                        sums.certificates > 0 ? double(sums.named) / double(sums.certificates) : 0.0);
    text += fmt::format("proved       {:>10}  culls: whom their certificates name suffice, exactly\n",
                        grouped(sums.proved));
    text += fmt::format("not shown    {:>10}  culls: whom their certificates name leave something\n",
                        grouped(sums.unshown.size()));
    if (sums.undecided > 0)
        text += fmt::format("undecided    {:>10}  too much work, or left open by a double's last bit\n",
                            grouped(sums.undecided));
    return text;
}

std::string jsonOf(const Sums& sums, const CheckOptions& options, const Checked& of) {
    nlohmann::ordered_json json;
    json["schema"] = "sightline.check/1";
    json["file"] = options.file;
    json["scene"] = of.title;
    json["frames"] = sums.frames;
    json["of"] = of.frames.size();
    json["certificates"] = sums.certificates;
    json["proved"] = sums.proved;
    json["undecided"] = sums.undecided;
    json["not_shown"] = nlohmann::ordered_json::array();
    for (const Unshown& cull : sums.unshown)
        json["not_shown"].push_back({{"frame", cull.frame},
                                     {"object", cull.object},
                                     {"path", objectPath(of.scene, of.scene.objects[cull.object])},
                                     {"pixel", {cull.x, cull.y}},
                                     {"visible", cull.visible}});
    return jsonText(json, 2) + "\n";
}

void tellUnshown(const Sums& sums, const Scene& scene) {
    for (size_t i = 0; i < std::min(sums.unshown.size(), kMostLines); ++i) {
        const Unshown& cull = sums.unshown[i];
        const std::string line = fmt::format(
            "frame {}: object {} \"{}\" is not hidden at pixel ({:.3f}, {:.3f}) by whom its certificate names{}\n",
            cull.frame, cull.object, oneLine(objectPath(scene, scene.objects[cull.object]), 200), cull.x, cull.y,
            cull.visible ? ", but visible there" : ", but by others");
        (void)std::fwrite(line.data(), 1, line.size(), stderr);
    }
    if (sums.unshown.size() > kMostLines) {
        const std::string line = fmt::format("and {} more\n", sums.unshown.size() - kMostLines);
        (void)std::fwrite(line.data(), 1, line.size(), stderr);
    }
}

/// The certificates of a run as JSON, and the scene that was culled.
Result<Checked> readRunToCheck(const CheckOptions& options) {
    if (options.scene.names.empty()) return usageError("SCENE is required: the one that was culled");
    const Result<RunFile> read = readRun(options.file);
    if (!read) return read.error();
    const CullRun& run = read->run;
    if (run.scene_hash.empty())
        return Error{Error::Kind::kInput,
                     read->file +
                         ": holds no certificates: `sightline cull SCENE --remember --certificates --json FILE`"
                         " writes them"};
    Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (run.scene_hash != fmt::format("{:016x}", bake::hashOf(*scene)) || run.instances != scene->objects.size())
        return Error{Error::Kind::kInput, fmt::format("{}: scene.hash: of another scene than {}", read->file,
                                                      oneLine(options.scene.title()))};
    Checked out{std::move(*scene), options.scene.title(), {}};
    for (size_t i = 0; i < run.frames.size(); ++i) {
        out.frames.push_back({viewOf(run.frames[i].camera, run), run.frames[i].certificates});
        if (!isUsable(out.frames.back().view))
            return Error{Error::Kind::kInput, fmt::format("{}: frames[{}].camera: no view", read->file, i)};
    }
    return out;
}

/// The certificates of a recorded frame, which has its own objects.
Result<Checked> readRecordingToCheck(const CheckOptions& options, const std::string& bytes) {
    if (!options.scene.names.empty()) return usageError("a recording holds its objects: there is no SCENE to name");
    const Result<FrameRecording> recording = parseRecording(bytes, options.file);
    if (!recording) return recording.error();
    Checked out{recordedScene(*recording), options.file, {{recording->view, {}}}};
    std::map<std::vector<uint32_t>, std::vector<uint32_t>> hidden_by;
    for (const FrameRecording::Certificate& certificate : recording->certificates) {
        const std::span<const uint32_t> named = recording->namedBy(certificate);
        hidden_by[{named.begin(), named.end()}].push_back(certificate.hidden);
    }
    for (auto& [hiders, hidden] : hidden_by) out.frames[0].certificates.push_back({hiders, std::move(hidden)});
    return out;
}

Result<Checked> readToCheck(const CheckOptions& options) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(options.file, ignored)) {
        const Result<std::string> bytes = readTextFile(options.file);
        if (!bytes) return bytes.error();
        if (isRecording(*bytes)) return readRecordingToCheck(options, *bytes);
    }
    return readRunToCheck(options);
}

/// The whole verb. Returns the exit code.
Result<int> runCheck(CheckOptions& options) {
    ApartFiles files;
    files.read("FILE", options.file);
    for (const std::string& name : options.scene.names) files.read("SCENE", name);
    files.write("--json", options.json);
    if (!files.status()) return files.status().error();
    const Result<Checked> of = readToCheck(options);
    if (!of) return of.error();
    if (Status writable = canWriteFiles({options.json}); !writable) return writable.error();

    stopGently();
    const SceneFacts facts(of->scene);
    std::vector<CheckedFrame> checked(of->frames.size());
    {
        Progress progress("checking", "frames", of->frames.size());
        const uint32_t threads =
            options.threads > 0 ? options.threads : std::max(std::thread::hardware_concurrency(), 1u);
        forEach(of->frames.size(), threads, [&](size_t i) {
            if (interrupted()) return;
            checked[i] = checkFrameOf(facts, of->frames[i], static_cast<uint32_t>(i));
            progress.step();
        });
    }
    const Sums sums = sumsOf(checked);
    const bool whole = sums.frames == of->frames.size();
    if (sums.frames == 0 && !whole) return reportInterruption("no frame", false);
    tell(options.json == "-" ? stderr : stdout, textOf(sums, options, *of));
    tellUnshown(sums, of->scene);
    if (!options.json.empty())
        if (Status written = writeText(options.json, jsonOf(sums, options, *of)); !written) return written.error();
    if (!sums.unshown.empty()) return kAnswerIsNo;
    return whole ? kDone : reportInterruption(fmt::format("{} of {} frames", sums.frames, of->frames.size()), true);
}

}  // namespace

void addCheck(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "check");
    const auto options = std::make_shared<CheckOptions>();
    verb->add_option("FILE", options->file,
                     "of cull --remember --certificates --json, or the report's directory; or of cull --remember "
                     "--record, which "
                     "needs no SCENE")
        ->required();
    addSceneChoice(*verb, options->scene);
    verb->get_option("SCENE")->required(false)->expected(0, 1000);
    verb->add_option("--threads", options->threads, "share the frames among so many (default: all cores)")
        ->check(Range{1u, kMostThreads})
        ->type_name("N");
    verb->add_option("--json", options->json, "write the result as JSON (-: standard output)")->type_name("FILE");
    verb->callback([options, &exit_code] {
        const Result<int> done = runCheck(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
