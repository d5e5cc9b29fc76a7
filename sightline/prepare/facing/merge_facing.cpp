// Puts triangles into clusters that are likely to be seen from their backs together.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/merge_facing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <queue>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/math/box.h"
#include "sightline/prepare/facing/culling_volume.h"
#include "sightline/prepare/facing/facets.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "sightline/prepare/facing/normal_classes.h"

namespace sightline {
namespace {

constexpr uint32_t kNoPlane = ~0u;

/// A facet as the merging reads it: its plane.
struct Plane {
    glm::dvec3 normal;
    double offset;  ///< n * p
    uint32_t triangle;
    uint32_t next;  ///< of the same cluster
};

struct Cluster {
    glm::dvec3 most, least;  ///< of the normals
    Box3d box;
    double probability = 0;
    uint32_t count = 0, first = kNoPlane, last = kNoPlane;  ///< planes in a list
    uint32_t parent = kNoPlane;                             ///< the cluster that it has become part of
    std::vector<uint32_t> neighbours;
};

struct Candidate {
    double gain;
    uint32_t a, b;
    bool operator<(const Candidate& other) const {
        if (gain != other.gain) return gain < other.gain;
        return a != other.a ? a > other.a : b > other.b;  // the same answer on every machine
    }
};

class Merger {
public:
    Merger(const MeshView& mesh, const FacingCost& cost, const MergeLimits& limits)
        : mesh_(mesh), cost_(cost), limits_(limits) {
        Box3d box;
        for (const uint32_t index : mesh.indices) box.grow(glm::dvec3(mesh.positions[index]));
        if (mesh.triangles()) origin_ = box.center();
        eyes_ = eyeSpace(box, cost.eye_space);
        eyes_ = {eyes_.min - origin_, eyes_.max - origin_};
        for (uint32_t t = 0; t < mesh.triangles(); ++t) addTriangle(t);
    }

    FacingPartition run() {
        connectByEdges();
        mergeAll();
        for (int round = 0; round < limits_.rounds; ++round) {
            const size_t before = alive();
            connectByPlace();
            mergeAll();
            if (alive() > before - before / 100) break;
        }
        return write();
    }

private:
    void addTriangle(uint32_t t) {
        const Facet facet = facetOf(mesh_, t, origin_);
        if (isDegenerate(mesh_, t) || facet.normal == glm::dvec3(0.0)) {
            aside_.push_back(t);
            return;
        }
        const uint32_t number = static_cast<uint32_t>(planes_.size());
        planes_.push_back({facet.normal, glm::dot(facet.normal, facet.corner[0]), t, kNoPlane});
        Cluster& cluster = clusters_.emplace_back();
        cluster.most = cluster.least = facet.normal;
        for (const glm::dvec3& p : facet.corner) cluster.box.grow(p);
        cluster.count = 1;
        cluster.first = cluster.last = number;
        cluster.probability = probabilityOf(cluster, nullptr);
    }

    /// P of one cluster, or of two as one.
    double probabilityOf(const Cluster& a, const Cluster* b) const {
        Box3d box = a.box;
        glm::dvec3 most = a.most, least = a.least;
        if (b) {
            box.grow(b->box);
            most = glm::max(most, b->most);
            least = glm::min(least, b->least);
        }
        CullingVolume volume;
        volume.origin = glm::vec3(box.center());
        volume.most = glm::vec3(most);
        volume.least = glm::vec3(least);
        const glm::dvec3 origin(volume.origin);
        double back = 1e300;
        for (const Cluster* one : {&a, b}) {
            if (!one) continue;
            for (uint32_t i = one->first; i != kNoPlane; i = planes_[i].next)
                back = std::min(back, planes_[i].offset - glm::dot(planes_[i].normal, origin));
        }
        volume.back = static_cast<float>(back);
        return cullingProbability(volume, eyes_);
    }

    void consider(uint32_t a, uint32_t b) {
        const Cluster &one = clusters_[a], &two = clusters_[b];
        if (one.count + two.count > limits_.triangles) return;
        const double now = one.probability * one.count + two.probability * two.count;
        const double together = one.count + two.count;
        // Both cull where the two together do.
        if (cost_.test - now + std::min(one.probability, two.probability) * together <= 0) return;
        const double gain = cost_.test - now + probabilityOf(one, &two) * together;
        if (gain > 0) queue_.push({gain, std::min(a, b), std::max(a, b)});
    }

    void link(uint32_t a, uint32_t b) {
        clusters_[a].neighbours.push_back(b);
        clusters_[b].neighbours.push_back(a);
        consider(a, b);
    }

    void connectByEdges() {
        // Corners are the same if they are equal, whatever else a vertex is there for.
        std::vector<uint32_t> order(mesh_.positions.size()), name(mesh_.positions.size());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto key = [&](uint32_t i) {
            const glm::vec3 p = mesh_.positions[i] + 0.0f;  // no negative zeros
            return std::array<uint32_t, 3>{std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y),
                                           std::bit_cast<uint32_t>(p.z)};
        };
        std::sort(order.begin(), order.end(),
                  [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
        for (size_t i = 0; i < order.size(); ++i)
            name[order[i]] = i && key(order[i]) == key(order[i - 1]) ? name[order[i - 1]] : order[i];
        struct Side {
            uint64_t key;
            uint32_t cluster;
        };
        std::vector<Side> sides;
        for (uint32_t c = 0; c < clusters_.size(); ++c) {
            const uint32_t t = planes_[c].triangle;
            for (int k = 0; k < 3; ++k) {
                const uint64_t a = name[mesh_.indices[3 * t + k]], b = name[mesh_.indices[3 * t + (k + 1) % 3]];
                sides.push_back({std::min(a, b) << 32 | std::max(a, b), c});
            }
        }
        std::sort(sides.begin(), sides.end(),
                  [](const Side& a, const Side& b) { return a.key != b.key ? a.key < b.key : a.cluster < b.cluster; });
        for (size_t i = 1; i < sides.size(); ++i)
            if (sides[i].key == sides[i - 1].key && sides[i].cluster != sides[i - 1].cluster)
                link(sides[i - 1].cluster, sides[i].cluster);
    }

    /// Links those that follow one another along a curve, among those that face alike.
    void connectByPlace() {
        const std::vector<uint32_t> order = inOrder();
        for (size_t i = 0; i < order.size(); ++i)
            for (size_t j = i + 1; j < std::min(i + 4, order.size()); ++j) link(order[i], order[j]);
    }

    void mergeAll() {
        while (!queue_.empty()) {
            const Candidate next = queue_.top();
            queue_.pop();
            if (clusters_[next.a].parent != kNoPlane || clusters_[next.b].parent != kNoPlane) continue;
            join(next.a, next.b);
        }
    }

    void join(uint32_t a, uint32_t b) {
        const uint32_t made = static_cast<uint32_t>(clusters_.size());
        Cluster cluster;
        {
            Cluster &one = clusters_[a], &two = clusters_[b];
            cluster.probability = probabilityOf(one, &two);
            cluster.most = glm::max(one.most, two.most);
            cluster.least = glm::min(one.least, two.least);
            cluster.box = one.box;
            cluster.box.grow(two.box);
            cluster.count = one.count + two.count;
            cluster.first = one.first;
            cluster.last = two.last;
            planes_[one.last].next = two.first;
            one.parent = two.parent = made;
            for (Cluster* old : {&one, &two}) {
                cluster.neighbours.insert(cluster.neighbours.end(), old->neighbours.begin(), old->neighbours.end());
                std::vector<uint32_t>().swap(old->neighbours);
            }
        }
        clusters_.push_back(std::move(cluster));
        std::vector<uint32_t>& around = clusters_[made].neighbours;
        for (uint32_t& n : around) n = rootOf(n);
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        std::erase(around, made);
        for (const uint32_t n : around) {
            clusters_[n].neighbours.push_back(made);
            consider(made, n);
        }
    }

    uint32_t rootOf(uint32_t cluster) {
        while (clusters_[cluster].parent != kNoPlane) {
            const uint32_t up = clusters_[cluster].parent;
            if (clusters_[up].parent != kNoPlane) clusters_[cluster].parent = clusters_[up].parent;
            cluster = up;
        }
        return cluster;
    }

    size_t alive() const {
        size_t count = 0;
        for (const Cluster& cluster : clusters_) count += cluster.parent == kNoPlane;
        return count;
    }

    /// Those that are no part of another one: by the class of the middle of their normals, and then along a curve through space.
    std::vector<uint32_t> inOrder() const {
        struct Place {
            uint64_t key;
            uint32_t cluster;
        };
        std::vector<Place> places;
        const glm::dvec3 size = eyes_.max - eyes_.min;
        for (uint32_t i = 0; i < clusters_.size(); ++i) {
            const Cluster& cluster = clusters_[i];
            if (cluster.parent != kNoPlane) continue;
            const glm::dvec3 ahead = cluster.most + cluster.least, center = cluster.box.center();
            const uint64_t face = ahead == glm::dvec3(0.0) ? 24 : static_cast<uint64_t>(normalClass(ahead, 2));
            uint64_t key = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double at = (center[axis] - eyes_.min[axis]) / size[axis];
                const auto step = static_cast<uint64_t>((at > 0 ? std::min(at, 1.0) : 0.0) * 0xfffff);  // 0 for a NaN
                for (int bit = 0; bit < 19; ++bit) key |= (step >> bit & 1) << (3 * bit + axis);
            }
            places.push_back({face << 58 | key, i});
        }
        std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
            return a.key != b.key ? a.key < b.key : a.cluster < b.cluster;
        });
        std::vector<uint32_t> order;
        for (const Place& place : places) order.push_back(place.cluster);
        return order;
    }

    FacingPartition write() const {
        FacingPartition out;
        std::vector<uint32_t> loose;
        for (const uint32_t c : inOrder()) {
            const Cluster& cluster = clusters_[c];
            // One that saves less than its share of a test where it fills up a full cluster is none.
            const double fill = static_cast<double>(cluster.count) / limits_.triangles;
            const bool worth = cluster.probability * cluster.count >= cost_.test * (1.0 - fill);
            for (uint32_t i = cluster.first; i != kNoPlane; i = planes_[i].next)
                (worth ? out.triangles : loose).push_back(planes_[i].triangle);
            if (!worth) continue;
            out.sizes.push_back(cluster.count);
            out.cost += cost_.test + (1.0 - cluster.probability) * cluster.count;
        }
        for (const std::vector<uint32_t>* rest : {&std::as_const(loose), &aside_})
            for (size_t i = 0; i < rest->size(); i += limits_.triangles) {
                const size_t count = std::min<size_t>(limits_.triangles, rest->size() - i);
                const auto from = rest->begin() + static_cast<std::ptrdiff_t>(i);
                out.triangles.insert(out.triangles.end(), from, from + static_cast<std::ptrdiff_t>(count));
                out.sizes.push_back(static_cast<uint32_t>(count));
                out.cost += cost_.test + static_cast<double>(count);
            }
        return out;
    }

    const MeshView& mesh_;
    const FacingCost cost_;
    const MergeLimits limits_;
    glm::dvec3 origin_{0.0};
    Box3d eyes_;  ///< relative to the origin
    std::vector<Plane> planes_;
    std::vector<Cluster> clusters_;
    std::vector<uint32_t> aside_;
    std::priority_queue<Candidate> queue_;
};

}  // namespace

FacingPartition mergeFacing(const MeshView& mesh, const FacingCost& cost, const MergeLimits& limits) {
    SIGHTLINE_ASSERT(limits.triangles >= 1 && cost.test > 0);
    return Merger(mesh, cost, limits).run();
}

double modelledCost(const FacingClusters& clusters, const MeshView& mesh, const FacingCost& cost) {
    Box3d box;
    for (const uint32_t triangle : clusters.triangles)
        for (int k = 0; k < 3; ++k) box.grow(glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]));
    Box3d eyes = eyeSpace(box, cost.eye_space);
    eyes = {eyes.min - clusters.origin, eyes.max - clusters.origin};
    double sum = 0;
    for (size_t i = 0; i < clusters.count(); ++i)
        sum += cost.test + (1.0 - cullingProbability(clusters.volume(i), eyes)) * clusters.size(i);
    return sum;
}

}  // namespace sightline
