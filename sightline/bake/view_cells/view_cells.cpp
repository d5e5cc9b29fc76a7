// Divides space into boxes, and asks of each which objects one flat hider hides from all of it.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/view_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "sightline/bake/flow/bit_runs.h"
#include "sightline/bake/objects/scene_hash.h"
#include "sightline/bake/soup/soup_scale.h"
#include "sightline/bake/view_cells/flat_hiders.h"
#include "sightline/bake/view_cells/hider_covers.h"
#include "sightline/bake/view_cells/hider_tree.h"
#include "sightline/base/bytes.h"
#include "sightline/base/random.h"
#include "sightline/tree/descend.h"

namespace sightline::bake {
namespace {

using Bits = std::vector<uint64_t>;

bool anyIn(const Bits& bits, uint32_t first, uint32_t end) {
    for (uint32_t word = first / 64; word <= (end - 1) / 64; ++word) {
        uint64_t part = bits[word];
        if (word == first / 64) part &= ~uint64_t{0} << first % 64;
        if (word == (end - 1) / 64) part &= ~uint64_t{0} >> (63 - (end - 1) % 64);
        if (part) return true;
    }
    return false;
}

void clearIn(Bits& bits, uint32_t first, uint32_t end) {
    for (uint32_t i = first; i < end; ++i) bits[i / 64] &= ~(uint64_t{1} << i % 64);
}

uint64_t countOf(const Bits& bits) {
    uint64_t count = 0;
    for (const uint64_t word : bits) count += static_cast<uint64_t>(std::popcount(word));
    return count;
}

bool meet(const Box3d& a, const Box3d& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis]) return false;
    return true;
}

/// What is seen from a region, by places of the hierarchy of objects, and what hides the rest of it.
struct RegionRow {
    Bits visible;
    std::vector<HiderCover> covers;  // those that hid something, the ones that hid last first
    bool over_budget = false;
};

/// Everything that rows are found with.
struct Hiding {
    const HiderCovers& covers;
    const HiderTree& search;
    const Bvh& objects;
    double bend = 0;  // the largest of the hiders'
    double reach = 0;
    uint64_t budget = 0;
};

/// Finds the row of one region.
class RowFinder {
public:
    RowFinder(const Hiding& of, const Box3d& region) : of_(of), region_(region), covers_(of.covers, region, of.reach) {}

    /// @param from  of a region that holds this one
    RegionRow find(const RegionRow& from) {
        row_.visible = from.visible;
        for (const HiderCover& cover : from.covers)
            if (std::optional<ReadyCover> ready = covers_.take(cover)) pool_.push_back(std::move(*ready));
        if (!of_.objects.nodes.empty()) descend(0);
        for (ReadyCover& ready : pool_) row_.covers.push_back(std::move(ready.cover));
        return std::move(row_);
    }
    /// Hiders that hid something.
    const std::vector<uint32_t>& used() const { return used_; }

private:
    static constexpr size_t kPool = 32;
    static constexpr size_t kMostTried = 8;  // hiders on the way to a box, the nearest

    void descend(uint32_t index) {
        const BvhNode& node = of_.objects.nodes[index];
        forEachSlot(usedSlots(node), [&](int slot) {
            const uint32_t first = node.first[slot], end = first + node.count[slot];
            if (!anyIn(row_.visible, first, end)) return;
            Box3d box{glm::dvec3(slotBox(node, slot).min), glm::dvec3(slotBox(node, slot).max)};
            box.min += of_.objects.origin;
            box.max += of_.objects.origin;
            if (!meet(box, region_) && isHidden(box)) return clearIn(row_.visible, first, end);
            if ((node.child[slot] & BvhNode::kLeaf) == 0) descend(node.child[slot]);
        });
    }

    bool isHidden(const Box3d& box) {
        for (size_t i = 0; i < pool_.size(); ++i)
            if (pool_[i].hides(box)) {
                const auto at = pool_.begin() + static_cast<std::ptrdiff_t>(i);
                std::rotate(pool_.begin(), at, at + 1);
                use(pool_[0].cover);
                return true;
            }
        if (spent_ > of_.budget) {
            row_.over_budget = true;
            return false;
        }
        // What hides the box hides its middle from that of the region.
        crossed_.clear();
        spent_ += of_.search.crossed(region_.center(), box.center(), kMostTried, crossed_);
        for (const Crossed& one : crossed_) {
            std::optional<ReadyCover> ready = covers_.find(one.hider, box);
            if (!ready) continue;
            use(ready->cover);
            if (pool_.size() == kPool) pool_.pop_back();
            pool_.insert(pool_.begin(), std::move(*ready));
            return true;
        }
        return false;
    }

    void use(const HiderCover& cover) {
        for (const CoverMember& member : cover) {
            const auto at = std::lower_bound(used_.begin(), used_.end(), member.hider);
            if (at == used_.end() || *at != member.hider) used_.insert(at, member.hider);
        }
    }

    const Hiding& of_;
    const Box3d region_;
    RegionCovers covers_;
    RegionRow row_;
    uint64_t spent_ = 0;
    std::vector<ReadyCover> pool_;
    std::vector<Crossed> crossed_;
    std::vector<uint32_t> used_;
};

/// A row that was found, and the hiders that it rests on.
struct FoundRow {
    RegionRow row;
    std::vector<uint32_t> used;
};

/// @param from  the row of a region that holds this one
Array<char> bytesOf(const FoundRow& found, const Bits& from) {
    Array<char> bytes;
    ByteWriter out(bytes);
    out.put(static_cast<uint8_t>(found.row.over_budget));
    out.put(static_cast<uint32_t>(found.row.covers.size()));
    for (const HiderCover& cover : found.row.covers) {
        out.put(static_cast<uint32_t>(cover.size()));
        for (const CoverMember& member : cover) {
            out.put(member.hider);
            out.put(member.shared);
        }
    }
    out.put(static_cast<uint32_t>(found.used.size()));
    for (const uint32_t hider : found.used) out.put(hider);
    Bits hidden = from;
    for (size_t word = 0; word < hidden.size(); ++word) hidden[word] &= ~found.row.visible[word];
    putBits(out, hidden);
    return bytes;
}

std::optional<FoundRow> foundRowOf(std::span<const char> bytes, const Bits& from, size_t hiders) {
    ByteCursor in(bytes);
    FoundRow out;
    const auto takeCount = [&](size_t each) { return std::min<uint64_t>(in.take<uint32_t>(), in.left() / each); };
    out.row.over_budget = in.take<uint8_t>() != 0;
    out.row.covers.resize(takeCount(4));
    bool good = true;
    for (HiderCover& cover : out.row.covers) {
        cover.resize(takeCount(8));
        for (CoverMember& member : cover) {
            member.hider = in.take<uint32_t>();
            member.shared = in.take<uint32_t>();
            good &= member.hider < hiders;
        }
        good &= !cover.empty() && cover.size() <= HiderCovers::kMostMembers;
    }
    out.used.resize(takeCount(4));
    for (uint32_t& hider : out.used) {
        hider = in.take<uint32_t>();
        good &= hider < hiders;
    }
    Bits hidden(from.size(), 0);
    if (!good || !takeBits(in, hidden, 0) || in.left() > 0) return std::nullopt;
    out.row.visible = from;
    for (size_t word = 0; word < hidden.size(); ++word) out.row.visible[word] &= ~hidden[word];
    return out;
}

/// A wall along an axis that cells may be halved at.
struct AxisWall {
    int axis = 0;
    double at = 0;  // where a cell that the wall hides from may end
    Box3d bounds;
};

struct Halving {
    int axis = 0;
    double at = 0;
};

/// A leaf of the tree as it grows.
struct Cell {
    Box3d region;
    uint32_t node = 0;  // above it
    uint32_t side = 0;  // 0: behind the node's plane
    RegionRow row;
    std::vector<uint32_t> walls;  // of AxisWall, that meet the region
    uint64_t seen = 0;            // objects of the row
    uint64_t eyes = 0;            // ViewCellSettings::eyes within
    double gain = 1;              // the share of what was seen that halvings took away lately
    bool done = false;            // it is not halved
};

class Division {
public:
    /// @param question  all that rows depend on besides a cell and its row
    Division(const Hiding& hiding, const ViewCellSettings& settings, double smallest, uint64_t question)
        : hiding_(hiding),
          settings_(settings),
          smallest_(smallest),
          margin_(kMargin * hiding.bend),
          question_(question) {
        constexpr double kAlong = 1 - 1e-12;
        for (const FlatHider& hider : hiding.covers.hiders())
            for (int axis = 0; axis < 3; ++axis) {
                const double normal = hider.plane[axis];
                if (std::abs(normal) < kAlong) continue;
                const double at = 0.5 * (hider.bounds.min[axis] + hider.bounds.max[axis]);
                walls_.push_back({axis, at + std::copysign(margin_, normal), hider.bounds});
            }
    }

    void run(const Box3d& bounds, ViewCells& out, const std::vector<uint32_t>& object_of_item) {
        begin(bounds);
        std::priority_queue<std::pair<double, uint32_t>> queue;  // the first number wins where worth is the same
        const auto wait = [&](uint32_t cell) {
            if (!cells_[cell].done) queue.emplace(worthOf(cells_[cell]), ~cell);
        };
        wait(0);
        const auto stops = [&] { return settings_.stop && settings_.stop(); };
        while (!queue.empty() && cells_.size() + 1 < settings_.most_cells && !stops()) {
            std::vector<uint32_t> batch;
            while (!queue.empty() && batch.size() < kBatch && cells_.size() + batch.size() + 1 < settings_.most_cells) {
                batch.push_back(~queue.top().second);
                queue.pop();
            }
            const auto before = static_cast<uint32_t>(cells_.size());
            for (const uint32_t cell : batch) halve(cell);
            std::vector<uint32_t> fresh = batch;
            for (uint32_t cell = before; cell < cells_.size(); ++cell) fresh.push_back(cell);
            findRows(fresh);
            for (const uint32_t cell : fresh) wait(cell);
            if (settings_.journal) settings_.journal->keep(stops());
            if (settings_.progress) settings_.progress(cells_.size(), settings_.most_cells);
        }
        finish(out, object_of_item);
    }

private:
    /// Of holes, how far before a wall a cell ends. A flow through portals takes an eye that is as near to a plane as its slack,
    /// seven holes, for one on both sides of it: so a cell that came as near to a wall would see what is behind.
    static constexpr double kMargin = 16;
    static constexpr size_t kBatch = 16;           // cells that are halved before rows are found
    static constexpr double kLeastGain = 1. / 16;  // that every halving may have

    /// Cuts off what is outside, leaf 0, and makes the first cell of the rest.
    void begin(const Box3d& bounds) {
        tree_.bounds = bounds;
        for (int axis = 0; axis < 3; ++axis)
            for (const bool upper : {false, true}) {
                LeafTreeNode node;
                node.plane[axis] = upper ? -1 : 1;
                node.plane.w = upper ? bounds.max[axis] : -bounds.min[axis];
                node.child[0] = LeafTreeNode::kLeaf;
                node.child[1] = static_cast<uint32_t>(tree_.nodes.size()) + 1;
                tree_.nodes.push_back(node);
            }
        Cell root;
        root.region = bounds;
        root.node = static_cast<uint32_t>(tree_.nodes.size()) - 1;
        root.side = 1;
        const auto objects = static_cast<uint32_t>(hiding_.objects.order.size());
        root.row.visible.assign((objects + 63) / 64, 0);
        for (uint32_t place = 0; place < objects; ++place) root.row.visible[place / 64] |= uint64_t{1} << place % 64;
        for (uint32_t wall = 0; wall < walls_.size(); ++wall) root.walls.push_back(wall);
        root.seen = objects;
        root.eyes = eyesIn(bounds);
        whole_ = longestOf(bounds);
        cells_.push_back(std::move(root));
    }

    static double longestOf(const Box3d& box) {
        const glm::dvec3 size = box.size();
        return std::max({size.x, size.y, size.z});
    }
    /// Where much is seen from much room, or from where many eyes are, and where halving has helped before.
    double worthOf(const Cell& cell) const {
        constexpr double kElsewhere = 0.01;  // what room counts beside eyes
        const glm::dvec3 part = cell.region.size() / tree_.bounds.size();
        double share = part.x * part.y * part.z;
        if (!settings_.eyes.empty())
            share = kElsewhere * share + static_cast<double>(cell.eyes) / static_cast<double>(settings_.eyes.size());
        return (cell.gain + kLeastGain) * static_cast<double>(cell.seen) * std::cbrt(share);
    }
    uint64_t eyesIn(const Box3d& region) const {
        return static_cast<uint64_t>(
            std::count_if(settings_.eyes.begin(), settings_.eyes.end(), [&](const glm::dvec3& eye) {
                return glm::all(glm::greaterThanEqual(eye, region.min)) && glm::all(glm::lessThan(eye, region.max));
            }));
    }

    Halving halvingOf(const Cell& cell) const {
        const glm::dvec3 size = cell.region.size();
        Halving best;
        double most = 0.25;  // of the cell's section
        std::vector<uint32_t> order;
        for (const uint32_t wall : cell.walls) {
            const AxisWall& at = walls_[wall];
            if (at.at > cell.region.min[at.axis] + hiding_.bend && at.at < cell.region.max[at.axis] - hiding_.bend)
                order.push_back(wall);
        }
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return std::pair(walls_[a].axis, walls_[a].at) < std::pair(walls_[b].axis, walls_[b].at);
        });
        double area = 0;
        for (size_t i = 0; i < order.size(); ++i) {
            const AxisWall& wall = walls_[order[i]];
            if (i > 0 && (walls_[order[i - 1]].axis != wall.axis || wall.at - walls_[order[i - 1]].at > hiding_.bend))
                area = 0;
            double shared = 1;
            for (int axis = 0; axis < 3; ++axis)
                if (axis != wall.axis)
                    shared *= std::max(0.0, std::min(wall.bounds.max[axis], cell.region.max[axis]) -
                                                std::max(wall.bounds.min[axis], cell.region.min[axis])) /
                              size[axis];
            area += shared;
            if (area > most) {
                most = area;
                best = {wall.axis, wall.at};
            }
        }
        if (most > 0.25) return best;
        for (int axis = 1; axis < 3; ++axis)
            if (size[axis] > size[best.axis]) best.axis = axis;
        best.at = cell.region.center()[best.axis];
        return best;
    }

    /// Makes two cells of one: the part behind keeps its number.
    void halve(uint32_t number) {
        const Halving at = halvingOf(cells_[number]);
        LeafTreeNode node;
        node.plane[at.axis] = 1;
        node.plane.w = -at.at;
        const auto index = static_cast<uint32_t>(tree_.nodes.size());
        tree_.nodes.push_back(node);
        Cell& behind = cells_[number];
        tree_.nodes[behind.node].child[behind.side] = index;
        Cell front = behind;
        behind.node = front.node = index;
        behind.side = 0;
        front.side = 1;
        behind.region.max[at.axis] = front.region.min[at.axis] = at.at;
        for (Cell* half : {&behind, &front}) {
            std::erase_if(half->walls, [&](uint32_t wall) { return !meet(walls_[wall].bounds, half->region); });
            half->eyes = eyesIn(half->region);
            const glm::dvec3 size = half->region.size();
            half->done = longestOf(half->region) < 2 * smallest_ || std::min({size.x, size.y, size.z}) < 4 * margin_;
        }
        cells_.push_back(std::move(front));
    }

    void findRows(std::span<const uint32_t> numbers) {
        struct Task {
            std::vector<uint32_t> used;
            uint64_t question = 0;
            Array<char> answer;  // that the journal does not have; or empty
        };
        std::vector<Task> tasks(numbers.size());
        runJobs(settings_.jobs, static_cast<uint32_t>(numbers.size()), [&](uint32_t i) {
            Cell& cell = cells_[numbers[i]];
            const glm::dvec3 size = cell.region.size();
            // From so much room hardly anything is hidden; in a seam between two cells no eye stands for long.
            constexpr double kMuch = 1. / 4;
            if (longestOf(cell.region) > kMuch * whole_ || std::min({size.x, size.y, size.z}) < 4 * margin_) return;
            FoundRow found = findRow(cell, tasks[i].question, tasks[i].answer);
            cell.row = std::move(found.row);
            tasks[i].used = std::move(found.used);
            const uint64_t before = std::exchange(cell.seen, countOf(cell.row.visible));
            const double taken = before ? 1 - static_cast<double>(cell.seen) / static_cast<double>(before) : 0;
            cell.gain = 0.5 * (cell.gain + taken);
        });
        for (const Task& task : tasks) {
            used_.insert(used_.end(), task.used.begin(), task.used.end());
            if (!task.answer.empty()) settings_.journal->add(task.question, task.answer);
        }
        std::sort(used_.begin(), used_.end());
        used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
    }

    /// By the journal, or by search; `answer` then receives what the journal is to hold, if there is one.
    FoundRow findRow(const Cell& cell, uint64_t& question, Array<char>& answer) const {
        const Bits& from = cell.row.visible;
        if (settings_.journal) {
            const glm::dvec3 &low = cell.region.min, &high = cell.region.max;
            question = askedWith(question_, {{low.x, low.y, low.z, high.x, high.y, high.z}});
            if (const auto known = settings_.journal->find(question))
                if (std::optional<FoundRow> found = foundRowOf(*known, from, hiding_.covers.hiders().size()))
                    return std::move(*found);
        }
        RowFinder finder(hiding_, cell.region);
        FoundRow found;
        found.row = finder.find(cell.row);
        found.used = finder.used();
        if (settings_.journal) answer = bytesOf(found, from);
        return found;
    }

    void finish(ViewCells& out, const std::vector<uint32_t>& object_of_item) {
        for (size_t i = 0; i < cells_.size(); ++i)
            tree_.nodes[cells_[i].node].child[cells_[i].side] = LeafTreeNode::kLeaf | static_cast<uint32_t>(i + 1);
        tree_.contents.assign(cells_.size() + 1, LeafContents::kEmpty);
        out.tree = std::move(tree_);
        BitMatrix rows(cells_.size() + 1, out.visible.columns());
        std::vector<bool> is_item(rows.columns(), false);
        for (const uint32_t object : object_of_item) is_item[object] = true;
        for (size_t row = 0; row < rows.rows(); ++row)
            for (size_t object = 0; object < rows.columns(); ++object)
                if (row == 0 || !is_item[object]) rows.set(row, object);
        double seen = 0;
        for (const Cell& cell : cells_) seen += static_cast<double>(cell.seen);
        const double pairs = static_cast<double>(cells_.size()) * static_cast<double>(hiding_.objects.order.size());
        out.hidden = 1 - seen / pairs;
        for (size_t i = 0; i < cells_.size(); ++i) {
            out.over_budget += cells_[i].row.over_budget;
            for (uint32_t place = 0; place < hiding_.objects.order.size(); ++place)
                if (cells_[i].row.visible[place / 64] >> place % 64 & 1)
                    rows.set(i + 1, object_of_item[hiding_.objects.order[place]]);
        }
        out.visible = std::move(rows);
        out.used = used_.size();
        for (const uint32_t hider : used_)
            out.walls.insert(out.walls.end(), hiding_.covers.hiders()[hider].objects.begin(),
                             hiding_.covers.hiders()[hider].objects.end());
        std::sort(out.walls.begin(), out.walls.end());
        out.walls.erase(std::unique(out.walls.begin(), out.walls.end()), out.walls.end());
    }

    const Hiding& hiding_;
    const ViewCellSettings& settings_;
    const double smallest_, margin_;
    const uint64_t question_;
    double whole_ = 0;
    std::vector<AxisWall> walls_;
    LeafTree tree_;
    std::vector<Cell> cells_;
    std::vector<uint32_t> used_;
};

}  // namespace

ViewCells viewCellsOf(const Scene& scene, const ViewCellSettings& settings) {
    ViewCells out;
    const std::optional<SoupScale> scale = soupScaleOf(scene);
    if (!scale) return out;
    const double finest = scale->diagonal / 512;
    out.smallest_occluder = settings.smallest_occluder >= 0 ? settings.smallest_occluder : finest;
    out.smallest_cell = settings.smallest_cell >= 0 ? settings.smallest_cell : finest;
    FlatHiderSettings flat;
    std::vector<WallTriangle> triangles = opaqueTriangles(scene, *scale, settings.smallest_hole, settings.movable);
    const double bend = largestHole(triangles);
    flat.least_area = std::max(out.smallest_occluder * out.smallest_occluder, bend * bend);
    flat.jobs = settings.jobs;
    const SoupWalls walls = sheetsOf(std::move(triangles), flat.least_area);
    const std::vector<FlatHider> hiders = flatHiders(walls, flat);
    out.hiders = hiders.size();
    if (hiders.empty()) return out;

    std::vector<Box3d> boxes;
    std::vector<uint32_t> object_of_item;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Box3d box = transformBox(scene.meshes[scene.objects[i].mesh].bounds, scene.objects[i].transform);
        if (box.empty() || !box.finite()) continue;
        boxes.push_back(box);
        object_of_item.push_back(i);
    }
    const Bvh objects = buildBvh(boxes);
    const HiderTree search(hiders);
    Box3d bounds = scale->core.bounds;
    const glm::dvec3 beyond(scale->diagonal / 16);
    bounds.min -= beyond;
    bounds.max += beyond;
    const glm::dvec3 far = glm::max(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)),
                                    glm::max(glm::abs(scale->bounds.min), glm::abs(scale->bounds.max)));
    const double reach = 2 * std::max({far.x, far.y, far.z, scale->diagonal});
    const HiderCovers covers(hiders, search, settings.jobs);
    const Hiding hiding{covers, search, objects, bend, reach, settings.budget};
    out.visible = BitMatrix(0, scene.objects.size());
    uint64_t question = 0;
    if (settings.journal) {
        const double numbers[] = {settings.smallest_hole, flat.least_area, static_cast<double>(settings.budget)};
        question = askedWith(mixSeed(kRowsVersion, hashOf(scene)), numbers);
        for (const uint32_t object : settings.movable) question = mixSeed(question, object);
    }
    Division(hiding, settings, out.smallest_cell, question).run(bounds, out, object_of_item);
    if (out.hidden >= settings.least_hidden) return out;
    out.tree = {};
    out.visible = {};
    out.walls.clear();
    return out;
}

}  // namespace sightline::bake
