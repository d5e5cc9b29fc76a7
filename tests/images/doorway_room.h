// A furnished room beyond a doorway, and pictures of it, for the laws of portal images.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/images/depth_image.h"
#include "sightline/images/portal_frame.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace images;
using namespace studies;

/// A doorway of one by two units in the plane z = 0, with its lower left corner in the origin, seen from z > 0.
inline PortalFrame madeDoorway() {
    const std::vector<glm::dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}};
    return *portalFrame(corners, {0.5, 1, 1});
}

/// A random doorway anywhere: a rectangle or a triangle, and a place before it.
struct AnyDoorway {
    PortalFrame frame;

    explicit AnyDoorway(Random& random) {
        const glm::dvec3 middle = randomVector(random, 50), right = randomUnit(random);
        const glm::dvec3 up = glm::normalize(glm::cross(right, randomUnit(random)));
        const double width = random.uniform(0.2, 4), height = random.uniform(0.2, 4);
        std::vector<glm::dvec3> corners = {middle, middle + width * right, middle + width * right + height * up,
                                           middle + height * up};
        if (random.below(3) == 0) corners.pop_back();
        frame = *portalFrame(corners, middle + glm::cross(right, up), up);
    }
    /// An eye before it, EyePlace::kBefore.
    glm::dvec3 eye(Random& random) const {
        for (;;) {
            const glm::dvec3 own(random.uniform(-4, 8), random.uniform(-4, 8), random.uniform(0.05, 8));
            if (eyePlace(frame, frame.toWorld(own)) == EyePlace::kBefore) return frame.toWorld(own);
        }
    }
};

/// A room of 5 x 3 x 6 units behind that doorway, open towards it, with boxes in it; each item has its own colour.
class DoorwayRoom {
public:
    explicit DoorwayRoom(uint64_t seed, int boxes = 12) {
        Random random(seed);
        TestMesh walls = boxMesh({-2, -0.5f, -6}, {3, 2.5f, 0});
        // Turned inside out, without the side of the doorway.
        for (size_t t = 0; t < walls.indices.size(); t += 3) std::swap(walls.indices[t], walls.indices[t + 1]);
        std::vector<uint32_t> kept;
        for (size_t t = 0; t < walls.indices.size(); t += 3) {
            const auto z = [&](size_t k) { return walls.positions[walls.indices[t + k]].z; };
            if (z(0) == 0 && z(1) == 0 && z(2) == 0) continue;
            kept.insert(kept.end(), walls.indices.begin() + static_cast<std::ptrdiff_t>(t),
                        walls.indices.begin() + static_cast<std::ptrdiff_t>(t) + 3);
        }
        walls.indices = kept;
        meshes_.push_back(walls);
        for (int i = 0; i < boxes; ++i) {
            const glm::vec3 low(randomIn(random, {{-1.5, -0.5, -5.5}, {2.5, 1.2, -0.8}}));
            const glm::vec3 size(randomIn(random, {{0.1, 0.2, 0.1}, {0.6, 1.2, 0.6}}));
            meshes_.push_back(boxMesh(low, low + size));
        }
        for (const TestMesh& mesh : meshes_) {
            DrawItem item;
            item.mesh = mesh.view();
            item.id = static_cast<uint32_t>(items_.size());
            items_.push_back(item);
        }
    }
    DoorwayRoom(const DoorwayRoom&) = delete;
    DoorwayRoom& operator=(const DoorwayRoom&) = delete;

    std::span<const DrawItem> items() const { return items_; }
    DepthImage take(const View& view) const { return takeImage(DrawList(items_), view, {}); }
    DepthImage take(const glm::dvec3& eye, uint32_t width, uint32_t height) const {
        return take(*portalView(madeDoorway(), eye, width, height));
    }

private:
    std::vector<TestMesh> meshes_;
    std::vector<DrawItem> items_;
};

inline std::vector<glm::u8vec3> coloursOf(const DepthImage& image) {
    std::vector<glm::u8vec3> out;
    for (const DepthSample& sample : image.samples) out.push_back(sample.colour);
    return out;
}

/// Where a view shows a point: sample and row, and 1 / w.
inline glm::dvec3 projected(const View& view, const glm::dvec3& point) {
    const glm::dvec4 clip = view.projection * view.view * glm::dvec4(point, 1.0);
    return {(clip.x / clip.w + 1) * 0.5 * view.width - 0.5, (clip.y / clip.w + 1) * 0.5 * view.height - 0.5,
            1 / clip.w};
}

}  // namespace sightline::test
