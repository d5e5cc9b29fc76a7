// The walls, slabs and ceilings of a procedural building: one closed surface, cut into named parts.
// SPDX-License-Identifier: MIT
//
// Mark de Berg, Otfried Cheong, Marc van Kreveld, Mark Overmars. Computational Geometry. 2008. (Monotone polygons.)
#include "sightline/tools/scene/building/shell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "sightline/base/assert.h"
#include "sightline/tools/scene/building/library.h"
#include "sightline/tools/scene/solids.h"

namespace sightline::tools::building {
namespace {

constexpr int32_t kSolid = -1, kAir = 0;  // otherwise 1 + room

/// A rectangle of the surface; u and v are the axes after `axis`, in turn.
struct Face {
    int axis = 0;
    bool positive = false;  ///< looks along +axis
    double at = 0;
    double low[2]{}, high[2]{};  ///< u, v
    uint32_t floor = 0;
    int32_t owner = 0;  ///< of the air in front
};

/// One floor as boxes of air or solid between all the planes that bound anything in it.
class FloorGrid {
public:
    FloorGrid(const Plan& plan, uint32_t index) : plan_(plan), floor_(plan.floors[index]), index_(index) {
        collectPlanes();
        owners_.assign(cells(0) * cells(1) * cells(2), kAir);
        fillSolid();
        for (uint32_t i = 0; i < floor_.rooms.size(); ++i) fill(airOf(i), static_cast<int32_t>(i) + 1);
        for (const Opening& opening : floor_.openings) fill(opening.hole, static_cast<int32_t>(opening.room) + 1);
    }

    void addFaces(std::vector<Face>& faces) const {
        for (int axis = 0; axis < 3; ++axis) {
            for (size_t plane = 0; plane < planes_[axis].size(); ++plane) {
                // What lies under a slab is the ceiling of the floor below, and its business.
                if (axis == 1 && plane == 0 && index_ > 0) continue;
                addPlane(axis, plane, true, faces);
                addPlane(axis, plane, false, faces);
            }
        }
    }

private:
    size_t cells(int axis) const { return planes_[axis].size() - 1; }
    bool isRoof() const { return index_ + 1 == plan_.floors.size(); }
    bool ground() const { return index_ == 0; }

    /// A shaft goes down through the slab as well.
    Box3d airOf(uint32_t room) const {
        Box3d box = floor_.rooms[room].box;
        const RoomKind kind = floor_.rooms[room].kind;
        const bool shaft = kind == RoomKind::kStairs || kind == RoomKind::kLift;
        if (shaft && !ground()) box.min.y = floor_.level - kSlab;
        box.max.y = std::min(box.max.y, floor_.ceiling);
        return box;
    }

    void collectPlanes() {
        const auto add = [&](const Box3d& box) {
            for (int axis = 0; axis < 3; ++axis) {
                planes_[axis].push_back(box.min[axis]);
                planes_[axis].push_back(box.max[axis]);
            }
        };
        const auto whole = [&](const Rect& rect) {
            add({{rect.min.x, floor_.level - kSlab, rect.min.y}, {rect.max.x, floor_.ceiling, rect.max.y}});
        };
        whole(plan_.footprint);
        if (ground()) whole(plan_.plot);
        for (uint32_t i = 0; i < floor_.rooms.size(); ++i) add(airOf(i));
        for (const Opening& opening : floor_.openings) add(opening.hole);
        planes_[1].push_back(floor_.level);
        for (std::vector<double>& planes : planes_) {
            std::sort(planes.begin(), planes.end());
            planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
        }
    }

    size_t planeAt(int axis, double at) const {
        const std::vector<double>& planes = planes_[axis];
        return static_cast<size_t>(std::lower_bound(planes.begin(), planes.end(), at) - planes.begin());
    }

    size_t number(const std::array<size_t, 3>& c) const { return (c[1] * cells(2) + c[2]) * cells(0) + c[0]; }

    void fill(const Box3d& box, int32_t owner) {
        std::array<size_t, 3> from, to, c;
        for (int axis = 0; axis < 3; ++axis) {
            from[axis] = planeAt(axis, box.min[axis]);
            to[axis] = planeAt(axis, box.max[axis]);
        }
        for (c[1] = from[1]; c[1] < to[1]; ++c[1])
            for (c[2] = from[2]; c[2] < to[2]; ++c[2])
                for (c[0] = from[0]; c[0] < to[0]; ++c[0]) owners_[number(c)] = owner;
    }

    void fillSolid() {
        const Rect &slab = ground() ? plan_.plot : plan_.footprint, &walls = plan_.footprint;
        const double foot = floor_.level - kSlab;
        fill({{slab.min.x, foot, slab.min.y}, {slab.max.x, floor_.level, slab.max.y}}, kSolid);
        fill({{walls.min.x, floor_.level, walls.min.y}, {walls.max.x, floor_.ceiling, walls.max.y}}, kSolid);
    }

    /// What is above the topmost boxes: the next slab, which has holes for the shafts.
    int32_t above(std::array<size_t, 3> c) const {
        if (isRoof()) return kAir;
        const Rect& slab = plan_.footprint;
        const double x = planes_[0][c[0]], z = planes_[2][c[2]];
        if (x < slab.min.x || x >= slab.max.x || z < slab.min.y || z >= slab.max.y) return kAir;
        --c[1];
        const int32_t owner = owners_[number(c)];
        const bool open = owner > 0 && floor_.rooms[static_cast<size_t>(owner) - 1].box.max.y > floor_.ceiling;
        return open ? owner : kSolid;
    }

    /// @param c  may lie one beyond either end
    int32_t ownerAt(const std::array<size_t, 3>& c) const {
        if (c[1] == cells(1)) return above(c);
        for (int axis = 0; axis < 3; ++axis)
            if (c[axis] >= cells(axis)) return kAir;  // before the first wraps around
        return owners_[number(c)];
    }

    /// The faces in one plane that look one way, as few rectangles as a greedy search gives: walls are cut into
    /// pieces of full height.
    void addPlane(int axis, size_t plane, bool positive, std::vector<Face>& faces) const {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const bool v_first = v == 1;  // grow upward first
        const int fast = v_first || axis == 1 ? v : u, slow = fast == v ? u : v;
        const size_t wide = cells(fast), high = cells(slow);
        std::vector<int32_t> tags(wide * high, -1);
        for (size_t s = 0; s < high; ++s) {
            for (size_t f = 0; f < wide; ++f) {
                std::array<size_t, 3> front, back;
                front[fast] = back[fast] = f;
                front[slow] = back[slow] = s;
                front[axis] = positive ? plane : plane - 1;
                back[axis] = positive ? plane - 1 : plane;
                const int32_t owner = ownerAt(front);
                if (owner != kSolid && ownerAt(back) == kSolid) tags[s * wide + f] = owner;
            }
        }
        for (size_t s = 0; s < high; ++s) {
            for (size_t f = 0; f < wide; ++f) {
                const int32_t tag = tags[s * wide + f];
                if (tag < 0) continue;
                size_t f1 = f + 1, s1 = s + 1;
                while (f1 < wide && tags[s * wide + f1] == tag) ++f1;
                const auto same = [&](size_t row) {
                    return std::all_of(tags.begin() + static_cast<std::ptrdiff_t>(row * wide + f),
                                       tags.begin() + static_cast<std::ptrdiff_t>(row * wide + f1),
                                       [&](int32_t other) { return other == tag; });
                };
                while (s1 < high && same(s1)) ++s1;
                for (size_t row = s; row < s1; ++row)
                    std::fill(tags.begin() + static_cast<std::ptrdiff_t>(row * wide + f),
                              tags.begin() + static_cast<std::ptrdiff_t>(row * wide + f1), -1);
                Face face{axis, positive, planes_[axis][plane], {}, {}, index_, tag};
                const int of_fast = fast == u ? 0 : 1;
                face.low[of_fast] = planes_[fast][f];
                face.high[of_fast] = planes_[fast][f1];
                face.low[1 - of_fast] = planes_[slow][s];
                face.high[1 - of_fast] = planes_[slow][s1];
                faces.push_back(face);
            }
        }
    }

    const Plan& plan_;
    const Floor& floor_;
    uint32_t index_;
    std::vector<double> planes_[3];
    std::vector<int32_t> owners_;
};

glm::dvec3 cornerOf(const Face& face, double u, double v) {
    glm::dvec3 corner;
    corner[face.axis] = face.at;
    corner[(face.axis + 1) % 3] = u;
    corner[(face.axis + 2) % 3] = v;
    return corner;
}

/// The corners of all faces, by the lines along an axis that they lie on.
class Corners {
public:
    void add(const Face& face) {
        for (const double u : {face.low[0], face.high[0]})
            for (const double v : {face.low[1], face.high[1]}) {
                const glm::dvec3 p = cornerOf(face, u, v);
                for (int axis = 0; axis < 3; ++axis)
                    lines_[axis].push_back({p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]});
            }
    }

    void sort() {
        for (std::vector<Entry>& line : lines_) {
            std::sort(line.begin(), line.end());
            line.erase(std::unique(line.begin(), line.end()), line.end());
        }
    }

    /// The corners from p to q, which differ in `axis` alone: p included, q not.
    void between(const glm::dvec3& p, const glm::dvec3& q, int axis, std::vector<glm::dvec3>& out) const {
        out.push_back(p);
        const double low = std::min(p[axis], q[axis]), high = std::max(p[axis], q[axis]);
        const Entry start{p[(axis + 1) % 3], p[(axis + 2) % 3], low};
        const size_t first = out.size();
        const std::vector<Entry>& line = lines_[axis];
        for (auto entry = std::upper_bound(line.begin(), line.end(), start); entry != line.end(); ++entry) {
            if ((*entry)[0] != start[0] || (*entry)[1] != start[1] || (*entry)[2] >= high) break;
            glm::dvec3 corner = p;
            corner[axis] = (*entry)[2];
            out.push_back(corner);
        }
        if (q[axis] < p[axis]) std::reverse(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
    }

private:
    using Entry = std::array<double, 3>;
    std::vector<Entry> lines_[3];
};

/// A face in triangles that use each corner of others on its rim.
void addFace(city::MeshBuilder& mesh, uint32_t material, const Face& face, const Corners& corners) {
    const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
    const glm::dvec3 a = cornerOf(face, face.low[0], face.low[1]), b = cornerOf(face, face.high[0], face.low[1]);
    const glm::dvec3 c = cornerOf(face, face.high[0], face.high[1]), d = cornerOf(face, face.low[0], face.high[1]);
    std::vector<glm::dvec3> rim;
    corners.between(a, b, u, rim);
    corners.between(b, c, v, rim);
    corners.between(c, d, u, rim);
    corners.between(d, a, v, rim);
    std::vector<glm::dvec2> outline;
    for (const glm::dvec3& p : rim) outline.push_back({p[u], p[v]});
    for (const auto& [i, j, k] : triangulateConvex(outline)) {
        if (face.positive) mesh.triangle(material, rim[i], rim[j], rim[k]);
        else mesh.triangle(material, rim[i], rim[k], rim[j]);
    }
}

uint32_t materialOf(const Plan& plan, const Face& face) {
    if (face.owner == kAir) {
        if (face.axis == 1 && face.floor == 0 && face.positive) return kGravel;
        return face.floor == 0 && face.axis != 1 ? kStone : face.axis == 1 ? kConcrete : kRender;
    }
    const RoomKind kind = plan.floors[face.floor].rooms[static_cast<size_t>(face.owner) - 1].kind;
    const bool ground = face.axis == 1 && face.positive, ceiling = face.axis == 1 && !face.positive;
    switch (kind) {
        case RoomKind::kRoof:
            return ground ? kGravel : kRender;
        case RoomKind::kLift:
            return kConcrete;
        case RoomKind::kBathroom:
            return ceiling ? kWhite : ground ? kDarkTile : kTile;
        case RoomKind::kKitchen:
            return ceiling ? kWhite : ground ? kDarkTile : kCream;
        case RoomKind::kStairs:
            return ceiling ? kWhite : ground ? kTerrazzo : kCream;
        case RoomKind::kLobby:
            return ceiling ? kWhite : ground ? kTerrazzo : kCream;
        case RoomKind::kStore:
            return ground ? kConcrete : kWhite;
        case RoomKind::kCorridor:
            return ceiling ? kWhite : ground ? kLinoleum : kCream;
        case RoomKind::kMeeting:
            return ceiling ? kWhite : ground ? kParquet : kWhite;
        default:
            return ground ? kCarpet : kWhite;
    }
}

const char* partName(const Plan& plan, const Face& face) {
    if (face.axis == 1) {
        if (face.owner == kAir)
            return face.floor + 1 == plan.floors.size() ? "Parapet" : face.positive ? "Ground" : "Underside";
        return face.positive ? "Floor" : "Ceiling";
    }
    // A facade is called after where it looks, a room's wall after where it stands.
    if (face.owner == kAir) {
        if (face.axis == 0) return face.positive ? "Facade east" : "Facade west";
        return face.positive ? "Facade south" : "Facade north";
    }
    if (face.axis == 0) return face.positive ? "West wall" : "East wall";
    return face.positive ? "North wall" : "South wall";
}

/// A facade's faces are a window wide: they are grouped by where they begin, so that no object is as long as the house.
int pieceOf(const Plan& plan, const Face& face) {
    constexpr double kPiece = 6;  // [metres]
    if (face.owner != kAir || face.axis == 1) return 0;
    const bool along_x = face.axis == 2;
    const double from = (face.floor == 0 ? plan.plot : plan.footprint).min[along_x ? 0 : 1];
    return static_cast<int>((face.low[along_x ? 0 : 1] - from) / kPiece);
}

}  // namespace

std::vector<std::array<uint32_t, 3>> triangulateConvex(const std::vector<glm::dvec2>& outline) {
    const auto count = static_cast<uint32_t>(outline.size());
    const auto less = [&](uint32_t a, uint32_t b) {
        return std::tie(outline[a].x, outline[a].y) < std::tie(outline[b].x, outline[b].y);
    };
    uint32_t last = 0;
    for (uint32_t i = 1; i < count; ++i)
        if (less(last, i)) last = i;
    // The lower chain runs up to the last corner, the upper one comes back from it.
    std::vector<uint32_t> order(count);
    for (uint32_t i = 0; i < count; ++i) order[i] = i;
    std::sort(order.begin(), order.end(), less);
    const auto lower = [&](uint32_t i) { return i <= last; };
    std::vector<std::array<uint32_t, 3>> triangles;
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        const glm::dvec2 p = outline[b] - outline[a], q = outline[c] - outline[a];
        const double area = p.x * q.y - p.y * q.x;
        if (area == 0) return false;
        triangles.push_back(area > 0 ? std::array<uint32_t, 3>{a, b, c} : std::array<uint32_t, 3>{a, c, b});
        return true;
    };
    std::vector<uint32_t> stack{order[0], order[1]};
    for (uint32_t n = 2; n < count; ++n) {
        const uint32_t next = order[n], top = stack.back();
        if (n + 1 == count || lower(next) != lower(top)) {
            for (size_t i = 0; i + 1 < stack.size(); ++i) add(stack[i], stack[i + 1], next);
            stack = {top, next};
        } else {
            while (stack.size() > 1 && add(stack[stack.size() - 2], stack.back(), next)) stack.pop_back();
            stack.push_back(next);
        }
    }
    SIGHTLINE_ASSERT(triangles.size() + 2 == count);
    return triangles;
}

std::vector<ShellPart> makeShell(const Plan& plan) {
    std::vector<Face> faces;
    for (uint32_t i = 0; i < plan.floors.size(); ++i) FloorGrid(plan, i).addFaces(faces);
    Corners corners;
    for (const Face& face : faces) corners.add(face);
    corners.sort();
    // Parts in the order of floors, rooms and directions; facades in pieces.
    std::map<std::tuple<uint32_t, int32_t, int, bool, int>, std::vector<const Face*>> groups;
    for (const Face& face : faces)
        groups[{face.floor, face.owner, face.axis, face.positive, pieceOf(plan, face)}].push_back(&face);
    std::vector<ShellPart> parts;
    for (const auto& [key, group] : groups) {
        ShellPart part;
        const Face& first = *group.front();
        part.floor = first.floor;
        part.room = first.owner == kAir ? kOutside : static_cast<uint32_t>(first.owner) - 1;
        part.name = partName(plan, first);
        if (first.owner == kAir && first.axis != 1) part.name += fmt::format(" {}", std::get<4>(key) + 1);
        city::MeshBuilder mesh;
        for (const Face* face : group) addFace(mesh, materialOf(plan, *face), *face, corners);
        part.mesh = mesh.finish(part.name);
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace sightline::tools::building
