// The occlusion buffer alone, from C: for programs that have a scene tree of their own and want a rasterizer.
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include <sightline/c/sightline.h>

int main(void) {
    /* A wall; counter-clockwise is its front. Prepared once a mesh. */
    const float corners[] = {-5, -5, 0, 5, -5, 0, 5, 5, 0, -5, 5, 0};
    const uint16_t indices[] = {0, 1, 2, 0, 2, 3};
    slOccluderDef def = slDefaultOccluderDef();
    def.mesh.positions = corners;
    def.mesh.vertex_count = 4;
    def.mesh.indices = indices;
    def.mesh.index_count = 6;
    def.mesh.index_size = sizeof indices[0];
    slOccluder* wall = NULL;
    if (slPrepareOccluder(&def, &wall) != SL_OK) return 1;

    slView view = slDefaultView();
    const double eye[3] = {0, 0, 10}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    slLookAt(view.view, eye, target, up);
    slPerspective(view.projection, 1.4, 1280.0 / 720.0, 0.1, INFINITY);

    /* The buffer may be far smaller than the image: what it hides is hidden at every resolution. */
    slBuffer* buffer = NULL;
    if (slCreateBuffer(320, NULL, &buffer) != SL_OK || slBufferBegin(buffer, &view) != SL_OK) return 1;

    /* Draw the nearest things first, and ask in the same order: then most of what follows is hidden. */
    uint32_t triangles = 0;
    slBufferDraw(buffer, wall, NULL, &triangles);
    const slBox boxes[] = {{{-1, -1, -9}, {1, 1, -8}},   /* behind the wall */
                           {{8, -1, -9}, {9, 1, -8}},    /* beside it */
                           {{-1, -1, 2}, {1, 1, 3}},     /* before it */
                           {{90, -1, -9}, {91, 1, -8}}}; /* out of view */
    uint8_t seen[4];
    slBufferAsk(buffer, boxes, 4, seen);
    const char* const words[] = {"may be seen", "is hidden", "is out of view"};
    for (int i = 0; i < 4; ++i) printf("box %d %s\n", i, words[seen[i]]);

    /* The buffer as an image, to look at. */
    slDepthImage image;
    slBufferImage(buffer, &image);
    for (uint32_t y = image.height; y > 0; y -= y < 12 ? y : 12) {
        for (uint32_t x = 0; x < image.width; x += 6)
            putchar(image.covered[(size_t)(y - 1) * image.width + x] ? '#' : '.');
        putchar('\n');
    }
    slDestroyBuffer(buffer);
    slDestroyOccluder(wall);
    return triangles == 2 && seen[0] == SL_HIDDEN && seen[1] == SL_SEEN && seen[2] == SL_SEEN && seen[3] == SL_OUTSIDE
               ? 0
               : 1;
}
