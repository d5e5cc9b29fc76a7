// Draws a wall by an installed z-buffer, and asks an installed query whether it can be seen.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>
#include <sightline/studies/hidden/zbuffer/zbuffer.h>

int main() {
    const std::vector<glm::vec3> corners = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};

    sightline::View view;
    view.view = sightline::lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    view.projection = sightline::perspective(1.4, 1280.0 / 720.0, 0.1);

    sightline::World world;
    sightline::ObjectDef object;
    object.bounds = {{-5, -5, 0}, {5, 5, 0}};
    world.add(object);
    sightline::Query query;
    const bool seen = query.visible(world.commit(), view).objects.size() == 1;

    sightline::studies::DrawItem item;
    item.mesh = {corners, indices};
    const sightline::studies::ZBufferImage image = sightline::studies::renderZBuffer({&item, 1}, view);
    const bool drawn = image.id[image.id.size() / 2 + image.width / 2] == 0;

    std::printf("seen %d, drawn %d\n", seen, drawn);
    return seen && drawn ? 0 : 1;
}
