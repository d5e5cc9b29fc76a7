// One query shared by several threads, beside the same on one.
// SPDX-License-Identifier: MIT
#include "bench/query_threads.h"

#include "bench/stopwatch.h"
#include "sightline/base/thread_pool.h"
#include "sightline/load/load_world.h"
#include "sightline/run/query.h"

namespace sightline::bench {
namespace {

constexpr uint32_t kWidth = 1280, kHeight = 720;

struct Cost {
    double whole = 0;         ///< one bin  [microseconds, and all that follow]
    double one = 0, two = 0;  ///< two bins of equal widths, by so many workers
    double one_balanced = 0, two_balanced = 0;
};

}  // namespace

void measureQueryThreads(const Scene& scene, const CameraPath& path, const std::string& where, int repeat,
                         Table& table) {
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    ThreadPool pool(2);
    Query whole, one, one_balanced, two(defaultMemory(), &pool), two_balanced(defaultMemory(), &pool);
    Cost sum;
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, kWidth, kHeight);
        View halves = view;
        halves.bins = 2;
        View balanced = halves;
        balanced.balance_bins = true;
        const std::vector<double> times = timeInterleaved(
            {[&] { whole.visible(now, view); }, [&] { one.visible(now, halves); }, [&] { two.visible(now, halves); },
             [&] { one_balanced.visible(now, balanced); }, [&] { two_balanced.visible(now, balanced); }},
            repeat);
        sum.whole += times[0];
        sum.one += times[1];
        sum.two += times[2];
        sum.one_balanced += times[3];
        sum.two_balanced += times[4];
    }
    const double n = static_cast<double>(path.frames.size());
    const auto add = [&](const char* what, double value, const char* baseline, double other) {
        table.rows.push_back({where, what, value / n, "us", baseline, other / n});
    };
    add("query in 2 bins, 1 worker", sum.one, "in 1 bin", sum.whole);
    add("query in 2 bins, 2 workers", sum.two, "in 1 bin, 1 worker", sum.whole);
    add("query in 2 bins, 2 workers", sum.two, "in 2 bins, 1 worker", sum.one);
    add("query in 2 bins by the last answer's work, 2 workers", sum.two_balanced, "in 1 bin, 1 worker", sum.whole);
    add("query in 2 bins by the last answer's work, 2 workers", sum.two_balanced, "in 2 such bins, 1 worker",
        sum.one_balanced);
}

}  // namespace sightline::bench
