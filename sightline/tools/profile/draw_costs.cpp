// What a draw call, a triangle, a vertex and a pixel cost on this machine, in this scene: fitted to frames of parts of it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/draw_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/profile/loaded_reference.h"
#include "sightline/tools/profile/middle.h"

namespace sightline::tools {
using namespace studies;
namespace {

constexpr int kCosts = 6;
using CostRow = std::array<double, kCosts>;

CostRow rowOf(const CostSample& sample) {
    return {sample.objects, sample.triangles, sample.vertices, sample.pixels, sample.samples, 1};
}

/// The normal equations of least squares, over some of the unknowns.
struct NormalEquations {
    double matrix[kCosts][kCosts] = {};
    double right[kCosts] = {};

    void add(const CostRow& row, double value) {
        for (int i = 0; i < kCosts; ++i) {
            for (int j = 0; j < kCosts; ++j) matrix[i][j] += row[size_t(i)] * row[size_t(j)];
            right[i] += row[size_t(i)] * value;
        }
    }

    /// Gauss's elimination; an unknown that others say already is 0.
    CostRow solve(const std::array<bool, kCosts>& free) const {
        double a[kCosts][kCosts + 1];
        for (int i = 0; i < kCosts; ++i) {
            for (int j = 0; j < kCosts; ++j) a[i][j] = free[size_t(i)] && free[size_t(j)] ? matrix[i][j] : 0;
            a[i][kCosts] = free[size_t(i)] ? right[i] : 0;
        }
        std::array<bool, kCosts> taken{};
        int pivot_of[kCosts];
        for (int column = 0; column < kCosts; ++column) {
            int pivot = -1;
            for (int i = 0; i < kCosts; ++i)
                if (!taken[size_t(i)] && (pivot < 0 || std::abs(a[i][column]) > std::abs(a[pivot][column]))) pivot = i;
            pivot_of[column] = -1;
            if (pivot < 0 || std::abs(a[pivot][column]) < 1e-9) continue;  // columns have length 1
            taken[size_t(pivot)] = true;
            pivot_of[column] = pivot;
            for (int i = 0; i < kCosts; ++i) {
                if (i == pivot) continue;
                const double by = a[i][column] / a[pivot][column];
                for (int j = column; j <= kCosts; ++j) a[i][j] -= by * a[pivot][j];
            }
        }
        CostRow out{};
        for (int column = 0; column < kCosts; ++column)
            if (pivot_of[column] >= 0) out[size_t(column)] = a[pivot_of[column]][kCosts] / a[pivot_of[column]][column];
        return out;
    }

    /// How fast the error falls as each unknown grows.
    CostRow gradient(const CostRow& at) const {
        CostRow out{};
        for (int i = 0; i < kCosts; ++i) {
            out[size_t(i)] = right[i];
            for (int j = 0; j < kCosts; ++j) out[size_t(i)] -= matrix[i][j] * at[size_t(j)];
        }
        return out;
    }
};

/// Lawson and Hanson's: unknowns become free one after the other, and those that would fall below 0 are held there again.
CostRow solveNonNegative(const NormalEquations& equations) {
    CostRow at{};
    std::array<bool, kCosts> free{};
    for (int step = 0; step < 4 * kCosts; ++step) {
        const CostRow fall = equations.gradient(at);
        int next = -1;
        for (int i = 0; i < kCosts; ++i)
            if (!free[size_t(i)] && fall[size_t(i)] > 1e-9 && (next < 0 || fall[size_t(i)] > fall[size_t(next)]))
                next = i;
        if (next < 0) break;
        free[size_t(next)] = true;
        for (int inner = 0; inner < kCosts; ++inner) {
            const CostRow wanted = equations.solve(free);
            double way = 1;
            for (int i = 0; i < kCosts; ++i)
                if (free[size_t(i)] && wanted[size_t(i)] < 0)
                    way = std::min(way, at[size_t(i)] / (at[size_t(i)] - wanted[size_t(i)]));
            for (int i = 0; i < kCosts; ++i)
                if (free[size_t(i)]) at[size_t(i)] += way * (wanted[size_t(i)] - at[size_t(i)]);
            if (way >= 1) break;
            for (int i = 0; i < kCosts; ++i)
                if (free[size_t(i)] && at[size_t(i)] <= 1e-15) {
                    free[size_t(i)] = false;
                    at[size_t(i)] = 0;
                }
        }
    }
    return at;
}

/// One frame to be timed.
struct Trial {
    View view;
    std::vector<DrawItem> items;
    StageLoads loads;
    CostSample sample;
    std::vector<double> seconds;
};

/// @param pass  how often vertices and triangles go through
void countTrial(Trial& trial, double pass, uint32_t threads) {
    CostSample& sample = trial.sample;
    sample.objects = static_cast<double>(trial.items.size());
    for (const DrawItem& item : trial.items) {
        sample.triangles += pass * static_cast<double>(item.mesh.triangles());
        sample.vertices += pass * static_cast<double>(item.mesh.positions.size());
    }
    sample.pixels = static_cast<double>(countFragments(trial.items, trial.view, threads));
    sample.samples = static_cast<double>(trial.view.width) * trial.view.height;
}

/// The items without some of their triangles.
std::vector<DrawItem> withTriangles(std::vector<DrawItem> items, size_t (*kept)(size_t triangles)) {
    for (DrawItem& item : items) item.mesh.indices = item.mesh.indices.first(3 * kept(item.mesh.triangles()));
    return items;
}

/// Each item's first triangle shrunk to a point: what is left of an object if nothing is drawn of it.
std::vector<DrawItem> hardlyMore(std::vector<DrawItem> items) {
    static constexpr uint32_t kPoint[3] = {0, 0, 0};
    for (DrawItem& item : items) item.mesh = {item.mesh.positions.first(1), kPoint};
    return items;
}

/// Those with many triangles; those with few; and any half.
std::vector<std::vector<DrawItem>> partsOf(std::vector<DrawItem> items, Random& random) {
    std::vector<std::vector<DrawItem>> parts = {items};
    const auto half = static_cast<std::ptrdiff_t>(items.size() / 2);
    if (half == 0) return parts;
    std::stable_sort(items.begin(), items.end(),
                     [](const DrawItem& a, const DrawItem& b) { return a.mesh.triangles() < b.mesh.triangles(); });
    parts.emplace_back(items.begin(), items.begin() + half);
    parts.emplace_back(items.begin() + half, items.end());
    for (size_t i = items.size() - 1; i > 0; --i) std::swap(items[i], items[random.below(i + 1)]);
    parts.emplace_back(items.begin(), items.begin() + half);
    return parts;
}

std::vector<Trial> trialsOf(const CostView& seen, bool any_items, const DrawCostSettings& settings, Random& random) {
    std::vector<DrawItem> all;
    for (const DrawItem& item : seen.items)
        if (item.mesh.triangles() > 0 && !item.mesh.positions.empty()) all.push_back(item);
    std::vector<Trial> trials;
    const auto add = [&](std::vector<DrawItem> items, const View& view, const StageLoads& loads, double pass) {
        trials.push_back({view, std::move(items), loads, {}, {}});
        countTrial(trials.back(), pass, settings.threads);
    };
    const View quarter = withPixels(seen.view, 0.25);
    for (const std::vector<DrawItem>& part : partsOf(all, random))
        for (const View& view : {seen.view, quarter}) {
            add(part, view, {}, 1);
            if (!any_items) add(part, view, StageLoads::of(FrameStage::kTransform, 2), 2);
        }
    if (!any_items) return trials;
    add(withTriangles(all, [](size_t count) { return (count + 1) / 2; }), seen.view, {}, 1);
    add(withTriangles(all, [](size_t) { return size_t{1}; }), quarter, {}, 1);
    add(hardlyMore(all), quarter, {}, 1);
    add({}, seen.view, {}, 1);
    add({}, quarter, {}, 1);
    return trials;
}

}  // namespace

double DrawCosts::nanosecondsOf(const CostSample& of) const {
    return object * of.objects + triangle * of.triangles + vertex * of.vertices + pixel * of.pixels +
           sample * of.samples + frame;
}

DrawCosts fitDrawCosts(std::span<const CostSample> samples) {
    // Each frame counts by its relative error; columns are made of one length, since counts differ by six orders.
    CostRow lengths{};
    std::vector<CostRow> rows;
    for (const CostSample& sample : samples) {
        if (!(sample.seconds > 0)) continue;
        CostRow row = rowOf(sample);
        for (double& value : row) value /= 1e9 * sample.seconds;
        for (size_t i = 0; i < kCosts; ++i) lengths[i] += row[i] * row[i];
        rows.push_back(row);
    }
    for (double& length : lengths) length = length > 0 ? std::sqrt(length) : 1;
    NormalEquations equations;
    for (CostRow& row : rows) {
        for (size_t i = 0; i < kCosts; ++i) row[i] /= lengths[i];
        equations.add(row, 1);
    }
    CostRow at = solveNonNegative(equations);
    for (size_t i = 0; i < kCosts; ++i) at[i] /= lengths[i];
    DrawCosts costs{at[0], at[1], at[2], at[3], at[4], at[5], 0, static_cast<uint32_t>(rows.size())};
    std::vector<double> errors;
    for (const CostSample& sample : samples)
        if (sample.seconds > 0)
            errors.push_back(std::abs(1e-9 * costs.nanosecondsOf(sample) - sample.seconds) / sample.seconds);
    costs.error = middleOf(std::move(errors));
    return costs;
}

DrawCosts measureDrawCosts(LoadedRenderer& renderer, std::span<const CostView> views,
                           const DrawCostSettings& settings) {
    Random random(settings.seed);
    std::vector<CostSample> samples;
    size_t done = 0;
    for (const CostView& seen : views) {
        std::vector<Trial> trials = trialsOf(seen, renderer.drawsAnything(), settings, random);
        for (uint32_t round = 0; round <= std::max(settings.rounds, 1u); ++round)
            for (Trial& trial : trials) {
                const auto submit = [&]() -> std::span<const DrawItem> { return trial.items; };
                const double seconds = renderer.draw(trial.view, submit, trial.loads).wall;
                if (round > 0) trial.seconds.push_back(seconds);  // the first warms up
            }
        for (Trial& trial : trials) {
            trial.sample.seconds = middleOf(std::move(trial.seconds));
            samples.push_back(trial.sample);
        }
        if (settings.progress) settings.progress(++done, views.size());
    }
    return fitDrawCosts(samples);
}

}  // namespace sightline::tools
