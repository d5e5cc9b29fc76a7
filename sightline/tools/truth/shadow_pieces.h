// What shadows of triangles leave of a flat part of a surface, cut by cut, with signs that are never wrong.
// SPDX-License-Identifier: MIT
//
// Kevin Weiler, Peter Atherton. Hidden Surface Removal Using Polygon Area Sorting. 1977.
//
// A flat part is cut by lines. Each line is where a plane meets the plane of the part: one through the eye and a side of a
// triangle, the triangle's own, the view's, or one through the eye and the line in which the triangle meets a plane of the
// view. What such a plane says of a point is a linear function. So its values at three points of the part, the part's
// frame, say all of it, whatever the part was cut by before; and where two lines cross is a product of theirs. No
// number grows with the number of cuts.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/truth/exact_number.h"

namespace sightline::tools {

/// Where sight lines come from: a point, or a direction.
struct SightOrigin {
    glm::dvec3 eye{0.0};        ///< of a perspective view; else a point that positions are relative to
    glm::dvec3 direction{0.0};  ///< of all sight lines of a parallel view; 0: they begin at the eye
    bool parallel() const { return direction != glm::dvec3(0.0); }
};

/// A corner of a triangle or a box, where it stands by exact arithmetic: transform * local.
class ExactCorner {
public:
    ExactCorner() = default;
    /// @param transform  finite; outlives the corner, as `origin` does
    ExactCorner(const glm::dmat4& transform, const glm::dvec3& local, const SightOrigin& origin);

    /// Relative to the eye.
    const Triple<Rounded>& rounded() const { return rounded_; }
    const Triple<Exact>& exact() const;
    glm::dvec3 about() const { return {rounded_.x.value, rounded_.y.value, rounded_.z.value}; }

private:
    Triple<Rounded> rounded_;
    const glm::dmat4* transform_ = nullptr;
    const SightOrigin* origin_ = nullptr;
    glm::dvec3 local_{0.0};
    mutable std::optional<Triple<Exact>> exact_;
};

/// A triangle of the scene, as seen by sight lines.
struct ExactTriangle {
    ExactCorner corners[3];
    /// 1: counter-clockwise as seen; -1: clockwise; 0: seen from its edge, or without area.
    int facing = 0;

    void findFacing(const SightOrigin& origin);
};

/// Whether a transform turns clockwise triangles into counter-clockwise ones.
/// @param transform  finite
bool mirrors(const glm::dmat4& transform);

/// A plane of the view, relative to the eye: inside is >= 0.
using ViewPlane = glm::dvec4;

/// 1, 0 or -1: on which side of a plane of the view a corner lies.
int sideOf(const ViewPlane& plane, const ExactCorner& corner);
/// On which side of a triangle's plane a corner lies: where the eye is, if the sign is that of ExactTriangle::facing.
int sideOf(const ExactTriangle& triangle, const ExactCorner& corner);

/// A convex polygon in the plane of a frame: its corners in order, and the line from each to the next.
struct Piece {
    std::vector<uint32_t> corners, lines;
};

/// The pieces of one flat part. Lines and corners stay until the next begin().
class ShadowPieces {
public:
    explicit ShadowPieces(const SightOrigin& origin) : origin_(origin) {}

    /// The whole of a triangle.
    /// @param frame  that is not seen from its edge; outlives the pieces
    Piece begin(const ExactTriangle& frame);
    /// The whole of a parallelogram: the triangle's corners, and the one that lies opposite the first.
    Piece beginParallelogram(const ExactTriangle& frame);

    /// The lines that bound the shadow of a triangle: what lies inside of all of them is hidden by it. A triangle whose plane
    /// the eye lies in has none.
    /// @param planes  that the triangle is cut by before it hides anything: the near plane's and the sections'
    /// @param lines   receives them
    /// @returns false if nothing is hidden
    bool shadow(const ExactTriangle& hider, std::span<const ViewPlane> planes, std::vector<uint32_t>& lines);

    /// Takes what lies inside of all lines from a piece, and appends what is left.
    /// @returns false if it takes nothing, of the piece's inside: then nothing is appended
    bool subtract(const Piece& piece, std::span<const uint32_t> lines, std::vector<Piece>& left);

    /// Cuts a piece to the inside of a plane of the view.
    /// @returns false if no inside is left
    bool clip(const ViewPlane& plane, Piece& piece);

    /// About the middle of a piece, relative to the eye.
    glm::dvec3 middle(const Piece& piece) const;
    /// About where a corner of it lies, relative to the eye.
    glm::dvec3 cornerOf(const Piece& piece, size_t i) const { return place(corners_[piece.corners[i]]); }

private:
    enum class Kind : uint8_t { kOfFrame, kSide, kBehind, kView, kCutHider };
    struct Rule {
        Kind kind = Kind::kOfFrame;
        uint8_t side = 0;  ///< of the triangle, of kSide; which line of the frame, of kOfFrame
        const ExactTriangle* hider = nullptr;
        ViewPlane plane{0.0};
    };
    struct Line {
        Rule rule;
        Triple<Rounded> rounded;
        mutable std::optional<Triple<Exact>> exact;
    };
    /// Where two lines cross, in the frame's barycentric coordinates times a positive number.
    struct Corner {
        uint32_t lines[2] = {0, 0};
        Triple<Rounded> rounded;
        bool turned = false;  ///< the product of the lines has a negative sum
        mutable std::optional<Triple<Exact>> exact;
    };

    template <class Number>
    Triple<Number> valuesOf(const Rule& rule) const;
    const Triple<Exact>& exactOf(const Line& line) const;
    const Triple<Exact>& exactOf(const Corner& corner) const;
    uint32_t addLine(const Rule& rule);
    uint32_t addCorner(uint32_t first, uint32_t second);
    int sign(uint32_t line, uint32_t corner) const;
    Piece pieceOf(std::span<const uint32_t> lines);
    void findSigns(const Piece& piece, uint32_t line, std::vector<int8_t>& signs) const;
    Piece part(const Piece& piece, uint32_t line, std::span<const int8_t> signs, int inside);
    glm::dvec3 place(const Corner& corner) const;

    const SightOrigin& origin_;
    const ExactTriangle* frame_ = nullptr;
    std::deque<Line> lines_;
    std::deque<Corner> corners_;
    std::vector<int8_t> signs_;
};

}  // namespace sightline::tools
