// Baking for the C interface: a caller's meshes as a scene, and the steps of a bake.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <new>
#include <string>

#include "sightline/bake/bake.h"
#include "sightline/c/bake/bake.h"
#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/handles.h"

using namespace sightline;
using c::fail;

struct slBaked {
    bake::BakedFile file;
    uint32_t cells = 0;
};

namespace {

constexpr char kBake[] = "slBake";

/// The materials of a scene: by whether they hide, and whether both sides are drawn.
uint32_t materialOf(bool hides, bool double_sided) { return (hides ? 0u : 2u) + double_sided; }

std::vector<tools::Material> allMaterials() {
    std::vector<tools::Material> materials(4);
    for (uint32_t i = 0; i < 4; ++i) {
        materials[i].alpha_mode = i & 2 ? tools::AlphaMode::kBlend : tools::AlphaMode::kOpaque;
        materials[i].double_sided = i & 1;
    }
    return materials;
}

slStatus addMesh(const slBakeMesh& from, const slLog& log, tools::Scene& scene) {
    c::MeshCopy copy;
    if (const slStatus status = c::toMesh(from.mesh, log, kBake, copy)) return status;
    tools::Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions.assign(copy.view.positions.begin(), copy.view.positions.end());
    mesh.indices.assign(copy.view.indices.begin(), copy.view.indices.end());
    for (const glm::vec3& p : mesh.positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return fail(log, SL_BAD_ARGUMENT, kBake, "a mesh has a position that is not finite");
        mesh.bounds.grow(glm::dvec3(p));
    }
    for (uint32_t t = 0; t < mesh.triangles(); ++t) {
        const bool both = from.double_sided ? from.double_sided[t] != 0 : from.both_sides;
        const uint32_t material = materialOf(!from.hides || from.hides[t], both);
        if (mesh.primitives.empty() || mesh.primitives.back().material != material)
            mesh.primitives.push_back({t, 0, material});
        ++mesh.primitives.back().triangle_count;
    }
    return SL_OK;
}

slStatus addObjects(const slBakeDef& def, const slLog& log, tools::Scene& scene) {
    for (size_t i = 0; i < def.object_count; ++i) {
        const slBakeObject& from = def.objects[i];
        if (from.mesh >= def.mesh_count)
            return fail(log, SL_BAD_ARGUMENT, kBake, "an object's mesh is none of def.meshes");
        if (c::isProjective(from.transform))
            return fail(log, SL_BAD_ARGUMENT, kBake, "an object's transform is not affine: is it transposed?");
        for (const double number : from.transform)
            if (!std::isfinite(number)) return fail(log, SL_BAD_ARGUMENT, kBake, "an object's transform is not finite");
        tools::SceneObject& object = scene.objects.emplace_back();
        object.key = from.key;
        object.mesh = from.mesh;
        object.transform = c::matrix(from.transform);
        object.name = from.name ? from.name : "";
    }
    return SL_OK;
}

/// Why a portal is none, or null. Whether walls are where it stands is looked at by the bake.
const char* wrongWith(const tools::ScenePortal& portal, const tools::Scene& scene) {
    constexpr double kAway = 0.5;  // walls are as thick as twice this at most [world units]
    glm::dvec3 area(0.0);
    for (size_t k = 0; k < portal.polygon.size(); ++k) {
        const glm::dvec3& p = portal.polygon[k];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "a portal's corner is not finite";
        for (const uint32_t cell : portal.cells) {
            const Box3d& box = scene.cells[cell].bounds;
            for (int axis = 0; axis < 3; ++axis)
                if (p[axis] < box.min[axis] - kAway || p[axis] > box.max[axis] + kAway)
                    return "a portal's corner does not lie on both of its cells";
        }
        area += glm::cross(p - portal.polygon[0], portal.polygon[(k + 1) % portal.polygon.size()] - portal.polygon[0]);
    }
    return glm::length(area) > 0 ? nullptr : "a portal has no area";
}

slStatus addCells(const slBakeDef& def, const slLog& log, tools::Scene& scene) {
    for (size_t i = 0; i < def.cell_count; ++i) {
        const Box3d box = c::box(def.cells[i].box);
        if (!box.finite() || box.empty())
            return fail(log, SL_BAD_ARGUMENT, kBake, "a cell's box is empty or not finite");
        tools::SceneCell& cell = scene.cells.emplace_back();
        cell.name = def.cells[i].name ? def.cells[i].name : "cell " + std::to_string(i);
        cell.bounds = box;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {1.0, -1.0}) {
                glm::dvec4 plane(0.0);
                plane[axis] = side;
                plane[3] = side > 0 ? -box.min[axis] : box.max[axis];
                cell.planes.push_back(plane);
            }
    }
    for (size_t i = 0; i < def.portal_count; ++i) {
        const slBakePortal& from = def.portals[i];
        if (from.cells[0] >= def.cell_count || from.cells[1] >= def.cell_count || from.cells[0] == from.cells[1])
            return fail(log, SL_BAD_ARGUMENT, kBake, "a portal does not join two of def.cells");
        if (!from.corners || from.corner_count < 3)
            return fail(log, SL_BAD_ARGUMENT, kBake, "a portal has fewer than three corners");
        if (from.door != SL_NOTHING && (from.door >= def.object_count || !def.objects[from.door].moves))
            return fail(log, SL_BAD_ARGUMENT, kBake, "a portal's door is none of def.objects that moves");
        tools::ScenePortal& portal = scene.portals.emplace_back();
        portal.name = from.name ? from.name : "portal " + std::to_string(i);
        portal.cells[0] = from.cells[0];
        portal.cells[1] = from.cells[1];
        for (size_t k = 0; k < from.corner_count; ++k) portal.polygon.push_back(c::vec(from.corners[k]));
        if (const char* const wrong = wrongWith(portal, scene)) return fail(log, SL_BAD_ARGUMENT, kBake, wrong);
        // Counter-clockwise as seen from the first cell, whichever way round it came.
        const glm::dvec3 normal =
            glm::cross(portal.polygon[1] - portal.polygon[0], portal.polygon[2] - portal.polygon[0]);
        if (glm::dot(normal, scene.cells[from.cells[0]].bounds.center() - portal.polygon[0]) < 0)
            std::reverse(portal.polygon.begin(), portal.polygon.end());
        portal.door = from.door == SL_NOTHING ? tools::ScenePortal::kNone : from.door;
        if (portal.door != tools::ScenePortal::kNone) portal.door_name = scene.objects[portal.door].name;
    }
    return SL_OK;
}

slStatus checkEyes(const slBakeDef& def, const slLog& log) {
    for (size_t i = 0; i < def.eye_count; ++i)
        for (const double number : def.eyes[i])
            if (!std::isfinite(number)) return fail(log, SL_BAD_ARGUMENT, kBake, "an eye is not finite");
    return SL_OK;
}

/// Step 1, by what the caller knows of cells.
bake::BakeCells cellsOf(const slBakeDef& def, const tools::Scene& scene, Jobs* jobs) {
    std::vector<uint32_t> movable;
    for (uint32_t i = 0; i < def.object_count; ++i)
        if (def.objects[i].moves) movable.push_back(i);
    bake::BakeCells cells;
    if (def.cell_count > 0) {
        bake::SceneCellSettings settings;
        settings.trusted = def.trusted;
        settings.movable = movable;
        cells = bake::sceneToBake(scene, "", settings);
    } else {
        bake::SoupCellSettings settings;
        settings.movable = movable;
        settings.jobs = jobs;
        bake::SoupCellReport report;
        cells = bake::soupToBake(scene, "", settings, &report);
        if (report.hardlyAnInside() || cells.space.graph.cells == 0) cells = bake::openToBake(scene, "");
    }
    if (def.view_cells >= 2) {
        bake::ViewCellSettings settings;
        settings.most_cells = def.view_cells;
        settings.movable = movable;
        settings.jobs = jobs;
        for (size_t i = 0; i < def.eye_count; ++i) settings.eyes.push_back(c::vec(def.eyes[i]));
        bake::addViewCells(cells, scene, settings);
    }
    for (uint32_t i = 0; i < def.object_count; ++i) cells.placing.moves.push_back(def.objects[i].moves);
    return cells;
}

slStatus bakeChecked(const slBakeDef& def, slBaked& baked) {
    const slLog& log = def.hooks.log;
    tools::Scene scene;
    scene.materials = allMaterials();
    for (size_t i = 0; i < def.mesh_count; ++i)
        if (const slStatus status = addMesh(def.meshes[i], log, scene)) return status;
    if (const slStatus status = addObjects(def, log, scene)) return status;
    if (const slStatus status = addCells(def, log, scene)) return status;
    if (const slStatus status = checkEyes(def, log)) return status;
    c::HookJobs jobs(def.hooks.jobs);
    bake::BakeSettings settings;
    settings.jobs = jobs.given() ? &jobs : nullptr;
    settings.form = VisibilityForm::kInPlace;
    bool stopped = false;
    if (def.progress) {
        settings.progress = [&](const bake::BakeProgress& at) {
            stopped = stopped || !def.progress(def.user, at.step, at.done);
        };
        settings.stop = [&] { return stopped; };
    }
    const Result<bake::Baked> made = bake::bake(cellsOf(def, scene, settings.jobs), scene, settings);
    if (!made) return fail(log, SL_BAD_ARGUMENT, kBake, made.error().message.c_str());
    if (made->interrupted) return fail(log, SL_STOPPED, kBake);
    baked.file = made->file;
    baked.cells = made->cells.space.graph.cells;
    return SL_OK;
}

}  // namespace

slBakeDef slDefaultBakeDef(void) {
    slBakeDef def{};
    def.cookie = c::kBakeCookie;
    return def;
}

slStatus slBake(const slBakeDef* def, slBaked** baked_out) {
    if (!def || !baked_out) return fail({}, SL_BAD_ARGUMENT, kBake, "def or baked_out is null");
    const slLog& log = def->hooks.log;
    if (def->cookie != c::kBakeCookie)
        return fail(log, SL_NO_DEFAULTS, kBake, "the def did not begin as slDefaultBakeDef()");
    if ((def->mesh_count > 0 && !def->meshes) || (def->object_count > 0 && !def->objects) ||
        (def->cell_count > 0 && !def->cells) || (def->portal_count > 0 && !def->portals) ||
        (def->eye_count > 0 && !def->eyes))
        return fail(log, SL_BAD_ARGUMENT, kBake, "an array of the def is null");
    try {
        auto baked = std::make_unique<slBaked>();
        if (const slStatus status = bakeChecked(*def, *baked)) return status;
        *baked_out = baked.release();
        return SL_OK;
    } catch (const std::bad_alloc&) { return fail(log, SL_NO_MEMORY, kBake); }
}

const void* slBakedBytes(const slBaked* baked, size_t* size_out) {
    if (size_out) *size_out = baked ? baked->file.in_place.size() : 0;
    return baked ? baked->file.in_place.data() : nullptr;
}

uint32_t slBakedCells(const slBaked* baked) { return baked ? baked->cells : 0; }

void slDestroyBaked(slBaked* baked) { delete baked; }
