// Two runs of one path beside one another: what B keeps, costs and gets wrong against A.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/compare_runs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <set>
#include <unordered_map>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/camera_json.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
namespace {

constexpr uint64_t kOnlyB = 1ull << 63;  // marks a key of B that A has no word for

/// Carries keys of B into those of A.
class Translation {
public:
    Translation(const RunFile& a, const RunFile& b) {
        std::unordered_map<uint64_t, const KeyName*> of_a;
        for (const KeyName& name : a.names) of_a[name.key] = &name;
        for (const KeyName& name : b.names) {
            const auto found = of_a.find(name.key);
            if (found != of_a.end() && !name.path.empty() && !found->second->path.empty())
                by_path |= found->second->path != name.path;
        }
        if (!by_path) return;
        const auto places = [](const RunFile& file) {
            std::unordered_map<std::string, std::vector<uint64_t>> out;
            for (const KeyName& name : file.names)
                if (!name.path.empty()) out[name.path].push_back(name.key);
            return out;
        };
        const auto in_a = places(a);
        for (const auto& [path, keys] : places(b)) {
            const auto found = in_a.find(path);
            if (found == in_a.end()) continue;
            for (size_t i = 0; i < std::min(keys.size(), found->second.size()); ++i) to_a_[keys[i]] = found->second[i];
        }
    }

    std::vector<uint64_t> idsOf(const std::vector<uint64_t>& keys) const {
        std::vector<uint64_t> ids;
        for (const uint64_t key : keys) ids.push_back(idOf(key));
        std::sort(ids.begin(), ids.end());
        return ids;
    }
    uint64_t idOf(uint64_t key) const {
        if (!by_path) return key;
        const auto found = to_a_.find(key);
        return found == to_a_.end() ? key | kOnlyB : found->second;
    }

    bool by_path = false;

private:
    std::unordered_map<uint64_t, uint64_t> to_a_;
};

std::string number(uint64_t value) { return readable(static_cast<double>(value)); }

std::string cameraKey(const FrameResult& frame) { return jsonText(cameraJson(frame.camera)); }

void pairFrames(const CullRun& a, const CullRun& b, RunComparison& out) {
    std::map<std::string, std::deque<size_t>> of_b;
    for (size_t i = 0; i < b.frames.size(); ++i) of_b[cameraKey(b.frames[i])].push_back(i);
    for (size_t i = 0; i < a.frames.size(); ++i) {
        const auto found = of_b.find(cameraKey(a.frames[i]));
        if (found == of_b.end() || found->second.empty()) continue;
        FramePair pair;
        pair.a = i;
        pair.b = found->second.front();
        found->second.pop_front();
        const double before = a.frames[i].query_microseconds, after = b.frames[pair.b].query_microseconds;
        pair.ratio = before > 0 ? after / before : 1;
        out.pairs.push_back(std::move(pair));
    }
    out.unpaired_a = a.frames.size() - out.pairs.size();
    out.unpaired_b = b.frames.size() - out.pairs.size();
}

void compareSets(const CullRun& a, const CullRun& b, const Translation& translation, RunComparison& out) {
    for (FramePair& pair : out.pairs) {
        const std::vector<uint64_t>& in_a = a.frames[pair.a].visible;
        const std::vector<uint64_t> in_b = translation.idsOf(b.frames[pair.b].visible);
        std::set_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(), std::back_inserter(pair.only_a));
        std::set_difference(in_b.begin(), in_b.end(), in_a.begin(), in_a.end(), std::back_inserter(pair.only_b));
        out.kept_a += in_a.size();
        out.kept_b += in_b.size();
        out.only_a += pair.only_a.size();
        out.only_b += pair.only_b.size();
        out.triangles_a += a.frames[pair.a].triangles;
        out.triangles_b += b.frames[pair.b].triangles;
    }
}

std::vector<RunComparison::Difference> differencesOf(const RunFile& a, const RunFile& b, const RunComparison& out) {
    std::map<uint64_t, RunComparison::Difference> found;
    for (const FramePair& pair : out.pairs) {
        for (const uint64_t id : pair.only_a) ++found[id].only_a;
        for (const uint64_t id : pair.only_b) ++found[id].only_b;
    }
    std::unordered_map<uint64_t, const KeyName*> of_a, of_b;
    for (const KeyName& name : a.names) of_a[name.key] = &name;
    for (const KeyName& name : b.names) of_b[name.key] = &name;
    std::vector<RunComparison::Difference> rows;
    for (auto& [id, row] : found) {
        row.id = id;
        const auto in_a = of_a.find(id), in_b = of_b.find(id & ~kOnlyB);
        const KeyName* const name = in_a != of_a.end() ? in_a->second : in_b != of_b.end() ? in_b->second : nullptr;
        if (name) {
            row.name = name->name;
            row.path = name->path;
        }
        rows.push_back(row);
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& x, const auto& y) { return x.only_a + x.only_b > y.only_a + y.only_b; });
    return rows;
}

void compareTimes(const CullRun& a, const CullRun& b, RunComparison& out) {
    std::vector<double> ratios, times_a, times_b;
    for (const FramePair& pair : out.pairs) {
        ratios.push_back(pair.ratio);
        times_a.push_back(a.frames[pair.a].query_microseconds);
        times_b.push_back(b.frames[pair.b].query_microseconds);
    }
    if (ratios.empty()) return;
    std::sort(ratios.begin(), ratios.end());
    out.median_a = medianOf(times_a);
    out.median_b = medianOf(times_b);
    out.ratio = medianOf(ratios);
    out.ratio_low = ratios[(ratios.size() - 1) / 10];
    out.ratio_high = ratios[ratios.size() - 1 - (ratios.size() - 1) / 10];
}

std::optional<double> overEstimateOver(const CullRun& run, const RunComparison& out, size_t FramePair::*side) {
    Verification sum;
    for (const FramePair& pair : out.pairs) {
        const FrameResult& frame = run.frames[pair.*side];
        if (!frame.verification) return std::nullopt;
        sum.exactly_visible += frame.verification->exactly_visible;
        sum.reported += frame.visible.size();
    }
    if (out.pairs.empty()) return std::nullopt;
    return sum.overEstimate();
}

void compareFalseCulls(const CullRun& a, const CullRun& b, const Translation& translation, RunComparison& out) {
    const auto keysOf = [](const FrameResult& frame) {
        std::set<uint64_t> keys;
        if (frame.verification)
            for (const FalseCullRow& row : frame.verification->rows) keys.insert(row.key);
        return keys;
    };
    for (const FrameResult& frame : a.frames) out.false_a += keysOf(frame).size();
    for (const FrameResult& frame : b.frames) out.false_b += keysOf(frame).size();
    out.new_false = out.false_b;
    for (const FramePair& pair : out.pairs) {
        const std::set<uint64_t> known = keysOf(a.frames[pair.a]);
        for (const uint64_t key : keysOf(b.frames[pair.b])) out.new_false -= known.count(translation.idOf(key));
    }
}

std::string sentenceOfSets(const RunComparison& out) {
    if (out.only_a + out.only_b == 0) return "Both keep the same objects in every pair of frames.";
    const auto frames = static_cast<double>(out.pairs.size());
    const double a = double(out.kept_a) / frames, b = double(out.kept_b) / frames;
    return fmt::format("B keeps {} objects a frame where A keeps {}: {} times an object only A kept, {} times only B.",
                       readable(b), readable(a), number(out.only_a), number(out.only_b));
}

std::string sentenceOfTimes(const RunComparison& out) {
    const std::string range = fmt::format("{} to {} in the middle eight tenths of the frames",
                                          readable(out.ratio_low, 3), readable(out.ratio_high, 3));
    if (out.ratio_low <= 1 && out.ratio_high >= 1)
        return fmt::format("Times do not tell them apart: B takes {} times as long as A, {}.", readable(out.ratio, 3),
                           range);
    return fmt::format("B is {}: it takes {} times as long as A, {}.", out.ratio < 1 ? "faster" : "slower",
                       readable(out.ratio, 3), range);
}

void judge(RunComparison& out, std::optional<double> most_ratio) {
    if (out.pairs.empty()) {
        out.ok = out.unpaired_a + out.unpaired_b == 0;  // of runs without frames nothing is wrong
        out.verdict.push_back("No frame of B has the camera of a frame of A: there is nothing to compare.");
    } else {
        if (!out.same_scene) out.verdict.push_back("The scenes are not the same: their objects or triangles differ.");
        if (!out.same_size) out.verdict.push_back("The viewports differ in size.");
        if (out.by_path) out.verdict.push_back("Keys stand for other objects in B: objects are told by their paths.");
        out.verdict.push_back(sentenceOfSets(out));
        out.verdict.push_back(sentenceOfTimes(out));
    }
    if (out.new_false > 0) {
        out.ok = false;
        out.verdict.push_back(fmt::format("B has {} that A has not.", counted(out.new_false, "false cull")));
    }
    if (most_ratio && !out.pairs.empty() && out.ratio > *most_ratio) {
        out.ok = false;
        out.verdict.push_back(
            fmt::format("That is slower than the {} times that were allowed.", readable(*most_ratio, 3)));
    }
}

using Json = nlohmann::ordered_json;

Json sideJson(const RunFile& file) {
    return {{"file", file.file},
            {"scene", file.run.scene},
            {"objects", file.run.objects},
            {"triangles", file.run.triangles},
            {"width", file.run.width},
            {"height", file.run.height},
            {"frames", file.run.frames.size()}};
}

Json optionalJson(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

}  // namespace

RunComparison compareRuns(const RunFile& a, const RunFile& b, std::optional<double> most_ratio) {
    RunComparison out;
    const Translation translation(a, b);
    out.by_path = translation.by_path;
    out.same_scene = a.run.objects == b.run.objects && a.run.triangles == b.run.triangles;
    out.same_size = a.run.width == b.run.width && a.run.height == b.run.height;
    pairFrames(a.run, b.run, out);
    compareSets(a.run, b.run, translation, out);
    compareTimes(a.run, b.run, out);
    compareFalseCulls(a.run, b.run, translation, out);
    out.over_estimate_a = overEstimateOver(a.run, out, &FramePair::a);
    out.over_estimate_b = overEstimateOver(b.run, out, &FramePair::b);
    out.differences = differencesOf(a, b, out);
    judge(out, most_ratio);
    return out;
}

std::string compareJson(const RunComparison& c, const RunFile& a, const RunFile& b, size_t most) {
    Json head;
    head["schema"] = "sightline.compare/1";
    head["a"] = sideJson(a);
    head["b"] = sideJson(b);
    head["ok"] = c.ok;
    head["verdict"] = c.verdict;
    head["paired"] = c.pairs.size();
    head["unpaired"] = {{"a", c.unpaired_a}, {"b", c.unpaired_b}};
    head["by_path"] = c.by_path;
    head["time"] = {{"a_microseconds", c.median_a},
                    {"b_microseconds", c.median_b},
                    {"ratio", c.ratio},
                    {"ratio_low", c.ratio_low},
                    {"ratio_high", c.ratio_high}};
    head["kept"] = {{"a", c.kept_a}, {"b", c.kept_b}, {"only_a", c.only_a}, {"only_b", c.only_b}};
    head["triangles"] = {{"a", c.triangles_a}, {"b", c.triangles_b}};
    head["over_estimate"] = {{"a", optionalJson(c.over_estimate_a)}, {"b", optionalJson(c.over_estimate_b)}};
    head["false_culls"] = {{"a", c.false_a}, {"b", c.false_b}, {"new", c.new_false}};
    head["frames"] = Json::array();
    for (const FramePair& pair : c.pairs)
        head["frames"].push_back({{"a", pair.a},
                                  {"b", pair.b},
                                  {"ratio", pair.ratio},
                                  {"only_a", pair.only_a.size()},
                                  {"only_b", pair.only_b.size()}});
    head["objects"] = Json::array();
    for (size_t i = 0; i < std::min(c.differences.size(), most); ++i) {
        const RunComparison::Difference& row = c.differences[i];
        head["objects"].push_back({{"key", row.id & ~kOnlyB},
                                   {"name", row.name},
                                   {"path", row.path},
                                   {"frames_only_a", row.only_a},
                                   {"frames_only_b", row.only_b}});
    }
    return jsonText(head, 1) + "\n";
}

}  // namespace sightline::tools
