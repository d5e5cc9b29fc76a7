// Which cells an eye sees through which part of the image: portals as windows, from cell to cell.
// SPDX-License-Identifier: MIT
//
// David Luebke, Chris Georges. Portals and Mirrors: Simple, Fast Evaluation of Potentially Visible Sets. 1995.
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/cells/portal_bounds.h"
#include "sightline/cells/portal_eye.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/cells/window_polygon.h"
#include "sightline/geom/view.h"

namespace sightline {

/// How far a door is open.
struct DoorState {
    float open = 1;  ///< 0: shut; 1: open; between: the last share of its portals along CellDoor::slide is left
};

struct PortalSettings {
    PortalWindows windows = PortalWindows::kOctagons;
    /// Work limit: cells entered; a cell counts each time. Beyond it run() returns false, and everything may be seen.
    uint32_t work = 1u << 16;
    /// Most portals in a chain; 0: no limit. Cells behind longer chains are left out although they may be visible, and
    /// PortalStats::too_deep counts them.
    uint32_t depth = 0;
};

/// A cell that is seen, and through what part of the image.
struct SeenCell {
    uint32_t cell = 0;
    uint32_t first_plane = 0,
             plane_count = 0;  ///< of PortalFlood::planes: what is wholly outside of one of them is not
                               ///< seen in this cell through this window; none: the whole view
    /// Of the image, in clip x and y over w, from -1 to 1; a little more with jitter.
    double left = -1, bottom = -1, right = 1, top = 1;
    uint32_t from = ~0u;    ///< index of the cell that it is seen from first; ~0: the eye may be in it
    uint32_t portal = ~0u;  ///< the graph's portal between them
};

struct PortalStats {
    uint64_t cells = 0;     ///< entered; a cell counts each time
    uint64_t portals = 0;   ///< looked at
    uint64_t whole = 0;     ///< portals too near to be cut to: the whole window was taken
    uint64_t joined = 0;    ///< polygons that were joined to a larger one because a cell had too many
    uint64_t too_deep = 0;  ///< portals beyond PortalSettings::depth, not looked through: not conservative
    bool work_spent = false;
};

/// What an eye sees of a graph of cells. Its memory is used again by the next view.
class PortalFlood {
public:
    explicit PortalFlood(Memory* memory = defaultMemory());

    /// Finds the cells that the eye may see, each once or, with polygons, once for each window.
    ///
    /// Conservative: a sight line that begins in the near rectangle, widened by the jitter, and passes through cells by
    /// their portals passes cells of the answer alone, and each within one of its windows. Starts from all cells that
    /// the pyramid from the eye to the near rectangle meets, or comes as close to as the space's tolerance. With
    /// View::through they begin on that outline, and the cells are those that it touches. Deterministic on every
    /// machine.
    /// @param view   isUsable(view)
    /// @param doors  [size: graph.doors(), or 0: all are open]
    /// @param rows   a bit for each row of visibility that may be seen at all; empty: all
    /// @returns false if nothing can be said: the eye, or a part of the near rectangle, is in no cell, or the work was
    ///          spent. Then everything may be seen.
    bool run(const PortalGraph& graph, const View& view, const PortalSettings& settings = {},
             std::span<const DoorState> doors = {}, std::span<const uint64_t> rows = {});

    std::span<const SeenCell> cells() const { return cells_; }
    /// Relative to the eye, normals inward and of unit length: dot(n, p - eye) + d >= 0 inside.
    std::span<const glm::dvec4> planes() const { return planes_; }
    const PortalStats& stats() const { return stats_; }

private:
    /// What is known of a cell in the view of number `view`; in any other view nothing is.
    struct CellState {
        WindowBounds window;  ///< through which it is seen
        uint64_t view = 0;
        uint32_t index = 0;  ///< of order_
        uint32_t depth = 0;  ///< portals of the shortest chain
        uint32_t from = ~0u, portal = ~0u;
        uint32_t polygon = ~0u;  ///< of polygons_: the first of its list
        bool waits = false;      ///< the window grew since its portals were looked at
    };
    struct Waiting {
        double key;
        uint32_t cell;
    };
    struct Step {
        uint32_t node;
        uint8_t sides;  ///< of its children: how many are done
    };

    /// A window of a cell, where windows are polygons.
    struct Polygon {
        WindowPolygon shape;
        uint32_t cell = 0;
        uint32_t next = ~0u;  ///< of the same cell
        uint32_t depth = 0;
        uint32_t from = ~0u, portal = ~0u;
        uint32_t became = ~0u;  ///< the one that holds it, if it is no more; after that: its index in the answer
        bool gone = false, waits = true;
    };
    /// A portal in the image.
    struct Projection {
        enum class Kind : uint8_t { kNothing, kPart, kWhole };
        Kind kind = Kind::kNothing;
        double margins[2];
        WindowBounds bounds;
        double w;  ///< the least
    };

    bool start(const PortalGraph& graph, const View& view);
    bool mayEnter(uint32_t cell) const;
    float openOf(const DirectedPortal& portal) const;
    int sides() const { return settings_.windows == PortalWindows::kBoxes ? 4 : 8; }
    Projection project(const DirectedPortal& portal);
    void findLines(const Projection& projection);

    void wait(uint32_t cell, double key);
    void reach(uint32_t cell, const WindowBounds& window, uint32_t from, uint32_t portal, uint32_t depth, double key);
    void reach(uint32_t cell, Polygon polygon, double key);
    void lookBackIn(uint32_t outside);
    bool enter(uint32_t cell);
    bool floodTree();
    bool floodByDistance();
    void lookThroughAll(uint32_t cell);
    void lookThrough(uint32_t cell, const DirectedPortal& portal);
    void pass(uint32_t cell, const DirectedPortal& portal, WindowBounds& window, double key);
    void lookThroughPolygons(uint32_t cell, const DirectedPortal& portal);
    void writeBounds();
    void writePolygons();
    void addPlane(const glm::dvec3& line, SeenCell& seen);

    const PortalGraph* graph_ = nullptr;
    PortalSettings settings_;
    std::span<const DoorState> doors_;
    std::span<const uint64_t> rows_;
    PortalEye eye_;
    uint64_t view_ = 0;
    Array<CellState> states_;
    Array<uint32_t> order_;    // cells, in the order in which they were reached
    Array<uint64_t> flagged_;  // per node: the view in which cells below it wait
    Array<Step> steps_;
    Array<Waiting> heap_;
    Array<uint32_t> start_;
    Array<PortalLook> looks_;
    Array<glm::dvec3> corners_, clipped_;
    Array<WindowLine> lines_;
    Array<Polygon> polygons_;
    Array<SeenCell> cells_;
    Array<glm::dvec4> planes_;
    PortalStats stats_;
};

}  // namespace sightline
