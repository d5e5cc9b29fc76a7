// What of a convex occludee no shadow volume has hidden yet: the outline in the image, less the shadows, piece by piece.
// SPDX-License-Identifier: MIT
#include "sightline/cull/proofs/uncovered.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr double kMargin = 1e-9, kMostMargin = 1e-3;  // of the image's half width

double sizeOf(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }
double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

bool makeShadow(const ImageFrame& frame, Shadow& shadow) {
    const OccluderVolume& volume = shadow.volume;
    SIGHTLINE_DEBUG_ASSERT(frame.usable && volume.planes > 0 && volume.planes <= OccluderVolume::kMaxPlanes);
    shadow.line_count = shadow.face_count = 0;
    for (uint32_t i = 0; i < volume.planes; ++i) {
        const glm::dvec3 normal(volume.normal[i][0], volume.normal[i][1], volume.normal[i][2]);
        const double still = volume.slack[i][0], turn = volume.slack[i][1];
        if (volume.distance[i] == 0) {
            Shadow::Line& line = shadow.lines[shadow.line_count++];
            line.line = frame.lineOf(normal);
            line.line.z -= turn * frame.longest;
            line.still = still;
            continue;
        }
        if (shadow.face_count == Shadow::kMostFaces) return false;
        shadow.slack[shadow.face_count][0] = still;
        shadow.slack[shadow.face_count][1] = turn;
        shadow.faces[shadow.face_count++] = {normal, static_cast<double>(volume.distance[i])};
    }
    return true;
}

bool Shadow::holds(const glm::dvec3* corners, uint32_t count, double error) const {
    SIGHTLINE_DEBUG_ASSERT(count > 0 && error >= 0);
    for (uint32_t plane = 0; plane < volume.planes; ++plane) {
        const glm::dvec3 normal(volume.normal[plane][0], volume.normal[plane][1], volume.normal[plane][2]);
        const double least = volume.slack[plane][0] + 2.0 * error - volume.distance[plane];
        for (uint32_t i = 0; i < count; ++i)
            if (!(glm::dot(normal, corners[i]) > least + volume.slack[plane][1] * sizeOf(corners[i]))) return false;
    }
    return true;
}

double Uncovered::Piece::area() const {
    double sum = 0;
    for (uint32_t i = 1; i + 1 < count; ++i) sum += cross(corner[i] - corner[0], corner[i + 1] - corner[0]);
    return 0.5 * sum;
}

/// The hull, counter-clockwise; false if it has too many corners.
bool Uncovered::Cloud::outline(Piece& piece) {
    SIGHTLINE_DEBUG_ASSERT(count <= kMostPoints);
    std::sort(point, point + count,
              [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    piece.count = 0;
    if (count == 0) return true;
    glm::dvec2 hull[2 * kMostOfPiece + 2];
    uint32_t made = 0, least = 2;
    const auto add = [&](const glm::dvec2& p) {
        while (made >= least && cross(hull[made - 1] - hull[made - 2], p - hull[made - 2]) <= 0) --made;
        if (made == std::size(hull)) return false;
        hull[made++] = p;
        return true;
    };
    for (uint32_t i = 0; i < count; ++i)
        if (!add(point[i])) return false;
    least = made + 1;
    for (uint32_t i = count - 1; i-- > 0;)
        if (!add(point[i])) return false;
    if (made > 1) --made;
    if (made > kMostOfPiece) return false;
    std::copy(hull, hull + made, piece.corner);
    piece.count = made;
    return true;
}

/// Parts a piece at a line: `within` where dot(line, (u, v, 1)) >= 0. Each may be empty.
/// @returns false if one of them has too many corners
bool Uncovered::split(const Piece& from, const glm::dvec3& line, Piece& within, Piece& outside) {
    SIGHTLINE_DEBUG_ASSERT(from.count <= kMostOfPiece && &from != &within && &from != &outside);
    within.count = outside.count = 0;
    double height[kMostOfPiece];
    for (uint32_t i = 0; i < from.count; ++i)
        height[i] = line.x * from.corner[i].x + line.y * from.corner[i].y + line.z;
    for (uint32_t i = 0; i < from.count; ++i)
        if (std::isnan(height[i])) return false;
    for (uint32_t i = 0; i < from.count; ++i) {
        const uint32_t next = i + 1 == from.count ? 0 : i + 1;
        if (within.count + 2 > kMostOfPiece || outside.count + 2 > kMostOfPiece) return false;
        if (height[i] >= 0) within.corner[within.count++] = from.corner[i];
        if (height[i] < 0) outside.corner[outside.count++] = from.corner[i];
        if ((height[i] >= 0) == (height[next] >= 0)) continue;
        const double t = height[i] / (height[i] - height[next]);
        const glm::dvec2 at = from.corner[i] + t * (from.corner[next] - from.corner[i]);
        within.corner[within.count++] = at;
        outside.corner[outside.count++] = at;
    }
    return true;
}

bool Uncovered::push(const Piece& piece) {
    if (piece.count == 0) return true;
    if (next_count_ == kMostPieces) return false;
    SIGHTLINE_DEBUG_ASSERT(next_count_ < kMostPieces);
    next()[next_count_++] = piece;
    return true;
}

bool Uncovered::addPoint(Cloud& cloud, const glm::dvec3& q) const {
    if (cloud.count == kMostPoints) return false;
    const double w = glm::dot(frame_.w, q);
    if (!(w > 1e-6 * sizeOf(q))) return false;
    cloud.point[cloud.count++] = {glm::dot(frame_.x, q) / w, glm::dot(frame_.y, q) / w};
    return true;
}

/// Leaves what of the body is not before the near plane.
bool Uncovered::clipNear(const VolumeView& view, const glm::dvec3* corners, uint32_t count, bool box) {
    SIGHTLINE_DEBUG_ASSERT(count <= kMostCorners && (!box || count == 8));
    double height[kMostCorners];
    is_box_ = false;
    bool all = true;
    for (uint32_t i = 0; i < count; ++i) {
        height[i] = glm::dot(glm::dvec3(view.near), corners[i]) + view.near.w + view.near_guard + error_;
        all = all && height[i] >= 0;
    }
    body_count_ = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (height[i] >= 0) body_[body_count_++] = corners[i];
    if (all) {
        is_box_ = box;
        return true;
    }
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t k = 0; k < count; ++k) {
            if (!(height[i] >= 0 && height[k] < 0) || (box && !std::has_single_bit(i ^ k))) continue;
            if (body_count_ == kMostPoints) return false;
            body_[body_count_++] = corners[i] + height[i] / (height[i] - height[k]) * (corners[k] - corners[i]);
        }
    return true;
}

bool Uncovered::begin(const VolumeView& view, const ImageFrame& frame, const glm::dvec3* corners, uint32_t count,
                      double error, bool box) {
    SIGHTLINE_DEBUG_ASSERT(view.usable && error >= 0);
    ++cuts_;
    frame_ = frame;
    error_ = error;
    piece_count_ = 0;
    if (!frame.usable || count == 0 || count > kMostCorners || !clipNear(view, corners, count, box)) return false;
    Cloud cloud;
    nearest_ = 1e300;
    farthest_ = reach_ = 0;
    for (uint32_t i = 0; i < body_count_; ++i) {
        if (!addPoint(cloud, body_[i])) return false;
        const double w = glm::dot(frame.w, body_[i]);
        nearest_ = std::min(nearest_, w);
        farthest_ = std::max(farthest_, w);
        reach_ = std::max(reach_, sizeOf(body_[i]));
    }
    // So far a corner may be elsewhere in the image, and twice that; and what rounding does to one far beside it.
    const double scale = std::max(glm::length(frame.x), glm::length(frame.y));
    double beside = scale * reach_ / nearest_;
    for (uint32_t i = 0; i < cloud.count; ++i)
        beside = std::max({beside, std::abs(cloud.point[i].x), std::abs(cloud.point[i].y)});
    margin_ = kMargin + 4.0 * scale * error / nearest_ + 0x1p-48 * beside;
    if (!(margin_ < kMostMargin)) return false;
    Piece piece, rest;
    if (!std::isfinite(reach_) || !cloud.outline(piece)) return false;
    const double edge = 1.0 + margin_;
    for (const glm::dvec3& side :
         {glm::dvec3(1, 0, edge), glm::dvec3(-1, 0, edge), glm::dvec3(0, 1, edge), glm::dvec3(0, -1, edge)}) {
        uint32_t crossing = 0;
        const Meets how = meets(piece, &side, 1, crossing);
        if (how == Meets::kWhole) continue;
        Piece within;
        if (!split(piece, side, within, rest)) return false;
        piece = within;
    }
    if (piece.count > 0) pieces()[piece_count_++] = piece;
    return true;
}

/// Points in the image whose hull is that of what of the body is not above a plane.
/// @returns false if they cannot be told
bool Uncovered::cutOff(const glm::dvec4& plane, Cloud& cloud) const {
    SIGHTLINE_DEBUG_ASSERT(body_count_ <= kMostPoints && (!is_box_ || body_count_ == 8));
    double height[kMostPoints];
    bool none = true;
    for (uint32_t i = 0; i < body_count_; ++i) {
        height[i] = glm::dot(glm::dvec3(plane), body_[i]) + plane.w;
        none = none && height[i] > 0;
    }
    cloud.count = 0;
    if (none) return true;
    for (uint32_t i = 0; i < body_count_; ++i) {
        if (height[i] > 0) continue;
        if (!addPoint(cloud, body_[i])) return false;
        for (uint32_t k = 0; k < body_count_; ++k) {
            if (height[k] <= 0 || (is_box_ && !std::has_single_bit(i ^ k))) continue;
            if (!addPoint(cloud, body_[i] + height[i] / (height[i] - height[k]) * (body_[k] - body_[i]))) return false;
        }
    }
    return true;
}

/// Whether all points lie beyond one side of a piece.
bool Uncovered::isBeside(const Cloud& cloud, const Piece& piece) const {
    for (uint32_t i = 0; i < piece.count; ++i) {
        const glm::dvec2 a = piece.corner[i], side = piece.corner[i + 1 == piece.count ? 0 : i + 1] - a;
        const double least = 2.0 * margin_ * glm::length(side);
        bool beyond = true;
        for (uint32_t k = 0; k < cloud.count && beyond; ++k) beyond = cross(side, cloud.point[k] - a) < -least;
        if (beyond) return true;
    }
    return false;
}

/// How a piece lies to lines, and a bit for each that crosses it.
Uncovered::Meets Uncovered::meets(const Piece& piece, const glm::dvec3* lines, uint32_t count, uint32_t& crossing) {
    SIGHTLINE_DEBUG_ASSERT(count <= 32);
    crossing = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 line = lines[i];
        bool some = false, all = true;
        for (uint32_t k = 0; k < piece.count; ++k) {
            const bool within = line.x * piece.corner[k].x + line.y * piece.corner[k].y + line.z >= 0;
            some |= within;
            all &= within;
        }
        if (!some) return Meets::kNot;
        crossing |= uint32_t{!all} << i;
    }
    return crossing ? Meets::kPartly : Meets::kWhole;
}

/// What of a piece lies within lines; what lies outside of one is added to the next pieces.
/// @returns null if there is no room
const Uncovered::Piece* Uncovered::cutAlong(const Piece& piece, const glm::dvec3* lines, uint32_t crossing,
                                            Piece* both) {
    SIGHTLINE_DEBUG_ASSERT(&piece != &both[0] && &piece != &both[1]);
    const Piece* left = &piece;
    uint32_t at = 0;
    for (; crossing && left->count > 0; crossing &= crossing - 1) {
        Piece outside;
        if (!split(*left, lines[std::countr_zero(crossing)], both[at], outside) || !push(outside)) return nullptr;
        left = &both[at];
        at = 1 - at;
    }
    return left;
}

/// Adds what lies before a face to the next pieces.
bool Uncovered::keepBefore(const Piece& piece, const Piece& before) {
    Piece both[2], outside;
    both[0] = piece;
    uint32_t at = 0;
    for (uint32_t i = 0; i < before.count && both[at].count > 0; ++i) {
        const glm::dvec2 a = before.corner[i], b = before.corner[(i + 1) % before.count];
        const double length = glm::length(b - a);
        if (!(length > 0)) continue;
        const glm::dvec2 in = glm::dvec2(a.y - b.y, b.x - a.x) / length;
        if (!split(both[at], {in, margin_ - glm::dot(in, a)}, both[1 - at], outside)) return false;
        at = 1 - at;
    }
    return push(both[at]);
}

double Uncovered::share(const Shadow& shadow) {
    SIGHTLINE_DEBUG_ASSERT(piece_count_ <= kMostPieces);
    if (!subtract(shadow)) return 0;
    double before = 0, after = 0;
    for (uint32_t i = 0; i < piece_count_; ++i) before += pieces()[i].area();
    for (uint32_t i = 0; i < next_count_; ++i) after += next()[i].area();
    return next_count_ == 0 ? 1.0 : std::max(0.0, 1.0 - after / before);
}

/// Leaves in the next pieces what a shadow leaves.
/// @returns false if it hides nothing, or it cannot be told
bool Uncovered::subtract(const Shadow& shadow) {
    glm::dvec3 lines[OccluderVolume::kMaxPlanes];
    for (uint32_t i = 0; i < shadow.line_count; ++i) {
        lines[i] = shadow.lines[i].line;
        lines[i].z -= 2.0 * (shadow.lines[i].still + error_) / nearest_ + kMargin;
    }
    SIGHTLINE_DEBUG_ASSERT(shadow.face_count <= Shadow::kMostFaces && nearest_ > 0);
    Cloud before[Shadow::kMostFaces];
    Piece outlines[Shadow::kMostFaces];
    bool known = false, outlined[Shadow::kMostFaces] = {};
    next_count_ = 0;
    for (uint32_t i = 0; i < piece_count_; ++i) {
        const Piece& piece = pieces()[i];
        uint32_t crossing = 0;
        if (meets(piece, lines, shadow.line_count, crossing) == Meets::kNot) {
            if (!push(piece)) return false;
            continue;
        }
        ++cuts_;
        const uint32_t kept = next_count_;
        Piece both[2];
        const Piece* const within = cutAlong(piece, lines, crossing, both);
        if (!within) return false;
        if (within->count == 0) {  // it misses the piece after all
            next_count_ = kept;
            if (!push(piece)) return false;
            continue;
        }
        for (uint32_t face = 0; face < shadow.face_count && !known; ++face) {
            const glm::dvec4& plane = shadow.faces[face];
            const double slack = shadow.slack[face][0] + 2.0 * error_ + (shadow.slack[face][1] + 1e-12) * reach_;
            if (!cutOff({glm::dvec3(plane), plane.w - slack - 1e-12 * std::abs(plane.w)}, before[face])) return false;
        }
        known = true;
        for (uint32_t face = 0; face < shadow.face_count; ++face) {
            if (before[face].count == 0 || isBeside(before[face], *within)) continue;
            if (!outlined[face] && !before[face].outline(outlines[face])) return false;
            outlined[face] = true;
            if (!keepBefore(*within, outlines[face])) return false;
        }
    }
    return known;
}

double Uncovered::remove(const Shadow& shadow, double least) {
    const double taken = share(shadow);
    if (!(taken > least)) return 0;
    takeNext();
    return taken;
}

void Uncovered::takeNext() {
    SIGHTLINE_DEBUG_ASSERT(next_count_ <= kMostPieces);
    now_ = 1 - now_;
    piece_count_ = next_count_;
}

void Uncovered::take(const Shadow& shadow) {
    if (subtract(shadow)) takeNext();
}

const Uncovered::Piece& Uncovered::largest() const {
    SIGHTLINE_DEBUG_ASSERT(piece_count_ > 0);
    uint32_t at = 0;
    double most = -1;
    for (uint32_t i = 0; i < piece_count_; ++i)
        if (const double area = pieces()[i].area(); area > most) most = area, at = i;
    return pieces()[at];
}

glm::dvec3 Uncovered::direction() const {
    const Piece& piece = largest();
    glm::dvec2 middle(0.0);
    for (uint32_t i = 0; i < piece.count; ++i) middle += piece.corner[i];
    middle /= piece.count;
    return frame_.back * glm::dvec3(middle, 1.0);
}

uint32_t Uncovered::besideSlit(bool around, glm::dvec3 (&directions)[8]) const {
    constexpr double kNarrow = 1e-3, kWidest = 1e-4;  // of its length; of the image's half width
    constexpr double kSmall = 1e-3;                   // the same
    const Piece& piece = largest();
    glm::dvec2 along(0.0), middle(0.0);
    for (uint32_t i = 0; i < piece.count; ++i) {
        const glm::dvec2 side = piece.corner[(i + 1) % piece.count] - piece.corner[i];
        if (glm::dot(side, side) > glm::dot(along, along)) along = side;
        middle += piece.corner[i] / static_cast<double>(piece.count);
    }
    const double length = glm::length(along), width = piece.area() / length;
    if (around ? !(length < kSmall) : !(width < kNarrow * length && width < kWidest)) return 0;
    constexpr double kSlant = 0.7071067811865476;  // no cosine: C libraries differ in its last bit
    constexpr double kUp[8] = {1, -1, 0, 0, kSlant, kSlant, -kSlant, -kSlant};
    constexpr double kRight[8] = {0, 0, 1, -1, kSlant, -kSlant, kSlant, -kSlant};
    const double away = (around ? 2 * length : 4 * width) + 1e-8;
    const glm::dvec2 right = away / length * along, up(-right.y, right.x);
    const uint32_t count = around ? 8 : 2;
    for (uint32_t i = 0; i < count; ++i)
        directions[i] = frame_.back * glm::dvec3(middle + kUp[i] * up + kRight[i] * right, 1.0);
    return count;
}

}  // namespace sightline
