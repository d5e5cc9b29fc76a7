// Finds T-junctions: vertices that lie exactly on the sides of other polygons.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/junctions.h"

#include <algorithm>
#include <numeric>

#include "sightline/math/box.h"
#include "sightline/prepare/occluder/exact.h"
#include "sightline/prepare/occluder/side_pairs.h"

namespace sightline {
namespace {

constexpr double kSharp = 0.7;  // cosine: polygons that go on more smoothly need no others at their side
// Work is counted in nodes of the tree that are looked into: this many per line and per vertex on average, and so many
// in any case; for one line at most; and what a vertex in a chain counts for, since each makes an edge.
constexpr size_t kAverageWork = 64, kLeastWork = 1 << 20, kMostWorkOfLine = 1 << 16, kWorkOfVertex = 16;

/// A line between two vertices, with the sides that run along it.
struct Line {
    uint32_t low, high;
    size_t first_side, last_side;  ///< of the sorted sides
};

/// Points in boxes in boxes, to be asked for those near a line.
class PointTree {
public:
    PointTree(const std::vector<glm::vec3>& positions, std::vector<uint32_t> points)
        : positions_(positions), points_(std::move(points)) {
        if (points_.empty()) return;
        nodes_.push_back({{}, 0, static_cast<uint32_t>(points_.size()), 0});
        for (uint32_t at = 0; at < nodes_.size(); ++at) {
            const Node range = nodes_[at];
            Box3f box;
            for (uint32_t i = range.first; i < range.last; ++i) box.grow(positions_[points_[i]]);
            nodes_[at].box = box;
            if (range.last - range.first <= kLeaf) continue;
            const glm::vec3 size = box.size();
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const uint32_t middle = range.first + (range.last - range.first) / 2;
            std::nth_element(points_.begin() + range.first, points_.begin() + middle, points_.begin() + range.last,
                             [&](uint32_t a, uint32_t b) {
                                 const float p = positions_[a][axis], q = positions_[b][axis];
                                 return p != q ? p < q : a < b;
                             });
            nodes_[at].child = static_cast<uint32_t>(nodes_.size());
            nodes_.push_back({{}, range.first, middle, 0});
            nodes_.push_back({{}, middle, range.last, 0});
        }
    }

    /// Adds points between a and b to `found`: all of them if `most` nodes are enough. Returns how many it looked into.
    size_t findBetween(const glm::vec3& a, const glm::vec3& b, size_t most, std::vector<uint32_t>& found) {
        size_t visits = 0;
        if (nodes_.empty()) return 0;
        stack_.assign(1, 0);
        while (!stack_.empty() && visits < most) {
            const Node& node = nodes_[stack_.back()];
            stack_.pop_back();
            ++visits;
            if (!mayMeet(node.box, a, b)) continue;
            if (node.child) {
                stack_.push_back(node.child + 1);
                stack_.push_back(node.child);
                continue;
            }
            for (uint32_t i = node.first; i < node.last; ++i)
                if (liesBetween(positions_[points_[i]], a, b)) found.push_back(points_[i]);
        }
        return visits;
    }

private:
    static constexpr uint32_t kLeaf = 6;

    struct Node {
        Box3f box;
        uint32_t first, last;
        uint32_t child;  ///< the first of two; 0 in a leaf
    };

    /// False only if the box misses the line from a to b. Separating axes, with room for rounding.
    static bool mayMeet(const Box3f& box, const glm::vec3& a, const glm::vec3& b) {
        for (int i = 0; i < 3; ++i)
            if (box.max[i] < std::min(a[i], b[i]) || box.min[i] > std::max(a[i], b[i])) return false;
        const glm::dvec3 low(box.min), high(box.max), along = glm::dvec3(b) - glm::dvec3(a);
        const glm::dvec3 offset = 0.5 * (low + high) - glm::dvec3(a), half = 0.5 * (high - low);
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const double p = along[i] * offset[j], q = along[j] * offset[i];
            const double reach = std::abs(along[i]) * half[j] + std::abs(along[j]) * half[i];
            if (std::abs(p - q) > reach * (1 + 1e-12) + 1e-12 * (std::abs(p) + std::abs(q))) return false;
        }
        return true;
    }

    const std::vector<glm::vec3>& positions_;
    std::vector<uint32_t> points_;
    std::vector<Node> nodes_;
    std::vector<uint32_t> stack_;
};

/// The lines along which some side has no partner, or one at a sharp angle.
std::vector<Line> findLines(const Patchwork& patchwork, std::span<const PatchSide> sides) {
    std::vector<Line> lines;
    std::vector<SidePair> pairs;
    size_t at = 0;
    forSharedSides(sides, [&](std::span<const PatchSide> shared) {
        const size_t first = at;
        at += shared.size();
        pairSides(patchwork, shared, pairs);
        for (const SidePair& pair : pairs) {
            if (pair.forward != SidePair::kNone && pair.backward != SidePair::kNone &&
                smoothness(patchwork, shared[pair.forward], shared[pair.backward]) > kSharp)
                continue;
            lines.push_back({shared[0].low, shared[0].high, first, at});
            break;
        }
    });
    return lines;
}

}  // namespace

void findJunctions(Patchwork& patchwork) {
    const std::vector<glm::vec3>& positions = patchwork.positions;
    const std::vector<PatchSide> sides = sortedSides(patchwork);
    const std::vector<Line> lines = findLines(patchwork, sides);
    std::vector<uint32_t> ends;
    for (const Line& line : lines) ends.insert(ends.end(), {line.low, line.high});
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    size_t left = kLeastWork + kAverageWork * (lines.size() + ends.size());
    PointTree tree(positions, std::move(ends));

    struct Found {
        size_t side;
        uint32_t first, last;  ///< of the vertices, in order from the side's low end
    };
    std::vector<Found> found;
    std::vector<uint32_t> vertices, between;
    for (const Line& line : lines) {
        const glm::vec3 &a = positions[line.low], &b = positions[line.high];
        between.clear();
        left -= tree.findBetween(a, b, std::min(left, kMostWorkOfLine), between);
        const size_t weight = kWorkOfVertex * between.size() * (line.last_side - line.first_side);
        if (weight > left) break;
        left -= weight;
        if (between.empty()) continue;
        const glm::vec3 size = glm::abs(b - a);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::sort(between.begin(), between.end(), [&](uint32_t p, uint32_t q) {
            return a[axis] < b[axis] ? positions[p][axis] < positions[q][axis]
                                     : positions[p][axis] > positions[q][axis];
        });
        const uint32_t first = static_cast<uint32_t>(vertices.size());
        vertices.insert(vertices.end(), between.begin(), between.end());
        for (size_t side = line.first_side; side < line.last_side; ++side)
            found.push_back({side, first, static_cast<uint32_t>(vertices.size())});
    }
    if (found.empty()) return;
    patchwork.first_chain.assign(4 * patchwork.polygons.size() + 1, 0);
    const auto placeOf = [&](const Found& f) { return 4 * size_t{sides[f.side].polygon} + sides[f.side].corner; };
    for (const Found& f : found) patchwork.first_chain[placeOf(f) + 1] = f.last - f.first;
    std::partial_sum(patchwork.first_chain.begin(), patchwork.first_chain.end(), patchwork.first_chain.begin());
    patchwork.chains.resize(patchwork.first_chain.back());
    for (const Found& f : found) {
        const auto to = patchwork.chains.begin() + patchwork.first_chain[placeOf(f)];
        if (sides[f.side].forward) std::copy(vertices.begin() + f.first, vertices.begin() + f.last, to);
        else std::reverse_copy(vertices.begin() + f.first, vertices.begin() + f.last, to);
    }
}

}  // namespace sightline
