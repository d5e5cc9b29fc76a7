// Levels of detail: what choosing costs, how near it comes to the best choice, and how steady frames are under a budget.
// SPDX-License-Identifier: MIT
//
// Thomas Funkhouser, Carlo Sequin. Adaptive Display Algorithm for Interactive Frame Rates During Visualization of
// Complex Virtual Environments. 1993.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/statue.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/lod/frame_control.h"
#include "sightline/lod/lod_budget.h"
#include "sightline/lod/lod_choice.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/mesh_lods.h"

namespace sightline::bench {
using namespace tools;
using namespace studies;
namespace {

// The choice by itself.

struct Choices {
    std::vector<LodLevel> levels;
    std::vector<LodItem> items;
    LodBudgetSettings settings;
};

Choices makeChoices(size_t count, uint64_t seed) {
    Choices made;
    double error = 0;
    for (uint32_t triangles = 8000; triangles > 100; triangles /= 2) {
        made.levels.push_back({error, triangles, triangles / 2});
        error = error > 0 ? 2.5 * error : 0.002;
    }
    Random random(seed);
    made.items.resize(count);
    for (LodItem& item : made.items) {
        item.levels = made.levels;
        item.pixels_of_unit = std::exp(random.uniform(1, 7));
        item.pixels = std::exp(random.uniform(1, 10));
        item.importance = random.uniform(0.5, 1);
    }
    made.settings.cost = {1000, 1, 0.5, 0.1};
    made.settings.hard = true;
    return made;
}

void measureChoice(size_t count, Table& table) {
    Choices made = makeChoices(count, 1);
    made.settings.nanoseconds = 3000.0 * static_cast<double>(count);
    std::vector<uint8_t> chosen(count, LodItem::kNone);
    LodBudget budget;
    Random random(2);
    std::vector<double> times;
    for (int frame = 0; frame < 40; ++frame) {
        for (size_t i = 0; i < count; ++i) {
            made.items[i].last = chosen[i];
            made.items[i].pixels *= random.uniform(0.98, 1.02);
        }
        const double start = threadTime();
        budget.choose(made.items, made.settings, chosen);
        if (frame > 0) times.push_back(1e3 * (threadTime() - start) / static_cast<double>(count));
    }
    table.rows.push_back({fmt::format("{} objects of {} levels", count, made.levels.size()), "choice under a budget",
                          medianOf(times), "ns/object", "target", 100});
}

/// The best benefit of all choices, by dynamic programming over whole microseconds.
double bestBenefit(const Choices& made, size_t budget) {
    std::vector<double> best(budget + 1, 0.0);
    for (const LodItem& item : made.items) {
        std::vector<double> next = best;  // left out
        for (size_t level = 0; level < item.levels.size(); ++level) {
            const auto cost =
                static_cast<size_t>(std::ceil(1e-3 * made.settings.cost.of(item.levels[level], item.pixels) - 1e-9));
            const double worth = item.importance * item.pixels * made.settings.error /
                                 (made.settings.error + item.levels[level].error * item.pixels_of_unit);
            for (size_t spent = cost; spent <= budget; ++spent)
                next[spent] = std::max(next[spent], best[spent - cost] + worth);
        }
        best = std::move(next);
    }
    return best[budget];
}

void measureOptimum(Table& table) {
    double sum = 0, worst = 1;
    constexpr int kCases = 300;
    Random random(3);
    for (int i = 0; i < kCases; ++i) {
        Choices made = makeChoices(20 + random.below(60), 100 + static_cast<uint64_t>(i));
        made.settings.cost = {1000, 1000.0 / 8, 0, 0};  // whole microseconds, but for the coarsest level
        for (LodLevel& level : made.levels) level.triangles = level.triangles / 8 * 8;
        const size_t budget = 200 + random.below(8000);
        made.settings.nanoseconds = 1e3 * static_cast<double>(budget);
        std::vector<uint8_t> chosen(made.items.size());
        const double share = LodBudget().choose(made.items, made.settings, chosen).benefit / bestBenefit(made, budget);
        sum += share;
        worst = std::min(worst, share);
    }
    table.rows.push_back({fmt::format("{} random choices", kCases), "benefit, mean", sum / kCases, "of the best",
                          "dynamic programming", 1, fmt::format("worst {:.4f}", worst)});
}

// The walk.

constexpr uint32_t kStatues = 900;
constexpr int kWalkFrames = 180;

/// Statues in clumps: from some places many are near, from others few.
Scene clumps() {
    Scene scene;
    scene.name = "clumps of statues";
    scene.materials.resize(1);
    scene.meshes.push_back(makeStatue(40));
    Random random(4);
    for (uint32_t i = 0; i < kStatues; ++i) {
        SceneObject object;
        object.key = i;
        const double clump = static_cast<double>(i % 9), spread = i % 9 < 3 ? 8.0 : 25.0;
        const glm::dvec3 middle(60.0 * std::cos(0.7 * clump), 0, 60.0 * std::sin(0.7 * clump));
        const glm::dvec3 at = middle + glm::dvec3(random.uniform(-spread, spread), random.uniform(-1, 2),
                                                  random.uniform(-spread, spread));
        object.transform[3] = glm::dvec4(at, 1.0);
        scene.objects.push_back(object);
    }
    return scene;
}

/// Looks inward from a ring around the clumps, and jumps to the other side twice.
View viewOfFrame(int frame, uint32_t size) {
    const double turn =
        0.012 * frame + (frame >= kWalkFrames / 3 ? 2.0 : 0.0) + (frame >= 2 * kWalkFrames / 3 ? 1.3 : 0.0);
    View view;
    view.width = 16 * size;
    view.height = 9 * size;
    const glm::dvec3 eye(85.0 * std::cos(turn), 3.0, 85.0 * std::sin(turn));
    view.view = lookAt(eye, {0, 0, 0}, {0, 1, 0});
    view.projection = perspective(1.0, 16.0 / 9.0, 0.1);
    return view;
}

struct Drawing {
    double milliseconds = 0;
    double objects = 0, triangles = 0, pixels = 0;  ///< the last as the cost model counts them
};

/// Draws what a query left by the levels that it chose; the shorter of two turns counts.
Drawing draw(const Scene& scene, const std::vector<LodLevel>& levels, const VisibleSet& set, const View& view) {
    std::vector<DrawItem> items;
    Drawing out;
    const LodMeasure measure = makeLodMeasure(view);
    for (size_t i = 0; i < set.objects.size(); ++i) {
        const SceneObject& object = scene.objects[set.objects[i].key];
        const Mesh& mesh = scene.meshes[object.mesh];
        const uint8_t level = set.lods.empty() ? uint8_t{0} : set.lods[i].level;
        DrawItem item;
        item.mesh = {mesh.positions, level ? std::span<const uint32_t>(mesh.lods[level - 1u].indices) : mesh.indices};
        item.transform = object.transform;
        item.id = static_cast<uint32_t>(object.key);
        items.push_back(item);
        out.objects += 1;
        out.triangles += levels[level].triangles;
        out.pixels += pixelsOfBox(measure, transformBox(mesh.bounds, object.transform));
    }
    const DrawList list(items);
    double best = 1e9;
    for (int turn = 0; turn < 2; ++turn) {
        const double start = threadTime();
        render(list, view, {});
        best = std::min(best, 1e-3 * (threadTime() - start));
    }
    out.milliseconds = best;
    return out;
}

/// What drawing costs by least squares over frames of a walk that is not the one measured.
DrawCost fitCosts(const std::vector<Drawing>& drawings) {
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (const Drawing& drawing : drawings) {
        const glm::dvec3 row(drawing.objects, 1e-3 * drawing.triangles, 1e-3 * drawing.pixels);
        normal += glm::outerProduct(row, row);
        right += 1e6 * drawing.milliseconds * row;
    }
    // Not below zero: coordinate by coordinate.
    glm::dvec3 cost(0.0);
    for (int round = 0; round < 1000; ++round)
        for (int i = 0; i < 3; ++i) {
            const double rest = right[i] - glm::dot(normal[i], cost) + normal[i][i] * cost[i];
            cost[i] = std::max(rest / normal[i][i], 0.0);
        }
    return {cost.x, 1e-3 * cost.y, 0, 1e-3 * cost.z};
}

enum class Mode { kFinest, kStatic, kReactiveLod, kReactiveDetail, kReactiveResolution, kPredictive };
constexpr const char* kModeNames[] = {"finest levels",           "levels by 1 pixel",   "reactive levels",
                                      "reactive detail culling", "reactive resolution", "levels by budget"};

struct Steadiness {
    std::vector<double> times;  ///< of the budget
    double modelled = 0;        ///< the largest, of the budget
    double drawn = 0;           ///< triangles

    double mean() const { return std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size()); }
    double most() const { return *std::max_element(times.begin(), times.end()); }
    double deviation() const {
        double sum = 0;
        for (const double time : times) sum += (time - mean()) * (time - mean());
        return std::sqrt(sum / static_cast<double>(times.size()));
    }
};

class Walk {
public:
    Walk() : scene_(clumps()) {
        addMeshLods(scene_.meshes[0]);
        levels_ = lodLevels(scene_.meshes[0]);
        LoadSettings settings;
        settings.lods = true;
        loaded_ = loadWorld(scene_, {}, settings);
        now_ = loaded_.world.commit();
    }

    /// Costs of another walk, at other errors.
    DrawCost calibrate() {
        std::vector<Drawing> drawings;
        for (int frame = 0; frame < 40; ++frame) {
            QuerySettings settings;
            settings.lod_error = 0.1 * std::exp2(frame % 8);
            Query query;
            const View view = viewOfFrame(7 * frame + 3, 40);
            drawings.push_back(draw(scene_, levels_, query.visible(now_, view, settings), view));
        }
        return fitCosts(drawings);
    }

    Steadiness measure(Mode mode, double budget, const DrawCost& cost) {
        Query query;
        Steadiness out;
        CostCorrection correction;
        ReactiveKnob levels({.target = budget, .least = 0.25, .most = 64});
        ReactiveKnob detail({.target = budget, .least = 1, .most = 400});
        ReactiveKnob resolution({.target = budget, .least = 1, .most = 16});
        for (int frame = 0; frame < kWalkFrames; ++frame) {
            QuerySettings settings;
            settings.lod_fade = 0;
            if (mode == Mode::kStatic) settings.lod_error = 1;
            if (mode == Mode::kReactiveLod) settings.lod_error = levels.value();
            if (mode == Mode::kReactiveDetail) settings.contribution = detail.value();
            if (mode == Mode::kPredictive) {
                settings.budget = budget / correction.factor();
                settings.hard_budget = true;
                settings.cost_object = cost.object;
                settings.cost_triangle = cost.triangle;
                settings.cost_pixel = cost.pixel;
            }
            const double scale = mode == Mode::kReactiveResolution ? std::sqrt(resolution.value()) : 1.0;
            const View view = viewOfFrame(frame, static_cast<uint32_t>(std::max(40.0 / scale, 4.0)));
            const VisibleSet set = query.visible(now_, view, settings);
            const Drawing drawing = draw(scene_, levels_, set, view);
            const double modelled = 1e-6 * static_cast<double>(set.stats.lod_cost);
            levels.observe(drawing.milliseconds);
            detail.observe(drawing.milliseconds);
            resolution.observe(drawing.milliseconds);
            if (modelled > 0) correction.observe(drawing.milliseconds, modelled);
            if (mode == Mode::kPredictive) out.modelled = std::max(out.modelled, modelled / settings.budget);
            out.times.push_back(drawing.milliseconds / budget);
            out.drawn += drawing.triangles / kWalkFrames;
        }
        return out;
    }

private:
    Scene scene_;
    std::vector<LodLevel> levels_;
    LoadedWorld loaded_;
    Snapshot now_;
};

void measureWalk(Table& table) {
    Walk walk;
    const DrawCost cost = walk.calibrate();
    const Steadiness finest = walk.measure(Mode::kFinest, 1, cost);
    // All frames have too much to draw.
    const double budget = 0.4 * *std::min_element(finest.times.begin(), finest.times.end());
    const std::string where = fmt::format("walk, budget {:.2f} ms", budget);
    for (int i = 0; i < static_cast<int>(std::size(kModeNames)); ++i) {
        const auto mode = static_cast<Mode>(i);
        const Steadiness one = walk.measure(mode, budget, cost);
        std::string note = fmt::format("mean {:.2f}, most {:.2f}, {:.0f} triangles", one.mean(), one.most(), one.drawn);
        if (mode == Mode::kPredictive) note += fmt::format(", modelled {:.4f} at most", one.modelled);
        table.rows.push_back({where, fmt::format("{}: deviation", kModeNames[i]), one.deviation(), "of the budget",
                              "target", 0.08, note});
    }
    table.rows.push_back({where, "a triangle, as calibrated", cost.triangle, "ns", "an object", cost.object,
                          fmt::format("a pixel {:.3f} ns", cost.pixel)});
}

}  // namespace

Table benchLod(const Options&) {
    Table table{"lod", {}};
    for (const size_t count : {100, 1000, 10000}) measureChoice(count, table);
    measureOptimum(table);
    measureWalk(table);
    return table;
}

}  // namespace sightline::bench
