// A small scene and a run through it, made by hand: a wall, a quad behind it, and two quads that share a key.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/scene.h"

namespace sightline {
using namespace tools;

inline Mesh quadMesh(double half, double z) {
    Mesh mesh;
    const auto h = static_cast<float>(half), depth = static_cast<float>(z);
    mesh.positions = {{-h, -h, depth}, {h, -h, depth}, {h, h, depth}, {-h, h, depth}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.primitives = {{0, 2, 0}};
    for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
    return mesh;
}

/// Object 0 (key 7) is a wall at z = 0; 1 (key 3) stands behind it; 2 and 3 (key 5) lie beside the view and in it.
inline Scene madeScene() {
    Scene scene;
    scene.name = "made";
    scene.materials.resize(1);
    scene.meshes = {quadMesh(2, 0), quadMesh(0.5, -3)};
    const auto add = [&](uint64_t key, uint32_t mesh, double x, const char* name) {
        SceneObject object;
        object.key = key;
        object.mesh = mesh;
        object.transform[3] = {x, 0, 0, 1};
        object.name = name;
        scene.objects.push_back(object);
    };
    add(7, 0, 0, "wall");
    add(3, 1, 0, "behind <the> \"wall\"");
    add(5, 1, 90, "beside");
    add(5, 1, 4, "in view");
    return scene;
}

inline CullRun madeRun(const Scene& scene, size_t frames = 2) {
    CullRun run;
    const auto order = orderByKey(scene);
    run.scene = "a <made> \"scene\".glb";
    run.command = "sightline cull 'a <made> scene'";
    run.objects = countKeys(scene, order);
    run.instances = scene.objects.size();
    run.triangles = drawnTriangles(scene);
    run.width = 64;
    run.height = 36;
    run.jitter = 0.5;
    for (size_t i = 0; i < frames; ++i) {
        FrameResult frame;
        frame.camera.eye = {0.01 * double(i), 0, 6};
        frame.camera.target = {0.01 * double(i), 0, 0};
        frame.reasons = {0, 1 + static_cast<int>(Stage::kOcclusion), 1 + static_cast<int>(Stage::kFrustum), 0};
        frame.query_microseconds = 10.5 + double(i);
        frame.stages[static_cast<int>(Stage::kFrustum)].microseconds = 2.5;
        countByKey(scene, order, run.settings.stages, frame);
        VerificationRow row;
        row.rays = 1000;
        row.supersampling = 4;
        row.id_samples = 64 * 36 * 16;
        row.exactly_visible = 2;
        row.proofs = ProofCounts{2, 0, i, 1};
        frame.verification = row;
        run.frames.push_back(frame);
    }
    return run;
}

}  // namespace sightline
