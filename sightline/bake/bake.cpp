// The steps of a bake, and the list of them.
// SPDX-License-Identifier: MIT
#include "sightline/bake/bake.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "sightline/bake/flow/bake_state.h"
#include "sightline/bake/objects/scene_hash.h"

namespace sightline::bake {
using namespace tools;
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

bool asksToStop(const BakeSettings& settings) { return settings.stop && settings.stop(); }

/// The rows of view cells with a column for each placed object instead of each of the scene.
BitMatrix rowsOfPlaced(const BitMatrix& visible, const std::vector<uint32_t>& object_of) {
    BitMatrix rows(visible.rows(), object_of.size());
    for (size_t row = 0; row < rows.rows(); ++row)
        for (size_t place = 0; place < object_of.size(); ++place)
            if (visible.at(row, object_of[place])) rows.set(row, place);
    return rows;
}

void seeAllObjects(const std::vector<uint32_t>& rows, BitMatrix& visible) {
    for (const uint32_t row : rows)
        for (size_t object = 0; object < visible.columns(); ++object) visible.set(row, object);
}

}  // namespace

Result<Baked> bake(BakeCells cells, const Scene& objects, const BakeSettings& settings) {
    Baked out;
    // Step 1. The cells: sceneToBake() or mapToBake() made them.
    out.cells = std::move(cells);
    CellSpace& space = out.cells.space;

    // Step 2. Whether the rows can be baked at once.
    if (const Status fits = checkBakeSize(out.cells.rows, out.cells.name); !fits) return fits.error();

    // Step 3. Which cells see one another.
    const Clock::time_point rows_begin = Clock::now();
    Result<CellVisibility> rows = bakeRows(out.cells.rows, settings);
    if (!rows) return rows.error();
    out.rows = std::move(*rows);
    out.interrupted = out.rows.stopped && asksToStop(settings);
    if (out.interrupted) return out;

    // Step 4. What sees the outside sees all.
    const std::vector<uint32_t> open_rows = seeAllFromOutside(space, out.rows.visible);
    out.rows_seconds = secondsSince(rows_begin);

    // Step 5. The cells of each object.
    const Clock::time_point objects_begin = Clock::now();
    const bool has_places = space.graph.cells > 0;
    if (has_places) out.objects = placeObjects(out.cells, objects, settings);

    // Step 6. The objects that each row sees.
    if (has_places && settings.object_rows && out.cells.rows.cells > 0) {
        const CellBoxes boxes = boxesInRows(out.cells, out.objects.places);
        out.object_rows = bakeObjectRows(out.cells.rows, out.rows, boxes, settings);
        seeAllObjects(open_rows, out.object_rows->visible);
    }
    const bool has_views = has_places && out.cells.views && !out.cells.views->tree.contents.empty();
    if (has_views) {
        out.view_rows = rowsOfPlaced(out.cells.views->visible, out.objects.object_of);
        out.view_counts = narrowViewRows(out.cells, objects, out.objects.object_of, settings, out.view_rows);
    }
    if (settings.journal && !settings.journal->written()) return settings.journal->written().error();
    out.interrupted = asksToStop(settings);
    if (out.interrupted) return out;
    out.objects_seconds = secondsSince(objects_begin);

    // Step 7. The file.
    VisibilityContent content{out.rows.visible, out.cells.row_of_leaf, out.cells.name, out.cells.hash};
    if (has_places) content.space = &space;
    if (has_places) content.objects = &out.objects.places;
    if (out.object_rows) content.object_rows = &out.object_rows->visible;
    if (has_views) {
        content.view_tree = &out.cells.views->tree;
        content.view_rows = &out.view_rows;
    }
    std::vector<uint32_t> prepared_of_place;
    if (has_places && !settings.prepared.empty()) {
        for (const uint32_t object : out.objects.object_of)
            prepared_of_place.push_back(settings.prepared_of_object[object]);
        content.prepared = settings.prepared;
        content.prepared_of_object = prepared_of_place;
    }
    Result<BakedFile> file = bakedFile(content, settings.form == VisibilityForm::kPacked);
    if (!file) return file.error();
    out.file = std::move(*file);
    return out;
}

BakeCells sceneToBake(const Scene& scene, const std::string& name, SceneCellSettings settings) {
    for (const ScenePortal& portal : scene.portals)
        if (portal.door < scene.objects.size()) settings.movable.push_back(portal.door);
    std::sort(settings.movable.begin(), settings.movable.end());
    settings.movable.erase(std::unique(settings.movable.begin(), settings.movable.end()), settings.movable.end());
    SceneCells cells = cellsOfScene(scene, settings);
    BakeCells out;
    out.name = name;
    out.hash = hashOf(scene);
    out.space = std::move(cells.space);
    for (uint32_t cell = 0; cell < out.space.graph.cells; ++cell) out.space.row_of_cell.push_back(cell);
    out.rows = out.space.graph;
    out.placing.walls = cells.report.walls;
    out.report = std::move(cells.report);
    return out;
}

BakeCells soupToBake(const Scene& scene, const std::string& name, const SoupCellSettings& settings,
                     SoupCellReport* report) {
    SoupCells cells = cellsOfSoup(scene, settings);
    BakeCells out;
    out.name = name;
    out.hash = hashOf(scene);
    out.space = std::move(cells.space);
    out.placing.walls = cells.report.walls;
    if (report) *report = std::move(cells.report);
    return out;
}

BakeCells openToBake(const Scene& scene, const std::string& name) {
    BakeCells out;
    out.name = name;
    out.hash = hashOf(scene);
    out.space.graph.cells = 1;
    out.space.graph.cell_of_leaf = {0};
    out.space.tree.contents = {LeafContents::kEmpty};
    out.space.tree.bounds = worldBounds(scene);
    return out;
}

void addViewCells(BakeCells& cells, const Scene& scene, const ViewCellSettings& settings) {
    cells.views = viewCellsOf(scene, settings);
    if (cells.views->tree.contents.empty() || (settings.stop && settings.stop())) return;
    SoupCellSettings dividing;
    dividing.smallest_hole = settings.smallest_hole;
    dividing.widest_gap = 0;
    dividing.movable = settings.movable;
    dividing.jobs = settings.jobs;
    SoupCells own = cellsOfSoup(scene, dividing);
    cells.view_space = std::move(own.space);
    std::vector<uint32_t>& walls = cells.placing.walls;
    walls.insert(walls.end(), cells.views->walls.begin(), cells.views->walls.end());
    walls.insert(walls.end(), own.report.walls.begin(), own.report.walls.end());
    std::sort(walls.begin(), walls.end());
    walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
}

BakeCells mapToBake(CellSpace leaves, CellGraph rows) {
    BakeCells out;
    out.space = std::move(leaves);
    out.rows = std::move(rows);
    out.row_of_leaf = out.rows.cell_of_leaf;
    const std::vector<uint32_t>& cell_of_leaf = out.space.graph.cell_of_leaf;
    out.space.row_of_cell.assign(out.space.graph.cells, CellGraph::kNoCell);
    for (size_t leaf = 0; leaf < cell_of_leaf.size(); ++leaf)
        if (const uint32_t cell = cell_of_leaf[leaf]; cell != CellGraph::kNoCell)
            out.space.row_of_cell[cell] = out.row_of_leaf[leaf];
    return out;
}

Status checkBakeSize(const CellGraph& rows, const std::string& name) {
    if (rows.portals.size() <= kMostBakedPortals) return success();
    return Error{Error::Kind::kInput, name + ": " + std::to_string(rows.portals.size()) + " portals, and at most " +
                                          std::to_string(kMostBakedPortals) + " can be baked at once"};
}

Result<CellVisibility> bakeRows(const CellGraph& rows, const BakeSettings& settings) {
    const Clock::time_point begin = Clock::now();
    Clock::time_point saved = begin;
    double writing = 0;  // the last checkpoint: of a large bake it takes long  [s]
    Status written = success();
    CellVisibilitySettings flows;
    flows.jobs = settings.jobs;
    flows.budget = settings.budget;
    flows.work = settings.work;
    flows.farthest = settings.farthest;
    flows.keep_follows = settings.object_rows;
    flows.resume = settings.resume;
    flows.progress = settings.progress;
    flows.stop = [&] {
        return !written || asksToStop(settings) ||
               (settings.time_limit > 0 && secondsSince(begin) > settings.time_limit);
    };
    if (settings.checkpoint)
        flows.checkpoint = [&](const CellVisibilityState& state) {
            if (state.flowed == state.order.size()) return;  // the end is near
            if (!asksToStop(settings) && secondsSince(saved) < std::max(settings.checkpoint_seconds, 20 * writing))
                return;
            const Clock::time_point write_begin = Clock::now();
            written = settings.checkpoint(
                (settings.journal ? settings.journal->bytes() : std::string()) +
                bakeStateBytes(state, hashOf(rows, settings.farthest), settings.budget, settings.work));
            saved = Clock::now();
            writing = secondsSince(write_begin);
        };
    CellVisibility visibility = bakeCellVisibility(rows, flows);
    if (!written) return written.error();
    return visibility;
}

ObjectCells placeObjects(const BakeCells& cells, const Scene& scene, const BakeSettings& settings) {
    ObjectCellSettings placing = cells.placing;
    placing.jobs = settings.jobs;
    if (settings.progress)
        placing.progress = [&](size_t done, size_t total) {
            settings.progress({"places", static_cast<double>(done) / static_cast<double>(total)});
        };
    return cellsOfObjects(scene, cells.space, placing);
}

PortalRowCounts narrowViewRows(const BakeCells& cells, const Scene& scene, std::span<const uint32_t> object_of,
                               const BakeSettings& settings, BitMatrix& rows) {
    PortalRowSettings narrowing;
    narrowing.moves = cells.placing.moves;
    narrowing.jobs = settings.jobs;
    narrowing.journal = settings.journal;
    narrowing.stop = settings.stop;
    if (settings.progress) narrowing.progress = [&](double done) { settings.progress({"view cells", done}); };
    return narrowRows(cells.views->tree, cells.view_space, scene, object_of, narrowing, rows);
}

BoxVisibility bakeObjectRows(const CellGraph& rows, const CellVisibility& visibility, const CellBoxes& boxes,
                             const BakeSettings& settings) {
    CellVisibilitySettings flows;
    flows.jobs = settings.jobs;
    flows.budget = settings.budget;
    flows.stop = settings.stop;
    flows.progress = settings.progress;
    return bakeBoxVisibility(rows, visibility, boxes, flows);
}

CellBoxes boxesInRows(const BakeCells& cells, const ObjectPlaces& objects) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double margin = std::max(cells.placing.margin, cells.space.tolerance);
    CellBoxes boxes;
    std::vector<uint32_t> rows;
    for (size_t i = 0; i < objects.size(); ++i) {
        rows.clear();
        for (const uint32_t cell : objects.cellsOf(i)) rows.push_back(cells.space.row_of_cell[cell]);
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        // kNoCell is the largest number.
        const bool everywhere = objects.everywhere[i] || (!rows.empty() && rows.back() == CellGraph::kNoCell);
        const Box3d& box = objects.bounds[i];
        if (everywhere) boxes.add({glm::dvec3(-kInfinity), glm::dvec3(kInfinity)}, {});
        else boxes.add({box.min - margin, box.max + margin}, rows);
    }
    return boxes;
}

Result<BakedFile> bakedFile(const VisibilityContent& content, bool packs) {
    BakedFile out;
    Result<Array<char>> in_place = visibilityFile(content, VisibilityForm::kInPlace);
    if (!in_place) return in_place.error();
    out.in_place = std::move(*in_place);
    const Result<VisibilityFile> opened = VisibilityFile::open(out.in_place, content.map_name);
    if (!opened) return opened.error();
    out.resident_bytes = opened->residentBytes();
    if (packs) out.packed = packedFile(*opened);
    return out;
}

}  // namespace sightline::bake
