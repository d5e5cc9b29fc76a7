// What must hold of prepared meshes that were read from any bytes: for the tests and the fuzzer.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

#include "sightline/geom/view.h"
#include "sightline/query/query.h"
#include "sightline/visfile/prepared_section.h"
#include "sightline/world/world.h"

namespace sightline::test {

/// Gives the meshes to a world and looks at them from two places, with all stages.
inline void drawPrepared(const PreparedMeshes& prepared) {
    constexpr size_t kMost = 64;
    World world;
    for (size_t i = 0; i < std::min(prepared.meshes.size(), kMost); ++i) {
        const PreparedMesh& mesh = prepared.meshes[i];
        ObjectDef object;
        object.bounds = {glm::dvec3(-2), glm::dvec3(2)};
        object.transform[3] = {4.0 * static_cast<double>(i), 0, 0, 1};
        object.key = i;
        if (!mesh.occluder.clusters.empty()) object.occluder = world.addOccluder(mesh.occluder, mesh.inner);
        object.shape = mesh.has_shape ? world.addShape(mesh.shape) : object.occluder;
        if (mesh.clusters.count() > 0) object.clusters = world.addClusters(mesh.clusters);
        if (!mesh.lods.levels.empty()) object.lods = world.addLods(mesh.lods.levels);
        world.add(object);
    }
    const Snapshot now = world.commit();
    QuerySettings settings;
    settings.stages = (1u << kStageCount) - 1;
    settings.occlusion_size = 128;
    settings.occluder_error = 4;
    settings.lod_error = 2;
    Query query;
    for (const double x : {0.5, -9.0}) {
        View view;
        view.view = lookAt({x, 3, 9}, {x / 2, 0, 0}, {0, 1, 0});
        view.projection = perspective(1.2, 4.0 / 3.0, 0.1);
        view.width = 160;
        view.height = 120;
        (void)query.visible(now, view, settings);
    }
}

/// Empty, or what is wrong with how the bytes of a section are read.
inline std::string faultOfPrepared(const Result<PreparedMeshes>& read, size_t objects) {
    if (!read.ok()) {
        const std::string& line = read.error().message;
        return line.rfind("a/map.see: ", 0) == 0 && line.find('\n') == std::string::npos
                   ? std::string()
                   : "not one line that begins with the file: " + line;
    }
    if (read->mesh_of_object.size() != objects) return "not a mesh for each object";
    for (const uint32_t mesh : read->mesh_of_object)
        if (mesh >= read->meshes.size() && mesh != PreparedMeshes::kNone)
            return "an object of a mesh that there is not";
    const Array<char> again = preparedSection(read->meshes, read->mesh_of_object);
    const Result<PreparedMeshes> second = readPreparedSection(again, objects, "again");
    if (!second.ok()) return "what was written again is refused: " + second.error().message;
    if (preparedSection(second->meshes, second->mesh_of_object) != again)
        return "what was written again is not the same";
    drawPrepared(*read);
    return {};
}

}  // namespace sightline::test
