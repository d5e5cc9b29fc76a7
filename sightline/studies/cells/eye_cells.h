// Which cells an eye sees, and which boxes in them: by rows, by the view volume, by chains of portals, by exact sight lines.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/cells/portal_eye.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/geom/frustum.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline::studies {

/// How much is asked of a cell. Each level asks what the one before does, and more: its cells are some of those.
enum class EyeLevel : uint8_t {
    kRow,        ///< it is in the rows
    kVolume,     ///< and a portal of it meets the view volume
    kChain,      ///< and is reached through cells of the rows and portals that meet the view volume and face the eye
    kSightLine,  ///< and a line from the eye passes, within the image, through all portals of such a chain
};
inline constexpr const char* kEyeLevelNames[] = {"row", "volume", "chain", "sight line"};

struct EyeCellSettings {
    EyeLevel level = EyeLevel::kSightLine;
    /// Chains that are followed at most. With more than that the answer is kChain's: more is seen.  [limit]
    uint32_t work = 1u << 14;
    /// Chains through one portal that are kept apart; 0: all. Of later ones only those lines are kept that one before them has as
    /// well: more is seen, and far fewer chains are followed where there are many ways around.  [limit]
    uint32_t ways = 8;
};

struct EyeCellStats {
    uint64_t portals = 0;   ///< looked at, once for each chain that leads there
    uint64_t programs = 0;  ///< linear programs solved
    uint64_t chains = 0;    ///< that a sight line passes
    uint64_t joined = 0;    ///< of these, widened for EyeCellSettings::ways
    uint64_t known = 0;     ///< not followed: what they see was seen through another, wider one
    bool work_spent = false;
};

/// What an eye sees of a graph of cells, without clipping anything. A sight line is a point of the image; a portal asks of it to
/// be on one side of the lines that its edges are there; so a chain of portals is a linear program in two variables, and
/// a box behind it one in three. Its memory is used again by the next view.
class EyeCells {
public:
    explicit EyeCells(Memory* memory = defaultMemory());

    /// Finds the cells that the eye may see.
    ///
    /// Conservative at each level: a sight line that begins in the near rectangle, widened by the jitter, or on the outline
    /// that the view looks through, and passes through cells by their portals, passes cells of the answer alone. Outlines
    /// count as wider by what points may be off; a chain is left only with a proof that no line passes. Portals are open.
    /// Deterministic on every machine.
    /// @param graph  must outlive the answer
    /// @param view   isUsable(view)
    /// @param rows   a bit for each row of visibility that may be seen at all; empty: all
    /// @returns false if nothing can be said: the eye, or a part of the near rectangle, is in no cell. Then all is seen.
    bool run(const PortalGraph& graph, const View& view, const EyeCellSettings& settings = {},
             std::span<const uint64_t> rows = {});

    bool sees(uint32_t cell) const { return all_ || seen_[cell] == round_; }
    /// Whether the eye may see a part of a box in a cell: eye-to-region, and eye-to-object with each cell that the object is
    /// in. Asks the box what the level asked the cell; at kSightLine also to be behind the last portal.
    /// @param box  finite
    bool sees(uint32_t cell, const Box3d& box) const;
    /// Each once, in the order in which they were found; empty where all are seen.
    std::span<const uint32_t> cells() const { return cells_; }
    const EyeCellStats& stats() const { return stats_; }

private:
    static constexpr uint32_t kNone = ~0u;

    /// A portal as this eye sees it.
    struct Seen {
        uint64_t round = 0;
        bool open = false;        ///< it meets the view volume, and faces the eye
        bool near = false;        ///< the eye may be in its plane: no line of the image bounds it
        uint32_t first = 0;       ///< of lines_ and images_: one for each edge, and for each corner
        uint32_t newest = kNone;  ///< window through it
        uint32_t ways = 0;        ///< windows through it
        glm::dvec3 doubt{0.0};    ///< how far its corners may be off in the image, homogeneous
    };
    /// What is seen of a cell through a chain: what is inside of some lines of the image.
    struct Window {
        uint32_t cell = 0, portal = kNone;  ///< the cell, and the portal by which it is entered
        uint32_t first = 0, count = 0;      ///< of kept_: numbers of lines, rising
        uint32_t through = kNone;           ///< the window before it through the same portal
        uint32_t into = kNone;              ///< the window before it into the same cell
        glm::dvec2 point{0.0};              ///< of the image, seen through the chain
    };

    bool findStart(const View& view);
    bool isInRows(uint32_t cell) const;
    bool meets(const DirectedPortal& portal) const;
    Seen& look(uint32_t portal);
    void addCell(uint32_t cell);
    void findInVolume();
    void followChains();
    void followLines(const EyeCellSettings& settings);
    void pass(uint32_t window, uint32_t portal);
    bool isKnown(const Seen& seen, std::span<const uint32_t> lines) const;
    bool mayMeet(const Window& window, const Box3d& relative) const;

    const PortalGraph* graph_ = nullptr;
    std::span<const uint64_t> rows_;
    PortalEye eye_;
    Frustum frustum_;
    EyeLevel level_ = EyeLevel::kRow;
    uint32_t ways_ = 0;
    bool all_ = true;
    uint64_t round_ = 0;
    Array<uint64_t> seen_;       // per cell: the round that it was last seen in
    Array<uint32_t> newest_in_;  // per cell: window
    Array<uint32_t> cells_, start_;
    Array<Seen> portals_;
    Array<glm::dvec3> images_, lines_;
    Array<uint32_t> kept_;
    Array<Window> windows_;
    Array<uint32_t> chosen_;
    Array<glm::dvec3> program_;
    EyeCellStats stats_;
};

}  // namespace sightline::studies
