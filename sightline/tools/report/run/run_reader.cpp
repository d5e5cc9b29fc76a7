// Reads what `cull --json` wrote: the schema sightline.cull/1, from a stranger's file.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/run_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/geom/setting_rows.h"
#include "sightline/tools/report/run/json_place.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

using nlohmann::json;
using Fault = JsonFault;
using At = JsonAt;

constexpr uint64_t kMostSide = 1u << 20;  // [pixels]
constexpr uint64_t kMostSupersampling = 1024;

/// Keys from here on are none of ours: a comparison marks what only B has by the highest bit.
constexpr uint64_t kMostKey = (1ull << 63) - 1;

std::vector<uint64_t> ascending(const At& list, uint64_t most, const char* what) {
    std::vector<uint64_t> out;
    out.reserve(list.size());
    for (size_t i = 0; i < list.size(); ++i) {
        const At entry = list.element(i);
        out.push_back(entry.whole(0, most));
        if (i > 0 && out[i] <= out[i - 1]) entry.fail(std::string(what) + " do not ascend");
    }
    return out;
}

std::vector<uint64_t> keysOf(const At& list) { return ascending(list, kMostKey, "keys"); }

/// Places of objects in the scene.
std::vector<uint32_t> placesOf(const At& list, const CullRun& run) {
    if (run.instances == 0 && list.size() > 0) list.fail("the scene has no objects");
    const auto places = ascending(list, std::min<uint64_t>(run.instances - 1, UINT32_MAX - 1), "objects");
    return {places.begin(), places.end()};
}

CameraFrame cameraOf(const At& at) {
    CameraFrame camera;
    at.member("eye").numbers(&camera.eye.x, 3);
    at.member("target").numbers(&camera.target.x, 3);
    at.member("up").numbers(&camera.up.x, 3);
    if (const auto angle = at.maybe("fov_y_degrees")) camera.fov_y_degrees = angle->number();
    if (const auto near = at.maybe("near")) camera.z_near = near->number();
    if (const auto far = at.maybe("far")) camera.z_far = far->number();
    if (const auto height = at.maybe("orthographic_height")) camera.orthographic_height = height->number();
    const auto view = at.maybe("view"), projection = at.maybe("projection");
    if (view.has_value() != projection.has_value()) at.fail("one matrix without the other");
    if (view) {
        camera.view.emplace();
        camera.projection.emplace();
        view->numbers(&(*camera.view)[0].x, 16);
        projection->numbers(&(*camera.projection)[0].x, 16);
    }
    return camera;
}

ClusterRow clustersOf(const At& at) {
    return {at.member("tested").whole(), at.member("back").whole(),  at.member("outside").whole(),
            at.member("hidden").whole(), at.member("whole").whole(), at.member("drawn").whole(),
            at.member("draws").whole()};
}

CellRow cellsOf(const At& at) {
    CellRow row;
    row.known = at.member("known").flag();
    row.cells = at.member("entered").whole();
    row.portals = at.member("portals").whole();
    row.whole = at.member("whole").whole();
    row.too_deep = at.member("too_deep").whole();
    return row;
}

VisibilityAsked visibilityOf(const At& at) {
    VisibilityAsked asked;
    asked.file = at.member("file").text();
    if (const auto doors = at.maybe("doors"))
        for (size_t i = 0; i < doors->size(); ++i)
            asked.doors.push_back({doors->element(i).member("name").text(), doors->element(i).member("open").number()});
    return asked;
}

void readSetting(const At& at, const SettingRow<PortalWindows>&, PortalWindows& out) {
    const std::string name = at.text();
    const auto* const found = std::find(std::begin(kWindowNames), std::end(kWindowNames), name);
    if (found == std::end(kWindowNames)) at.fail("there are no such windows");
    out = static_cast<PortalWindows>(found - std::begin(kWindowNames));
}
void readSetting(const At& at, const SettingRow<bool>&, bool& out) { out = at.flag(); }
void readSetting(const At& at, const SettingRow<double>&, double& out) { out = at.positive(); }
void readSetting(const At& at, const SettingRow<uint32_t>& row, uint32_t& out) {
    out = static_cast<uint32_t>(at.whole(static_cast<uint64_t>(row.least), static_cast<uint64_t>(row.most)));
}

/// What a run had besides its stages, which its frames tell.
void readSettings(const At& head, QuerySettings& settings) {
    forEachSetting([&](const auto& row) {
        if (const auto at = head.maybe(row.name)) readSetting(*at, row, settings.*row.member);
        // Runs of earlier versions have these two beside their visibility file.
        else if (const auto visibility = head.maybe("visibility"))
            if (const auto there = visibility->maybe(row.name)) readSetting(*there, row, settings.*row.member);
    });
}

void readStages(const At& list, FrameResult& frame, uint32_t& stages) {
    stages = 0;
    for (size_t i = 0; i < list.size(); ++i) {
        const At at = list.element(i);
        const std::string name = at.member("name").text();
        const auto* const found = std::find(std::begin(kStageNames), std::end(kStageNames), name);
        if (found == std::end(kStageNames)) at.member("name").fail("there is no such stage");
        const auto stage = static_cast<size_t>(found - std::begin(kStageNames));
        if (stages >> stage & 1) at.member("name").fail("named twice");
        stages |= 1u << stage;  // facing, too, to find what is named twice
        StageRow& row = frame.stages[stage];
        row.tested = at.member("tested").whole();
        row.culled = at.member("culled").whole();
        if (row.culled > row.tested) at.member("culled").fail("more than were tested");
        row.instances = row.culled;
        if (const auto instances = at.maybe("instances")) row.instances = instances->whole();
        if (const auto doubt = at.maybe("doubt")) row.doubt = doubt->whole();
        row.microseconds = at.member("microseconds").positive();
    }
    stages &= kAllStages;
}

uint32_t offOf(const At& at) {
    const std::string name = at.text();
    for (const OffRow& row : kOffRows)
        if (name == row.name) return offBit(row.off);
    at.fail("nothing of this name can be switched off");
}

/// Keys stand where places in the list of names will be.
VerificationRow verificationOf(const At& at, std::vector<uint64_t>& unseen) {
    VerificationRow row;
    row.false_culls = at.member("false_culls").whole();
    row.rays = at.member("samples").whole();
    row.exactly_visible = at.member("exactly_visible").whole();
    if (const auto aimed = at.maybe("aimed_samples")) row.aimed_rays = aimed->whole();
    if (const auto samples = at.maybe("id_samples")) row.id_samples = samples->whole();
    if (const auto side = at.maybe("supersampling"))
        row.supersampling = static_cast<uint32_t>(side->whole(0, kMostSupersampling));
    if (const auto unconfirmed = at.maybe("unconfirmed")) row.unconfirmed = unconfirmed->whole();
    if (const auto proofs = at.maybe("proofs"))
        row.proofs = ProofCounts{proofs->member("culled_hidden").whole(), proofs->member("culled_undecided").whole(),
                                 proofs->member("kept_hidden").whole(), proofs->member("kept_undecided").whole()};
    if (const auto seen = at.maybe("lossy_seen")) row.lossy_seen = seen->whole();
    if (const auto list = at.maybe("list"))
        for (size_t i = 0; i < list->size(); ++i) {
            const At entry = list->element(i);
            FalseCullRow cull;
            cull.key = entry.member("key").whole(0, kMostKey);
            double pixel[2];
            entry.member("pixel").numbers(pixel, 2);
            cull.x = pixel[0];
            cull.y = pixel[1];
            cull.witness = entry.member("witness").text();
            row.rows.push_back(cull);
        }
    if (row.false_culls > 0 && row.rows.empty()) at.member("false_culls").fail("more than are listed");
    if (const auto list = at.maybe("kept_unseen")) unseen = keysOf(*list);
    return row;
}

void readFrame(const At& at, CullRun& run, uint32_t& stages, FrameResult& frame, std::vector<uint64_t>& unseen) {
    frame.camera = cameraOf(at.member("camera"));
    const At visible = at.member("visible");
    frame.visible = keysOf(visible);
    if (frame.visible.size() > run.objects) visible.fail("more than the scene has");
    frame.objects_visible = frame.visible.size();
    if (const auto instances = at.maybe("instances")) frame.objects_visible = instances->whole(0, run.instances);
    if (const auto eyes = at.maybe("eyes")) {
        if (eyes->size() != frame.visible.size()) eyes->fail("not one for each that is visible");
        for (size_t i = 0; i < eyes->size(); ++i)
            frame.eyes.push_back(static_cast<uint8_t>(eyes->element(i).whole(1, 3)));
    }
    readStages(at.member("stages"), frame, stages);
    frame.triangles = at.member("triangles").whole();
    if (const auto alone = at.maybe("frustum_alone"))
        frame.frustum_alone = {alone->member("objects").whole(0, run.objects), alone->member("triangles").whole()};
    if (const auto clusters = at.maybe("clusters")) frame.clusters = clustersOf(*clusters);
    if (const auto cells = at.maybe("cells")) frame.cells = cellsOf(*cells);
    if (const auto certificates = at.maybe("certificates"))
        for (size_t i = 0; i < certificates->size(); ++i) {
            const At row = certificates->element(i);
            frame.certificates.push_back({placesOf(row.member("hiders"), run), placesOf(row.member("hidden"), run)});
        }
    frame.query_microseconds = at.member("query_microseconds").positive();
    const auto count = [&](const char* name, uint64_t& out) {
        if (const auto value = at.maybe(name)) out = value->whole();
    };
    for (const CounterRow& row : kQueryCounters)
        if (row.kind != CounterRow::kOfAnswer) count(row.name, frame.stats.*row.member);
    for (const CounterFlagRow& row : kQueryFlags)
        if (const auto flag = at.maybe(row.name)) frame.stats.*row.member = flag->flag();
    if (const auto off = at.maybe("off"))
        for (size_t i = 0; i < off->size(); ++i) frame.stats.off |= offOf(off->element(i));
    if (const auto changed = at.maybe("changed_pixels"))
        frame.changed_pixels = changed->whole(0, uint64_t{run.width} * run.height);
    if (const auto thread = at.maybe("thread")) frame.thread = static_cast<uint32_t>(thread->whole(0, 65535));
    if (const auto begin = at.maybe("begin_microseconds")) frame.begin_microseconds = begin->positive();
    if (const auto end = at.maybe("end_microseconds")) frame.end_microseconds = end->positive();
    if (const auto verification = at.maybe("verification")) frame.verification = verificationOf(*verification, unseen);
}

/// Every key that the run speaks of, by name where the file has one.
std::vector<KeyName> namesOf(const At& head, const CullRun& run, const std::vector<std::vector<uint64_t>>& unseen) {
    std::vector<KeyName> names;
    if (const auto list = head.maybe("objects"))
        for (size_t i = 0; i < list->size(); ++i) {
            const At at = list->element(i);
            names.push_back({at.member("key").whole(0, kMostKey), at.member("name").text(), at.member("path").text()});
            if (i > 0 && names[i].key <= names[i - 1].key) at.member("key").fail("keys do not ascend");
        }
    std::vector<uint64_t> keys;
    for (size_t i = 0; i < run.frames.size(); ++i) {
        const FrameResult& frame = run.frames[i];
        keys.insert(keys.end(), frame.visible.begin(), frame.visible.end());
        keys.insert(keys.end(), unseen[i].begin(), unseen[i].end());
        if (frame.verification)
            for (const FalseCullRow& row : frame.verification->rows) keys.push_back(row.key);
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<KeyName> all;
    size_t at = 0;
    for (const uint64_t key : keys) {
        while (at < names.size() && names[at].key < key) ++at;
        all.push_back(at < names.size() && names[at].key == key ? names[at] : KeyName{key, "", ""});
    }
    return all;
}

uint32_t placeOf(const std::vector<KeyName>& names, uint64_t key) {
    const auto found = std::lower_bound(names.begin(), names.end(), key,
                                        [](const KeyName& name, uint64_t wanted) { return name.key < wanted; });
    return static_cast<uint32_t>(found - names.begin());
}

RunFile readHead(const At& head) {
    if (head.member("schema").text() != "sightline.cull/1") head.member("schema").fail("not sightline.cull/1");
    RunFile file;
    CullRun& run = file.run;
    const At scene = head.member("scene");
    run.scene = scene.member("file").text();
    run.objects = scene.member("objects").whole();
    run.triangles = scene.member("triangles").whole();
    run.instances = run.objects;
    if (const auto instances = scene.maybe("instances")) run.instances = instances->whole();
    if (const auto hash = scene.maybe("hash")) run.scene_hash = hash->text();
    run.width = static_cast<uint32_t>(head.member("width").whole(1, kMostSide));
    run.height = static_cast<uint32_t>(head.member("height").whole(1, kMostSide));
    if (const auto jitter = head.maybe("jitter")) run.jitter = jitter->positive();
    readSettings(head, run.settings);
    if (const auto sections = head.maybe("sections"))
        for (size_t i = 0; i < sections->size(); ++i) {
            glm::dvec4 plane;
            sections->element(i).numbers(&plane.x, 4);
            if (!run.sections.add(plane)) sections->fail("too many planes");
        }
    if (const auto asked = head.maybe("visibility")) run.visibility = visibilityOf(*asked);
    if (const auto test = head.maybe("cluster_test")) run.cluster_test = test->positive();
    if (const auto stereo = head.maybe("stereo")) run.stereo = stereo->positive();
    if (const auto repeat = head.maybe("repeat")) run.repeat = static_cast<int>(repeat->whole(1, 1000000));
    if (const auto interrupted = head.maybe("interrupted")) run.interrupted = interrupted->flag();
    if (const auto wanted = head.maybe("frames_wanted")) run.frames_wanted = wanted->whole();
    const At frames = head.member("frames");
    std::vector<std::vector<uint64_t>> unseen(frames.size());
    run.frames.resize(frames.size());
    for (size_t i = 0; i < run.frames.size(); ++i) {
        uint32_t stages = 0;
        readFrame(frames.element(i), run, stages, run.frames[i], unseen[i]);
        if (i > 0 && stages != run.settings.stages)
            frames.element(i).member("stages").fail("other stages than frame 0");
        run.settings.stages = stages;
    }
    file.names = namesOf(head, run, unseen);
    for (size_t i = 0; i < run.frames.size(); ++i) {
        if (!run.frames[i].verification) continue;
        VerificationRow& row = *run.frames[i].verification;
        for (const uint64_t key : unseen[i]) row.kept_unseen.push_back(placeOf(file.names, key));
        for (FalseCullRow& cull : row.rows) cull.object = placeOf(file.names, cull.key);
    }
    return file;
}

}  // namespace

std::string RunFile::labelOf(uint64_t key) const {
    const uint32_t place = placeOf(names, key);
    if (place < names.size() && names[place].key == key && !names[place].path.empty()) return names[place].path;
    return fmt::format("object {}", key);
}

Result<RunFile> parseRun(std::string_view text, const std::string& file) {
    try {
        const json document = parseJson(text);
        RunFile out = readHead({&document, ""});
        out.file = file;
        return out;
    } catch (const Fault& fault) {
        return Error{Error::Kind::kInput, file + ": " + fault.what};
    } catch (const json::exception& error) {
        const size_t first = text.find_first_not_of(" \t\r\n");
        if (first == std::string_view::npos || text[first] != '{')
            return Error{Error::Kind::kInput, file + ": is no run: `sightline cull --json FILE` writes one"};
        return Error{Error::Kind::kInput, file + ": not JSON: " + jsonFaultOf(error.what())};
    }
}

Result<RunFile> readRun(const std::string& path) {
    std::error_code ignored;
    const bool directory = std::filesystem::is_directory(path, ignored);
    const std::string file = directory ? (std::filesystem::path(path) / "cull.json").string() : path;
    const Result<std::string> text = readTextFile(file);
    if (!text) return text.error();
    Result<RunFile> run = parseRun(*text, file);
    if (run) {
        const std::filesystem::path parent = std::filesystem::path(file).parent_path();
        run->directory = parent.empty() ? "./" : (parent / "").string();
    }
    return run;
}

}  // namespace sightline::tools
