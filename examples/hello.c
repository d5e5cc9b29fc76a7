// The smallest program: a wall hides one of two boxes, and the library says why.
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include <sightline/c/sightline.h>

static slObjectId add(slWorld* world, uint64_t key, slBox bounds, slOccluderId hides_with) {
    slObjectDef def = slDefaultObjectDef();
    slObjectId id = {0, 0};
    def.key = key; /* yours: the answer names objects by it */
    def.bounds = bounds;
    def.occluder = hides_with;
    slAddObject(world, &def, &id);
    return id;
}

int main(void) {
    const float corners[] = {-5, -5, 0, 5, -5, 0, 5, 5, 0, -5, 5, 0};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    const slBox wall_box = {{-5, -5, 0}, {5, 5, 0}}, behind_box = {{-1, -1, -9}, {1, 1, -8}},
                beside_box = {{8, -1, -9}, {9, 1, -8}};
    const slOccluderId none = {0};

    /* Any mesh can hide what is behind it. It is prepared once, and shared by all objects that are made of it. */
    slOccluderDef mesh = slDefaultOccluderDef();
    mesh.mesh.positions = corners;
    mesh.mesh.vertex_count = 4;
    mesh.mesh.indices = indices;
    mesh.mesh.index_count = 6;
    slOccluder* prepared = NULL;
    if (slPrepareOccluder(&mesh, &prepared) != SL_OK) return 1;

    slWorldDef def = slDefaultWorldDef();
    slWorld* world = NULL;
    slOccluderId wall = none;
    if (slCreateWorld(&def, &world) != SL_OK || slAddOccluder(world, prepared, &wall) != SL_OK) return 1;
    slDestroyOccluder(prepared);
    add(world, 1, wall_box, wall);
    const slObjectId behind = add(world, 2, behind_box, none);
    add(world, 3, beside_box, none);

    /* The eye looks from z = 10 to the origin. Other matrices than OpenGL's: view.clip_space. */
    const double eye[3] = {0, 0, 10}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    slView view = slDefaultView();
    slLookAt(view.view, eye, target, up);
    slPerspective(view.projection, 1.4, 1280.0 / 720.0, 0.1, INFINITY);

    /* A snapshot never changes. A query is a thread's own, and is kept from frame to frame. */
    slSnapshot* now = NULL;
    slQuery* query = NULL;
    slVisibleSet set;
    if (slCommit(world, &now) != SL_OK || slCreateQuery(NULL, &query) != SL_OK) return 1;
    if (slQueryVisible(query, now, &view, NULL, &set) != SL_OK) return 1;
    for (uint32_t i = 0; i < set.count; ++i) printf("seen: object %u\n", (unsigned)set.objects[i].key);
    const int seen = (int)set.count;

    slExplanation why;
    char words[200];
    slQueryExplain(query, now, &view, NULL, behind, &why);
    slExplanationWords(&why, words, sizeof words);
    printf("%s\n", words);

    slDestroyQuery(query);
    slReleaseSnapshot(now);
    slDestroyWorld(world);
    return seen == 2 && why.verdict == SL_OCCLUDED ? 0 : 1;
}
