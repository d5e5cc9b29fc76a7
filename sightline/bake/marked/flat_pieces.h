// Convex pieces of a plane: differences, unions and hulls of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::bake {

/// Corners of a convex polygon, counter-clockwise.
using FlatPiece = std::vector<glm::dvec2>;

/// dot(line, (p, 1)) >= 0 is kept.
FlatPiece clipPiece(const FlatPiece& piece, const glm::dvec3& line);

double areaOf(const FlatPiece& piece);

/// What two convex polygons share; empty if nothing.
FlatPiece sharedBy(const FlatPiece& a, const FlatPiece& b);

/// Each point within `by` of the piece is in the result, and each of the result within 1.1 * by. Corners are bevelled,
/// so that a sharp one does not reach farther. Pieces without area grow as well.
FlatPiece grownBy(const FlatPiece& piece, double by);

/// The points of a piece that are at least `by` from the lines of its sides; empty if there are none.
FlatPiece shrunkBy(const FlatPiece& piece, double by);

/// What is left of pieces when others are taken away.
class FlatRest {
public:
    explicit FlatRest(FlatPiece whole) { pieces_.push_back(std::move(whole)); }

    /// O(pieces). What is left of a piece is never less than what lies outside `taken`, up to rounding.
    void take(const FlatPiece& taken);

    bool empty() const { return pieces_.empty(); }
    const std::vector<FlatPiece>& pieces() const { return pieces_; }
    /// No more is taken once there are so many pieces: what is left is then too much.
    static constexpr size_t kMost = 8192;

private:
    std::vector<FlatPiece> pieces_, next_;
};

/// The convex hull of points.
FlatPiece hullOf(std::vector<glm::dvec2> points);

/// A hole: pieces that touch.
struct FlatHole {
    std::vector<FlatPiece> pieces;  ///< convex; they hold all that was given
    double area = 0;                ///< of what was given
    bool merged = false;            ///< its pieces are its hull, and larger
};

/// Puts together what touches to within `touching`, and makes few convex pieces of many.
/// @param most  pieces of all holes together; beyond it a hole of several becomes its hull, and if that is not enough
///              all of them one  [>= 1]
std::vector<FlatHole> holesOf(const std::vector<FlatPiece>& pieces, double touching, size_t most);

}  // namespace sightline::bake
