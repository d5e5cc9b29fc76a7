// Half-spaces cut an interval out of a segment; boxes of space tell which brushes are asked.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/brush_rays.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "sightline/base/assert.h"

namespace sightline::tools {
namespace {

/// A side that took another's plane moved by no more than the slack at each corner of its face. Beyond these corners, which
/// the sides beside it moved as little, it is turned by 1e-5 at most: twice the slack holds it.
constexpr double kMoved = 2;
constexpr double kBrushRounding = 0x1p-36;  // of coordinates
constexpr int kDeepest = 9;
constexpr size_t kFew = 6, kMostNodes = size_t(1) << 20;

double heightOver(const glm::dvec4& plane, const glm::dvec3& p) {
    return plane.x * p.x + plane.y * p.y + plane.z * p.z + plane.w;
}

/// Takes away what of an outline is higher over a plane than this.
void cutAbove(const glm::dvec4& plane, double height, std::vector<glm::dvec3>& outline) {
    std::vector<glm::dvec3> kept;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &here = outline[i], &next = outline[i + 1 < outline.size() ? i + 1 : 0];
        const double at_here = heightOver(plane, here) - height, at_next = heightOver(plane, next) - height;
        if (at_here <= 0) kept.push_back(here);
        if ((at_here <= 0) != (at_next <= 0)) kept.push_back(here + at_here / (at_here - at_next) * (next - here));
    }
    outline.swap(kept);
}

/// A square in a plane about a point of it.
std::vector<glm::dvec3> squareIn(const glm::dvec4& plane, const glm::dvec3& middle, double half) {
    const glm::dvec3 n(plane), size = glm::abs(n);
    glm::dvec3 helper(0.0);
    helper[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
    const glm::dvec3 u = half * glm::normalize(glm::cross(helper, n)), v = glm::cross(n, u);
    return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
}

/// The text of a map by its lines: braces, and three points at the beginning of a side.
class SideLines {
public:
    explicit SideLines(std::string_view text) : text_(text) {}

    /// Calls begin() for each brush, and side(points) for each of its sides.
    template <class Begin, class Side>
    void run(Begin&& begin, Side&& side) {
        int depth = 0;
        while (nextLine()) {
            const std::string_view line = line_;
            if (line.starts_with('(')) {
                glm::dvec3 points[3];
                if (depth < 2 || patch_ || !readPoints(line, points)) continue;
                if (!std::exchange(begun_, true)) begin();
                side(points);
                continue;
            }
            for (size_t at = 0; at < line.size(); ++at) {
                if (line[at] == '"') {
                    at = std::min(line.find('"', at + 1), line.size());
                    // A quote in a text, or the end of a path.
                    while (at < line.size() && line[at - 1] == '\\' && line.find('"', at + 1) != std::string_view::npos)
                        at = line.find('"', at + 1);
                } else if (line.substr(at).starts_with("patch")) {
                    patch_ = true;
                } else if (line[at] == '{') {
                    if (++depth == 2) begun_ = patch_ = false;
                } else if (line[at] == '}') {
                    // A brush without a side is one, too.
                    if (depth-- == 2 && !begun_ && !patch_) begin();
                }
            }
        }
    }

private:
    bool nextLine() {
        if (at_ >= text_.size()) return false;
        const size_t end = std::min(text_.find('\n', at_), text_.size());
        line_ = text_.substr(at_, end - at_);
        at_ = end + 1;
        const size_t first = std::min(line_.find_first_not_of(" \t\r"), line_.size());
        line_.remove_prefix(first);
        if (!line_.starts_with('"')) line_ = line_.substr(0, line_.find("//"));
        return true;
    }

    static bool readPoints(std::string_view line, glm::dvec3 (&points)[3]) {
        size_t at = 0;
        for (glm::dvec3& point : points) {
            double numbers[3];
            at = line.find('(', at);
            if (at == std::string_view::npos) return false;
            ++at;
            for (double& number : numbers) {
                while (at < line.size() && (line[at] == ' ' || line[at] == '\t' || line[at] == '+')) ++at;
                const auto [end, error] = std::from_chars(line.data() + at, line.data() + line.size(), number);
                if (error != std::errc()) return false;
                at = static_cast<size_t>(end - line.data());
            }
            point = {numbers[0], numbers[2], -numbers[1]};
        }
        return true;
    }

    std::string_view text_, line_;
    size_t at_ = 0;
    bool begun_ = false, patch_ = false;
};

}  // namespace

Result<BrushRays> BrushRays::read(std::string_view text, std::span<const uint8_t> stops, double slack) {
    BrushRays out;
    size_t count = 0;
    bool taken = false;
    out.slack_ = slack;
    SideLines(text).run(
        [&] {
            taken = count < stops.size() && stops[count];
            ++count;
            if (taken) out.brushes_.push_back({static_cast<uint32_t>(out.planes_.size()), 0, 0});
        },
        [&](const glm::dvec3(&points)[3]) {
            if (!taken) return;
            const glm::dvec3 normal = glm::cross(points[0] - points[1], points[2] - points[1]);
            const double length = glm::length(normal);
            if (!(length > 0)) return;
            for (const glm::dvec3& p : points) {
                out.points_.push_back(p);
                out.bounds_.grow(p);
            }
            out.planes_.emplace_back(normal / length, -glm::dot(normal / length, points[1]));
            ++out.brushes_.back().count;
        });
    if (count != stops.size())
        return Error{Error::Kind::kInput,
                     fmt::format("by their lines there are {} brushes, and {} were read", count, stops.size())};
    if (!out.bounds_.empty()) {
        out.bounds_.min -= 1024.0;
        out.bounds_.max += 1024.0;
    }
    out.grow();
    out.divide();
    return out;
}

double BrushRays::growthAt(const glm::dvec3& point) const {
    return kMoved * slack_ + kBrushRounding * largestCoordinate(point);
}

/// No point of a brush has a larger coordinate; one without an end reaches to the bounds. The faces are moved out by the
/// slack, and cut by twice that: so much may a tree have moved them, and no face is lost beside one that equals it.
double BrushRays::largestOf(const Brush& brush) const {
    const double beyond = 2 * glm::length(bounds_.size());
    double by_corners = 0, by_points = 0;
    for (uint32_t i = brush.first; i < brush.first + brush.count; ++i) {
        const glm::dvec3* points = points_.data() + 3 * size_t{i};
        for (int k = 0; k < 3; ++k) by_points = std::max(by_points, largestCoordinate(points[k]));
        std::vector<glm::dvec3> face = squareIn(planes_[i], points[1] + slack_ * glm::dvec3(planes_[i]), beyond);
        for (uint32_t k = brush.first; k < brush.first + brush.count && !face.empty(); ++k)
            if (k != i) cutAbove(planes_[k], 2 * slack_, face);
        for (const glm::dvec3& corner : face) by_corners = std::max(by_corners, largestCoordinate(corner));
    }
    const double most = std::max(largestCoordinate(bounds_.min), largestCoordinate(bounds_.max));
    return std::min(by_corners > 0 ? by_corners : by_points, most);
}

void BrushRays::grow() {
    for (Brush& brush : brushes_) {
        if (brush.count == 0) continue;
        brush.growth = kMoved * slack_ + kBrushRounding * largestOf(brush);
    }
    for (const Brush& brush : brushes_)
        for (uint32_t i = brush.first; i < brush.first + brush.count; ++i) planes_[i].w -= brush.growth;
}

bool BrushRays::meets(const Brush& brush, const Box3d& box) const {
    const glm::dvec3 center = box.center(), half = 0.5 * box.size();
    for (uint32_t i = brush.first; i < brush.first + brush.count; ++i) {
        const double size = largestCoordinate(center) + largestCoordinate(half) + std::abs(planes_[i].w);
        if (heightOver(planes_[i], center) > glm::dot(glm::abs(glm::dvec3(planes_[i])), half) + 1e-12 * size)
            return false;
    }
    return true;
}

void BrushRays::divide() {
    struct Task {
        uint32_t node;
        int depth;
        std::vector<uint32_t> brushes;
    };
    std::vector<Task> tasks(1);
    tasks[0].depth = 0;
    for (uint32_t i = 0; i < brushes_.size(); ++i) tasks[0].brushes.push_back(i);
    nodes_.push_back({bounds_, 0, 0, false});
    while (!tasks.empty()) {
        const Task task = std::move(tasks.back());
        tasks.pop_back();
        Node node = nodes_[task.node];
        if (task.brushes.size() <= kFew || task.depth == kDeepest || nodes_.size() + 8 > kMostNodes) {
            node.first = static_cast<uint32_t>(lists_.size());
            node.count = static_cast<uint32_t>(task.brushes.size());
            lists_.insert(lists_.end(), task.brushes.begin(), task.brushes.end());
            nodes_[task.node] = node;
            continue;
        }
        node.divided = true;
        node.first = static_cast<uint32_t>(nodes_.size());
        nodes_[task.node] = node;
        const glm::dvec3 middle = node.box.center();
        for (uint32_t k = 0; k < 8; ++k) {
            Box3d box = node.box;
            for (int axis = 0; axis < 3; ++axis) (((k >> axis) & 1) != 0 ? box.min : box.max)[axis] = middle[axis];
            std::vector<uint32_t> kept;
            for (const uint32_t brush : task.brushes)
                if (meets(brushes_[brush], box)) kept.push_back(brush);
            tasks.push_back({static_cast<uint32_t>(nodes_.size()), task.depth + 1, std::move(kept)});
            nodes_.push_back({box, 0, 0, false});
        }
    }
}

double BrushRays::follow(const glm::dvec3& a, const glm::dvec3& b) const {
    double first = 1;
    if (brushes_.empty()) return first;
    const glm::dvec3 way = b - a;
    // Beyond the bounds of the boxes nothing is known: a segment ends there.
    const auto clip = [&](const Box3d& box, double& from, double& to) {
        for (int axis = 0; axis < 3; ++axis) {
            if (way[axis] == 0) {
                if (a[axis] < box.min[axis] || a[axis] > box.max[axis]) return false;
                continue;
            }
            const double low = (box.min[axis] - a[axis]) / way[axis], high = (box.max[axis] - a[axis]) / way[axis];
            from = std::max(from, std::min(low, high));
            to = std::min(to, std::max(low, high));
        }
        return from <= to + 1e-12;
    };
    double from = 0, to = 1;
    if (!clip(bounds_, from, to) || from > 0) return 0;
    first = to;
    uint32_t stack[8 * (kDeepest + 1)];
    size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
        const Node& node = nodes_[stack[--size]];
        double enter = 0, leave = 1;
        if (!clip(node.box, enter, leave) || enter > first) continue;
        if (node.divided) {
            for (uint32_t k = 0; k < 8; ++k) stack[size++] = node.first + k;
            continue;
        }
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Brush& brush = brushes_[lists_[i]];
            double in = 0, out = 1;
            for (uint32_t k = brush.first; k < brush.first + brush.count && in <= out; ++k) {
                const double at_a = heightOver(planes_[k], a), at_b = heightOver(planes_[k], b);
                if (at_a > 0 && at_b > 0) in = 2;
                else if (at_a > 0) in = std::max(in, at_a / (at_a - at_b));
                else if (at_b > 0) out = std::min(out, at_a / (at_a - at_b));
            }
            if (in <= out) first = std::min(first, in);
        }
    }
    return first;
}

glm::dvec3 BrushRays::pointNearSide(Random& random) const {
    const size_t point = random.below(points_.size());
    // A brush without sides begins where the next one does.
    const auto next = std::upper_bound(brushes_.begin(), brushes_.end(), point / 3,
                                       [](size_t side, const Brush& brush) { return side < brush.first; });
    const double off = 4 * std::prev(next)->growth * std::exp2(random.uniform(0, 10));
    return points_[point] + off * randomDirection(random);
}

namespace {

/// A stretch of a segment within a leaf of any contents, as parameters.
struct LeafStretch {
    uint32_t leaf;
    double from, to;
};

class BrushChecker {
public:
    BrushChecker(const BrushRays& rays, const LeafTree& tree, const BitMatrix& rows,
                 std::span<const uint32_t> row_of_leaf, const AimedHoles& holes, double farthest)
        : rays_(rays),
          tree_(tree),
          row_of_leaf_(row_of_leaf),
          holes_(holes),
          farthest_(farthest),
          judge_(rows, false),
          convicted_(tree.contents.size(), false) {}

    void cast(Random& random) {
        const glm::dvec3 through = aim(random);
        glm::dvec3 direction = randomDirection(random);
        if (random.below(2) == 0) {
            const glm::dvec3 toward = aim(random) - through;
            if (glm::length(toward) > rays_.growthAt(through)) direction = glm::normalize(toward);
        }
        const double reach = glm::length(tree_.bounds.size());
        const glm::dvec3 ahead = within(through, through + reach * direction);
        const glm::dvec3 behind = within(through, through - reach * direction);
        const double to = rays_.follow(through, ahead), back = rays_.follow(through, behind);
        if (to <= 0 || back <= 0) return;
        judge(through + back * (behind - through), through + to * (ahead - through));
    }

    const RowJudge& judge() const { return judge_; }
    const std::vector<RowMiss>& solid() const { return solid_; }

private:
    glm::dvec3 aim(Random& random) const {
        const uint64_t kind = random.below(3);
        if (kind == 0 && holes_.size() > 0) return pointInHole(random, holes_.outline(random.below(holes_.size())));
        if (kind == 1 && rays_.brushes() > 0) return rays_.pointNearSide(random);
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        return tree_.bounds.min + glm::dvec3(x, y, z) * tree_.bounds.size();
    }

    /// What of a segment lies in the tree's bounds; nothing if it begins outside.
    glm::dvec3 within(const glm::dvec3& a, const glm::dvec3& b) const {
        double to = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = tree_.bounds.min[axis], high = tree_.bounds.max[axis], way = b[axis] - a[axis];
            if (a[axis] < low || a[axis] > high) return a;
            if (way != 0) to = std::min(to, ((way > 0 ? high : low) - a[axis]) / way);
        }
        return a + to * (b - a);
    }

    void walk(const glm::dvec3& a, const glm::dvec3& b) {
        stretches_.clear();
        struct Part {
            uint32_t child;
            double from, to;
        };
        std::vector<Part> parts = {{tree_.nodes.empty() ? LeafTreeNode::kLeaf : 0, 0, 1}};
        while (!parts.empty()) {
            Part part = parts.back();
            parts.pop_back();
            if ((part.child & LeafTreeNode::kLeaf) != 0) {
                stretches_.push_back({part.child & ~LeafTreeNode::kLeaf, part.from, part.to});
                continue;
            }
            const LeafTreeNode& node = tree_.nodes[part.child];
            const double at_a = heightOver(node.plane, a), slope = heightOver(node.plane, b) - at_a;
            const bool near = at_a + part.from * slope >= 0, far = at_a + part.to * slope >= 0;
            if (near != far) {
                const double cross = std::clamp(-at_a / slope, part.from, part.to);
                parts.push_back({node.child[far], cross, part.to});
                part.to = cross;
            }
            parts.push_back({node.child[near], part.from, part.to});
        }
    }

    void judge(const glm::dvec3& a, const glm::dvec3& b) {
        const double length = glm::distance(a, b);
        const auto growthAlong = [&](double at) { return rays_.growthAt(a + at * (b - a)); };
        if (!(length > 4 * std::max(growthAlong(0), growthAlong(1)))) return;
        walk(a, b);
        places_.clear();
        extents_.clear();
        for (const LeafStretch& stretch : stretches_) {
            // Shorter ones may be no more than rounding at a corner of the tree.
            const double least = 0.5 * std::max(growthAlong(stretch.from), growthAlong(stretch.to));
            if (!((stretch.to - stretch.from) * length > least)) continue;
            const LeafContents contents = tree_.contents[stretch.leaf];
            if (contents == LeafContents::kSolid || contents == LeafContents::kSky) {
                if (!convicted_[stretch.leaf]) solid_.push_back({stretch.leaf, stretch.leaf, a, b});
                convicted_[stretch.leaf] = true;
                continue;
            }
            const uint32_t row = row_of_leaf_[stretch.leaf];
            if (!places_.empty() && places_.back() == row) {
                extents_.back().second = stretch.to * length;
                continue;
            }
            places_.push_back(row);
            extents_.emplace_back(stretch.from * length, stretch.to * length);
        }
        judge_.judge(
            places_, a, b, [](size_t, size_t) { return true; },
            [&](size_t i, size_t j) {
                const double left = extents_[i].second, entered = extents_[j].first;
                return !(farthest_ > 0) ||
                       entered - left + std::max(growthAlong(left / length), growthAlong(entered / length)) <=
                           farthest_;
            });
    }

    const BrushRays& rays_;
    const LeafTree& tree_;
    std::span<const uint32_t> row_of_leaf_;
    const AimedHoles& holes_;
    double farthest_;
    RowJudge judge_;
    std::vector<bool> convicted_;
    std::vector<RowMiss> solid_;
    std::vector<LeafStretch> stretches_;
    std::vector<uint32_t> places_;
    std::vector<std::pair<double, double>> extents_;
};

}  // namespace

BrushReport checkBrushRows(const BrushRays& rays, const LeafTree& tree, const BitMatrix& rows,
                           std::span<const uint32_t> row_of_leaf, const AimedHoles& holes,
                           const RowCheckSettings& settings) {
    SIGHTLINE_ASSERT(row_of_leaf.size() == tree.contents.size());
    constexpr uint32_t kParts = 16;
    std::vector<BrushChecker> parts(kParts, BrushChecker(rays, tree, rows, row_of_leaf, holes, settings.farthest));
    runJobs(settings.jobs, kParts, [&](uint32_t part) {
        Random random(mixSeed(settings.seed, part));
        for (uint64_t i = 0; i < (settings.segments + kParts - 1) / kParts; ++i) parts[part].cast(random);
    });
    BrushReport report;
    BitMatrix missed(rows.rows(), rows.columns());
    std::vector<bool> convicted(tree.contents.size(), false);
    for (const BrushChecker& part : parts) {
        part.judge().addTo(report.rows, missed, settings.most_examples, nullptr);
        for (const RowMiss& solid : part.solid()) {
            if (!convicted[solid.row]) report.solid.push_back(solid);
            convicted[solid.row] = true;
        }
    }
    return report;
}

}  // namespace sightline::tools
