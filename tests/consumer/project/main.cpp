// Asks an installed Sightline for what can be seen: a wall, a box behind it, a box beside it.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/hidden/zbuffer.h>
#include <sightline/prepare/occluder.h>
#include <sightline/run/query.h>

int main() {
    const std::vector<glm::vec3> corners = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    const sightline::MeshView wall{corners, indices};

    sightline::World world;
    const sightline::OccluderId occluder = world.addOccluder(sightline::prepareOccluder(wall));
    const auto add = [&](uint64_t key, glm::dvec3 low, glm::dvec3 high, sightline::OccluderId hides_with) {
        sightline::ObjectDef object;
        object.bounds.grow(low);
        object.bounds.grow(high);
        object.key = key;
        object.occluder = hides_with;
        world.add(object);
    };
    add(1, {-5, -5, 0}, {5, 5, 0}, occluder);
    add(2, {-1, -1, -9}, {1, 1, -8}, {});
    add(3, {8, -1, -9}, {9, 1, -8}, {});

    sightline::View view;
    view.view = sightline::lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    view.projection = sightline::perspective(1.4, 1280.0 / 720.0, 0.1);

    sightline::Query query;
    bool seen[4] = {};
    for (const sightline::Visible& object : query.visible(world.commit(), view).objects) seen[object.key] = true;

    sightline::DrawItem item;
    item.mesh = wall;
    const sightline::ZBufferImage image = sightline::renderZBuffer({&item, 1}, view);
    const bool drawn = image.id[image.id.size() / 2 + image.width / 2] == 0;

    std::printf("wall %d, behind %d, beside %d, drawn %d\n", seen[1], seen[2], seen[3], drawn);
    return seen[1] && !seen[2] && seen[3] && drawn ? 0 : 1;
}
