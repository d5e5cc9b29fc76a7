// The large flat parts of a scene's opaque surfaces, as convex polygons that hide what is behind them.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/flat_hiders.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sightline/bake/soup/flat_sheet.h"

namespace sightline::bake {
namespace {

constexpr size_t kMostCorners = 12;      // of a hull that hides
constexpr size_t kMostOfHull = 4096;     // triangles; of more, the hull is not tried
constexpr size_t kMostLines = 48;        // of a part, along each direction
constexpr double kLeastShare = 1. / 32;  // of its part that a further rectangle must add

/// The triangles of a sheet's side that hang together, in a frame along their longest edge.
struct SidePart {
    std::vector<const SheetTriangle*> triangles;
    std::vector<FlatPiece> pieces;  // turned
    std::vector<FlatPiece> exact;   // turned, not grown
    double area = 0;
};

class Grid {
public:
    Grid(const SidePart& part, double step) {
        lines(part, 0, step);
        lines(part, 1, step);
        const size_t columns = lines_[0].size(), rows = lines_[1].size();
        if (columns < 2 || rows < 2) return;
        covered_.assign((columns - 1) * (rows - 1), 0);
        for (size_t y = 0; y + 1 < rows; ++y)
            for (size_t x = 0; x + 1 < columns; ++x) covered_[at(x, y)] = isCovered(part, rectOf(x, y, x + 1, y + 1));
        unused_ = covered_;
    }

    /// The rectangle of covered cells with the most area that no other has yet, and marks it; empty if that is too
    /// little.
    FlatPiece takeLargest(double least) {
        double best = 0;
        size_t from[2] = {}, to[2] = {};
        const size_t columns = lines_[0].size(), rows = lines_[1].size();
        for (size_t low = 0; low + 1 < rows; ++low) {
            std::vector<uint8_t> open(columns, 1);
            std::vector<double> fresh(columns, 0);
            for (size_t high = low + 1; high < rows; ++high) {
                double run = 0, whole = 0;
                size_t begin = 0;
                for (size_t x = 0; x + 1 < columns; ++x) {
                    const size_t cell = at(x, high - 1);
                    open[x] = open[x] && covered_[cell];
                    const double area = (lines_[0][x + 1] - lines_[0][x]) * (lines_[1][high] - lines_[1][high - 1]);
                    if (unused_[cell]) fresh[x] += area;
                    if (!open[x]) {
                        run = whole = 0;
                        begin = x + 1;
                        continue;
                    }
                    run += fresh[x];
                    whole += (lines_[0][x + 1] - lines_[0][x]) * (lines_[1][high] - lines_[1][low]);
                    // Where as much is new, the larger one hides more.
                    if (const double worth = run + whole / 1024; run >= least && worth > best) {
                        best = worth;
                        from[0] = begin;
                        from[1] = low;
                        to[0] = x + 1;
                        to[1] = high;
                    }
                }
            }
        }
        if (!(best > 0)) return {};
        for (size_t y = from[1]; y < to[1]; ++y)
            for (size_t x = from[0]; x < to[0]; ++x) unused_[at(x, y)] = 0;
        return rectOf(from[0], from[1], to[0], to[1]);
    }

private:
    size_t at(size_t x, size_t y) const { return y * (lines_[0].size() - 1) + x; }
    FlatPiece rectOf(size_t x0, size_t y0, size_t x1, size_t y1) const {
        const double left = lines_[0][x0], right = lines_[0][x1], low = lines_[1][y0], high = lines_[1][y1];
        return {{left, low}, {right, low}, {right, high}, {left, high}};
    }

    /// The coordinates of the corners, each with the length of the edges along it; of too many those with the most.
    void lines(const SidePart& part, int axis, double step) {
        struct Line {
            double at, length;
        };
        std::vector<Line> all;
        for (const FlatPiece& piece : part.exact)
            for (size_t i = 0; i < piece.size(); ++i) {
                const glm::dvec2 &a = piece[i], &b = piece[(i + 1) % piece.size()];
                const bool along = std::abs(b[axis] - a[axis]) <= step;
                all.push_back({a[axis], along ? glm::length(b - a) : 0});
            }
        std::stable_sort(all.begin(), all.end(), [](const Line& a, const Line& b) { return a.at < b.at; });
        std::vector<Line> joined;
        for (const Line& line : all)
            if (!joined.empty() && line.at - joined.back().at <= step) joined.back().length += line.length;
            else joined.push_back(line);
        if (joined.size() > kMostLines) {
            std::vector<double> lengths;
            joined.front().length = joined.back().length = HUGE_VAL;
            for (const Line& line : joined) lengths.push_back(line.length);
            std::nth_element(lengths.begin(), lengths.begin() + kMostLines - 1, lengths.end(), std::greater<>());
            const double least = lengths[kMostLines - 1];
            std::erase_if(joined, [&](const Line& line) { return line.length < least; });
            if (joined.size() > 2 * kMostLines) joined.erase(joined.begin() + kMostLines, joined.end() - 1);
        }
        for (const Line& line : joined) lines_[axis].push_back(line.at);
    }

    static bool isCovered(const SidePart& part, const FlatPiece& cell) {
        FlatRest rest(cell);
        for (size_t i = 0; i < part.pieces.size(); ++i) {
            const FlatPiece& piece = part.pieces[i];
            glm::dvec2 min = piece[0], max = piece[0];
            for (const glm::dvec2& point : piece) {
                min = glm::min(min, point);
                max = glm::max(max, point);
            }
            if (max.x <= cell[0].x || min.x >= cell[1].x || max.y <= cell[0].y || min.y >= cell[2].y) continue;
            rest.take(piece);
            if (rest.empty()) return true;
        }
        return false;
    }

    std::vector<double> lines_[2];
    std::vector<uint8_t> covered_, unused_;
};

/// The parts of one side: what touches hangs together.
std::vector<std::vector<const SheetTriangle*>> partsOf(const FlatSheet& sheet, uint8_t side) {
    std::vector<const SheetTriangle*> of_side;
    for (const SheetTriangle& triangle : sheet.triangles())
        if ((triangle.sides & side) != 0) of_side.push_back(&triangle);
    std::vector<uint32_t> root(of_side.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    std::vector<uint32_t> open;  // those that reach as far right as the one that is looked at
    for (uint32_t i = 0; i < of_side.size(); ++i) {
        std::erase_if(open, [&](uint32_t other) { return of_side[other]->max.x < of_side[i]->min.x; });
        for (const uint32_t other : open) {
            if (of_side[other]->max.y < of_side[i]->min.y || of_side[other]->min.y > of_side[i]->max.y) continue;
            const uint32_t a = find(other), b = find(i);
            if (a == b || sharedBy(of_side[other]->piece, of_side[i]->piece).empty()) continue;
            root[std::max(a, b)] = std::min(a, b);
        }
        open.push_back(i);
    }
    std::vector<std::vector<const SheetTriangle*>> parts;
    std::vector<uint32_t> number(of_side.size(), ~0u);
    for (uint32_t i = 0; i < of_side.size(); ++i) {
        uint32_t& part = number[find(i)];
        if (part == ~0u) {
            part = static_cast<uint32_t>(parts.size());
            parts.emplace_back();
        }
        parts[part].push_back(of_side[i]);
    }
    return parts;
}

/// Finds the hiders of one sheet.
class SheetHiders {
public:
    SheetHiders(const SoupWalls& walls, const WallSheet& sheet, const FlatHiderSettings& settings)
        : walls_(walls), plane_(sheet.plane), bend_(sheet.rounding), settings_(settings), sheet_(walls, sheet) {}

    std::vector<FlatHider> find() {
        const auto two_sided = [](const SheetTriangle& triangle) { return triangle.sides == 3; };
        const bool alike = std::all_of(sheet_.triangles().begin(), sheet_.triangles().end(), two_sided);
        for (const uint8_t side : {1, 2}) {
            if (alike && side == 2) break;
            for (const auto& part : partsOf(sheet_, side)) addPart(part, side);
        }
        if (alike)
            for (size_t i = 0, count = found_.size(); i < count; ++i) {
                FlatHider behind = found_[i];
                behind.plane = -behind.plane;
                std::reverse(behind.corners.begin(), behind.corners.end());
                found_.push_back(std::move(behind));
            }
        return std::move(found_);
    }

private:
    glm::dvec2 turned(const glm::dvec2& p) const { return {glm::dot(along_, p), along_.x * p.y - along_.y * p.x}; }
    glm::dvec2 back(const glm::dvec2& p) const { return p.x * along_ + p.y * glm::dvec2(-along_.y, along_.x); }

    void addPart(const std::vector<const SheetTriangle*>& triangles, uint8_t side) {
        SidePart part;
        part.triangles = triangles;
        double longest = 0;
        for (const SheetTriangle* triangle : triangles) {
            FlatPiece piece = sheet_.frame().to(walls_.triangles[triangle->triangle].corners);
            if (areaOf(piece) < 0) std::swap(piece[1], piece[2]);
            part.area += areaOf(piece);
            for (size_t i = 0; i < 3; ++i) {
                const glm::dvec2 edge = piece[(i + 1) % 3] - piece[i];
                if (const double length = glm::length(edge); length > longest) {
                    longest = length;
                    along_ = edge / length;
                }
            }
            part.exact.push_back(std::move(piece));
        }
        if (part.area < settings_.least_area) return;
        if (addHull(part, side)) return;
        // The longest edge of a quad of two triangles is its diagonal: so many edges that are parallel are better.
        along_ = mostEdges(part);
        for (size_t i = 0; i < triangles.size(); ++i) {
            FlatPiece piece;
            for (const glm::dvec2& point : triangles[i]->piece) piece.push_back(turned(point));
            part.pieces.push_back(std::move(piece));
            for (glm::dvec2& point : part.exact[i]) point = turned(point);
        }
        Grid grid(part, finestOf(part) / 3);
        for (uint32_t i = 0; i < settings_.most_of_part; ++i) {
            FlatPiece rect = grid.takeLargest(std::max(settings_.least_area, kLeastShare * part.area));
            if (rect.empty()) break;
            for (glm::dvec2& point : rect) point = back(point);
            add(part, rect, side);
        }
    }

    bool addHull(const SidePart& part, uint8_t side) {
        if (part.triangles.size() > kMostOfHull) return false;
        std::vector<glm::dvec2> points;
        for (const FlatPiece& piece : part.exact) points.insert(points.end(), piece.begin(), piece.end());
        FlatPiece hull = withoutStraight(hullOf(std::move(points)), finestOf(part));
        if (hull.size() < 3 || hull.size() > kMostCorners) return false;
        FlatRest rest(hull);
        for (const SheetTriangle* triangle : part.triangles) {
            rest.take(triangle->piece);
            if (rest.empty()) break;
        }
        if (!rest.empty()) return false;
        add(part, hull, side);
        return true;
    }

    static double finestOf(const SidePart& part) {
        double least = HUGE_VAL;
        for (const SheetTriangle* triangle : part.triangles) least = std::min(least, triangle->rounding);
        return least;
    }

    /// Leaves out corners that lie on the line of their neighbours.
    static FlatPiece withoutStraight(const FlatPiece& hull, double rounding) {
        FlatPiece out;
        for (size_t i = 0; i < hull.size(); ++i) {
            const glm::dvec2 before = out.empty() ? hull.back() : out.back();
            const glm::dvec2 chord = hull[(i + 1) % hull.size()] - before, to = hull[i] - before;
            const double length = glm::length(chord);
            if (length > 0 && std::abs(chord.x * to.y - chord.y * to.x) <= rounding / 8 * length) continue;
            out.push_back(hull[i]);
        }
        return out;
    }

    /// The direction, or the one across, of the most length of edges.
    static glm::dvec2 mostEdges(const SidePart& part) {
        constexpr int kSteps = 256;  // of a quarter turn
        std::vector<double> lengths(kSteps, 0);
        std::vector<std::pair<double, glm::dvec2>> longest(kSteps);
        for (const FlatPiece& piece : part.exact)
            for (size_t i = 0; i < piece.size(); ++i) {
                const glm::dvec2 edge = piece[(i + 1) % piece.size()] - piece[i];
                const double length = glm::length(edge);
                if (!(length > 0)) continue;
                const double quarter = std::atan2(edge.y, edge.x) / 1.5707963267948966;
                const int step = static_cast<int>(std::lround((quarter - std::floor(quarter)) * kSteps)) % kSteps;
                const auto slot = static_cast<size_t>(step);
                lengths[slot] += length;
                if (length > longest[slot].first) longest[slot] = {length, edge / length};
            }
        const auto best = std::max_element(lengths.begin(), lengths.end()) - lengths.begin();
        return longest[static_cast<size_t>(best)].second;
    }

    void add(const SidePart& part, const FlatPiece& shape, uint8_t side) {
        FlatHider hider;
        hider.area = areaOf(shape);
        if (!(hider.area >= settings_.least_area)) return;
        hider.plane = side == 1 ? plane_ : -plane_;
        hider.bend = bend_;
        hider.corners = sheet_.frame().from(shape);
        if (side == 2) std::reverse(hider.corners.begin(), hider.corners.end());
        for (const glm::dvec3& corner : hider.corners) hider.bounds.grow(corner);
        hider.hole = finestOf(part);
        for (const SheetTriangle* triangle : part.triangles)
            if (!sharedBy(triangle->piece, shape).empty())
                hider.objects.push_back(walls_.triangles[triangle->triangle].object);
        std::sort(hider.objects.begin(), hider.objects.end());
        hider.objects.erase(std::unique(hider.objects.begin(), hider.objects.end()), hider.objects.end());
        found_.push_back(std::move(hider));
    }

    const SoupWalls& walls_;
    const glm::dvec4 plane_;
    const double bend_;
    const FlatHiderSettings& settings_;
    FlatSheet sheet_;
    glm::dvec2 along_{1, 0};
    std::vector<FlatHider> found_;
};

}  // namespace

std::vector<FlatHider> flatHiders(const SoupWalls& walls, const FlatHiderSettings& settings) {
    constexpr uint32_t kTask = 16;  // sheets
    std::vector<std::vector<FlatHider>> found(walls.sheets.size());
    const auto tasks = static_cast<uint32_t>((found.size() + kTask - 1) / kTask);
    runJobs(settings.jobs, tasks, [&](uint32_t task) {
        for (size_t i = size_t{task} * kTask; i < std::min(size_t{task + 1} * kTask, found.size()); ++i)
            found[i] = SheetHiders(walls, walls.sheets[i], settings).find();
    });
    std::vector<FlatHider> out;
    for (std::vector<FlatHider>& of_sheet : found)
        for (FlatHider& hider : of_sheet) out.push_back(std::move(hider));
    return out;
}

}  // namespace sightline::bake
