// Bakes a scene in cells: which cells and objects each cell sees, as a visibility file that a world can attach.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "sightline/bake/bake.h"
#include "sightline/base/thread_pool.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/scene/procedural.h"

namespace {

int fail(const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return fail("usage: bake SCENE OUT, as in bake building:1:2 house.vis");
    // A scene of your own has objects, cells and portals; this one is made up.
    const sightline::Result<sightline::tools::Scene> scene = sightline::tools::makeProcedural(argv[1]);
    if (!scene) return fail(scene.error().message);
    if (scene->cells.empty()) return fail(std::string(argv[1]) + ": has no cells");

    sightline::ThreadPool threads(4);
    sightline::bake::BakeSettings settings;
    settings.jobs = &threads;
    settings.object_rows = true;
    // What meshes hide with goes into the file, too: whoever opens it need not prepare them.
    std::vector<sightline::PreparedMesh> meshes;
    std::vector<uint32_t> mesh_of_object;
    for (const sightline::tools::Mesh& mesh : scene->meshes)
        meshes.push_back(sightline::tools::prepareMesh(*scene, mesh, {}));
    for (const sightline::tools::SceneObject& object : scene->objects) mesh_of_object.push_back(object.mesh);
    settings.prepared = meshes;
    settings.prepared_of_object = mesh_of_object;
    sightline::bake::SceneCellSettings marks;
    marks.trusted = true;  // who made the scene knows its walls; without it they are searched for holes
    const sightline::Result<sightline::bake::Baked> baked =
        sightline::bake::bake(sightline::bake::sceneToBake(*scene, argv[1], marks), *scene, settings);
    if (!baked) return fail(baked.error().message);

    const std::span<const char> bytes = baked->file.bytes(settings.form);
    std::ofstream(argv[2], std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));

    const size_t cells = baked->rows.visible.rows();
    std::printf("%zu cells, of which each sees %.1f; %zu bytes\n", cells,
                static_cast<double>(baked->rows.visible.count()) / static_cast<double>(cells), bytes.size());
    const sightline::Result<sightline::VisibilityFile> file = sightline::VisibilityFile::open(bytes, argv[2]);
    return file && file->hasCells() && file->hasObjectRows() ? 0 : fail("the file does not open");
}
