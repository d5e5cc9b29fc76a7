// The cells and portals of a procedural building, which its plan knows.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/cells.h"

#include <string>
#include <utility>

#include "sightline/base/assert.h"

namespace sightline::tools::building {
namespace {

constexpr uint32_t kNoDoor = ~0u;

/// Beside the building and above it, in the order of quarter turns from +z.
struct Around {
    uint32_t side[4];
    uint32_t above;
};

class CellMaker {
public:
    explicit CellMaker(Scene& scene) : scene_(scene) {}

    uint32_t cell(std::string name, const Box3d& box) {
        SceneCell& cell = scene_.cells.emplace_back();
        cell.name = std::move(name);
        cell.bounds = box;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec4 low(0), high(0);
            low[axis] = 1;
            low.w = -box.min[axis];
            high[axis] = -1;
            high.w = box.max[axis];
            cell.planes.push_back(low);
            cell.planes.push_back(high);
        }
        return static_cast<uint32_t>(scene_.cells.size() - 1);
    }

    /// The rectangle in which two boxes touch.
    void portal(uint32_t a, uint32_t b, uint32_t door = kNoDoor) {
        const Box3d &p = scene_.cells[a].bounds, &q = scene_.cells[b].bounds;
        for (int axis = 0; axis < 3; ++axis) {
            const bool onward = p.max[axis] == q.min[axis];
            if (!onward && p.min[axis] != q.max[axis]) continue;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const glm::dvec3 low = glm::max(p.min, q.min), high = glm::min(p.max, q.max);
            if (!(low[u] < high[u] && low[v] < high[v])) continue;
            ScenePortal portal;
            portal.name = scene_.cells[a].name + " - " + scene_.cells[b].name;
            portal.cells[0] = a;
            portal.cells[1] = b;
            portal.door = door;
            const double at = onward ? p.max[axis] : p.min[axis];
            const glm::dvec2 corners[] = {{low[u], low[v]}, {high[u], low[v]}, {high[u], high[v]}, {low[u], high[v]}};
            for (int i = 0; i < 4; ++i) {
                // Seen from a: against the axis if b lies onward, so the other way round.
                const glm::dvec2& corner = corners[onward ? 3 - i : i];
                glm::dvec3 point;
                point[axis] = at;
                point[u] = corner.x;
                point[v] = corner.y;
                portal.polygon.push_back(point);
            }
            scene_.portals.push_back(std::move(portal));
            return;
        }
        SIGHTLINE_ASSERT(!"cells of a portal touch");
    }

private:
    Scene& scene_;
};

Around addAround(const Plan& plan, CellMaker& maker) {
    const Rect &plot = plan.plot, &house = plan.footprint;
    const double top = plan.air, roof = plan.floors.back().ceiling;
    Around around{};
    around.side[0] = maker.cell("Outside south", {{plot.min.x, 0, house.max.y}, {plot.max.x, top, plot.max.y}});
    around.side[1] = maker.cell("Outside east", {{house.max.x, 0, house.min.y}, {plot.max.x, top, house.max.y}});
    around.side[2] = maker.cell("Outside north", {{plot.min.x, 0, plot.min.y}, {plot.max.x, top, house.min.y}});
    around.side[3] = maker.cell("Outside west", {{plot.min.x, 0, house.min.y}, {house.min.x, top, house.max.y}});
    around.above = maker.cell("Outside above", {{house.min.x, roof, house.min.y}, {house.max.x, top, house.max.y}});
    for (int quarter = 0; quarter < 4; ++quarter) {
        maker.portal(around.side[quarter], around.side[(quarter + 1) % 4]);
        maker.portal(around.above, around.side[quarter]);
    }
    return around;
}

}  // namespace

void addCells(const Plan& plan, const std::vector<std::vector<uint32_t>>& leaves, Scene& scene) {
    CellMaker maker(scene);
    const Around around = addAround(plan, maker);
    std::vector<uint32_t> below;  // cells of the floor below's rooms
    for (size_t f = 0; f < plan.floors.size(); ++f) {
        const Floor& floor = plan.floors[f];
        std::vector<uint32_t> cells;
        for (size_t r = 0; r < floor.rooms.size(); ++r) {
            const Room& room = floor.rooms[r];
            cells.push_back(maker.cell(room.name, room.box));
            const bool shaft = room.kind == RoomKind::kStairs || room.kind == RoomKind::kLift;
            if (shaft && f > 0) maker.portal(below[r], cells.back());  // shafts have the same places on each floor
            if (room.kind == RoomKind::kRoof) maker.portal(cells.back(), around.above);
        }
        for (size_t o = 0; o < floor.openings.size(); ++o) {
            const Opening& opening = floor.openings[o];
            const uint32_t hole = maker.cell(opening.name, opening.hole);
            maker.portal(cells[opening.room], hole, leaves[f][o]);
            maker.portal(hole, opening.other == kOutside ? around.side[opening.quarter & 3] : cells[opening.other]);
        }
        below = std::move(cells);
    }
}

}  // namespace sightline::tools::building
