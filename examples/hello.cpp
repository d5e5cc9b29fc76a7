// The smallest program: which of three objects can be seen, and why one of them cannot.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

int main() {
    // Any mesh can hide what is behind it. It is prepared once, and shared by all objects that are made of it.
    const std::vector<glm::vec3> corners = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};

    sightline::World world;
    const sightline::OccluderId wall = world.addOccluder(sightline::prepareOccluder({corners, indices}));

    // An object is a box around all that is drawn of it, and what it hides with, if it hides anything.
    const auto add = [&](uint64_t key, glm::dvec3 low, glm::dvec3 high, sightline::OccluderId hides_with = {}) {
        sightline::ObjectDef object;
        object.bounds = {low, high};
        object.key = key;  // yours; the answer names objects by it
        object.occluder = hides_with;
        return world.add(object);
    };
    add(1, {-5, -5, 0}, {5, 5, 0}, wall);
    const sightline::ObjectId behind = add(2, {-1, -1, -9}, {1, 1, -8});
    add(3, {8, -1, -9}, {9, 1, -8});

    // The matrices are OpenGL's. The eye looks from z = 10 to the origin.
    sightline::View view;
    view.view = sightline::lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    view.projection = sightline::perspective(1.4, 1280.0 / 720.0, 0.1);

    // A snapshot never changes, whatever becomes of the world. A query is a thread's own, and is kept from frame to frame.
    const sightline::Snapshot now = world.commit();
    sightline::Query query;
    bool seen[4] = {};
    for (const sightline::Visible& object : query.visible(now, view).objects) seen[object.key] = true;
    std::printf("seen: wall %d, box behind it %d, box beside it %d\n", seen[1], seen[2], seen[3]);

    const sightline::Explanation why = query.explain(now, view, behind);
    const bool by_wall = why.occlusion.hiders.size() == 1 && why.occlusion.hiders[0].key == 1;
    std::printf("the box behind the wall is hidden by the wall alone: %d\n", by_wall);

    return seen[1] && !seen[2] && seen[3] && by_wall ? 0 : 1;
}
