// Grows a tree of planes: each cell is divided by the sheet that is most nearly a wall of it.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace sightline::bake {
namespace {

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

using Outline = std::vector<glm::dvec3>;

/// Cuts an outline where dot(plane, (p, 1)) < 0.
void cutOutline(Outline& outline, const glm::dvec4& plane) {
    Outline kept;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &a = outline[i], &b = outline[i + 1 == outline.size() ? 0 : i + 1];
        const double at_a = heightOf(plane, a), at_b = heightOf(plane, b);
        if (at_a >= 0) kept.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    outline.swap(kept);
    if (outline.size() < 3) outline.clear();
}

double areaOfOutline(const Outline& outline) {
    glm::dvec3 sum(0.0);
    for (size_t i = 2; i < outline.size(); ++i) sum += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    return glm::length(sum) / 2;
}

/// A part of a triangle of a sheet.
struct Fragment {
    uint32_t sheet;
    uint8_t sides;  // 1: it faces along the sheet's normal, 2: against it
    Outline outline;
    double area;
};

/// A cell that may be divided.
struct OpenCell {
    std::vector<Fragment> fragments;
    uint32_t slot;  // the parent's number << 1 | side; ~0: the root
    uint32_t depth;
};

struct Candidate {
    uint32_t sheet = SoupTree::kNoSheet;
    glm::dvec4 plane{0.0};
    double area = 0;  // of the sheet in the cell, of its better side
    double score = 0;
};

class TreeGrower {
public:
    TreeGrower(const SoupWalls& walls, const Box3d& bounds, const SoupTreeSettings& settings)
        : walls_(walls), settings_(settings) {
        out_.tree.bounds = bounds;
    }

    SoupTree run() {
        std::vector<OpenCell> open;
        open.push_back({takeAll(), kNone, 0});
        size_t leaves = 1;
        while (!open.empty()) {
            OpenCell cell = std::move(open.back());
            open.pop_back();
            const Candidate best = leaves < settings_.most_leaves ? choose(cell) : Candidate();
            if (!(glm::length(glm::dvec3(best.plane)) > 0)) {
                out_.full |= leaves >= settings_.most_leaves && choose(cell).sheet != SoupTree::kNoSheet;
                addLeaf(cell.slot);
                continue;
            }
            ++leaves;
            const auto node = static_cast<uint32_t>(out_.tree.nodes.size());
            out_.tree.nodes.push_back({best.plane});
            out_.sheet_of_node.push_back(best.sheet);
            parent_.push_back(cell.slot);
            hang(cell.slot, node);
            out_.depth = std::max(out_.depth, cell.depth + 1);
            OpenCell behind{{}, node << 1, cell.depth + 1}, before{{}, node << 1 | 1, cell.depth + 1};
            for (Fragment& fragment : cell.fragments)
                part(std::move(fragment), best.plane, behind.fragments, before.fragments);
            open.push_back(std::move(behind));
            open.push_back(std::move(before));
        }
        return std::move(out_);
    }

private:
    static constexpr uint32_t kNone = ~0u;

    std::vector<Fragment> takeAll() const {
        std::vector<Fragment> all;
        for (uint32_t sheet = 0; sheet < walls_.sheets.size(); ++sheet)
            for (const uint32_t t : walls_.sheets[sheet].triangles) {
                if (walls_.part[t] < settings_.least_area) continue;
                const WallTriangle& triangle = walls_.triangles[t];
                Fragment fragment{sheet, 3, Outline(triangle.corners, triangle.corners + 3), 0};
                const glm::dvec3 normal =
                    glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
                if (!triangle.both)
                    fragment.sides = glm::dot(normal, glm::dvec3(walls_.sheets[sheet].plane)) > 0 ? 1 : 2;
                fragment.area = glm::length(normal) / 2;
                all.push_back(std::move(fragment));
            }
        return all;
    }

    void hang(uint32_t slot, uint32_t child) {
        if (slot != kNone) out_.tree.nodes[slot >> 1].child[slot & 1] = child;
    }

    void addLeaf(uint32_t slot) {
        hang(slot, LeafTreeNode::kLeaf | static_cast<uint32_t>(out_.tree.contents.size()));
        out_.tree.contents.push_back(LeafContents::kEmpty);
    }

    /// The area of a plane in a cell.
    double sectionOf(const glm::dvec4& plane, uint32_t slot) const {
        const Box3d& box = out_.tree.bounds;
        const glm::dvec3 n(plane), size = glm::abs(n);
        const double diagonal = glm::length(box.size());
        const glm::dvec3 middle = box.center() - n * heightOf(plane, box.center());
        glm::dvec3 helper(0.0);
        helper[size.x < size.y ? (size.x < size.z ? 0 : 2) : (size.y < size.z ? 1 : 2)] = 1;
        const glm::dvec3 u = diagonal * glm::normalize(glm::cross(helper, n)), v = glm::cross(n, u);
        Outline outline = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
        for (; slot != kNone && !outline.empty(); slot = parent_[slot >> 1]) {
            const glm::dvec4& bound = out_.tree.nodes[slot >> 1].plane;
            cutOutline(outline, (slot & 1) != 0 ? bound : -bound);
        }
        for (int axis = 0; axis < 3 && !outline.empty(); ++axis)
            for (const double side : {1.0, -1.0}) {
                glm::dvec4 bound(0.0);
                bound[axis] = side;
                bound.w = side > 0 ? -box.min[axis] : box.max[axis];
                cutOutline(outline, bound);
            }
        return areaOfOutline(outline);
    }

    /// The share of a cell's area that a plane would split, of a sample; and how uneven the rest is, from 0 to 1.
    double costOf(const std::vector<Fragment>& fragments, const glm::dvec4& plane, double& uneven) const {
        constexpr size_t kSample = 256;
        const size_t step = (fragments.size() + kSample - 1) / kSample;
        size_t split = 0, sides[2] = {0, 0}, asked = 0;
        for (size_t i = 0; i < fragments.size(); i += step, ++asked) {
            double low = INFINITY, high = -INFINITY;
            for (const glm::dvec3& point : fragments[i].outline) {
                low = std::min(low, heightOf(plane, point));
                high = std::max(high, heightOf(plane, point));
            }
            const bool behind = low<-settings_.bend, before = high> settings_.bend;
            split += behind && before;
            sides[0] += behind && !before;
            sides[1] += before && !behind;
        }
        const size_t whole = sides[0] + sides[1];
        uneven = whole > 0 ? std::abs(double(sides[0]) - double(sides[1])) / double(whole) : 0;
        return double(split) / double(asked);
    }

    /// The plane that divides a cell; without length: none does.
    Candidate choose(const OpenCell& cell) const {
        constexpr size_t kMost = 24;
        constexpr double kBarely = 0.05;  // a share of a section: less is hardly a wall
        std::map<uint32_t, std::pair<double, double>> areas;
        for (const Fragment& fragment : cell.fragments) {
            std::pair<double, double>& area = areas[fragment.sheet];
            if ((fragment.sides & 1) != 0) area.first += fragment.area;
            if ((fragment.sides & 2) != 0) area.second += fragment.area;
        }
        std::vector<Candidate> candidates;
        for (const auto& [sheet, area] : areas)
            if (const double most = std::max(area.first, area.second); most >= settings_.least_area)
                candidates.push_back({sheet, walls_.sheets[sheet].plane, most, 0});
        if (candidates.empty()) return {};
        const size_t count = std::min(kMost, candidates.size());
        std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count), candidates.end(),
                          [](const Candidate& a, const Candidate& b) {
                              return a.area != b.area ? a.area > b.area : a.sheet < b.sheet;
                          });
        Candidate best;
        best.score = -INFINITY;
        double most_opaque = 0;
        for (size_t i = 0; i < count; ++i) {
            Candidate& candidate = candidates[i];
            const double section = sectionOf(candidate.plane, cell.slot);
            const double opaque = section > 0 ? std::min(candidate.area / section, 1.0) : 1;
            double uneven = 0;
            candidate.score = opaque - 0.5 * costOf(cell.fragments, candidate.plane, uneven);
            most_opaque = std::max(most_opaque, opaque);
            if (candidate.score > best.score) best = candidate;
        }
        // Where nothing is nearly a wall, as in a city seen whole, halves keep the tree flat.
        if (most_opaque < kBarely && cell.fragments.size() >= 64)
            if (const Candidate half = halfOf(cell); half.score > best.score) return half;
        return best;
    }

    Candidate halfOf(const OpenCell& cell) const {
        Candidate best;
        best.score = -INFINITY;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> ends;
            for (const Fragment& fragment : cell.fragments) {
                double high = -INFINITY;
                for (const glm::dvec3& point : fragment.outline) high = std::max(high, point[axis]);
                ends.push_back(high);
            }
            std::nth_element(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2), ends.end());
            Candidate half;
            half.plane[axis] = 1;
            half.plane.w = -ends[ends.size() / 2];
            double uneven = 0;
            const double split = costOf(cell.fragments, half.plane, uneven);
            if (uneven > 0.8) continue;
            half.score = 0.2 - 0.5 * split;
            if (half.score > best.score) best = half;
        }
        takeSheetIn(cell, best);
        return best;
    }

    /// Gives a plane the largest sheet that lies in it, if there is one: walls in a plane without a sheet hide nothing.
    void takeSheetIn(const OpenCell& cell, Candidate& half) const {
        std::map<uint32_t, double> areas;
        for (const Fragment& fragment : cell.fragments)
            if (std::all_of(fragment.outline.begin(), fragment.outline.end(), [&](const glm::dvec3& point) {
                    return std::abs(heightOf(half.plane, point)) <= settings_.bend;
                }))
                areas[fragment.sheet] += fragment.area;
        for (const auto& [sheet, area] : areas)
            if (area > half.area) {
                half.sheet = sheet;
                half.area = area;
            }
        if (half.sheet != SoupTree::kNoSheet) half.plane = walls_.sheets[half.sheet].plane;
    }

    void part(Fragment&& fragment, const glm::dvec4& plane, std::vector<Fragment>& behind,
              std::vector<Fragment>& before) const {
        double low = INFINITY, high = -INFINITY;
        for (const glm::dvec3& point : fragment.outline) {
            low = std::min(low, heightOf(plane, point));
            high = std::max(high, heightOf(plane, point));
        }
        if (low >= -settings_.bend && high <= settings_.bend) return;  // in the plane
        if (high <= settings_.bend) return behind.push_back(std::move(fragment));
        if (low >= -settings_.bend) return before.push_back(std::move(fragment));
        for (const bool front : {false, true}) {
            Fragment part{fragment.sheet, fragment.sides, fragment.outline, 0};
            cutOutline(part.outline, front ? plane : -plane);
            part.area = areaOfOutline(part.outline);
            if (part.area > 0) (front ? before : behind).push_back(std::move(part));
        }
    }

    const SoupWalls& walls_;
    const SoupTreeSettings& settings_;
    SoupTree out_;
    std::vector<uint32_t> parent_;  // per node
};

}  // namespace

SoupTree treeOfSheets(const SoupWalls& walls, const Box3d& bounds, const SoupTreeSettings& settings) {
    return TreeGrower(walls, bounds, settings).run();
}

}  // namespace sightline::bake
