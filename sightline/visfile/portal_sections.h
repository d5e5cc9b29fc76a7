// The sections of portals and of the doors that shut them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/cells/cell_space.h"
#include "sightline/visfile/placed_parts.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

namespace visibility_file {

/// portals (4 bytes), 4 of zero, points (8); per portal its two cells, number of points, door (4 each), thickness (8),
/// plane (32); the points of all, 24 each, in the order of the portals.
inline constexpr uint32_t kPortals = section_file::tagOf("port");
/// doors (4 bytes), 4 of zero; per door its key (8) and slide (24); per door where its name ends (4); the names. None:
/// no section.
inline constexpr uint32_t kDoors = section_file::tagOf("door");

}  // namespace visibility_file

/// Adds the sections to a file.
/// Errors (kUsage): what a reader would refuse.
Status addPortalSections(const CellSpace& space, SectionWriter& writer, Memory* memory = defaultMemory());

/// These sections where they lie.
class PlacedPortals {
public:
    /// @param cells  that there are
    /// @param file   what errors call the bytes
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<PlacedPortals> open(const SectionFile& sections, uint32_t cells, std::string_view file);

    uint32_t portals() const { return portals_; }
    uint32_t doors() const { return doors_; }
    /// Portals, their points, and doors.
    void copyTo(CellSpace& space) const;

private:
    CellPortal portal(uint32_t i) const;

    uint32_t portals_ = 0, doors_ = 0;
    std::span<const char> records_, door_records_;
    PlacedNumbers<double> points_;
    PlacedNames names_;
};

}  // namespace sightline
