// Every pair of options of cull: nothing visible is culled and each object is accounted for, or one line refuses the pair.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

using OptionPairs = Tool;

/// Each works alone.
const char* const kOptions[] = {
    "--size 200x120",
    "--visibility b.slvis",
    "--visibility b.slvis --windows boxes",
    "--visibility b.slvis --portal-depth 2",
    "--remember",
    "--remember --propose",
    "--remember --taught",
    "--remember --certificates",
    "--list",
    "--report R",
    "--split materials",
    "--split grid:2",
    "--up z",
    "--unit ft",
    "--sides both",
    "--seed 5",
    "--path walk --fps 5",
    "--path orbit",
    "--path scatter",
    "--eye 3,1.6,-2",
    "--repeat 2",
    "--use frustum,occlusion,volumes",
    "--use frustum,occlusion,clusters",
    "--use frustum,occlusion,clusters --cluster-test 1",
    "--skip occlusion",
    "--skip frustum",
    "--distance 12",
    "--distance 12 --hysteresis 0.3",
    "--contribution 3",
    "--section 0,1,0,-0.2",
    "--occluder-triangles 300",
    "--occlusion-size 96",
    "--masked",
    "--occluder-error 2",
    "--close-gaps 0.06",
    "--no-faces",
    "--no-second-look",
    "--second-look-polygons 20",
    "--lod-error 4",
    "--lod-error 4 --lod-fade 3",
    "--budget 0.05 --cost-triangle 10",
    "--budget 0.05 --cost-triangle 10 --hard-budget --cost-object 500",
    "--jitter 2",
    "--no-proofs",
    "--stereo 0.06",
    "--bins 3",
    "--bins 3 --query-threads 2",
    "--trace T.json",
    "--record r.slframe --frame 0",
    "--depth-images D",
    "--threads 2",
};

/// Pairs that one line refuses, by words of each, and words of the line.
const struct {
    const char *first, *second, *line;
} kRefused[] = {
    {"--visibility", "--split", "baked of another scene"},
    {"--visibility", "--up z", "baked of another scene"},
    {"--visibility", "--unit", "baked of another scene"},
    {"--visibility", "--sides", "baked of another scene"},
    {"--eye", "--path", "--eye excludes"},
    {"--eye", "--seed", "--eye excludes"},
    {"--remember", "--repeat", "--remember: each frame is asked once"},
    {"--taught", "--stereo", "--taught: not for two eyes"},
    {"--propose", "--stereo", "--propose: not for two eyes"},
    {"--certificates", "--stereo", "--certificates: not of two eyes"},
    {"--certificates", "--lod-error", "--certificates: not of levels of detail"},
    {"--certificates", "--budget", "--certificates: not of levels of detail"},
    {"--depth-images", "--skip occlusion", "--depth-images needs the occlusion stage"},
};

std::set<std::string> optionsOf(const std::string& words) {
    std::set<std::string> out;
    std::istringstream list(words);
    for (std::string word; list >> word;)
        if (word.starts_with("--")) out.insert(word);
    return out;
}

/// The words of the line that refuses a pair; empty: none does.
std::string refusalOf(const std::string& a, const std::string& b) {
    for (const auto& row : kRefused)
        for (const auto& [x, y] : {std::pair(a, b), std::pair(b, a)})
            if (x.find(row.first) != std::string::npos && y.find(row.second) != std::string::npos) return row.line;
    return "";
}

/// Every object is visible or culled by one stage.
std::string unaccounted(const json& run) {
    for (const json& frame : run["frames"]) {
        uint64_t sum = frame["visible"].size();
        for (const json& row : frame["stages"]) sum += row["culled"].get<uint64_t>();
        if (sum != run["scene"]["objects"].get<uint64_t>())
            return std::to_string(sum) + " of " + run["scene"]["objects"].dump() + " are accounted for";
    }
    return "";
}

bool excludes(const std::string& a, const std::string& b) {
    const std::set<std::string> of_a = optionsOf(a), of_b = optionsOf(b);
    return std::any_of(of_a.begin(), of_a.end(), [&](const std::string& option) { return of_b.contains(option); });
}

TEST_F(OptionPairs, AreSoundOrRefused) {
    ASSERT_EQ(run("export building:1:1 -o house.glb").exit_code, 0);
    ASSERT_EQ(run("bake house.glb -o b.slvis").exit_code, 0);
    const auto cull = [&](const std::string& options) {
        std::string words = "cull house.glb --verify --rays 100 --json o.json " + options;
        if (options.find("--eye") == std::string::npos) words += " --frames 2";
        if (options.find("--size") == std::string::npos) words += " --size 128x72";
        return run(words);
    };
    // Pairs that work together are asked by five at once: each answer stands for ten pairs.
    constexpr size_t kCount = std::size(kOptions), kTogether = 5;
    std::set<std::pair<size_t, size_t>> open;
    for (size_t i = 0; i < kCount; ++i)
        for (size_t k = i + 1; k < kCount; ++k) {
            if (excludes(kOptions[i], kOptions[k])) continue;
            const std::string line = refusalOf(kOptions[i], kOptions[k]);
            if (line.empty()) {
                open.insert({i, k});
                continue;
            }
            const std::string both = std::string(kOptions[i]) + " " + kOptions[k];
            const Outcome outcome = cull(both);
            EXPECT_TRUE(outcome.exit_code == 2 || outcome.exit_code == 3) << both << ": " << outcome.exit_code;
            EXPECT_NE(outcome.err.find(line), std::string::npos) << both << ": " << outcome.err;
        }
    EXPECT_GT(open.size(), 800u);
    const auto goTogether = [&](size_t i, size_t k) {
        return !excludes(kOptions[i], kOptions[k]) && refusalOf(kOptions[i], kOptions[k]).empty();
    };
    size_t culls = 0;
    while (!open.empty()) {
        std::vector<size_t> taken{open.begin()->first, open.begin()->second};
        while (taken.size() < kTogether) {
            size_t best = kCount, most = 0;
            for (size_t i = 0; i < kCount; ++i) {
                size_t fresh = 0;
                const bool fits =
                    std::all_of(taken.begin(), taken.end(), [&](size_t k) { return k != i && goTogether(i, k); });
                for (const size_t k : taken) fresh += open.contains(std::minmax(i, k));
                if (fits && fresh > most) best = i, most = fresh;
            }
            if (best == kCount) break;
            taken.push_back(best);
        }
        std::string options;
        for (const size_t i : taken) {
            (options += ' ') += kOptions[i];
            for (const size_t k : taken)
                if (i < k) open.erase({i, k});
        }
        SCOPED_TRACE(options);
        const Outcome outcome = cull(options);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        if (outcome.exit_code != 0) continue;
        const json answer = json::parse(read(path("o.json")));
        EXPECT_EQ(answer["verification"]["false_culls"], 0);
        if (options.find("--stereo") == std::string::npos) { EXPECT_EQ(unaccounted(answer), ""); }
        for (const json& frame : answer["frames"])
            culls += answer["scene"]["objects"].get<size_t>() - frame["visible"].size();
    }
    EXPECT_GT(culls, 5000u);
}

}  // namespace
}  // namespace sightline
