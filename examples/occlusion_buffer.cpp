// The occlusion buffer alone, for programs with a scene tree of their own: draw what hides, ask what is hidden.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

namespace {

/// Draws all clusters of an occluder that have an image. The transform must live as long as the tiles are asked.
uint32_t draw(sightline::DepthTiles& tiles, const sightline::Screen& screen, const sightline::Occluder& occluder,
              const glm::dmat4& transform) {
    const sightline::OccluderInstance instance = sightline::makeOccluderInstance(screen, occluder, transform);
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < occluder.clusters.size(); ++i) {
        const sightline::BoxAnswer box = sightline::projectBox(instance.screen, occluder.clusters[i].bounds);
        if (!box.outside) triangles += sightline::drawOccluder(tiles, instance, i, box);
    }
    return triangles;
}

/// Whether a box, placed by a transform, may be seen. A box in doubt may: it touches the near plane, say.
bool mayBeSeen(sightline::DepthTiles& tiles, const sightline::Screen& screen, const sightline::Box3f& box,
               const glm::dmat4& transform) {
    const sightline::BoxAnswer answer = sightline::projectBox(sightline::objectScreen(screen, transform), box);
    if (answer.outside) return false;
    return answer.doubt || !sightline::isHidden(tiles, answer.rect);
}

}  // namespace

int main() {
    const std::vector<glm::vec3> corners = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    const sightline::Occluder wall = sightline::prepareOccluder({corners, indices});

    sightline::View view;
    view.view = sightline::lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    view.projection = sightline::perspective(1.4, 1280.0 / 720.0, 0.1);

    // The buffer may be far smaller than the image: what it hides is hidden at every resolution.
    const sightline::Screen screen = sightline::makeScreen(view, 320);
    sightline::DepthTiles tiles;
    tiles.clear(screen.width, screen.height);

    // Draw the nearest things first, and ask in the same order: then most of what follows is hidden.
    const glm::dmat4 here(1.0);
    const uint32_t triangles = draw(tiles, screen, wall, here);
    const bool behind = mayBeSeen(tiles, screen, {{-1, -1, -9}, {1, 1, -8}}, here);
    const bool beside = mayBeSeen(tiles, screen, {{8, -1, -9}, {9, 1, -8}}, here);
    const bool before = mayBeSeen(tiles, screen, {{-1, -1, 2}, {1, 1, 3}}, here);
    std::printf("%u triangles drawn into %u x %u pixels\n", triangles, screen.width, screen.height);
    std::printf("may be seen: behind the wall %d, beside it %d, before it %d\n", behind, beside, before);

    // The buffer as an image, to look at: 1 where a pixel is covered all over.
    std::vector<float> nearness(size_t{tiles.width} * tiles.height);
    std::vector<uint8_t> covered(nearness.size());
    sightline::readDepthImage(tiles, sightline::Seams::kResolve, nearness, covered);
    for (uint32_t y = tiles.height; y > 0; y -= y < 12 ? y : 12) {
        for (uint32_t x = 0; x < tiles.width; x += 6)
            std::putchar(covered[size_t{y - 1} * tiles.width + x] ? '#' : '.');
        std::putchar('\n');
    }
    return triangles == 2 && !behind && beside && before ? 0 : 1;
}
