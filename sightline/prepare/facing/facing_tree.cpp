// Makes the tree over clusters that are seen from their backs together.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <queue>

#include "sightline/prepare/facing/culling_volume.h"
#include "sightline/prepare/facing/facets.h"
#include "sightline/prepare/facing/facing_clusters.h"

namespace sightline {
namespace {

constexpr uint32_t kNoRun = ~0u;

/// A run of clusters that may become a node.
struct Run {
    uint32_t first, count;
    CullingVolume volume;
    uint32_t left = kNoRun, right = kNoRun;    ///< what it was made of; of no node: none
    uint32_t before = kNoRun, after = kNoRun;  ///< in the row of those that are no part of another one
    bool taken = false;
};

struct Pair {
    double settled;
    uint32_t a, b;
    bool operator<(const Pair& other) const { return settled != other.settled ? settled < other.settled : a > other.a; }
};

/// The share of eyes for which a volume is known to be seen from the back or from the front.
double settledShare(const CullingVolume& volume, const Box3d& eyes) {
    const CullingVolume turned{volume.origin, -volume.least, -volume.most, -volume.front, -volume.back};
    return cullingProbability(volume, eyes) + cullingProbability(turned, eyes);
}

class TreeMaker {
public:
    TreeMaker(const FacingClusters& clusters, const MeshView& mesh, const FacingSettings& settings)
        : clusters_(clusters), mesh_(mesh) {
        Box3d box;
        for (const uint32_t t : clusters.triangles)
            for (int k = 0; k < 3; ++k) box.grow(glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]));
        const Box3d eyes = eyeSpace(box, settings.eye_space);
        eyes_ = {eyes.min - clusters.origin, eyes.max - clusters.origin};
    }

    void run(FacingTree& tree) {
        const uint32_t count = static_cast<uint32_t>(clusters_.count());
        for (uint32_t i = 0; i < count; ++i)
            runs_.push_back(
                {i, 1, clusters_.volume(i), kNoRun, kNoRun, i ? i - 1 : kNoRun, i + 1 < count ? i + 1 : kNoRun});
        for (uint32_t i = 0; i + 1 < count; ++i) consider(i, i + 1);
        while (!queue_.empty()) {
            const Pair pair = queue_.top();
            queue_.pop();
            if (!runs_[pair.a].taken && !runs_[pair.b].taken) join(pair.a, pair.b);
        }
        for (uint32_t i = 0; i < runs_.size(); ++i)
            if (!runs_[i].taken && runs_[i].before == kNoRun)
                for (uint32_t at = i; at != kNoRun; at = runs_[at].after) write(tree, at);
    }

private:
    CullingVolume volumeOf(uint32_t first, uint32_t count) const {
        std::vector<Facet> facets;
        for (uint32_t i = clusters_.first[first]; i < clusters_.first[first + count]; ++i)
            if (!isDegenerate(mesh_, clusters_.triangles[i]))
                facets.push_back(facetOf(mesh_, clusters_.triangles[i], clusters_.origin));
        return makeCullingVolume(facets, eyes_);
    }

    void consider(uint32_t a, uint32_t b) {
        // What both settle apart is more than what they settle together, more or less: most pairs need no more.
        constexpr double kWorth = 0.5;
        if (std::min(settledShare(runs_[a].volume, eyes_), settledShare(runs_[b].volume, eyes_)) < kWorth) return;
        const double settled = settledShare(volumeOf(runs_[a].first, runs_[a].count + runs_[b].count), eyes_);
        if (settled > kWorth) queue_.push({settled, a, b});
    }

    void join(uint32_t a, uint32_t b) {
        const uint32_t made = static_cast<uint32_t>(runs_.size());
        Run run{runs_[a].first, runs_[a].count + runs_[b].count, {}, a, b, runs_[a].before, runs_[b].after};
        run.volume = volumeOf(run.first, run.count);
        runs_[a].taken = runs_[b].taken = true;
        runs_.push_back(run);
        if (run.before != kNoRun) runs_[run.before].after = made, consider(run.before, made);
        if (run.after != kNoRun) runs_[run.after].before = made, consider(made, run.after);
    }

    void write(FacingTree& tree, uint32_t at) const {
        std::vector<uint32_t> todo{at};
        while (!todo.empty()) {
            const Run& run = runs_[todo.back()];
            todo.pop_back();
            if (run.left == kNoRun) continue;
            tree.nodes.push_back({run.volume, run.first, run.count, 0});
            todo.push_back(run.right);
            todo.push_back(run.left);
        }
    }

    const FacingClusters& clusters_;
    const MeshView& mesh_;
    Box3d eyes_;
    std::vector<Run> runs_;
    std::priority_queue<Pair> queue_;
};

}  // namespace

FacingTree makeFacingTree(const FacingClusters& clusters, const MeshView& mesh, const FacingSettings& settings,
                          Memory* memory) {
    FacingTree tree(memory);
    TreeMaker(clusters, mesh, settings).run(tree);
    // The node after the last descendant is the first that begins where this one ends.
    std::vector<uint32_t> open;
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        while (!open.empty()) {
            const FacingNode& last = tree.nodes[open.back()];
            if (tree.nodes[i].first < last.first + last.count) break;
            tree.nodes[open.back()].next = i;
            open.pop_back();
        }
        open.push_back(i);
    }
    for (const uint32_t i : open) tree.nodes[i].next = static_cast<uint32_t>(tree.nodes.size());
    return tree;
}

}  // namespace sightline
