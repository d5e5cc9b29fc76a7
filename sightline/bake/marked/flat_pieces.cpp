// Clips, grows and merges convex pieces of a plane.
// SPDX-License-Identifier: MIT
#include "sightline/bake/marked/flat_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sightline::bake {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double heightOf(const glm::dvec3& line, const glm::dvec2& point) {
    return line.x * point.x + line.y * point.y + line.z;
}

/// The line through an edge, its normal to the left: inward.
bool lineThrough(const glm::dvec2& a, const glm::dvec2& b, glm::dvec3& line) {
    const glm::dvec2 along = b - a;
    const double length = glm::length(along);
    if (!(length > 0)) return false;
    const glm::dvec2 normal(-along.y / length, along.x / length);
    line = glm::dvec3(normal, -glm::dot(normal, a));
    return true;
}

struct FlatBox {
    glm::dvec2 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
};

FlatBox boxOf(const FlatPiece& piece) {
    FlatBox box;
    for (const glm::dvec2& point : piece) {
        box.min = glm::min(box.min, point);
        box.max = glm::max(box.max, point);
    }
    return box;
}

bool apart(const FlatBox& a, const FlatBox& b, double by) {
    return a.max.x + by < b.min.x || b.max.x + by < a.min.x || a.max.y + by < b.min.y || b.max.y + by < a.min.y;
}

/// Whether some edge of a has all of b farther than `by` behind it.
bool separated(const FlatPiece& a, const FlatPiece& b, double by) {
    for (size_t i = 0; i < a.size(); ++i) {
        glm::dvec3 line;
        if (!lineThrough(a[i], a[(i + 1) % a.size()], line)) continue;
        double highest = -std::numeric_limits<double>::infinity();
        for (const glm::dvec2& point : b) highest = std::max(highest, heightOf(line, point));
        if (highest < -by) return true;
    }
    return false;
}

FlatPiece hullOfBoth(const FlatPiece& a, const FlatPiece& b) {
    std::vector<glm::dvec2> points(a);
    points.insert(points.end(), b.begin(), b.end());
    return hullOf(std::move(points));
}

double areaOfAll(const std::vector<FlatPiece>& pieces) {
    double sum = 0;
    for (const FlatPiece& piece : pieces) sum += areaOf(piece);
    return sum;
}

FlatPiece hullOfAll(const std::vector<FlatPiece>& pieces) {
    std::vector<glm::dvec2> points;
    for (const FlatPiece& piece : pieces) points.insert(points.end(), piece.begin(), piece.end());
    return hullOf(std::move(points));
}

/// Joins two pieces into their hull where the hull holds nothing else.
void joinPairs(std::vector<FlatPiece>& pieces, double touching) {
    constexpr size_t kFew = 64;  // the search is cubic
    if (pieces.size() > kFew) return;
    for (bool again = true; again;) {
        again = false;
        for (size_t i = 0; i < pieces.size() && !again; ++i)
            for (size_t k = i + 1; k < pieces.size() && !again; ++k) {
                FlatPiece hull = hullOfBoth(pieces[i], pieces[k]);
                const double both = areaOf(pieces[i]) + areaOf(pieces[k]);
                const FlatBox box = boxOf(hull);
                const double room = 1e-9 * both + touching * 1e-3 * glm::length(box.max - box.min);
                if (areaOf(hull) > both + room) continue;
                pieces[i] = std::move(hull);
                pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
                again = true;
            }
    }
}

/// Numbers the groups of pieces that touch.
std::vector<uint32_t> groupsOf(const std::vector<FlatPiece>& pieces, double touching) {
    std::vector<uint32_t> group(pieces.size());
    std::iota(group.begin(), group.end(), 0u);
    const auto rootOf = [&](uint32_t i) {
        while (group[i] != i) i = group[i] = group[group[i]];
        return i;
    };
    std::vector<FlatBox> boxes;
    for (const FlatPiece& piece : pieces) boxes.push_back(boxOf(piece));
    for (uint32_t i = 0; i < pieces.size(); ++i)
        for (uint32_t k = 0; k < i; ++k) {
            if (apart(boxes[i], boxes[k], touching) || rootOf(i) == rootOf(k)) continue;
            if (separated(pieces[i], pieces[k], touching) || separated(pieces[k], pieces[i], touching)) continue;
            group[std::max(rootOf(i), rootOf(k))] = std::min(rootOf(i), rootOf(k));
        }
    for (uint32_t i = 0; i < pieces.size(); ++i) group[i] = rootOf(i);
    return group;
}

}  // namespace

FlatPiece clipPiece(const FlatPiece& piece, const glm::dvec3& line) {
    FlatPiece kept;
    for (size_t i = 0; i < piece.size(); ++i) {
        const glm::dvec2 &a = piece[i], &b = piece[(i + 1) % piece.size()];
        const double at_a = heightOf(line, a), at_b = heightOf(line, b);
        if (at_a >= 0) kept.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) kept.push_back(a + (at_a / (at_a - at_b)) * (b - a));
    }
    if (kept.size() < 3) kept.clear();
    return kept;
}

double areaOf(const FlatPiece& piece) {
    double sum = 0;
    for (size_t i = 1; i + 1 < piece.size(); ++i) sum += cross(piece[i] - piece[0], piece[i + 1] - piece[0]);
    return sum / 2;
}

FlatPiece sharedBy(const FlatPiece& a, const FlatPiece& b) {
    FlatPiece shared = a;
    for (size_t i = 0; i < b.size() && !shared.empty(); ++i) {
        glm::dvec3 line;
        if (lineThrough(b[i], b[(i + 1) % b.size()], line)) shared = clipPiece(shared, line);
    }
    return shared;
}

FlatPiece grownBy(const FlatPiece& piece, double by) {
    // The octagon around each corner: its sides are `by` away, its corners less than 1.09 of it.
    constexpr double kTurn = 0.41421356237309515;  // tan(pi / 8)
    std::vector<glm::dvec2> points;
    for (const glm::dvec2& corner : piece)
        for (const double one : {-1.0, 1.0})
            for (const double part : {-kTurn, kTurn}) {
                points.push_back(corner + by * glm::dvec2(one, part));
                points.push_back(corner + by * glm::dvec2(part, one));
            }
    return hullOf(std::move(points));
}

FlatPiece shrunkBy(const FlatPiece& piece, double by) {
    FlatPiece inner = piece;
    for (size_t i = 0; i < piece.size() && !inner.empty(); ++i) {
        const glm::dvec2 along = piece[(i + 1) % piece.size()] - piece[i];
        const double length = glm::length(along);
        if (!(length > 0)) continue;
        const glm::dvec2 normal(-along.y / length, along.x / length);
        inner = clipPiece(inner, {normal, -glm::dot(normal, piece[i]) - by});
    }
    return inner;
}

void FlatRest::take(const FlatPiece& taken) {
    if (taken.size() < 3 || pieces_.size() > kMost) return;
    const FlatBox box = boxOf(taken);
    next_.clear();
    for (FlatPiece& piece : pieces_) {
        if (apart(boxOf(piece), box, 0)) {
            next_.push_back(std::move(piece));
            continue;
        }
        const size_t before = next_.size();
        FlatPiece rest = piece;
        for (size_t i = 0; i < taken.size() && !rest.empty(); ++i) {
            glm::dvec3 line;
            if (!lineThrough(taken[i], taken[(i + 1) % taken.size()], line)) continue;
            FlatPiece out = clipPiece(rest, -line);
            if (!out.empty() && areaOf(out) > 0) next_.push_back(std::move(out));
            rest = clipPiece(rest, line);
        }
        if (!rest.empty()) continue;
        // Nothing of it is taken: it stays whole.
        next_.resize(before);
        next_.push_back(std::move(piece));
    }
    pieces_.swap(next_);
}

FlatPiece hullOf(std::vector<glm::dvec2> points) {
    std::sort(points.begin(), points.end(),
              [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return {};
    FlatPiece hull;
    for (int pass = 0; pass < 2; ++pass) {
        const size_t begin = hull.size();
        for (const glm::dvec2& point : points) {
            while (hull.size() >= begin + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= 0)
                hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

std::vector<FlatHole> holesOf(const std::vector<FlatPiece>& pieces, double touching, size_t most) {
    const std::vector<uint32_t> group = groupsOf(pieces, touching);
    std::vector<FlatHole> holes;
    std::vector<uint32_t> hole_of(pieces.size());
    size_t all = 0;
    for (uint32_t i = 0; i < pieces.size(); ++i) {
        if (group[i] == i) {
            hole_of[i] = static_cast<uint32_t>(holes.size());
            holes.emplace_back();
        }
        holes[hole_of[group[i]]].pieces.push_back(pieces[i]);
    }
    for (FlatHole& hole : holes) {
        hole.area = areaOfAll(hole.pieces);
        joinPairs(hole.pieces, touching);
        all += hole.pieces.size();
    }
    for (FlatHole& hole : holes) {
        const size_t count = hole.pieces.size();
        if (count == 1) continue;
        FlatPiece hull = hullOfAll(hole.pieces);
        const bool nearly = areaOf(hull) <= hole.area * 1.01;
        if (all <= most && count <= most && !nearly) continue;
        hole.merged = !nearly;
        hole.pieces.assign(1, std::move(hull));
        all -= count - 1;
    }
    if (all <= most) return holes;
    FlatHole whole;
    for (const FlatHole& hole : holes) {
        whole.area += hole.area;
        whole.pieces.insert(whole.pieces.end(), hole.pieces.begin(), hole.pieces.end());
    }
    whole.merged = true;
    whole.pieces.assign(1, hullOfAll(whole.pieces));
    return {whole};
}

}  // namespace sightline::bake
