// Writes and opens portals and doors.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/portal_sections.h"

#include <cmath>

#include "sightline/base/bytes.h"

namespace sightline {

using namespace visibility_file;

namespace {

constexpr uint64_t kPortalBytes = 56, kPortalsAt = 16, kDoorBytes = 32, kDoorsAt = 8;
constexpr uint32_t kOneWay = 1u << 31;  // in the place of a portal's number of points

/// Null, or what is wrong with it.
const char* faultOf(const CellPortal& portal, uint32_t cells, uint32_t doors) {
    if (portal.cells[0] >= cells || portal.cells[1] >= cells || portal.cells[0] == portal.cells[1])
        return "a portal that does not join two cells";
    if (portal.count < 3) return "a portal of fewer than three points";
    if (portal.door >= doors && portal.door != CellPortal::kNone) return "a portal with a door that there is not";
    if (!(std::isfinite(portal.thickness) && portal.thickness >= 0)) return "a portal without a thickness";
    if (!std::isfinite(portal.plane.w) || !(std::abs(glm::length(glm::dvec3(portal.plane)) - 1) < 1e-6))
        return "a portal without a plane";
    return nullptr;
}

}  // namespace

Status addPortalSections(const CellSpace& space, SectionWriter& writer, Memory* memory) {
    const auto wrong = [](const char* what) { return Error{Error::Kind::kUsage, what}; };
    const CellGraph& graph = space.graph;
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    uint64_t points = 0;
    for (const CellPortal& portal : graph.portals) points += portal.count;
    out.put(static_cast<uint32_t>(graph.portals.size()));
    out.put(uint32_t{0});
    out.put(points);
    for (const CellPortal& portal : graph.portals) {
        if (const char* fault = faultOf(portal, graph.cells, static_cast<uint32_t>(space.doors.size())))
            return wrong(fault);
        if (uint64_t{portal.first} + portal.count > graph.points.size()) return wrong("a portal without its points");
        const uint32_t count = portal.count | (portal.one_way ? kOneWay : 0);
        for (const uint32_t number : {portal.cells[0], portal.cells[1], count, portal.door}) out.put(number);
        out.put(portal.thickness);
        for (int k = 0; k < 4; ++k) out.put(portal.plane[k]);
    }
    for (const CellPortal& portal : graph.portals)
        for (const glm::dvec3& point : graph.outline(portal))
            for (int axis = 0; axis < 3; ++axis) {
                if (!std::isfinite(point[axis])) return wrong("a portal whose outline is not finite");
                out.put(point[axis]);
            }
    writer.add(kPortals, std::move(bytes));
    if (space.doors.empty()) return success();
    Array<char> doors(memory);
    ByteWriter put(doors);
    put.put(static_cast<uint32_t>(space.doors.size()));
    put.put(uint32_t{0});
    for (const CellDoor& door : space.doors) {
        put.put(door.key);
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(door.slide[axis])) return wrong("a door whose slide is not finite");
            put.put(door.slide[axis]);
        }
    }
    uint64_t end = 0;
    for (const CellDoor& door : space.doors) put.put(static_cast<uint32_t>(end += door.name.size()));
    if (end > ~0u) return wrong("names of doors that are too long");
    for (const CellDoor& door : space.doors) doors.insert(doors.end(), door.name.begin(), door.name.end());
    writer.add(kDoors, std::move(doors));
    return success();
}

CellPortal PlacedPortals::portal(uint32_t i) const {
    ByteCursor from(records_.subspan(kPortalBytes * i, kPortalBytes));
    CellPortal out;
    for (uint32_t& cell : out.cells) cell = from.take<uint32_t>();
    out.count = from.take<uint32_t>();
    out.one_way = (out.count & kOneWay) != 0;
    out.count &= ~kOneWay;
    out.door = from.take<uint32_t>();
    out.thickness = from.take<double>();
    for (int k = 0; k < 4; ++k) out.plane[k] = from.take<double>();
    return out;
}

Result<PlacedPortals> PlacedPortals::open(const SectionFile& sections, uint32_t cells, std::string_view file) {
    const std::span<const char> bytes = sections.find(kPortals), doors = sections.find(kDoors);
    const uint64_t at = sections.placeOf(bytes), doors_at = sections.placeOf(doors);
    PlacedPortals out;
    if (!doors.empty()) {
        if (doors.size() < kDoorsAt) return faultAt(file, "doors that end within their head", doors_at);
        ByteCursor head(doors);
        out.doors_ = head.take<uint32_t>();
        if (head.take<uint32_t>() != 0) return faultAt(file, "a mark that is not known", doors_at + 4);
        PlacedParts parts(doors.subspan(kDoorsAt));
        out.door_records_ = parts.take(out.doors_, kDoorBytes);
        out.names_.ends = parts.take<uint32_t>(out.doors_);
        if (parts.failed()) return faultAt(file, "fewer doors than it says", doors_at);
        out.names_.bytes = doors.subspan(kDoorsAt + parts.at());
        if (!out.names_.fit()) return faultAt(file, "names that are not as long as they say", doors_at);
        for (uint32_t i = 0; i < out.doors_; ++i) {
            ByteCursor door(out.door_records_.subspan(kDoorBytes * i, kDoorBytes));
            door.take<uint64_t>();
            for (int axis = 0; axis < 3; ++axis)
                if (!std::isfinite(door.take<double>()))
                    return faultAt(file, "a door whose slide is not finite", doors_at + kDoorsAt + kDoorBytes * i);
        }
    }
    if (bytes.size() < kPortalsAt) return faultAt(file, "portals that end within their head", at + bytes.size());
    ByteCursor head(bytes);
    out.portals_ = head.take<uint32_t>();
    if (head.take<uint32_t>() != 0) return faultAt(file, "a mark that is not known", at + 4);
    const uint64_t points = head.take<uint64_t>();
    PlacedParts parts(bytes.subspan(kPortalsAt));
    out.records_ = parts.take(out.portals_, kPortalBytes);
    const std::span<const char> places = parts.take(points, 3 * sizeof(double));
    if (!parts.fits()) return faultAt(file, "portals that are not as long as they say", at);
    out.points_ = PlacedNumbers<double>(places);
    uint64_t counted = 0;
    for (uint32_t i = 0; i < out.portals_; ++i) {
        const CellPortal portal = out.portal(i);
        if (const char* fault = faultOf(portal, cells, out.doors_))
            return faultAt(file, fault, at + kPortalsAt + kPortalBytes * i);
        counted += portal.count;
    }
    if (counted != points) return faultAt(file, "not as many points as portals have", at + 8);
    if (points > ~0u) return faultAt(file, "more points than there may be", at + 8);
    for (size_t i = 0; i < out.points_.size(); ++i)
        if (!std::isfinite(out.points_[i]))
            return faultAt(file, "a point that is not finite",
                           at + kPortalsAt + kPortalBytes * out.portals_ + sizeof(double) * i);
    return out;
}

void PlacedPortals::copyTo(CellSpace& space) const {
    uint32_t first = 0;
    for (uint32_t i = 0; i < portals_; ++i) {
        CellPortal added = portal(i);
        added.first = first;
        first += added.count;
        space.graph.portals.push_back(added);
    }
    for (size_t i = 0; i < points_.size(); i += 3)
        space.graph.points.emplace_back(points_[i], points_[i + 1], points_[i + 2]);
    for (uint32_t i = 0; i < doors_; ++i) {
        ByteCursor from(door_records_.subspan(kDoorBytes * i, kDoorBytes));
        CellDoor& door = space.doors.emplace_back();
        door.name = names_[i];
        door.key = from.take<uint64_t>();
        for (int axis = 0; axis < 3; ++axis) door.slide[axis] = from.take<double>();
    }
}

}  // namespace sightline
