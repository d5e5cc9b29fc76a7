// Prints a number for many answers of the query: tools/try_foreign compares what machines print.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/query.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline::test {
namespace {

/// Walls, and bars across their boxes under any transform.
World makeWorld(Random& random) {
    World world;
    TestMesh wall_mesh = boxMesh(), bar_mesh = boxMesh();
    for (glm::vec3& p : bar_mesh.positions) p = p.z < 0.5f ? 0.1f * p : glm::vec3(1) - 0.1f * (glm::vec3(1, 1, 2) - p);
    const OccluderId wall = world.addOccluder(prepareOccluder(wall_mesh.view()));
    const OccluderId bar = world.addOccluder(prepareOccluder(bar_mesh.view()));
    for (int i = 0; i < 400; ++i) {
        const bool is_wall = i % 5 == 0;
        glm::dmat4 t(1.0);
        for (int axis = 0; axis < 3; ++axis) t[axis][axis] = is_wall ? random.uniform(0.2, 9) : random.uniform(0.3, 5);
        if (is_wall) t[i % 2 ? 0 : 2] *= 0.05;
        else
            for (int k = 0; k < 3; ++k) t[k][(k + 1) % 3] = random.uniform(-1, 1);
        if (!is_wall && i % 3 == 0) t[0] = -t[0];
        t[3] = glm::dvec4(randomVector(random, {15, 5, 15}), 1.0);
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform = t;
        def.key = static_cast<uint64_t>(i);
        def.shape = is_wall ? wall : bar;
        if (i % 4 != 1) def.occluder = def.shape;
        world.add(def);
    }
    return world;
}

/// A walk, asked frame by frame and in other ways: how many objects were kept, and a number for which and in what order.
void printAnswers(uint64_t seed) {
    Random random(seed);
    World world = makeWorld(random);
    const Snapshot now = world.commit();
    const glm::dvec3 start = randomVector(random, {12, 4, 12}), step = randomVector(random, {0.1, 0, 0.1});
    const QuerySettings ways[] = {{},
                                  {.stateless = true},
                                  {.second_look = false, .stateless = true},
                                  {.faces = false, .second_look = false, .stateless = true},
                                  {.proofs = false, .stateless = true},
                                  {.occlusion_size = 640, .stateless = true}};
    Query walk;
    uint64_t kept = 0, number = 0;
    for (int frame = 0; frame < 24; ++frame) {
        View view = viewAt(start + double(frame) * step, 3.0 * step, {frame % 2 ? 100.0 : 50.0, 320, 180});
        if (frame % 3 == 2) view.projection = orthographic(12, 16.0 / 9.0, 0.1, 100);
        for (const QuerySettings& way : ways) {
            Query cold;
            const VisibleSet set = (way.stateless ? cold : walk).visible(now, view, way);
            kept += set.objects.size();
            for (const Visible& object : set.objects) number = mixSeed(number, object.key);
        }
    }
    std::printf("world %d: %d kept, %016llx\n", int(seed), int(kept), static_cast<unsigned long long>(number));
}

}  // namespace
}  // namespace sightline::test

int main() {
    for (uint64_t seed = 1; seed <= 4; ++seed) sightline::test::printAnswers(seed);
}
