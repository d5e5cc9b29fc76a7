// What pictures of a scene need to know of it: what may be in view, and the colours of things.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/scene_look.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sightline/studies/hidden/shade/light.h"

namespace sightline::tools {
using namespace studies;

bool mayBeInView(const glm::dmat4& clip, const Box3d& box) {
    int outside[5] = {};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p = clip * glm::dvec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                               corner & 4 ? box.max.z : box.min.z, 1.0);
        const double slack = 1e-9 * (std::abs(p.w) + std::abs(p.x) + std::abs(p.y));
        outside[0] += p.x < -p.w - slack;
        outside[1] += p.x > p.w + slack;
        outside[2] += p.y < -p.w - slack;
        outside[3] += p.y > p.w + slack;
        outside[4] += p.z < -p.w - slack;
    }
    return std::none_of(std::begin(outside), std::end(outside), [](int count) { return count == 8; });
}

bool isSolid(const Material& material) { return material.alpha_mode != AlphaMode::kBlend && !material.transmissive; }

glm::dvec3 colourOf(const Scene& scene, const SceneObject& object, const Primitive& primitive) {
    const glm::dvec3 colour(scene.materials[primitive.material].base_color);
    return colour == glm::dvec3(1.0) ? hashedColour(object.key) : colour;
}

double diagonalOf(const Box3d& box) { return box.empty() ? 1.0 : std::max(glm::length(box.size()), 1e-9); }

}  // namespace sightline::tools
