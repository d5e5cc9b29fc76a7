// What shadows of triangles leave of a flat part of a surface, cut by cut, with signs that are never wrong.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/shadow_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sightline::tools {
namespace {

template <class Number>
Triple<Number> positionOf(const ExactCorner& corner);
template <>
Triple<Rounded> positionOf(const ExactCorner& corner) {
    return corner.rounded();
}
template <>
Triple<Exact> positionOf(const ExactCorner& corner) {
    return corner.exact();
}

template <class Number>
Triple<Number> tripleOf(const glm::dvec3& v) {
    return {Number(v.x), Number(v.y), Number(v.z)};
}

template <class Number>
Number scaled(const Number& value, int by) {
    return by < 0 ? -value : value;
}

/// What a plane of the view says of a point.
template <class Number>
Number atPlane(const ViewPlane& plane, const Triple<Number>& point) {
    return dot(tripleOf<Number>(glm::dvec3(plane)), point) + Number(plane.w);
}

/// Positive if a triangle is clockwise as sight lines see it.
template <class Number>
Number clockwise(const ExactTriangle& triangle, const SightOrigin& origin) {
    const Triple<Number> a = positionOf<Number>(triangle.corners[0]);
    const Triple<Number> ab = positionOf<Number>(triangle.corners[1]) - a;
    const Triple<Number> ac = positionOf<Number>(triangle.corners[2]) - a;
    return dot(cross(ab, ac), origin.parallel() ? tripleOf<Number>(origin.direction) : a);
}

/// The sign of what `find` computes: in double if that suffices.
template <class Find>
int exactSign(Find&& find) {
    const int sign = find(Rounded()).sign();
    return sign != Rounded::kUnknown ? sign : find(Exact()).sign();
}

}  // namespace

ExactCorner::ExactCorner(const glm::dmat4& transform, const glm::dvec3& local, const SightOrigin& origin)
    : transform_(&transform), origin_(&origin), local_(local) {
    const auto coordinate = [&](int row) {
        const Rounded sum = Rounded(transform[0][row]) * local.x + Rounded(transform[1][row]) * local.y +
                            Rounded(transform[2][row]) * local.z;
        return sum + (Rounded(transform[3][row]) - Rounded(origin.eye[row]));
    };
    rounded_ = {coordinate(0), coordinate(1), coordinate(2)};
}

const Triple<Exact>& ExactCorner::exact() const {
    if (!exact_) {
        const auto coordinate = [&](int row) {
            return Exact((*transform_)[0][row]) * local_.x + Exact((*transform_)[1][row]) * local_.y +
                   Exact((*transform_)[2][row]) * local_.z + Exact((*transform_)[3][row]) - origin_->eye[row];
        };
        exact_ = Triple<Exact>{coordinate(0), coordinate(1), coordinate(2)};
    }
    return *exact_;
}

void ExactTriangle::findFacing(const SightOrigin& origin) {
    facing = -exactSign([&](auto number) { return clockwise<decltype(number)>(*this, origin); });
}

bool mirrors(const glm::dmat4& transform) {
    return exactSign([&](auto number) {
               const auto column = [&](int i) { return tripleOf<decltype(number)>(glm::dvec3(transform[i])); };
               return dot(cross(column(0), column(1)), column(2));
           }) < 0;
}

int sideOf(const ViewPlane& plane, const ExactCorner& corner) {
    return exactSign([&](auto number) {
        using Number = decltype(number);
        return atPlane<Number>(plane, positionOf<Number>(corner));
    });
}

int sideOf(const ExactTriangle& triangle, const ExactCorner& corner) {
    return exactSign([&](auto number) {
        using Number = decltype(number);
        const Triple<Number> a = positionOf<Number>(triangle.corners[0]);
        const Triple<Number> ab = positionOf<Number>(triangle.corners[1]) - a;
        const Triple<Number> ac = positionOf<Number>(triangle.corners[2]) - a;
        return dot(cross(ab, ac), positionOf<Number>(corner) - a);
    });
}

// Lines.

template <class Number>
Triple<Number> ShadowPieces::valuesOf(const Rule& rule) const {
    const auto at = [&](auto&& function) {
        return Triple<Number>{function(positionOf<Number>(frame_->corners[0])),
                              function(positionOf<Number>(frame_->corners[1])),
                              function(positionOf<Number>(frame_->corners[2]))};
    };
    if (rule.kind == Kind::kOfFrame) {
        // Of a triangle the three coordinates; of a parallelogram two of them, and one less each of these.
        switch (rule.side) {
            case 0:
                return {Number(1), Number(0), Number(0)};
            case 1:
                return {Number(0), Number(1), Number(0)};
            case 2:
                return {Number(0), Number(0), Number(1)};
            case 3:
                return {Number(1), Number(0), Number(1)};
            default:
                return {Number(1), Number(1), Number(0)};
        }
    }
    if (rule.kind == Kind::kView)
        return at([&](const Triple<Number>& point) { return atPlane<Number>(rule.plane, point); });

    const ExactTriangle& hider = *rule.hider;
    const Triple<Number> a = positionOf<Number>(hider.corners[0]);
    if (rule.kind == Kind::kSide) {
        // Sight lines meet the triangle where they pass all sides alike: on the side where the third corner lies.
        const Triple<Number> from = positionOf<Number>(hider.corners[rule.side]);
        const Triple<Number> to = positionOf<Number>(hider.corners[(rule.side + 1) % 3]);
        const Triple<Number> normal =
            origin_.parallel() ? cross(tripleOf<Number>(origin_.direction), to - from) : cross(from, to);
        return at([&](const Triple<Number>& point) {
            return scaled(origin_.parallel() ? dot(normal, point - from) : dot(normal, point), -hider.facing);
        });
    }
    const Triple<Number> normal =
        cross(positionOf<Number>(hider.corners[1]) - a, positionOf<Number>(hider.corners[2]) - a);
    if (rule.kind == Kind::kBehind)
        return at([&](const Triple<Number>& point) { return scaled(dot(normal, point - a), -hider.facing); });

    // The sight line to a point p meets the triangle at q. Inside of the plane is where n.q + k >= 0.
    const Triple<Number> n = tripleOf<Number>(glm::dvec3(rule.plane));
    const Number k(rule.plane.w);
    if (!origin_.parallel()) {  // q = p * (normal.a / normal.p), and normal.p has the sign of -facing
        const Number height = dot(normal, a);
        return at([&](const Triple<Number>& point) {
            return scaled(k * dot(normal, point) + height * dot(n, point), -hider.facing);
        });
    }
    const Triple<Number> d = tripleOf<Number>(origin_.direction);  // q = p - d * (normal.(p - a) / normal.d)
    const Number slope = dot(normal, d), along = dot(n, d);
    return at([&](const Triple<Number>& point) {
        return scaled((dot(n, point) + k) * slope - dot(normal, point - a) * along, -hider.facing);
    });
}

const Triple<Exact>& ShadowPieces::exactOf(const Line& line) const {
    if (!line.exact) line.exact = valuesOf<Exact>(line.rule);
    return *line.exact;
}

uint32_t ShadowPieces::addLine(const Rule& rule) {
    Line line;
    line.rule = rule;
    line.rounded = valuesOf<Rounded>(rule);
    // Only signs matter: small and large scenes are brought to one size, so that products stay in the range of double.
    const double size =
        std::max({std::abs(line.rounded.x.value), std::abs(line.rounded.y.value), std::abs(line.rounded.z.value)});
    if (size > 0 && std::isfinite(size)) {
        const double scale = std::ldexp(1.0, -std::ilogb(size));
        for (Rounded* value : {&line.rounded.x, &line.rounded.y, &line.rounded.z}) {
            value->value *= scale;
            value->error = value->error * scale + 0x1p-1000;
        }
    }
    lines_.push_back(std::move(line));
    return static_cast<uint32_t>(lines_.size() - 1);
}

// Corners.

const Triple<Exact>& ShadowPieces::exactOf(const Corner& corner) const {
    if (!corner.exact) {
        corner.exact = cross(exactOf(lines_[corner.lines[0]]), exactOf(lines_[corner.lines[1]]));
        if (corner.turned) corner.exact = Triple<Exact>{-corner.exact->x, -corner.exact->y, -corner.exact->z};
    }
    return *corner.exact;
}

uint32_t ShadowPieces::addCorner(uint32_t first, uint32_t second) {
    Corner corner;
    corner.lines[0] = first;
    corner.lines[1] = second;
    corner.rounded = cross(lines_[first].rounded, lines_[second].rounded);
    const auto sum = [](const auto& of) { return of.x + of.y + of.z; };
    int sign = sum(corner.rounded).sign();
    if (sign == Rounded::kUnknown) sign = sum(exactOf(corner)).sign();
    if (sign < 0) {
        corner.rounded = {-corner.rounded.x, -corner.rounded.y, -corner.rounded.z};
        corner.turned = true;
        corner.exact.reset();
    }
    corners_.push_back(std::move(corner));
    return static_cast<uint32_t>(corners_.size() - 1);
}

int ShadowPieces::sign(uint32_t line, uint32_t corner) const {
    const Line& l = lines_[line];
    const Corner& c = corners_[corner];
    if (c.lines[0] == line || c.lines[1] == line) return 0;
    const int sign = dot(l.rounded, c.rounded).sign();
    return sign != Rounded::kUnknown ? sign : dot(exactOf(l), exactOf(c)).sign();
}

glm::dvec3 ShadowPieces::place(const Corner& corner) const {
    const auto about = [&](double x, double y, double z) {
        return x * frame_->corners[0].about() + y * frame_->corners[1].about() + z * frame_->corners[2].about();
    };
    const Triple<Rounded>& at = corner.rounded;
    const Rounded sum = at.x + at.y + at.z;
    if (std::max({at.x.error, at.y.error, at.z.error}) < 1e-12 * sum.value)
        return about(at.x.value / sum.value, at.y.value / sum.value, at.z.value / sum.value);
    const Triple<Exact>& exact = exactOf(corner);  // of lines that are next to parallel
    const Exact exact_sum = exact.x + exact.y + exact.z;
    return about(ratio(exact.x, exact_sum), ratio(exact.y, exact_sum), ratio(exact.z, exact_sum));
}

// Pieces.

Piece ShadowPieces::pieceOf(std::span<const uint32_t> lines) {
    Piece piece;
    for (size_t i = 0; i < lines.size(); ++i) {
        piece.corners.push_back(addCorner(lines[(i + lines.size() - 1) % lines.size()], lines[i]));
        piece.lines.push_back(lines[i]);
    }
    return piece;
}

Piece ShadowPieces::begin(const ExactTriangle& frame) {
    frame_ = &frame;
    lines_.clear();
    corners_.clear();
    uint32_t lines[3];
    for (uint8_t i = 0; i < 3; ++i) lines[i] = addLine({Kind::kOfFrame, i});
    return pieceOf(lines);
}

Piece ShadowPieces::beginParallelogram(const ExactTriangle& frame) {
    frame_ = &frame;
    lines_.clear();
    corners_.clear();
    uint32_t lines[4];
    for (uint8_t i = 0; i < 4; ++i) lines[i] = addLine({Kind::kOfFrame, static_cast<uint8_t>(i + 1)});
    return pieceOf(lines);
}

bool ShadowPieces::shadow(const ExactTriangle& hider, std::span<const ViewPlane> planes, std::vector<uint32_t>& lines) {
    lines.clear();
    if (hider.facing == 0) return false;
    for (uint8_t side = 0; side < 3; ++side) lines.push_back(addLine({Kind::kSide, side, &hider}));
    lines.push_back(addLine({Kind::kBehind, 0, &hider}));
    for (const ViewPlane& plane : planes) {
        int inside = 0;
        for (const ExactCorner& corner : hider.corners) inside += sideOf(plane, corner) >= 0;
        if (inside == 3) continue;
        if (inside == 0) return false;
        lines.push_back(addLine({Kind::kCutHider, 0, &hider, plane}));
    }
    return true;
}

void ShadowPieces::findSigns(const Piece& piece, uint32_t line, std::vector<int8_t>& signs) const {
    signs.clear();
    for (const uint32_t corner : piece.corners) signs.push_back(static_cast<int8_t>(sign(line, corner)));
}

Piece ShadowPieces::part(const Piece& piece, uint32_t line, std::span<const int8_t> signs, int inside) {
    Piece result;
    const auto add = [&](uint32_t corner, uint32_t along) {
        result.corners.push_back(corner);
        result.lines.push_back(along);
    };
    const size_t count = piece.corners.size();
    for (size_t i = 0; i < count; ++i) {
        const int here = inside * signs[i], next = inside * signs[(i + 1) % count];
        if (here > 0 || (here == 0 && next >= 0)) add(piece.corners[i], piece.lines[i]);
        else if (here == 0) add(piece.corners[i], line);
        if (here * next < 0) {
            const uint32_t crossing = addCorner(piece.lines[i], line);
            add(crossing, here > 0 ? line : piece.lines[i]);
        }
    }
    return result;
}

bool ShadowPieces::subtract(const Piece& piece, std::span<const uint32_t> lines, std::vector<Piece>& left) {
    const auto holds = [&](int sign) { return std::find(signs_.begin(), signs_.end(), sign) != signs_.end(); };
    for (const uint32_t line : lines) {  // most shadows lie wholly beside it
        findSigns(piece, line, signs_);
        if (!holds(1)) return false;
    }
    const size_t before = left.size();
    Piece inside = piece;
    for (const uint32_t line : lines) {
        findSigns(inside, line, signs_);
        if (!holds(1)) {
            left.resize(before);
            return false;
        }
        if (!holds(-1)) continue;
        left.push_back(part(inside, line, signs_, -1));
        inside = part(inside, line, signs_, 1);
    }
    return true;
}

bool ShadowPieces::clip(const ViewPlane& plane, Piece& piece) {
    const uint32_t line = addLine({Kind::kView, 0, nullptr, plane});
    findSigns(piece, line, signs_);
    if (std::find(signs_.begin(), signs_.end(), -1) == signs_.end()) return true;  // what lies in the plane is inside
    if (std::find(signs_.begin(), signs_.end(), 1) == signs_.end()) return false;
    piece = part(piece, line, signs_, 1);
    return true;
}

glm::dvec3 ShadowPieces::middle(const Piece& piece) const {
    glm::dvec3 sum(0.0);
    for (size_t i = 0; i < piece.corners.size(); ++i) sum += cornerOf(piece, i);
    return sum / static_cast<double>(piece.corners.size());
}

}  // namespace sightline::tools
