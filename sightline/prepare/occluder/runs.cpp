// Sorts polygons into runs that become clusters: compact pieces of what hangs together, gatherings of the rest.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/runs.h"

#include <algorithm>
#include <numeric>

#include "sightline/geom/occluder.h"
#include "sightline/math/box.h"
#include "sightline/prepare/occluder/side_pairs.h"

namespace sightline {
namespace {

constexpr uint32_t kLeastJoined = 3;  // a single panel shares no side worth a record

/// A box or a slab, with what its triangles leave unpaired: few of its faces are seen at once, and cutting it in two
/// costs more than it gains.

/// Cosine below which polygons lie back to back: no eye sees the fronts of both. Where more than two meet, these are
/// the faces between boxes that touch; kept apart they do not break the wall that the boxes make.
constexpr double kFolded = -0.999;

/// Sets of numbers that grow together. The root of a set is its least member.
class Sets {
public:
    explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    uint32_t root(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(uint32_t a, uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    std::vector<uint32_t> roots() {
        std::vector<uint32_t> out(parent_.size());
        for (uint32_t i = 0; i < out.size(); ++i) out[i] = root(i);
        return out;
    }

private:
    std::vector<uint32_t> parent_;
};

class Splitter {
public:
    Splitter(const Patchwork& patchwork, uint32_t most_vertices)
        : patchwork_(patchwork), most_vertices_(most_vertices), seen_(patchwork.positions.size(), 0) {}

    /// Splits at a median of the longest axis until the pieces are small enough, so that each is compact. Iterative:
    /// meshes of millions of triangles must not exhaust the stack.
    void split(Runs& out, std::span<const uint32_t> polygons, bool joined, uint32_t most, uint32_t most_folded) {
        if (polygons.empty()) return;
        const uint32_t first = static_cast<uint32_t>(out.order.size());
        sorted_.clear();
        for (uint32_t polygon : polygons)
            sorted_.push_back({centerOf(polygon), glm::vec3(normalOf(patchwork_, polygon)), polygon});
        stack_.assign(1, {0, static_cast<uint32_t>(polygons.size())});
        while (!stack_.empty()) {
            const Range range = stack_.back();
            stack_.pop_back();
            const uint32_t count = range.last - range.first;
            if (count <= most && fits(range) && (count <= most_folded || facesOneWay(range))) {
                std::sort(sorted_.begin() + range.first, sorted_.begin() + range.last,
                          [](const Sorted& a, const Sorted& b) { return a.polygon < b.polygon; });
                out.runs.push_back({first + range.first, first + range.last, joined});
                continue;
            }
            const uint32_t pieces = std::max(2u, (count + most - 1) / most);
            const uint32_t middle = range.first + static_cast<uint32_t>(uint64_t{count} * ((pieces + 1) / 2) / pieces);
            halve(range, middle);
            stack_.push_back({middle, range.last});
            stack_.push_back({range.first, middle});
        }
        for (const Sorted& sorted : sorted_) out.order.push_back(sorted.polygon);
    }

private:
    struct Sorted {
        glm::vec3 center, normal;
        uint32_t polygon;
    };
    struct Range {
        uint32_t first, last;
    };

    glm::vec3 centerOf(uint32_t polygon) const {
        const PatchPolygon& p = patchwork_.polygons[polygon];
        glm::vec3 sum(0.0f);
        for (int k = 0; k < p.corners; ++k) sum += patchwork_.positions[p.vertex[k]];
        return sum / static_cast<float>(p.corners);
    }

    bool fits(const Range& range) {
        ++mark_;
        uint32_t vertices = 0;
        for (uint32_t i = range.first; i < range.last; ++i) {
            const PatchPolygon& p = patchwork_.polygons[sorted_[i].polygon];
            for (int k = 0; k < p.corners; ++k) {
                vertices += seen_[p.vertex[k]] != mark_;
                seen_[p.vertex[k]] = mark_;
            }
        }
        return vertices <= most_vertices_;
    }

    /// Whether no two polygons are far from facing the same way, so that they lie beside each other, not in front.
    bool facesOneWay(const Range& range) const {
        constexpr float kLeastCosine = 0.3f;  // to the mean
        glm::vec3 sum(0.0f);
        for (uint32_t i = range.first; i < range.last; ++i) sum += sorted_[i].normal;
        const float least = kLeastCosine * glm::length(sum);
        for (uint32_t i = range.first; i < range.last; ++i)
            if (!(glm::dot(sum, sorted_[i].normal) > least)) return false;
        return true;
    }

    void halve(const Range& range, uint32_t middle) {
        Box3f box;
        for (uint32_t i = range.first; i < range.last; ++i) box.grow(sorted_[i].center);
        const glm::vec3 size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::nth_element(sorted_.begin() + range.first, sorted_.begin() + middle, sorted_.begin() + range.last,
                         [axis](const Sorted& a, const Sorted& b) {
                             return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis]
                                                                     : a.polygon < b.polygon;
                         });
    }

    const Patchwork& patchwork_;
    uint32_t most_vertices_;
    std::vector<uint32_t> seen_;  ///< per vertex: the range that met it last
    uint32_t mark_ = 0;
    std::vector<Sorted> sorted_;
    std::vector<Range> stack_;
};

/// For each polygon, a number that those have in common that hang together by the sides that pairSides() joins.
std::vector<uint32_t> findWholes(const Patchwork& patchwork) {
    Sets sets(patchwork.polygons.size());
    const std::vector<PatchSide> sides = sortedSides(patchwork);
    std::vector<SidePair> pairs;
    forSharedSides(std::span(sides), [&](std::span<const PatchSide> shared) {
        pairSides(patchwork, shared, pairs);
        for (const SidePair& pair : pairs) {
            if (pair.forward == SidePair::kNone || pair.backward == SidePair::kNone) break;
            const PatchSide &f = shared[pair.forward], &b = shared[pair.backward];
            if (shared.size() == 2 || smoothness(patchwork, f, b) > kFolded) sets.join(f.polygon, b.polygon);
        }
    });
    return sets.roots();
}

}  // namespace

Runs sortIntoRuns(const Patchwork& patchwork, const RunLimits& limits) {
    const std::vector<PatchPolygon>& polygons = patchwork.polygons;
    const size_t count = polygons.size();
    Runs out;
    out.whole = findWholes(patchwork);
    const auto partOf = [&](uint32_t i) { return std::pair(limits.by_mesh ? polygons[i].mesh : 0u, out.whole[i]); };
    out.order.resize(count);
    std::iota(out.order.begin(), out.order.end(), 0u);
    std::sort(out.order.begin(), out.order.end(), [&](uint32_t a, uint32_t b) {
        const auto part_a = partOf(a), part_b = partOf(b);
        return part_a != part_b ? part_a < part_b : a < b;
    });
    std::vector<uint32_t> whole_size(count, 0);
    for (uint32_t whole : out.whole) ++whole_size[whole];

    Splitter splitter(patchwork, limits.most_vertices);
    std::vector<uint32_t> loose, joined;
    std::vector<uint32_t> order = std::move(out.order);
    const auto endMesh = [&] {
        std::sort(loose.begin(), loose.end());
        splitter.split(out, loose, false, limits.most_loose, limits.most_loose);
        loose.clear();
    };
    for (size_t first = 0, last = 0; first < count; first = last) {
        while (last < count && partOf(order[last]) == partOf(order[first])) ++last;
        if (first > 0 && partOf(order[first]).first != partOf(order[first - 1]).first) endMesh();
        const size_t size = limits.reach_across ? whole_size[out.whole[order[first]]] : last - first;
        joined.assign(order.begin() + static_cast<ptrdiff_t>(first), order.begin() + static_cast<ptrdiff_t>(last));
        if (size < kLeastJoined) loose.insert(loose.end(), joined.begin(), joined.end());
        else splitter.split(out, joined, true, limits.most_joined, limits.most_folded);
    }
    endMesh();
    return out;
}

}  // namespace sightline
