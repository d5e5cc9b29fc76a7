// A world whose z points away from the viewer, as in Unity: mirrored by one matrix, with meshes and boxes as they are.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

namespace {

// Sightline's world is right-handed: the engine's, with z negated.
const glm::dmat4 kMirror = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};

/// What the engine has: a camera at z that looks along +z (turned: along -z), and its two matrices.
sightline::View viewOf(double z, bool turned, bool like_unity) {
    const double side = turned ? -1 : 1;
    // World to eye, x to the right and y up. Unity's eye looks along its -z, Direct3D's along its +z.
    const double depth = like_unity ? -side : side;
    const glm::dmat4 view = {side, 0, 0, 0, 0, 1, 0, 0, 0, 0, depth, 0, 0, 0, -depth * z, 1};
    glm::dmat4 projection = sightline::perspective(1.0, 16.0 / 9.0, 0.1, 100);
    if (!like_unity) {  // the same for depth from 0 to 1, and an eye that looks along +z
        projection[2] *= -1.0;
        for (int i = 0; i < 4; ++i) projection[i].z = 0.5 * (projection[i].z + projection[i].w);
    }
    sightline::View out;
    const sightline::ClipSpace space = like_unity
                                           ? sightline::ClipSpace{}
                                           : sightline::ClipSpace{sightline::ClipDepth::kZeroToOne, false, false, true};
    sightline::setMatrices(out, view * kMirror, projection, space);  // the mirror here
    return out;
}

}  // namespace

int main() {
    // A wall as the engine has it: its front looks towards -z, and its triangles turn clockwise as the engine shows them.
    const std::vector<glm::vec3> corners = {{-5, -5, 0}, {-5, 5, 0}, {5, 5, 0}, {5, -5, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};

    sightline::World world;
    const sightline::OccluderId wall = world.addOccluder(sightline::prepareOccluder({corners, indices}));
    const auto add = [&](uint64_t key, glm::dvec3 low, glm::dvec3 high, const glm::dmat4& transform,
                         sightline::OccluderId hides_with = {}) {
        sightline::ObjectDef object;
        object.bounds = {low, high};             // in the mesh's own space, as it is
        object.transform = kMirror * transform;  // and the mirror here
        object.key = key;
        object.occluder = hides_with;
        world.add(object);
    };
    const auto moved = [](double x, double z) { return glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, z, 1); };
    add(1, {-5, -5, 0}, {5, 5, 0}, moved(0, 10), wall);
    add(2, {-1, -1, -1}, {1, 1, 1}, moved(0, 20));   // behind the wall
    add(3, {-1, -1, -1}, {1, 1, 1}, moved(12, 20));  // to the right of it
    add(4, {-1, -1, -1}, {1, 1, 1}, moved(0, 3));    // before it

    const sightline::Snapshot now = world.commit();
    sightline::Query query;
    bool right = true;
    for (const bool like_unity : {true, false}) {
        // From before the wall, and from behind it, where its back is not drawn.
        for (const bool behind : {false, true}) {
            const sightline::VisibleSet set = query.visible(now, viewOf(behind ? 40 : 0, behind, like_unity));
            bool seen[5] = {};
            for (const sightline::Visible& object : set.objects) seen[object.key] = true;
            std::printf("%s, from %s: wall %d, behind it %d, beside it %d, before it %d\n",
                        like_unity ? "Unity" : "Direct3D", behind ? "behind" : "before", seen[1], seen[2], seen[3],
                        seen[4]);
            right = right && set.problem == sightline::ViewProblem::kNone && seen[2] == behind && seen[3] && seen[4];
        }
    }
    return right ? 0 : 1;
}
