// Several frusta in one walk of a world's hierarchy, beside a walk for each.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"

#include "bench/stopwatch.h"
#include "sightline/cull/hierarchy.h"

namespace sightline::bench {
namespace {

std::vector<Frustum> eyes() {
    View view;
    view.view = lookAt(glm::dvec3(0.0), glm::dvec3(1, 0.1, 0.3), {0, 1, 0});
    view.projection = perspective(glm::radians(90.0), 1.0, 0.1);
    return {makeFrustum(shiftedEye(view, -0.032)), makeFrustum(shiftedEye(view, 0.032))};
}

/// A sun's boxes around parts of a view, each twice as large as the one before.
std::vector<Frustum> cascades(double world) {
    std::vector<Frustum> frusta;
    for (double size = 0.05 * world; size < 0.5 * world; size *= 2.0) {
        const glm::dvec3 middle = 0.5 * size * glm::normalize(glm::dvec3(1, 0.1, 0.3));
        View view;
        view.view = lookAt(middle + 2.0 * world * glm::dvec3(0.2, 1, 0.1), middle, {1, 0, 0});
        view.projection = orthographic(1.2 * size, 1.0, 0.0, 4.0 * world);
        frusta.push_back(makeFrustum(view));
    }
    return frusta;
}

std::vector<Frustum> cubeFaces(double reach) {
    std::vector<Frustum> frusta;
    for (int face = 0; face < 6; ++face) {
        glm::dvec3 toward(0.0);
        toward[face / 2] = face % 2 ? -1.0 : 1.0;
        View view;
        view.view = lookAt(glm::dvec3(0.0), toward, {0, 1, 0});
        view.projection = perspective(glm::radians(90.0), 1.0, 0.1, reach);
        frusta.push_back(makeFrustum(view));
    }
    return frusta;
}

}  // namespace

void measureManyFrusta(Table& table, const PlacedBvh& tree, const std::string& where, double world, int repeat) {
    struct Case {
        const char* name;
        std::vector<Frustum> frusta;
    };
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(tree.size() + 8), masks(tree.size() + 8);
    for (const Case& of :
         {Case{"two eyes", eyes()}, Case{"four cascades", cascades(world)},
          Case{"six cube faces", cubeFaces(0.3 * world)}, Case{"six long cube faces", cubeFaces(4 * world)}}) {
        HierarchyStats once, each, sum;
        const std::vector<double> times =
            threadTimes({[&] { cullHierarchy(of.frusta, tree, scratch, kept, masks, &once); },
                         [&] {
                             sum = {};
                             for (const Frustum& frustum : of.frusta) {
                                 cullHierarchy(frustum, tree, scratch, kept, &each);
                                 sum.nodes += each.nodes + each.inside_nodes;
                             }
                         }},
                        repeat ? repeat : 15);
        const std::string row = where + "; " + of.name;
        table.rows.push_back({row, "one walk for all", times[0], "us", "a walk for each", times[1]});
        table.rows.push_back({row, "nodes visited", static_cast<double>(once.nodes + once.inside_nodes), "nodes",
                              "by a walk for each", static_cast<double>(sum.nodes)});
    }
}

}  // namespace sightline::bench
