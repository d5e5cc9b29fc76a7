// Makes the shadow volume of a convex occluder for one view, in double, with bounds on all rounding.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cull/occluder_volumes.h"

namespace sightline {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWorstTurn = 1e-3;  // by which a plane may be turned inward before the volume is given up

/// A face as the view sees it.
struct Front {
    glm::dvec3 normal{0.0};  ///< world space, out of the side that the eye sees
    double near = 0;         ///< all of the face lies at least so far below the eye, against the normal
    double far = 0;          ///< and at most so far
    bool flipped = false;    ///< the side that is seen is the back of a double-sided face
    bool seen = false;
};

Front frontOf(const VolumeView& view, const VolumePlace& place, const VolumeFace& face, bool flipped) {
    Front front;
    front.flipped = flipped;
    const glm::dvec3 wanted = flipped ? -face.normal : face.normal;
    const double low = flipped ? -face.high : face.low, high = flipped ? -face.low : face.high;
    const glm::dvec3 normal = place.covector * wanted;
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) return front;
    front.normal = normal / length;
    // dot(normal, A v + shift) = dot(A^T normal, v) + dot(normal, shift); A^T normal is the face's own normal, to scale
    // and up to rounding, which is looked at rather than estimated.
    const double scale = 1.0 / length;
    const glm::dvec3 rest = glm::transpose(place.linear) * front.normal - scale * wanted;
    const double slack = glm::dot(glm::abs(rest), place.extent) + 3.0 * place.error;
    const double shift = glm::dot(front.normal, place.shift);
    front.near = -(scale * high + shift) - slack;
    front.far = -(scale * low + shift) + slack;
    front.seen = view.screen.perspective ? front.near > 0.0 : glm::dot(front.normal, view.direction) < -0x1p-20;
    return front;
}

/// Puts a volume together; gives up where a plane would be known too badly.
struct Maker {
    const VolumeView& view;
    const VolumePlace& place;
    const VolumePart part;
    OccluderVolume& volume;
    VolumeOutline& outline;
    Front fronts[VolumePart::kMaxFaces] = {};
    uint32_t seen = 0;  ///< bit per face of the part
    uint8_t kept[OccluderVolume::kMaxOutline] = {};
    uint32_t kept_count = 0;
    double farthest = 0;  ///< corner of the outline

    const VolumeFace& face(uint32_t i) const {
        SIGHTLINE_DEBUG_ASSERT(i < part.face_count && part.first_face + i < place.parts->members.size());
        return place.parts->faces[place.parts->members[part.first_face + i]];
    }
    glm::dvec3 corner(uint32_t i) const {
        SIGHTLINE_DEBUG_ASSERT(i < place.parts->corners.size());
        return place.linear * place.parts->corners[i] + place.shift;
    }

    bool make();
    bool addAllBut(const VolumeFace& face, uint32_t side, bool& reverse);
    void look();
    bool trace();
    bool traceFace();
    bool traceBody();
    bool isBefore() const;
    void thin();
    bool addPlane(const glm::dvec3& normal, double distance, double still, double turn);
    bool addSide(uint32_t from, uint32_t to);
    bool addFace(const Front& front);
    bool addNear(const VolumeFace& face, const Front& front);
    double lost(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;
};

void Maker::look() {
    SIGHTLINE_DEBUG_ASSERT(part.face_count > 0 && part.face_count <= VolumePart::kMaxFaces);
    seen = 0;
    for (uint32_t i = 0; i < part.face_count; ++i) {
        fronts[i] = frontOf(view, place, face(i), false);
        if (part.face_count == 1 && !fronts[i].seen && face(i).double_sided)
            fronts[i] = frontOf(view, place, face(i), true);
        if (fronts[i].seen) seen |= 1u << i;
    }
}

bool Maker::traceFace() {
    const VolumeFace& only = face(0);
    const bool reverse = place.flips != fronts[0].flipped;
    SIGHTLINE_DEBUG_ASSERT(only.count >= 3 && only.count <= OccluderVolume::kMaxOutline);
    for (uint32_t i = 0; i < only.count; ++i)
        outline.corner[i] = corner(place.parts->outline[only.first + (reverse ? only.count - 1 - i : i)]);
    outline.count = only.count;
    return true;
}

/// The sides between what is seen and what is not, one after the other.
bool Maker::traceBody() {
    struct Directed {
        uint32_t from, to;
    };
    SIGHTLINE_DEBUG_ASSERT(part.first_edge + part.edge_count <= place.parts->edges.size());
    Directed open[OccluderVolume::kMaxOutline];
    uint32_t count = 0;
    const auto isSeen = [&](uint8_t f) { return f != VolumeEdge::kNone && (seen >> f & 1); };
    for (uint32_t e = part.first_edge; e < part.first_edge + part.edge_count; ++e) {
        const VolumeEdge& edge = place.parts->edges[e];
        const bool left = isSeen(edge.left), right = isSeen(edge.right);
        if (left == right) continue;
        if (count == OccluderVolume::kMaxOutline) return false;
        open[count++] = left != place.flips ? Directed{edge.from, edge.to} : Directed{edge.to, edge.from};
    }
    if (count < 3) return false;
    outline.count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        outline.corner[outline.count++] = corner(open[i].from);
        if (i + 1 == count) return open[i].to == open[0].from;
        uint32_t next = i + 1;
        while (next < count && open[next].from != open[i].to) ++next;
        if (next == count) return false;
        std::swap(open[i + 1], open[next]);
    }
    return false;
}

/// Whether all corners that are seen lie before the eye, in the direction of the face that it is farthest in front of.
bool Maker::isBefore() const {
    if (!view.screen.perspective) return true;
    uint32_t best = 0;
    double most = 0;
    for (uint32_t i = 0; i < part.face_count; ++i)
        if ((seen >> i & 1) && fronts[i].near > most) most = fronts[best = i].near;
    for (uint32_t i = 0; i < part.face_count; ++i) {
        if (!(seen >> i & 1) || i == best) continue;
        const VolumeFace& f = face(i);
        for (uint32_t k = f.first; k < f.first + f.count; ++k)
            if (!(-glm::dot(fronts[best].normal, corner(place.parts->outline[k])) >
                  place.norm * f.reach + 2.0 * place.error))
                return false;
    }
    return most > 0;
}

bool Maker::trace() {
    if (!(part.face_count == 1 ? traceFace() : traceBody())) return false;
    farthest = 0;
    for (uint32_t i = 0; i < outline.count; ++i) farthest = std::max(farthest, glm::length(outline.corner[i]));
    return std::isfinite(farthest);
}

/// What the image loses if b is left out of the outline; for choosing.
double Maker::lost(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
    if (!view.screen.perspective) return std::abs(glm::dot(view.direction, glm::cross(b - a, c - a)));
    return std::abs(glm::dot(a, glm::cross(b, c))) / (glm::length(a) * glm::length(b) * glm::length(c));
}

/// Leaves out the corners that matter least, until there are few enough sides.
void Maker::thin() {
    SIGHTLINE_DEBUG_ASSERT(outline.count >= 3 && outline.count <= OccluderVolume::kMaxOutline);
    kept_count = outline.count;
    for (uint32_t i = 0; i < kept_count; ++i) kept[i] = static_cast<uint8_t>(i);
    while (kept_count > OccluderVolume::kMaxSides) {
        uint32_t least = 0;
        double least_lost = 1e300;
        for (uint32_t i = 0; i < kept_count; ++i) {
            const auto at = [&](uint32_t k) { return outline.corner[kept[k % kept_count]]; };
            const double value = lost(at(i + kept_count - 1), at(i), at(i + 1));
            if (value < least_lost) least_lost = value, least = i;
        }
        std::copy(kept + least + 1, kept + kept_count, kept + least);
        --kept_count;
    }
}

/// @param still  slack that is the same everywhere  [world units]
/// @param turn   slack per distance from the eye
bool Maker::addPlane(const glm::dvec3& normal, double distance, double still, double turn) {
    SIGHTLINE_DEBUG_ASSERT(volume.planes <= OccluderVolume::kMaxPlanes);
    if (volume.planes == OccluderVolume::kMaxPlanes) return false;
    if (!(turn < kWorstTurn) || !std::isfinite(distance) || !std::isfinite(still)) return false;
    // As in the frustum's test: ten roundings of 2^-24 stay under 2^-19 of the sum of the sizes.
    constexpr double kRounding = 0x1p-19, kUp = 1.0 + 0x1p-20;
    const uint32_t at = volume.planes++;
    for (int axis = 0; axis < 3; ++axis) volume.normal[at][axis] = static_cast<float>(normal[axis]);
    volume.distance[at] = static_cast<float>(distance);
    volume.slack[at][0] = static_cast<float>(kUp * (still + 2.0 * view.place_error + kRounding * std::abs(distance)));
    volume.slack[at][1] = static_cast<float>(kUp * (turn + kRounding));
    return true;
}

/// The plane through the eye and a side, with the corners that the side leaves out.
///
/// With the true corners a + da and b + db, the plane's determinant at p is that of a and b, but for at most
/// |p| (|da| |b| + |a| |db| + |da| |db|); divided by the length of b x a that is the slack's turn.
bool Maker::addSide(uint32_t from, uint32_t to) {
    SIGHTLINE_DEBUG_ASSERT(from < outline.count && to < outline.count && from != to);
    const glm::dvec3 a = outline.corner[from], b = outline.corner[to];
    const double length_a = glm::length(a), length_b = glm::length(b), apart = glm::length(b - a), e = place.error;
    const bool perspective = view.screen.perspective;
    const glm::dvec3 normal = perspective ? glm::cross(b, a) : glm::cross(b - a, view.direction);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return false;
    const glm::dvec3 unit = normal / length;
    double still = 0, turn = 0, distance = 0;
    if (perspective) {
        turn = (e * (length_a + length_b + e) + 0x1p-49 * length_a * length_b) / length;
    } else {
        distance = -glm::dot(unit, a);
        turn = (0x1p-46 * apart + 2.0 * e) / length;
        still = turn * length_a + e * apart / length + e + 0x1p-49 * length_a;
    }
    if ((from + 1) % outline.count == to) return addPlane(unit, distance, still, turn);
    // Corners are left out between a and b. Where their directions lie within 60 degrees of one, a sum of them with
    // factors of zero and more is at least half as long as its terms together: it rises no higher, in proportion, than
    // twice what the highest does.
    const glm::dvec3 middle = a / length_a + b / length_b;
    const double middle_length = glm::length(middle);
    double highest = 0;
    for (uint32_t i = from;; i = (i + 1) % outline.count) {
        const glm::dvec3& v = outline.corner[i];
        const double length_v = glm::length(v), height = glm::dot(unit, v) + distance + e + 0x1p-49 * length_v;
        if (perspective) {
            if (!(length_v > 1e3 * e) || !(glm::dot(middle, v) > 0.51 * middle_length * length_v)) return false;
            highest = std::max(highest, 2.01 * height / length_v);
        } else {
            highest = std::max(highest, height);
        }
        if (i == to) break;
    }
    return perspective ? addPlane(unit, distance, still, turn + highest)
                       : addPlane(unit, distance, still + highest, turn);
}

/// The plane behind all of a face.
bool Maker::addFace(const Front& front) { return addPlane(-front.normal, -front.far, place.error, 0x1p-50); }

/// Keeps hits on the face beyond the near plane's guard: G of the header.
bool Maker::addNear(const VolumeFace& face, const Front& front) {
    const glm::dvec3 row(view.near);
    const double error = place.error + 0x1p-47 * (farthest + std::abs(view.near.w));
    const double guard = view.near_guard + error;
    double nearest = 1e300;
    for (uint32_t k = face.first; k < face.first + face.count; ++k)
        nearest = std::min(nearest, glm::dot(row, corner(place.parts->outline[k])) + view.near.w);
    if (nearest - place.norm * face.reach - error >= guard) return true;
    constexpr double kUp = 1.0 + 0x1p-40;
    double factor = 0, least = 0;
    if (view.screen.perspective) {
        factor = kUp * (guard - view.near.w) / front.near;
    } else {
        factor = -kUp * glm::dot(row, view.direction) / glm::dot(front.normal, view.direction);
        least = guard - view.near.w - factor * front.near;
    }
    const glm::dvec3 normal = row + factor * front.normal;
    const double length = glm::length(normal);
    const double turn = 0x1p-46 * (1.0 + factor) / length;
    if (!(length > 0.0)) return false;
    return addPlane(normal / length, -least / length, 0x1p-46 * std::abs(least) / length, turn);
}

bool Maker::make() {
    look();
    if (!seen || !trace() || !isBefore()) return false;
    volume.planes = 0;
    thin();
    for (uint32_t i = 0; i < kept_count; ++i)
        if (!addSide(kept[i], kept[(i + 1) % kept_count])) return false;
    for (uint32_t i = 0; i < part.face_count; ++i)
        if ((seen >> i & 1) && !(addFace(fronts[i]) && addNear(face(i), fronts[i]))) return false;
    return true;
}

/// The planes of a face, but for that of a side.
/// @param reverse  receives whether its outline is seen to run the other way round
bool Maker::addAllBut(const VolumeFace& of, uint32_t side, bool& reverse) {
    SIGHTLINE_DEBUG_ASSERT(side < of.count);
    Front front = frontOf(view, place, of, false);
    if (!front.seen && of.double_sided) front = frontOf(view, place, of, true);
    if (!front.seen || of.count > OccluderVolume::kMaxSides) return false;
    reverse = place.flips != front.flipped;
    outline.count = of.count;
    farthest = 0;
    for (uint32_t k = 0; k < of.count; ++k) {
        outline.corner[k] = corner(place.parts->outline[of.first + (reverse ? of.count - 1 - k : k)]);
        farthest = std::max(farthest, glm::length(outline.corner[k]));
    }
    if (!std::isfinite(farthest)) return false;
    const uint32_t left_out = reverse ? (2 * of.count - 2 - side) % of.count : side;
    for (uint32_t k = 0; k < of.count; ++k)
        if (k != left_out && !addSide(k, (k + 1) % of.count)) return false;
    return addFace(front) && addNear(of, front);
}

}  // namespace

VolumeView makeVolumeView(const View& view, const Screen& screen, const glm::dvec3& offset) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    VolumeView out;
    out.screen = screen;
    const glm::dvec3 x(screen.x), y(screen.y), w(screen.w), near(screen.near);
    const double length = glm::length(near);
    out.near = screen.near / length;
    out.near_guard = screen.near_guard / length;
    const auto sizeOf = [](const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
    out.eye_error = 0x1p-48 * (sizeOf(screen.eye) + sizeOf(glm::dvec3(view.view[3])));
    out.place_error = out.eye_error + 0x1p-50 * sizeOf(offset);
    if (screen.perspective) {
        out.pixels_at_one = std::abs(glm::dot(glm::cross(x, y), w));
        // Rays meet in the eye if nothing is added to the rows there; and the eye must lie before the near plane.
        out.usable = screen.x.w == 0 && screen.y.w == 0 && screen.w.w == 0 && out.near.w < 0;
    } else {
        const glm::dvec3 along = glm::cross(x, y);
        out.direction = along / glm::length(along);
        if (glm::dot(out.direction, near) < 0) out.direction = -out.direction;
        out.pixels_at_one = glm::length(along) / (screen.w.w * screen.w.w);
        out.usable = screen.w.w > 0 && glm::dot(out.direction, near) > 0x1p-20 * length;
    }
    out.usable = out.usable && out.pixels_at_one > 0 && std::isfinite(out.pixels_at_one) && std::isfinite(out.near.w);
    return out;
}

VolumePlace placeParts(const VolumeView& view, const VolumeParts& parts, const Box3f& bounds,
                       const glm::dmat4& transform) {
    VolumePlace place;
    place.parts = &parts;
    place.linear = glm::dmat3(transform);
    const double determinant = glm::determinant(place.linear);
    place.flips = determinant < 0;
    place.covector = glm::transpose(glm::inverse(place.linear));
    place.shift = glm::dvec3(transform[3]) - view.screen.eye;
    const glm::dmat3 back = glm::transpose(place.covector);
    place.eye = view.screen.perspective ? back * -place.shift : back * view.direction;
    double size = 0, squares = 0;
    for (int row = 0; row < 3; ++row) {
        place.extent[row] = std::max<double>(std::abs(bounds.min[row]), std::abs(bounds.max[row]));
        size += std::abs(transform[3][row]) + std::abs(view.screen.eye[row]);
    }
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const double a = place.linear[column][row];
            squares += a * a;
            size += std::abs(a) * place.extent[column];
        }
    place.norm = 1.0001 * std::sqrt(squares);
    place.error = 0x1p-49 * size + view.eye_error;  // as OccluderInstance: sixteen roundings of 2^-53
    place.usable = view.usable && determinant != 0 && std::isfinite(place.norm) && std::isfinite(place.error) &&
                   std::isfinite(place.covector[0][0] + place.covector[1][1] + place.covector[2][2]);
    return place;
}

double roughPixels(const VolumeView& view, const VolumePlace& place, uint32_t index) {
    SIGHTLINE_DEBUG_ASSERT(index < place.parts->parts.size());
    const VolumePart& part = place.parts->parts[index];
    const double away = glm::length(part.center - place.eye) - part.radius;
    double sum = 0;
    for (uint32_t i = 0; i < part.face_count; ++i) {
        const VolumeFace& face = place.parts->faces[place.parts->members[part.first_face + i]];
        const bool both = part.face_count == 1 && face.double_sided;
        const double height = view.screen.perspective ? glm::dot(face.normal, place.eye - face.center)
                                                      : -glm::dot(face.normal, place.eye) / glm::length(place.eye);
        const double front = both ? std::abs(height) : height;
        if (!(front > 0)) continue;
        if (!view.screen.perspective) {
            sum += face.area * front * place.norm * place.norm / 3.0;
            continue;
        }
        const double distance = std::max(front, away);
        sum += std::min(2.0 * kPi, face.area * front / (distance * distance * distance));
    }
    return sum * view.pixels_at_one;
}

bool makeVolume(const VolumeView& view, const VolumePlace& place, uint32_t part, OccluderVolume& volume,
                VolumeOutline& outline) {
    if (!place.usable) return false;
    SIGHTLINE_DEBUG_ASSERT(view.usable && part < place.parts->partCount());
    Maker maker{view, place, place.parts->part(part), volume, outline};
    return maker.make();
}

bool makeSeamVolume(const VolumeView& view, const VolumePlace& one, const VolumePlace& other, const VolumeSeam& seam,
                    OccluderVolume& volume) {
    if (!one.usable || !other.usable || !view.screen.perspective) return false;
    SIGHTLINE_DEBUG_ASSERT(seam.face[0] < one.parts->faces.size() && seam.face[1] < other.parts->faces.size());
    VolumeOutline outline;
    volume.planes = 0;
    Maker makers[2] = {{view, one, VolumePart(), volume, outline}, {view, other, VolumePart(), volume, outline}};
    bool reverse[2];
    return makers[0].addAllBut(one.parts->faces[seam.face[0]], seam.side[0], reverse[0]) &&
           makers[1].addAllBut(other.parts->faces[seam.face[1]], seam.side[1], reverse[1]) && reverse[0] == reverse[1];
}

double visiblePixels(const VolumeView& view, const VolumeOutline& outline) {
    glm::dvec4 points[2][OccluderVolume::kMaxOutline + 8];
    uint32_t count = outline.count;
    SIGHTLINE_DEBUG_ASSERT(count <= OccluderVolume::kMaxOutline);
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec4 q(outline.corner[i], 1.0);
        points[0][i] = {glm::dot(view.screen.x, q), glm::dot(view.screen.y, q), glm::dot(view.screen.w, q),
                        glm::dot(view.screen.near, q) - view.screen.near_guard};
    }
    const double width = view.screen.width, height = view.screen.height;
    const glm::dvec4 sides[5] = {{0, 0, 0, 1}, {1, 0, 0, 0}, {-1, 0, width, 0}, {0, 1, 0, 0}, {0, -1, height, 0}};
    int now = 0;
    for (const glm::dvec4& side : sides) {
        const glm::dvec4* in = points[now];
        glm::dvec4* out = points[1 - now];
        uint32_t made = 0;
        for (uint32_t i = 0; i < count && made + 2 < OccluderVolume::kMaxOutline + 8; ++i) {
            const glm::dvec4 &a = in[i], &b = in[(i + 1) % count];
            const double at_a = glm::dot(side, a), at_b = glm::dot(side, b);
            if (at_a >= 0) out[made++] = a;
            if ((at_a >= 0) != (at_b >= 0)) out[made++] = a + (at_a / (at_a - at_b)) * (b - a);
        }
        count = made;
        now = 1 - now;
    }
    double area = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec4 &a = points[now][i], &b = points[now][(i + 1) % count];
        if (!(a.z > 0 && b.z > 0)) return 0;
        area += (a.x * b.y - a.y * b.x) / (a.z * b.z);
    }
    return 0.5 * std::abs(area);
}

bool holds(const OccluderVolume& volume, const VolumeOutline& outline) {
    for (uint32_t plane = 0; plane < volume.planes; ++plane) {
        const glm::dvec3 normal(volume.normal[plane][0], volume.normal[plane][1], volume.normal[plane][2]);
        for (uint32_t i = 0; i < outline.count; ++i) {
            const glm::dvec3& q = outline.corner[i];
            const double reach = std::abs(q.x) + std::abs(q.y) + std::abs(q.z);
            if (!(glm::dot(normal, q) + volume.distance[plane] >
                  volume.slack[plane][0] + volume.slack[plane][1] * reach))
                return false;
        }
    }
    return true;
}

}  // namespace sightline
