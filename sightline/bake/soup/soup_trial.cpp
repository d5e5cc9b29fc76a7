// Looks round from places, and counts the objects of the cells that are seen.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_trial.h"

#include <algorithm>
#include <vector>

#include "sightline/bake/objects/object_cells.h"
#include "sightline/cells/portals.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// The six views from a place that cover all directions.
std::vector<View> viewsRound(const glm::dvec3& eye, double z_near) {
    constexpr uint32_t kSide = 64;  // [pixels]
    std::vector<View> views;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            CameraFrame frame;
            glm::dvec3 along(0.0), up(0.0);
            along[axis] = side;
            up[(axis + 1) % 3] = 1;
            frame.eye = eye;
            frame.target = eye + along;
            frame.up = up;
            frame.fov_y_degrees = 90;
            frame.z_near = z_near;
            views.push_back(makeView(frame, kSide, kSide));
        }
    return views;
}

}  // namespace

SoupTrial trialOf(const Scene& scene, const SoupCells& cells, const SoupCellSettings& settings, double diagonal) {
    ObjectCellSettings placing;
    placing.jobs = settings.jobs;
    const ObjectCells objects = cellsOfObjects(scene, cells.space, placing);
    const PortalGraph graph(cells.space);
    const double z_near = diagonal / 4096;
    PortalFlood flood;
    std::vector<bool> seen(graph.cells());
    SoupTrial out;
    out.smallest_occluder = cells.report.smallest_occluder;
    out.cells = graph.cells();
    out.portals = graph.portals();
    for (const glm::dvec3& eye : settings.eyes) {
        seen.assign(graph.cells(), false);
        for (const View& view : viewsRound(eye, z_near)) {
            if (!flood.run(graph, view)) seen.assign(graph.cells(), true);
            for (const SeenCell& cell : flood.cells()) seen[cell.cell] = true;
            out.portals_tried += static_cast<double>(flood.stats().portals);
        }
        for (size_t i = 0; i < objects.places.size(); ++i) {
            const auto in = objects.places.cellsOf(i);
            const bool counts = objects.places.everywhere[i] ||
                                std::any_of(in.begin(), in.end(), [&](uint32_t cell) { return seen[cell]; });
            out.objects_seen += counts;
        }
    }
    const double places = std::max<double>(1, static_cast<double>(settings.eyes.size()));
    out.objects_seen /= places;
    out.portals_tried /= places;
    return out;
}

}  // namespace sightline::bake
