// What must hold for whatever the readers of the Quake family hand out.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "sightline/import/prt.h"

namespace sightline::test {

inline std::span<const unsigned char> bytesOf(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

/// Empty, or what is wrong with an error's line.
inline std::string lineFault(const Error& error, const std::string& file) {
    if (error.message.rfind(file + ": ", 0) != 0) return "does not begin with the file: " + error.message;
    for (const char c : error.message)
        if (c < ' ' || c > '~') return "is not one printable line: " + error.message;
    return error.kind == Error::Kind::kInput ? "" : "is not the input's fault";
}

/// Empty, or what is wrong with the graph.
inline std::string graphFault(const CellGraph& graph) {
    for (const CellPortal& portal : graph.portals) {
        for (const uint32_t cell : portal.cells)
            if (cell >= graph.cells) return "a portal's cell is out of range";
        if (portal.cells[0] == portal.cells[1]) return "a portal leads into its own cell";
        if (portal.count < 3 || uint64_t(portal.first) + portal.count > graph.points.size())
            return "an outline is out of range";
        for (const glm::dvec3& point : graph.outline(portal))
            if (!(std::abs(glm::dot(glm::dvec3(portal.plane), point) + portal.plane.w) <= portal.thickness))
                return "a portal is thicker than it says";
    }
    for (const uint32_t cell : graph.cell_of_leaf)
        if (cell != CellGraph::kNoCell && cell >= graph.cells) return "a leaf's cell is out of range";
    return "";
}

/// Empty, or what is wrong with the answer to these bytes.
inline std::string prtFault(const std::string& bytes) {
    const Result<CellGraph> graph = parsePrt(bytesOf(bytes), "fuzz.prt");
    return graph.ok() ? graphFault(*graph) : lineFault(graph.error(), "fuzz.prt");
}

}  // namespace sightline::test
