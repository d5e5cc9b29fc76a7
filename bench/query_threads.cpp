// One query shared by several threads, beside the same on one.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"

#include "bench/stopwatch.h"
#include "sightline/base/thread_pool.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint32_t kAskedWidth = 1280, kAskedHeight = 720;

struct Cost {
    double whole = 0;         ///< one bin  [microseconds, and all that follow]
    double one = 0, two = 0;  ///< two bins of equal widths, by so many workers
};

}  // namespace

void measureQueryThreads(const Scene& scene, const CameraPath& path, const std::string& where, int repeat,
                         Table& table) {
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    ThreadPool pool(2);
    Query whole, one, two(defaultMemory(), &pool);
    Cost sum;
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, kAskedWidth, kAskedHeight);
        QuerySettings halves{.bins = 2};
        const std::vector<double> times =
            timeInterleaved({[&] { whole.visible(now, view); }, [&] { one.visible(now, view, halves); },
                             [&] { two.visible(now, view, halves); }},
                            repeat);
        sum.whole += times[0];
        sum.one += times[1];
        sum.two += times[2];
    }
    const double n = static_cast<double>(path.frames.size());
    const Rows add{table, where, "us", 1.0 / n};
    add("query in 2 bins, 1 worker", sum.one, "in 1 bin", sum.whole);
    add("query in 2 bins, 2 workers", sum.two, "in 1 bin, 1 worker", sum.whole);
    add("query in 2 bins, 2 workers", sum.two, "in 2 bins, 1 worker", sum.one);
}

}  // namespace sightline::bench
