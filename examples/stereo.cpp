// Two eyes of a headset: one call that says what either eye may see, and which of the two.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

int main() {
    const std::vector<glm::vec3> corners = {{-0.3, -9, 7}, {0.3, -9, 7}, {0.3, 9, 7}, {-0.3, 9, 7}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};

    sightline::World world;
    const sightline::OccluderId pillar = world.addOccluder(sightline::prepareOccluder({corners, indices}));
    const auto add = [&](uint64_t key, glm::dvec3 low, glm::dvec3 high, sightline::OccluderId hides_with = {}) {
        sightline::ObjectDef object;
        object.bounds = {low, high};
        object.key = key;
        object.occluder = hides_with;
        world.add(object);
    };
    add(1, {-0.3, -9, 7}, {0.3, 9, 7}, pillar);  // a metre before the viewer
    add(2, {-1, -1, -13}, {1, 1, -12});          // behind the pillar for both eyes
    add(3, {5.7, -1, -13}, {6.2, 1, -12});       // the right eye looks past the pillar, the left one does not
    add(4, {9, -1, -13}, {10, 1, -12});

    // The runtime of the headset gives each eye its own view and projection, which need not be symmetric: setMatrices()
    // takes those of OpenXR with Vulkan or Direct3D. Here the eyes are half of 64 mm beside one camera.
    sightline::View camera;
    camera.view = sightline::lookAt({0, 0, 8}, {0, 0, 0}, {0, 1, 0});
    camera.projection = sightline::perspective(1.6, 1.0, 0.05);
    camera.width = camera.height = 1440;
    const sightline::View left = sightline::shiftedEye(camera, -0.032), right = sightline::shiftedEye(camera, 0.032);

    const sightline::Snapshot now = world.commit();
    sightline::Query query;
    const sightline::StereoSet set = query.visibleStereo(now, left, right);
    // Draw once for both eyes (instanced, multiview) what is in the answer; or for each eye what has its bit.
    uint8_t eyes[5] = {};
    for (size_t i = 0; i < set.objects.size(); ++i) eyes[set.objects[i].key] = set.eyes[i];
    for (int key = 1; key <= 4; ++key)
        std::printf("object %d: left %d, right %d\n", key, (eyes[key] & sightline::kLeftEye) != 0,
                    (eyes[key] & sightline::kRightEye) != 0);

    const uint8_t both = sightline::kLeftEye | sightline::kRightEye;
    return eyes[1] == both && eyes[2] == 0 && eyes[3] == sightline::kRightEye && eyes[4] == both ? 0 : 1;
}
