// How far two triangle surfaces are apart at most: an upper bound of their Hausdorff distance, proved and tight.
// SPDX-License-Identifier: MIT
//
// Nicolas Aspert, Diego Santa-Cruz, Touradj Ebrahimi. MESH: Measuring Errors between Surfaces using the Hausdorff
// Distance. 2002.
// Michael Guthe, Pavel Borodin, Reinhard Klein. Fast and Accurate Hausdorff Distance Calculation between Meshes. 2005.
// Min Tang, Minkyoung Lee, Young J. Kim. Interactive Hausdorff Distance Computation for General Polygonal Models. 2009.
#include "sightline/prepare/lod/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sightline {
namespace {

constexpr uint32_t kNoTriangle = ~uint32_t{0};
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr uint32_t kMostCuts = 128;       // of a piece out of its triangle
constexpr uint32_t kCutsByNearness = 16;  // before every other cut halves the longest side: then pieces surely shrink
constexpr double kAsNear = 0x1p-40;       // of the largest coordinate: triangles that are equally near but for rounding

/// The bounds are off by less than so much of the largest coordinate M. A corner of a piece is a weighted mean of
/// corners that were made before, and rounds by 11 * 2^-53 M along each axis at most; so the piecewise linear map from
/// the triangle to its pieces moves no point by more than 128 * 19 * 2^-53 M. The point of the other triangle and the
/// length of the way there round by less than 2^-47 M. Together that is less than 2^-41 M.
constexpr double kSlack = 0x1p-40;

struct Piece {
    glm::dvec3 at[3];
    double distance[3];  ///< of the corners from the other surface
    uint32_t near[3];    ///< triangles there that are so near
    uint32_t best;       ///< the one that gave the bound
    double bound = 0;    ///< of the distance of all points of the piece
    uint8_t side = 0;    ///< whose piece it is
    uint8_t cuts = 0;
};

double distanceFrom(const TriangleCorners& t, const glm::dvec3& p) { return std::sqrt(squaredDistance(t, p)); }

/// Triangles from which the distances of a piece's corners are known.
class Candidates {
public:
    Candidates(const DistanceSurface& other, const Piece& piece) : other_(other), piece_(piece) {}

    void add(uint32_t triangle) {
        for (int i = 0; i < count_; ++i)
            if (triangle_[i] == triangle) return;
        triangle_[count_] = triangle;
        for (int k = 0; k < 3; ++k)
            distance_[count_][k] =
                piece_.near[k] == triangle ? piece_.distance[k] : distanceFrom(other_.corners(triangle), piece_.at[k]);
        ++count_;
    }

    /// Lowers the piece's bound by all of them.
    void bound(Piece& piece) const {
        for (int i = 0; i < count_; ++i) {
            const double most = std::max({distance_[i][0], distance_[i][1], distance_[i][2]});
            if (most < piece.bound) piece.bound = most, piece.best = triangle_[i];
        }
    }

    /// Of triangles that are equally near to a corner, those are named that are so for the most corners: where the
    /// named ones still differ, the surface there is not one triangle.
    void agree(Piece& piece, double as_near) const {
        int serves[kMost] = {};
        for (int i = 0; i < count_; ++i)
            for (int k = 0; k < 3; ++k) serves[i] += distance_[i][k] <= piece.distance[k] + as_near;
        for (int k = 0; k < 3; ++k) {
            const double most_away = piece.distance[k] + as_near;
            int most = 0;
            for (int i = 0; i < count_; ++i)
                if (distance_[i][k] <= most_away && serves[i] > most) {
                    most = serves[i];
                    piece.near[k] = triangle_[i];
                    piece.distance[k] = distance_[i][k];
                }
        }
    }

private:
    static constexpr int kMost = 5;  // of the corners, of the middle, and the best one before the cut

    const DistanceSurface& other_;
    const Piece& piece_;
    int count_ = 0;
    uint32_t triangle_[kMost];
    double distance_[kMost][3];
};

class Search {
public:
    Search(const DistanceSurface& a, const DistanceSurface& b, const DistanceLimits& limits)
        : surfaces_{&a, &b}, limits_(limits) {
        Box3d box = a.box();
        box.grow(b.box());
        diagonal_ = glm::length(box.size());
        const glm::dvec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
        reach_ = std::max({reach.x, reach.y, reach.z});
    }

    SurfaceDistance run() {
        begin(0);
        begin(1);
        if (pieces_.empty()) return {};  // the same triangles
        std::vector<Piece> first;
        first.swap(pieces_);
        for (const Piece& piece : first) file(piece);
        const uint64_t most = uint64_t{limits_.cuts} * (surfaces_[0]->triangles() + surfaces_[1]->triangles() + 1000);
        uint64_t cuts = 0;
        while (!open_.empty() && open_.front().bound > std::max(settled_, allowed()) && cuts < most) {
            std::pop_heap(open_.begin(), open_.end());
            const uint32_t place = open_.back().place;
            open_.pop_back();
            const Piece piece = pieces_[place];
            free_.push_back(place);
            if (piece.cuts == kMostCuts) {
                settled_ = std::max(settled_, piece.bound);
                continue;
            }
            cut(piece);
            ++cuts;
        }
        const double upper = std::max(settled_, open_.empty() ? 0.0 : open_.front().bound);
        const double slack = kSlack * reach_ + std::numeric_limits<double>::min();
        return {std::max(lower_ - slack, 0.0), upper + slack, cuts};
    }

private:
    struct Open {
        double bound;
        uint64_t number;  ///< the earlier one of equal bounds first: a heap has one order everywhere
        uint32_t place;
        bool operator<(const Open& other) const {
            return bound != other.bound ? bound < other.bound : number > other.number;
        }
    };

    const DistanceSurface& other(int side) const { return *surfaces_[1 - side]; }
    double allowed() const { return (1 + limits_.relative) * lower_ + limits_.absolute * diagonal_; }

    /// The nearest triangle of the other surface, and what that says of the lower bound. If the point cannot raise
    /// that, any triangle that shows it.
    NearTriangle nearest(int side, const glm::dvec3& p, NearTriangle known) {
        const DistanceSurface& from = other(side);
        const NearTriangle found = from.tree().nearest(p, known, lower_ * lower_);
        if (const double distance = std::sqrt(found.squared); distance > farthest_) {
            farthest_ = distance;
            lower_ = std::max(lower_, from.tree().leastDistance(p, distance));
        }
        return found;
    }

    /// The triangles that the other surface has not, with the distances of their corners.
    void begin(uint8_t side) {
        const DistanceSurface& own = *surfaces_[side];
        std::vector<NearTriangle> of_place(own.places(), {kInfinite, kNoTriangle});
        for (uint32_t t = 0; t < own.triangles(); ++t) {
            if (other(side).holds(own.corners(t))) continue;
            Piece piece;
            piece.side = side;
            uint32_t last = 0;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3& p = piece.at[k] = own.corners(t).at[k];
                NearTriangle& near = of_place[own.placesOf(t)[static_cast<size_t>(k)]];
                if (near.triangle == kNoTriangle)
                    near = nearest(side, p, {squaredDistance(other(side).corners(last), p), last});
                piece.near[k] = last = near.triangle;
                piece.distance[k] = std::sqrt(near.squared);
            }
            piece.best = last;
            piece.bound = kInfinite;
            pieces_.push_back(piece);
        }
    }

    /// Finds a piece's bound. Then it is either settled or open.
    void file(Piece piece) {
        Candidates candidates(other(piece.side), piece);
        candidates.add(piece.near[0]);
        candidates.add(piece.near[1]);
        candidates.add(piece.near[2]);
        candidates.add(piece.best);
        candidates.bound(piece);
        if (piece.bound > allowed()) {
            const glm::dvec3 middle = (piece.at[0] + piece.at[1] + piece.at[2]) / 3.0;
            const double known = squaredDistance(other(piece.side).corners(piece.best), middle);
            candidates.add(nearest(piece.side, middle, {known, piece.best}).triangle);
            candidates.bound(piece);
        }
        if (!(piece.bound > allowed())) {
            settled_ = std::max(settled_, piece.bound);
            return;
        }
        candidates.agree(piece, kAsNear * reach_);
        uint32_t place = static_cast<uint32_t>(pieces_.size());
        if (free_.empty()) {
            pieces_.push_back(piece);
        } else {
            place = free_.back();
            free_.pop_back();
            pieces_[place] = piece;
        }
        open_.push_back({piece.bound, number_++, place});
        std::push_heap(open_.begin(), open_.end());
    }

    /// How much farther a place on a side is from the triangle nearest to its one end than from that of its other end.
    struct Excess {
        const TriangleCorners &at_from, &at_to;
        glm::dvec3 from, along;

        double operator()(double share) const {
            const glm::dvec3 p = from + share * along;
            return distanceFrom(at_from, p) - distanceFrom(at_to, p);
        }
    };

    Excess excessOf(const Piece& piece, int from) const {
        const int to = (from + 1) % 3;
        return {other(piece.side).corners(piece.near[from]), other(piece.side).corners(piece.near[to]), piece.at[from],
                piece.at[to] - piece.at[from]};
    }

    /// The share of the way at which both are equally near: secants with the guard that is named after Illinois. Where
    /// one triangle ends and the next one begins in the same plane, the excess is straight and the first secant finds
    /// it.
    double crossing(const Excess& excess) const {
        double low = 0, high = 1, at_low = excess(0), at_high = excess(1), share = 0.5;
        for (int i = 0, last = 0; i < 24; ++i) {
            share = (low * at_high - high * at_low) / (at_high - at_low);
            const double now = excess(share);
            if (std::abs(now) <= 0x1p-50 * reach_) break;
            const int sign = now < 0 ? -1 : 1;
            if (now < 0) low = share, at_low = now;
            else high = share, at_high = now;
            if (sign == last) (now < 0 ? at_high : at_low) /= 2;
            last = sign;
        }
        return std::clamp(share, 0.0, 1.0);
    }

    /// A point of the piece over a vertex in which the triangles that are nearest to its corners come together. Cuts
    /// along sides would close in on such a place for ever.
    bool overVertex(const Piece& piece, glm::dvec3& found) const {
        const DistanceSurface& from = other(piece.side);
        if (piece.near[0] == piece.near[1] && piece.near[1] == piece.near[2]) return false;
        const glm::dvec3 ab = piece.at[1] - piece.at[0], ac = piece.at[2] - piece.at[0], normal = glm::cross(ab, ac);
        const double area = glm::dot(normal, normal);
        if (!(area > 1e-12 * glm::dot(ab, ab) * glm::dot(ac, ac))) return false;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t place = from.placesOf(piece.near[0])[k];
            const auto has = [&](uint32_t triangle) {
                const auto& places = from.placesOf(triangle);
                return places[0] == place || places[1] == place || places[2] == place;
            };
            if (!has(piece.near[1]) || !has(piece.near[2])) continue;
            const glm::dvec3 way = from.corners(piece.near[0]).at[k] - piece.at[0];
            const double of_b = glm::dot(glm::cross(way, ac), normal) / area;
            const double of_c = glm::dot(glm::cross(ab, way), normal) / area;
            constexpr double kInside = 1e-6;
            if (!(of_b > kInside && of_c > kInside && of_b + of_c < 1 - kInside)) continue;
            found = piece.at[0] + of_b * ab + of_c * ac;
            return true;
        }
        return false;
    }

    /// The point of the piece, where a side may be cut, at which the nearest triangle changes; or where there is no
    /// such, the middle of the longest side.
    glm::dvec3 placeToCut(const Piece& piece, bool by_nearness, int& side, uint32_t& hint) const {
        double longest = -1, longest_unlike = -1;
        int unlike = 0;  // sides by the corner that they start from
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 along = piece.at[(k + 1) % 3] - piece.at[k];
            const double squared = glm::dot(along, along), as_near = kAsNear * reach_;
            if (squared > longest) longest = squared, side = k;
            if (!by_nearness || piece.near[k] == piece.near[(k + 1) % 3] || !(squared > longest_unlike)) continue;
            // A corner that is as near to the other triangle lies where they meet already.
            const Excess excess = excessOf(piece, k);
            if (excess(0) < -as_near && excess(1) > as_near) longest_unlike = squared, unlike = k;
        }
        double share = 0.5;
        if (longest_unlike > 0) {
            side = unlike;
            share = crossing(excessOf(piece, side));
        }
        const int next = (side + 1) % 3;
        hint = piece.near[share < 0.5 ? side : next];
        return piece.at[side] + share * (piece.at[next] - piece.at[side]);
    }

    /// Into two pieces, or into three around a vertex.
    void cut(const Piece& piece) {
        const bool by_nearness = piece.cuts < kCutsByNearness || piece.cuts % 2 == 0;
        glm::dvec3 p;
        int side = 0;
        uint32_t hint = piece.near[0];
        const bool around = by_nearness && overVertex(piece, p);
        if (!around) p = placeToCut(piece, by_nearness, side, hint);
        const NearTriangle near = nearest(piece.side, p, {squaredDistance(other(piece.side).corners(hint), p), hint});
        for (int replaced = 0; replaced < 3; ++replaced) {
            if (!around && replaced == (side + 2) % 3) continue;
            Piece part = piece;
            part.at[replaced] = p;
            part.distance[replaced] = std::sqrt(near.squared);
            part.near[replaced] = near.triangle;
            ++part.cuts;
            file(part);
        }
    }

    const DistanceSurface* surfaces_[2];
    DistanceLimits limits_;
    double diagonal_ = 0, reach_ = 0;
    double farthest_ = 0;  ///< computed distance of any point so far
    double lower_ = 0;     ///< proved one
    double settled_ = 0;   ///< the largest bound of pieces that are not looked at any more
    std::vector<Piece> pieces_;
    std::vector<uint32_t> free_;  ///< of these
    std::vector<Open> open_;      ///< a heap, the largest bound first
    uint64_t number_ = 0;
};

}  // namespace

SurfaceDistance surfaceDistance(const DistanceSurface& a, const DistanceSurface& b, const DistanceLimits& limits) {
    if (!a.finite() || !b.finite()) return {kInfinite, kInfinite, 0};
    if (a.triangles() == 0 && b.triangles() == 0) return {};
    if (a.triangles() == 0 || b.triangles() == 0) return {kInfinite, kInfinite, 0};
    return Search(a, b, limits).run();
}

SurfaceDistance surfaceDistance(const MeshView& a, const MeshView& b, const DistanceLimits& limits) {
    return surfaceDistance(DistanceSurface(a), DistanceSurface(b), limits);
}

}  // namespace sightline
