// Engines' answers, judged: sound ones pass, whatever visible is left out is convicted where it is seen, and no word is lost.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "apps/cli/verbs/scene_choice.h"
#include "sightline/base/random.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/camera_path.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

const std::vector<std::string> kScenes = {"building:1:1", "city:1:300", "terrain:3:33", "made:near"};

class Judge : public Tool {
protected:
    static constexpr const char* kSmall = " --size 192x108 --rays 100000";

    /// A run of ours, as `cull --json` writes it, with verdicts: file run.json.
    json cull(const std::string& scene, const std::string& more = " --frames 4") const {
        succeed("cull " + scene + more + kSmall + " --jitter 0 --repeat 1 --verify --json run.json");
        return json::parse(read(path("run.json")));
    }
    json judge(const std::string& arguments, int exit_code) const {
        const Outcome outcome = run("judge " + arguments + " --rays 100000 --json said.json");
        EXPECT_EQ(outcome.exit_code, exit_code) << arguments << "\n" << outcome.err;
        return json::parse(read(path("said.json")));
    }
    /// The cameras of a run as a camera path: file path.json.
    void writeCameras(const json& run) const {
        json frames = json::array();
        for (const json& frame : run["frames"]) frames.push_back(frame["camera"]);
        write("path.json", json{{"frames", frames}}.dump());
    }
    /// The keys of some frames as both formats: drawn.csv, drawn.json.
    void writeAnswers(const std::vector<std::vector<uint64_t>>& frames) const {
        std::string csv = "frame,key\r\n";
        json list = json::array();
        for (size_t i = 0; i < frames.size(); ++i) {
            if (frames[i].empty()) csv += std::to_string(i) + ",\r\n";
            for (const uint64_t key : frames[i]) csv += std::to_string(i) + "," + std::to_string(key) + "\r\n";
            list.push_back({{"drawn", frames[i]}});
        }
        write("drawn.csv", csv);
        write("drawn.json", json{{"frames", list}}.dump());
    }
    static tools::Scene load(const std::string& scene) {
        cli::SceneChoice choice;
        choice.names = {scene};
        return *cli::loadScene(choice);
    }
};

/// What a ray through a pixel meets up to the first surface that hides, over all triangles in double, one by one; what ties
/// with that, too.
std::set<uint64_t> seenAt(const tools::Scene& scene, const View& view, double x, double y) {
    const glm::dmat4 back = glm::inverse(view.projection * view.view);
    const auto at = [&](double depth) {
        const glm::dvec4 p = back * glm::dvec4(2 * x / view.width - 1, 1 - 2 * y / view.height, depth, 1);
        return glm::dvec3(p) / p.w;
    };
    const glm::dvec3 from = at(-1), along = glm::normalize(at(0) - from);  // from the near plane on
    std::vector<std::pair<double, uint64_t>> hits;
    double nearest = std::numeric_limits<double>::infinity();  // that hides
    for (const tools::SceneObject& object : scene.objects) {
        const tools::Mesh& mesh = scene.meshes[object.mesh];
        for (const tools::Primitive& primitive : mesh.primitives)
            for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
                glm::dvec3 corners[3];
                for (size_t k = 0; k < 3; ++k)
                    corners[k] = glm::dvec3(object.transform * glm::dvec4(mesh.positions[mesh.indices[3 * t + k]], 1));
                const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0], s = from - corners[0];
                const glm::dvec3 p = glm::cross(along, b), q = glm::cross(s, a);
                const double det = glm::dot(a, p);
                const bool front = (det > 0) == (glm::determinant(glm::dmat3(object.transform)) > 0);
                if (det == 0 || (!front && !scene.materials[primitive.material].double_sided)) continue;
                const double u = glm::dot(s, p) / det, v = glm::dot(along, q) / det, d = glm::dot(b, q) / det;
                const double slack = 1e-9, rounding = 1e-6;  // the witnesses' rays are floats
                if (u < -rounding || v < -rounding || u + v > 1 + rounding || d < -slack) continue;
                hits.emplace_back(d, object.key);
                const bool inside = u > slack && v > slack && u + v < 1 - slack;
                if (inside && !mesh.deforms && scene.materials[primitive.material].hides())
                    nearest = std::min(nearest, d);
            }
    }
    std::set<uint64_t> out;
    for (const auto& [d, key] : hits)
        if (d <= nearest + 1e-7 * (1 + std::abs(nearest))) out.insert(key);
    return out;
}

TEST_F(Judge, FindsNothingWrongWithOurOwnAnswers) {
    for (const std::string& scene : kScenes) {
        const json run = cull(scene), said = judge(scene + " --answers run.json", 0);
        EXPECT_EQ(said["schema"], "sightline.judge/1");
        EXPECT_EQ(said["frames"].size(), run["frames"].size());
        EXPECT_EQ(said["width"], 192);
        EXPECT_EQ(said["verdict"]["false_culls"], 0) << scene;
        EXPECT_TRUE(said["missing_frames"].empty());
        // The same witnesses say the same of the same culls.
        const json& own = run["verification"];
        EXPECT_EQ(said["verdict"]["exactly_visible"], own["exactly_visible"]) << scene;
        EXPECT_EQ(said["verdict"]["drawn"], own["reported"]);
        EXPECT_EQ(said["verdict"]["over_estimate"], own["over_estimate"]);
        EXPECT_EQ(said["verdict"]["proofs"]["not_drawn_hidden"], own["proofs"]["culled_hidden"]) << scene;
        EXPECT_EQ(said["verdict"]["proofs"]["drawn_hidden"], own["proofs"]["kept_hidden"]);
        EXPECT_GE(said["verdict"]["frustum_alone"]["drawn"], said["verdict"]["drawn_in_view"]);
    }
}

// Of what is kept, a seeded part is left out: what of it is visible is convicted, all of it and nothing else, at a place where a slow
// ray sees it.
TEST_F(Judge, ConvictsWhateverVisibleIsLeftOut) {
    Random random(3);
    size_t convicted = 0;
    for (const std::string& name : kScenes) {
        const tools::Scene scene = load(name);
        const json run = cull(name);
        writeCameras(run);
        std::vector<std::vector<uint64_t>> drawn;
        std::vector<std::set<uint64_t>> expected;
        for (const json& frame : run["frames"]) {
            const std::vector<uint64_t> visible = frame["visible"], unseen = frame["verification"]["kept_unseen"];
            drawn.emplace_back();
            expected.emplace_back();
            for (const uint64_t key : visible)
                if (random.below(4) != 0) drawn.back().push_back(key);
                else if (!std::binary_search(unseen.begin(), unseen.end(), key)) expected.back().insert(key);
        }
        writeAnswers(drawn);
        const bool any = std::any_of(expected.begin(), expected.end(), [](const auto& keys) { return !keys.empty(); });
        const json said = judge(name + " --cameras path.json --size 192x108 --answers drawn.csv", any);
        const Result<tools::CameraPath> path = tools::readCameraPath(this->path("path.json"));
        ASSERT_TRUE(path.ok());
        for (size_t i = 0; i < expected.size(); ++i) {
            std::set<uint64_t> found;
            const View view = tools::makeView(path->frames[i], 192, 108);
            for (const json& missed : said["frames"][i]["list"]) {
                found.insert(missed["key"].get<uint64_t>());
                const std::set<uint64_t> seen = seenAt(scene, view, missed["pixel"][0], missed["pixel"][1]);
                EXPECT_TRUE(seen.contains(missed["key"])) << name << " frame " << i << " " << missed;
            }
            EXPECT_EQ(found, expected[i]) << name << " frame " << i;
            convicted += found.size();
        }
    }
    EXPECT_GT(convicted, 60u);
}

TEST_F(Judge, SaysTheSameOfBothFormats) {
    const json run = cull("building:1:1");
    writeCameras(run);
    std::vector<std::vector<uint64_t>> drawn;
    for (const json& frame : run["frames"]) drawn.push_back(frame["visible"]);
    drawn[1].resize(drawn[1].size() / 2);
    drawn[2].clear();
    drawn[3].push_back(drawn[3].front());  // twice
    writeAnswers(drawn);
    json from[2];
    const char* const files[] = {"drawn.csv", "drawn.json"};
    for (int i = 0; i < 2; ++i) {
        from[i] = judge(std::string("building:1:1 --cameras path.json --size 192x108 --answers ") + files[i], 1);
        EXPECT_EQ(from[i]["answers"], files[i]);
        from[i].erase("answers");
    }
    EXPECT_EQ(from[0], from[1]);
    EXPECT_EQ(from[0]["frames"][2]["drawn"], 0);
    EXPECT_EQ(from[0]["frames"][2]["false_culls"], from[0]["frames"][2]["exactly_visible"]);
    EXPECT_EQ(from[0]["frames"][3]["false_culls"], 0);
    EXPECT_EQ(from[0]["frames"][3]["drawn"], run["frames"][3]["visible"].size());
}

TEST_F(Judge, WhoKeepsAllHasTheOverEstimateOfTheFrustumAlone) {
    for (const std::string& name : kScenes) {
        const json run = cull(name, " --frames 4 --use frustum");
        writeCameras(run);
        std::vector<uint64_t> all;
        for (const tools::SceneObject& object : load(name).objects) all.push_back(object.key);
        writeAnswers(std::vector<std::vector<uint64_t>>(run["frames"].size(), all));
        const json said = judge(name + " --cameras path.json --size 192x108 --answers drawn.json", 0);
        const json& verdict = said["verdict"];
        EXPECT_EQ(verdict["drawn"], all.size() * run["frames"].size());
        EXPECT_EQ(verdict["drawn_in_view"], run["verification"]["reported"]) << name;
        EXPECT_EQ(verdict["frustum_alone"]["drawn"], run["verification"]["reported"]) << name;
        EXPECT_EQ(verdict["frustum_alone"]["over_estimate"], run["verification"]["over_estimate"]) << name;
    }
}

TEST_F(Judge, TakesNamesAndPathsAndTellsOfThoseThatAreShared) {
    const json run = cull("building:1:1", " --frames 3");
    std::map<std::string, size_t> bearers;
    for (const tools::SceneObject& object : load("building:1:1").objects) ++bearers[object.name];
    std::map<uint64_t, json> called;
    for (const json& object : run["objects"]) called[object["key"]] = object;
    json by_path = run, by_name = run;
    std::set<std::string> shared;
    for (size_t i = 0; i < run["frames"].size(); ++i) {
        json paths = json::array(), names = json::array();
        std::map<std::string, size_t> times;
        for (const json& key : run["frames"][i]["visible"]) {
            paths.push_back(called[key]["path"]);
            names.push_back(called[key]["name"]);
            ++times[called[key]["name"]];
        }
        for (const auto& [name, count] : times)
            if (count < bearers[name]) shared.insert(name);
        by_path["frames"][i]["visible"] = paths;
        by_name["frames"][i]["visible"] = names;
    }
    ASSERT_FALSE(shared.empty());
    write("path.json", by_path.dump());
    write("name.json", by_name.dump());
    json by_keys = judge("building:1:1 --answers run.json", 0), paths = judge("building:1:1 --answers path.json", 0);
    by_keys.erase("answers");
    paths.erase("answers");
    EXPECT_EQ(by_keys, paths);

    const json names = judge("building:1:1 --answers name.json", 0);
    std::set<std::string> told;
    for (const json& name : names["shared_names"]) {
        told.insert(name["name"]);
        EXPECT_EQ(name["objects"], bearers[name["name"]]);
    }
    EXPECT_EQ(told, shared);
    EXPECT_GT(names["verdict"]["visible_by_shared_name"], 0);
    EXPECT_GT(names["verdict"]["drawn"], by_keys["verdict"]["drawn"]);
    const Outcome outcome = this->run("judge building:1:1 --answers name.json --rays 1000");
    EXPECT_NE(outcome.out.find("Call them by their keys"), std::string::npos) << outcome.out;
}

TEST_F(Judge, TellsOfFramesThatTheFileLacks) {
    const json run = cull("city:1:100", " --frames 6");
    writeCameras(run);
    std::string csv = "frame,key\n";
    for (const size_t i : {1, 4})
        for (const json& key : run["frames"][i]["visible"]) csv += std::to_string(i) + "," + key.dump() + "\n";
    write("drawn.csv", csv);
    const json said = judge("city:1:100 --cameras path.json --size 192x108 --answers drawn.csv", 0);
    EXPECT_EQ(said["missing_frames"], json({0, 2, 3, 5}));
    ASSERT_EQ(said["frames"].size(), 2u);
    EXPECT_EQ(said["frames"][1]["frame"], 4);
    const Outcome outcome = this->run("judge city:1:100 --cameras path.json --answers drawn.csv --rays 1000");
    EXPECT_NE(outcome.out.find("4 frames that drawn.csv does not have: 0, 2 and 3, 5"), std::string::npos)
        << outcome.out;
}

// A renderer that writes its matrices, and one that draws both eyes by one answer.
TEST_F(Judge, TakesMatricesAndTwoEyes) {
    const json run = cull("building:1:1", " --frames 2");
    const Result<tools::CameraPath> path = [&] {
        writeCameras(run);
        return tools::readCameraPath(this->path("path.json"));
    }();
    json answers = {{"width", 192}, {"height", 108}};
    for (size_t i = 0; i < 2; ++i) {
        const View view = tools::makeView(path->frames[i], 192, 108);
        json camera;
        for (int k = 0; k < 16; ++k) {
            camera["view"].push_back(view.view[k / 4][k % 4]);
            camera["projection"].push_back(view.projection[k / 4][k % 4]);
        }
        answers["frames"].push_back({{"camera", camera}, {"drawn", run["frames"][i]["visible"]}});
    }
    write("drawn.json", answers.dump());
    const json said = judge("building:1:1 --answers drawn.json", 0);
    EXPECT_EQ(said["verdict"]["exactly_visible"], run["verification"]["exactly_visible"]);

    // Eyes that far apart see more than the one in the middle.
    EXPECT_GT(judge("building:1:1 --answers drawn.json --stereo 3", 1)["verdict"]["false_culls"], 0);
    succeed("cull building:1:1 --frames 2 --stereo 3 --repeat 1 --json two.json" + std::string(kSmall));
    const json both = judge("building:1:1 --answers two.json", 0);
    EXPECT_EQ(both["stereo"], 3);
}

TEST_F(Judge, DrawsWhatWasMissed) {
    json run = cull("building:1:1", " --frames 2");
    for (json& frame : run["frames"]) frame["visible"] = json::array();
    write("none.json", run.dump());
    const json said = judge("building:1:1 --answers none.json --pictures missed", 1);
    std::set<std::string> named;
    for (const json& frame : said["frames"])
        for (const json& missed : frame["list"])
            if (missed.contains("picture")) named.insert(missed["picture"]);
    EXPECT_EQ(named.size(), 20u);
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("missed"))) {
        EXPECT_TRUE(named.contains("missed/" + entry.path().filename().string())) << entry.path();
        EXPECT_EQ(read(entry.path()).substr(1, 3), "PNG");
        ++files;
    }
    EXPECT_EQ(files, 20u);
    // Each pixel of a frame of which nothing is drawn belongs to one of the missed.
    uint64_t pixels = 0;
    for (const json& missed : said["frames"][0]["list"]) pixels += missed["pixels"].get<uint64_t>();
    EXPECT_EQ(pixels, said["frames"][0]["changed_pixels"]);
    EXPECT_GT(pixels, 192u * 108 / 4);
}

TEST_F(Judge, ErrorsAreOneLineAndAnExitCode) {
    const json run = cull("building:1:1", " --frames 2");
    writeCameras(run);
    const std::string at = "judge building:1:1 --cameras path.json --answers ";
    write("a.csv", "frame,name\n0,Lawn\n");
    const std::string good = run["objects"][0]["path"];
    write("slip.json", json{{"frames", {{{"drawn", {good, good + "x"}}}}}}.dump());
    write("key.csv", "frame,key\n0,0\n1,50000\n");
    write("late.csv", "frame,key\n0,0\n2,1\n");
    write("ok.csv", "frame,key\n0,0\n");
    write("shape.json", R"({"frames": [{"drawn": 3}]})");
    expectError(at + "a.csv", 3, "a.csv: line 2: no object is named \"Lawn\"");
    expectError(at + "slip.json", 3, "slip.json: frames[0].drawn[1]: no object is named");
    expectError(at + "slip.json", 3, "did you mean");
    expectError(at + "key.csv", 3, "key.csv: line 3: no object has the key 50000 (the largest is");
    expectError(at + "late.csv", 3, "late.csv: line 3: frame 2: the path has 2 frames, from 0");
    expectError(at + "shape.json", 3, "shape.json: frames[0].drawn: not an array");
    expectError(at + "none.csv", 3, "none.csv: no such file");
    expectError("judge building:1:1 --answers ok.csv", 2, "--cameras is required: ok.csv has no cameras");
    expectError("judge building:1:1 --cameras path.json", 2, "--answers");
    expectError(at + "ok.csv --json ok.csv", 2, "ok.csv");
    expectError(at + "ok.csv --json no/such/a.json", 4, "no/such/a.json");
    const Outcome help = succeed("help judge");
    EXPECT_NE(help.out.find("--answers"), std::string::npos);
}

}  // namespace
}  // namespace sightline
