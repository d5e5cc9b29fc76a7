// A bake: from a scene or a map in cells to the bytes of its visibility file, as a list of steps.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/bake/marked/scene_cells.h"
#include "sightline/bake/objects/box_visibility.h"
#include "sightline/bake/objects/object_cells.h"
#include "sightline/bake/soup/soup_cells.h"
#include "sightline/bake/view_cells/portal_rows.h"
#include "sightline/bake/view_cells/view_cells.h"
#include "sightline/base/jobs.h"
#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline::bake {
using namespace tools;

// A bake in full, of a scene whose cells and portals are marked:
//
//     ThreadPool threads(8);
//     BakeSettings settings;
//     settings.jobs = &threads;
//     const Result<Baked> baked = bake(sceneToBake(scene, "house"), scene, settings);
//     if (!baked) return complain(baked.error().message);
//     write("house.vis", baked->file.bytes(settings.form));
//
// bake() calls the steps below in their order. An engine that wants other steps calls them itself: each is a function,
// and plain structs lie between them. The answer of every step is the same for any number of threads and any
// instruction set, unless a limit of time or BakeSettings::stop ends it early: then more is visible, never less.

struct BakeSettings {
    Jobs* jobs = nullptr;  ///< threads to share the work out to
    /// Work limit: portals that are clipped for one portal and direction. What is left then stays visible. 0: none.
    uint64_t budget = 0;
    uint64_t work = 0;      ///< CellVisibilitySettings
    double farthest = 0;    ///< CellVisibilitySettings  [world units]
    double time_limit = 0;  ///< for the rows of cells; what is not settled by then stays visible; 0: none  [s]
    bool object_rows =
        false;  ///< find also which objects each row sees, if there are rows: takes longer than the cells do
    VisibilityForm form = VisibilityForm::kPacked;  ///< of the file
    /// What the file is to hold of the objects' meshes besides, so that a program need not prepare it again.
    std::span<const PreparedMesh> prepared;
    std::span<const uint32_t> prepared_of_object;  ///< per object of the scene which of these  [size: Scene::objects]

    /// Asked between pieces of work, by whichever thread works, one at a time; true ends the bake without a file.
    std::function<bool()> stop;
    /// Told between pieces of work how far the step is: "base", "rays", "flow", "places", "view cells",
    /// "objects".
    std::function<void(const BakeProgress&)> progress;

    /// Gets the bytes that a bake of the same cells and budget can go on from. It is called every so many seconds, and
    /// once when `stop` says true. An error ends the bake.
    std::function<Status(const std::string&)> checkpoint;
    double checkpoint_seconds = 10;  ///< between two checkpoints  [s] [>= 0]
    /// What readBakeState() made of the bytes of a checkpoint, or null. The bake takes it apart.
    CellVisibilityState* resume = nullptr;
    /// ViewCellSettings::journal of the same view cells, or null. Its bytes go before those of a checkpoint.
    RowJournal* journal = nullptr;
};

/// What is baked.
struct BakeCells {
    std::string name;   ///< of the map or scene, for people; the file keeps it
    uint64_t hash = 0;  ///< of the map or scene: a reader knows by it what the file belongs to; 0: not known
    CellGraph rows;     ///< the cells that have a row of visibility, and their portals
    /// The cells of run time as places, as fine as the rows or finer; CellSpace::row_of_cell leads to the rows. Without
    /// cells: the file holds rows alone, and no object is placed.
    CellSpace space;
    std::vector<uint32_t> row_of_leaf;      ///< of a map: per leaf its row; CellGraph::kNoCell: none; may be empty
    ObjectCellSettings placing;             ///< how objects are placed in the cells of `space`
    std::optional<SceneCellReport> report;  ///< of marked cells: what is odd about them
    std::optional<ViewCells> views;         ///< of the scene whose objects are placed
    CellSpace
        view_space;  ///< with view cells: cells of the scene's own walls, which rows are narrowed by; may have none
};

/// Step 1, of a scene: its marked cells, checked against its walls. Doors count as open, and hide nothing.
/// @param name      BakeCells::name
/// @param settings  SceneCellSettings::movable gets the doors in addition
BakeCells sceneToBake(const Scene& scene, const std::string& name, SceneCellSettings settings = {});

/// Step 1, of a scene without marks: cells of its own walls, by cellsOfSoup(). They have no rows.
/// @param report  receives what became of the scene, if there is one
BakeCells soupToBake(const Scene& scene, const std::string& name, const SoupCellSettings& settings = {},
                     SoupCellReport* report = nullptr);

/// The cells of a scene that has none: one that is all of space.
/// @param name  BakeCells::name
BakeCells openToBake(const Scene& scene, const std::string& name);

/// After Step 1, of a scene: view cells, by viewCellsOf(), and cells of its own walls, by cellsOfSoup(), however space is
/// divided for the query. What these rest on becomes a wall, too.
/// @param scene  whose objects are placed
void addViewCells(BakeCells& cells, const Scene& scene, const ViewCellSettings& settings = {});

/// Step 1, of a map: the leaves of its tree as places, and its rows.
/// @param leaves  tree, tolerance, and the graph whose cell_of_leaf says which cell a leaf is
/// @param rows    the graph of cells that have rows; its cell_of_leaf is over the leaves of the same tree
BakeCells mapToBake(CellSpace leaves, CellGraph rows);

/// Step 2: whether the rows can be baked at once. Errors (kInput): more portals than kMostBakedPortals.
/// @param name  what errors call the cells
Status checkBakeSize(const CellGraph& rows, const std::string& name);

/// Step 3: which cells see one another, by bakeCellVisibility(), with checkpoints and the limit of time. With
/// BakeSettings::object_rows it keeps CellVisibility::follows. Errors: of the checkpoint.
/// @pre checkBakeSize()
Result<CellVisibility> bakeRows(const CellGraph& rows, const BakeSettings& settings);

// Step 4, seeAllFromOutside(), stands in marked/scene_cells.h: what sees the outside sees all.

/// Step 5: the cells of each object that stands still, by cellsOfObjects().
ObjectCells placeObjects(const BakeCells& cells, const Scene& scene, const BakeSettings& settings);

/// Step 5, where there are view cells: takes out of their rows what no way through the portals of BakeCells::view_space leads
/// to, by narrowRows().
/// @param scene      whose objects are placed
/// @param object_of  per column of the rows the scene's object
/// @param rows       [leaves of the view cells x placed objects]
PortalRowCounts narrowViewRows(const BakeCells& cells, const Scene& scene, std::span<const uint32_t> object_of,
                               const BakeSettings& settings, BitMatrix& rows);

/// Step 6: which boxes each row sees, by bakeBoxVisibility().
/// @param visibility  bakeRows() of the same rows, with BakeSettings::object_rows
BoxVisibility bakeObjectRows(const CellGraph& rows, const CellVisibility& visibility, const CellBoxes& boxes,
                             const BakeSettings& settings);

/// The boxes of Step 6: placed objects, grown by the margin of their placing, in rows instead of cells.
CellBoxes boxesInRows(const BakeCells& cells, const ObjectPlaces& objects);

/// The bytes of a visibility file.
struct BakedFile {
    Array<char> in_place;         ///< always
    Array<char> packed;           ///< if it was asked for
    uint64_t resident_bytes = 0;  ///< VisibilityFile::residentBytes()

    std::span<const char> bytes(VisibilityForm form) const {
        return form == VisibilityForm::kPacked ? packed : in_place;
    }
};

/// Step 7: the file, in place and, if `packs`, packed. It is opened as a reader opens it. Errors: of visibilityFile().
Result<BakedFile> bakedFile(const VisibilityContent& content, bool packs);

/// All that a bake made.
struct Baked {
    BakeCells cells;  ///< as in the file: the outside has no row any more
    CellVisibility rows;
    ObjectCells objects;
    std::optional<BoxVisibility> object_rows;  ///< if they were asked for
    BitMatrix view_rows;                       ///< [leaves of the view cells x placed objects], if there are view cells
    PortalRowCounts view_counts;               ///< of these
    BakedFile file;
    bool interrupted = false;                      ///< by BakeSettings::stop: there is no file
    double rows_seconds = 0, objects_seconds = 0;  ///< of Steps 3 and 4, and of Steps 5 and 6
};

/// Steps 2 to 7.
/// @param cells    Step 1
/// @param objects  the scene whose objects are placed; empty: none
/// Errors: of the steps.
Result<Baked> bake(BakeCells cells, const Scene& objects, const BakeSettings& settings = {});

}  // namespace sightline::bake
