// The same cameras answered by the query and, where it is handed to CMake, by a peer: in one run, in turns, by thread time.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/contestant.h"
#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint64_t kColdSeed = 1179, kWalkSeed = 1201;
constexpr uint32_t kColdCameras = 32, kWalkFrames = 300;

class Asking final : public Contestant {
public:
    Asking(const char* name, const Snapshot& now, const QuerySettings& settings)
        : name_(name), now_(now), settings_(settings) {}
    const char* name() const override { return name_; }
    void begin() override { query_ = Query(); }
    size_t answer(const View& view) override { return query_.visible(now_, view, settings_).objects.size(); }

private:
    const char* name_;
    const Snapshot& now_;
    QuerySettings settings_;
    Query query_;
};

/// What a contestant needed, the median of the rounds for each camera, and what it kept.
struct Score {
    std::vector<double> times;  ///< [microseconds]
    double kept = 0;            ///< mean of the cameras
};

/// Each contestant answers all cameras in order, and then the next one does; in each round.
std::vector<Score> compete(const std::vector<std::unique_ptr<Contestant>>& contestants,
                           const std::vector<CameraFrame>& cameras, int rounds) {
    std::vector<Score> out(contestants.size());
    std::vector<std::vector<std::vector<double>>> times(contestants.size(),
                                                        std::vector<std::vector<double>>(cameras.size()));
    for (int round = 0; round < rounds; ++round)
        for (size_t who = 0; who < contestants.size(); ++who) {
            contestants[who]->begin();
            for (size_t i = 0; i < cameras.size(); ++i) {
                const View view = makeView(cameras[i], 1280, 720);
                const double start = threadTime();
                const size_t kept = contestants[who]->answer(view);
                times[who][i].push_back(threadTime() - start);
                if (round == 0) out[who].kept += static_cast<double>(kept) / static_cast<double>(cameras.size());
            }
        }
    for (size_t who = 0; who < contestants.size(); ++who)
        for (const std::vector<double>& of_frame : times[who]) out[who].times.push_back(medianOf(of_frame));
    return out;
}

void measurePeers(const Scene& scene, int repeat, Table& table) {
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(true, 0));
    const Snapshot now = loaded.world.commit();
    QuerySettings boxes{.stateless = true};
    boxes.faces = boxes.second_look = false;
    std::vector<std::unique_ptr<Contestant>> all;
#ifdef SIGHTLINE_PEER
    all.push_back(makeMaskedContestant(scene));
#endif
    all.push_back(std::make_unique<Asking>("frustum alone", now, QuerySettings{.stages = stageBit(Stage::kFrustum)}));
    all.push_back(std::make_unique<Asking>("stateless, boxes alone", now, boxes));
    all.push_back(std::make_unique<Asking>("stateless", now, QuerySettings{.stateless = true}));
    all.push_back(std::make_unique<Asking>("query", now, QuerySettings()));
    const struct {
        const char* name;
        std::vector<CameraFrame> cameras;
        int rounds;
    } runs[] = {
        {"cold", seededCameras(scene, kColdCameras, kColdSeed).frames, repeat > 0 ? repeat : 5},
        {"walk", walkThrough(scene, {.frames = kWalkFrames, .seed = kWalkSeed}).frames, repeat > 0 ? repeat : 3},
    };
    for (const auto& run : runs) {
        const std::vector<Score> results = compete(all, run.cameras, run.rounds);
        const Rows row{table, fmt::format("{}, {}", scene.name, run.name)};
        const Score& base = results[0];
        for (size_t who = 0; who < all.size(); ++who) {
            const std::string name = all[who]->name(), of = all[0]->name();
            row(name + ", mean of a frame", meanOf(results[who].times), "us", of, meanOf(base.times));
            row(name + ", 99 of 100 frames", percentileOf(results[who].times, 0.99), "us", of,
                percentileOf(base.times, 0.99));
            row(name + ", kept", results[who].kept, "objects", of, base.kept);
        }
    }
}

}  // namespace

Table benchPeers(const Options& options) {
    Table table{"peers", {}};
    if (options.scene) {
        measurePeers(*options.scene, options.repeat, table);
        return table;
    }
    for (const Scene& scene : {makeCity(1, 20000), makeBuilding(1, 10), makeTerrain(1, 512)})
        measurePeers(scene, options.repeat, table);
    return table;
}

}  // namespace sightline::bench
