// Back faces by clusters: what each test finds on the same ones, what making them well is worth, and what a frame asks.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

#include "bench/facing_meshes.h"
#include "bench/stopwatch.h"
#include "sightline/cull/facing_clusters.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "sightline/prepare/facing/merge_facing.h"
#include "sightline/studies/facing/back_faces.h"
#include "sightline/studies/facing/triangle_planes.h"

namespace sightline::bench {
using namespace studies;
namespace {

constexpr int kEyes = 200;

/// What the tests find on given clusters, in triangles over all eyes.
struct Found {
    double backs = 0, oracle = 0, volumes = 0, turned = 0, cones = 0, all = 0, meshopt = 0, masks = 0, both = 0,
           finer = 0;
};

Found findOn(const ClusteredMesh& clustered, const Box3d& eyes_box) {
    const MeshView mesh = clustered.mesh.view();
    std::vector<uint32_t> order(mesh.triangles());
    std::iota(order.begin(), order.end(), 0u);
    const FacingClusters clusters = describeClusters(mesh, order, clustered.sizes, {.mask_steps = 2});
    FacingSettings finer{.turned = false, .cones = false, .mask_steps = 4};
    const FacingClusters fine = describeClusters(mesh, order, clustered.sizes, finer);
    const TrianglePlanes planes = makeTrianglePlanes(mesh);
    const MeshoptCones meshopt(clustered);
    const size_t bytes = (clusters.count() + 15) / 16 * 2;
    std::vector<uint8_t> triangles((mesh.triangles() + 15) / 16 * 2);
    std::vector<uint8_t> by[5] = {std::vector<uint8_t>(bytes), std::vector<uint8_t>(bytes), std::vector<uint8_t>(bytes),
                                  std::vector<uint8_t>(bytes), std::vector<uint8_t>(bytes)};
    Found found;
    for (const FacingEye& eye : randomEyes(eyes_box, kEyes)) {
        found.backs += static_cast<double>(findBackFaces(planes, eye, triangles));
        findBackClusters(clusters, eye, kVolumeTest, by[0]);
        findBackClusters(clusters, eye, kTurnedTest, by[1]);
        findBackClusters(clusters, eye, kConeTest, by[2]);
        findBackClusters(clusters, eye, kAllFacingTests, by[3]);
        meshopt.find(eye.point, by[4]);
        double* const sums[5] = {&found.volumes, &found.turned, &found.cones, &found.all, &found.meshopt};
        for (size_t c = 0; c < clusters.count(); ++c) {
            for (int k = 0; k < 5; ++k)
                if (bitOf(by[k], c)) *sums[k] += clusters.size(c);
            size_t backs = 0, masked = 0;
            const uint64_t* const masks = backTriangles(clusters, c, eye);
            for (uint32_t i = 0; i < clusters.size(c); ++i) {
                backs += bitOf(triangles, clusters.first[c] + i);
                masked += masks && masks[i / 64] >> (i % 64) & 1;
            }
            if (backs == clusters.size(c)) found.oracle += static_cast<double>(backs);
            found.masks += static_cast<double>(masked);
            const uint64_t* const more = backTriangles(fine, c, eye);
            for (size_t i = 0; more && i < (clusters.size(c) + 63) / 64; ++i)
                found.finer += static_cast<double>(std::popcount(more[i]));
            found.both += static_cast<double>(bitOf(by[3], c) ? clusters.size(c) : masked);
        }
    }
    return found;
}

void addRecallRows(const FacingMesh& mesh, Table& table) {
    const Box3d eyes = eyeSpace(mesh.box(), 3.0);
    for (const uint32_t size : {16u, 32u, 64u}) {
        const ClusteredMesh clustered = meshoptClusters(mesh, size, 0.5f);
        const Found found = findOn(clustered, eyes);
        const std::string where = fmt::format("{}, meshoptimizer's clusters of {}", mesh.name, size);
        const Rows row{table, where, "of back faces", 1.0 / found.backs};
        row("any cluster test", found.oracle, "all", found.backs);
        row("volumes", found.volumes, "any cluster test", found.oracle);
        row("turned volumes", found.turned, "volumes", found.volumes);
        row("cones", found.cones, "meshoptimizer's cones", found.meshopt);
        row("all three", found.all, "meshoptimizer's cones", found.meshopt);
        row("all three", found.all, "any cluster test", found.oracle);
        row("masks, 24 sectors", found.masks, "cones", found.cones);
        row("masks, 96 sectors", found.finer, "cones", found.cones);
        row("all three and 24 sectors", found.both, "all", found.backs);
    }
}

/// The cheapest of many ways to cluster.
struct Cheapest {
    double cost = 1e300;
    std::string name;
};

void addCostRows(const FacingMesh& mesh, int repeat, Table& table) {
    constexpr double kTests[] = {1.0, 4.0, 16.0};
    Cheapest best[3];
    FacingSettings settings;
    settings.turned = settings.cones = false;
    for (const uint32_t size : {8u, 16u, 32u, 64u, 124u, 256u})
        for (const float weight : {0.0f, 0.25f, 0.5f, 1.0f}) {
            const ClusteredMesh clustered = meshoptClusters(mesh, size, weight);
            std::vector<uint32_t> order(clustered.mesh.view().triangles());
            std::iota(order.begin(), order.end(), 0u);
            const FacingClusters clusters = describeClusters(clustered.mesh.view(), order, clustered.sizes, settings);
            for (int i = 0; i < 3; ++i) {
                const double cost = modelledCost(clusters, clustered.mesh.view(), {.test = kTests[i]});
                if (cost < best[i].cost) best[i] = {cost, fmt::format("clusters of {}, weight {}", size, weight)};
            }
        }
    const double all = static_cast<double>(mesh.view().triangles());
    for (int i = 0; i < 3; ++i) {
        const FacingCost cost{.test = kTests[i]};
        const FacingPartition part = mergeFacing(mesh.view(), cost, {.triangles = 256});
        const FacingClusters clusters = describeClusters(mesh.view(), part.triangles, part.sizes, settings);
        const double ours = modelledCost(clusters, mesh.view(), cost);
        const std::string where = fmt::format("{}, a test as dear as {} triangles", mesh.name, kTests[i]);
        table.rows.push_back({where, "modelled cost", ours / all, "of all triangles", "meshoptimizer's best",
                              best[i].cost / all, best[i].name});
        table.rows.push_back({where, "clusters of", all / static_cast<double>(part.sizes.size()), "triangles", "", 0});
    }
    const std::vector<double> times =
        threadTimes({[&] { meshoptClusters(mesh, 64, 0.5f); }, [&] { mergeFacing(mesh.view()); }}, std::min(repeat, 3));
    const double each = 1.0 / all;
    table.rows.push_back(
        {mesh.name, "making clusters", times[1] * each, "us/triangle", "meshoptimizer", times[0] * each});
}

void addClusterTimes(const FacingMesh& mesh, int repeat, Table& table) {
    const FacingPartition part = mergeFacing(mesh.view());
    const FacingClusters clusters = describeClusters(mesh.view(), part.triangles, part.sizes);
    const FacingTree tree = makeFacingTree(clusters, mesh.view());
    const std::vector<FacingEye> eyes = randomEyes(eyeSpace(mesh.box(), 3.0), kEyes);
    std::vector<uint8_t> back((clusters.count() + 15) / 16 * 2);
    std::vector<TriangleRange> ranges(clusters.count() / 2 + 1);
    size_t asked = 0, runs = 0, drawn = 0, tree_asked = 0;
    const auto test = [&](uint32_t tests) {
        return [&, tests] {
            for (const FacingEye& eye : eyes) findBackClusters(clusters, eye, tests, back);
        };
    };
    const std::vector<double> times =
        threadTimes({test(kVolumeTest), test(kTurnedTest), test(kConeTest), test(kAllFacingTests),
                     [&] {
                         tree_asked = 0;
                         for (const FacingEye& eye : eyes) tree_asked += walkFacingTree(tree, clusters, eye, back);
                     }},
                    repeat);
    for (const FacingEye& eye : eyes) {
        findBackClusters(clusters, eye, kAllFacingTests, back);
        const size_t count = remainingRanges(clusters, back, 0, ranges);
        runs += count;
        for (size_t i = 0; i < count; ++i) drawn += ranges[i].count;
    }
    asked = clusters.count() * eyes.size();
    const double each = 1e3 / static_cast<double>(asked);
    const std::string where = fmt::format("{}, {} clusters", mesh.name, clusters.count());
    const Rows row{table, where};
    row("volumes", times[0] * each, "ns/cluster", "", 0);
    row("turned volumes", times[1] * each, "ns/cluster", "volumes", times[0] * each);
    row("cones", times[2] * each, "ns/cluster", "volumes", times[0] * each);
    row("all three", times[3] * each, "ns/cluster", "volumes", times[0] * each);
    row("tree of volumes", times[4] * each, "ns/cluster", "volumes", times[0] * each,
        fmt::format("{} nodes", tree.nodes.size()));
    row("volumes asked by the tree", static_cast<double>(tree_asked) / kEyes, "volumes", "clusters", clusters.count());
    const double all = static_cast<double>(mesh.view().triangles());
    row("triangles drawn", static_cast<double>(drawn) / kEyes, "triangles", "all", all);
    row("runs of triangles", static_cast<double>(runs) / kEyes, "runs", "", 0);
}

}  // namespace

void addClusterRows(const FacingMesh& mesh, int repeat, Table& table) {
    addRecallRows(mesh, table);
    addCostRows(mesh, repeat, table);
    addClusterTimes(mesh, repeat, table);
}

}  // namespace sightline::bench
