// The occlusion buffer alone, for programs with a scene tree of their own: draw what hides, ask what is hidden.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

int main() {
    const std::vector<glm::vec3> corners = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    const sightline::Occluder wall = sightline::prepareOccluder({corners, indices});  // once a mesh

    sightline::View view;
    view.view = sightline::lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    view.projection = sightline::perspective(1.4, 1280.0 / 720.0, 0.1);

    // The buffer may be far smaller than the image: what it hides is hidden at every resolution.
    sightline::OcclusionBuffer buffer(320);
    buffer.begin(view);

    // Draw the nearest things first, and ask in the same order: then most of what follows is hidden.
    const uint32_t triangles = buffer.draw(wall);
    const bool behind = buffer.ask({{-1, -1, -9}, {1, 1, -8}}) == sightline::Sight::kOccluded;
    const bool beside = buffer.ask({{8, -1, -9}, {9, 1, -8}}) == sightline::Sight::kVisible;
    const bool before = buffer.ask({{-1, -1, 2}, {1, 1, 3}}) == sightline::Sight::kVisible;
    const bool elsewhere = buffer.ask({{90, -1, -9}, {91, 1, -8}}) == sightline::Sight::kOutside;
    std::printf("%u triangles drawn into %u x %u pixels\n", triangles, buffer.width(), buffer.height());
    std::printf("hidden behind the wall %d; seen beside it %d, before it %d; out of view %d\n", behind, beside, before,
                elsewhere);

    // The buffer as an image, to look at: 1 where a pixel is covered all over.
    std::vector<float> nearness(size_t{buffer.width()} * buffer.height());
    std::vector<uint8_t> covered(nearness.size());
    buffer.depthImage(nearness, covered);
    for (uint32_t y = buffer.height(); y > 0; y -= y < 12 ? y : 12) {
        for (uint32_t x = 0; x < buffer.width(); x += 6)
            std::putchar(covered[size_t{y - 1} * buffer.width() + x] ? '#' : '.');
        std::putchar('\n');
    }
    return triangles == 2 && behind && beside && before && elsewhere ? 0 : 1;
}
