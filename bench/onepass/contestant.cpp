// The one rasterizer as a contestant: a flat list, the nearest first; boxes asked, clusters drawn, boxes asked again.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bench/contestant.h"
#include "bench/flat_boxes.h"
#include "bench/onepass/draw.h"
#include "sightline/geom/frustum.h"
#include "sightline/prepare/occluder/occluder.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint32_t kSize = 384;

/// A box in the image.
struct BoxImage {
    int x0, y0, x1, y1;
    float nearness;
    bool bounded;  ///< false: it reaches before the near plane
};

class OnePass final : public Contestant {
public:
    explicit OnePass(const Scene& scene) : scene_(scene), boxes_(objectBoxes(scene)), flat_(boxes_) {
        for (const Mesh& mesh : scene.meshes) {
            std::vector<uint8_t> hides(mesh.triangles(), 0), both(mesh.triangles(), 0);
            for (const Primitive& part : mesh.primitives)
                for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
                    hides[t] = !mesh.deforms && scene.materials[part.material].hides();
                    both[t] = scene.materials[part.material].double_sided;
                }
            meshes_.push_back(makePlaneMesh(prepareOccluder({mesh.positions, mesh.indices}, hides, both)));
        }
        images_.resize(boxes_.size());
        for (const SceneObject& object : scene.objects)
            mirrored_.push_back(glm::determinant(glm::dmat3(object.transform)) < 0);
    }

    const char* name() const override { return "one pass 384"; }

    size_t answer(const View& view) override {
        const Screen screen = makeScreen(view, kSize);
        image_.clear(screen.width, screen.height, 1e-6f / static_cast<float>(screen.near_w));
        const size_t in_view = cullFrustum(makeFrustum(view), flat_.arrays, flat_.kept);
        order_.clear();
        for (size_t i = 0; i < in_view; ++i) {
            const uint32_t object = flat_.kept[i];
            images_[object] = imageOf(screen, screen.eye, boxes_[object].center(), 0.5 * boxes_[object].size());
            order_.push_back({-images_[object].nearness, object});
        }
        std::sort(order_.begin(), order_.end());
        kept_.clear();
        for (const auto& [nearness, object] : order_) {
            if (!isObjectOpen(screen, object)) continue;
            const Screen rows = objectScreen(screen, scene_.objects[object].transform);
            const ObjectFrame frame = objectFrame(rows, mirrored_[object]);
            const PlaneMesh& mesh = meshes_[scene_.objects[object].mesh];
            for (uint32_t c = 0; c < mesh.clusters.size(); ++c)
                if (mesh.clusters.size() == 1 || isClusterOpen(rows, mesh.clusters[c]))
                    drawCluster(image_, frame, mesh, c);
            kept_.push_back(object);
        }
        return static_cast<size_t>(
            std::count_if(kept_.begin(), kept_.end(), [&](uint32_t object) { return isObjectOpen(screen, object); }));
    }

private:
    /// Of a box whose centre is given with what the rows are over: relative to the eye in the world.
    BoxImage imageOf(const Screen& screen, const glm::dvec3& origin, const glm::dvec3& centre,
                     const glm::dvec3& half) const {
        double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300, least = 1e300;
        for (int corner = 0; corner < 8; ++corner) {
            glm::dvec3 at = centre - origin;
            for (int axis = 0; axis < 3; ++axis) at[axis] += corner >> axis & 1 ? half[axis] : -half[axis];
            const glm::dvec4 p(at, 1);
            const double w = glm::dot(screen.w, p);
            if (!(w > screen.near_w))
                return {0,
                        0,
                        static_cast<int>(screen.width) - 1,
                        static_cast<int>(screen.height) - 1,
                        std::numeric_limits<float>::infinity(),
                        false};
            const double x = glm::dot(screen.x, p) / w, y = glm::dot(screen.y, p) / w;
            x0 = std::min(x0, x);
            y0 = std::min(y0, y);
            x1 = std::max(x1, x);
            y1 = std::max(y1, y);
            least = std::min(least, w);
        }
        const auto pixel = [](double v, uint32_t size) {
            return static_cast<int>(std::clamp(std::floor(v), 0.0, size - 1.0));
        };
        return {pixel(x0 - 1e-3, screen.width),
                pixel(y0 - 1e-3, screen.height),
                pixel(x1 + 1e-3, screen.width),
                pixel(y1 + 1e-3, screen.height),
                static_cast<float>(1 / least * (1 + 1e-6)),
                true};
    }

    bool isObjectOpen(const Screen& screen, uint32_t object) {
        const BoxImage& box = images_[object];
        if (!box.bounded) return true;
        const glm::dvec3 centre = boxes_[object].center() - screen.eye, half = 0.5 * boxes_[object].size();
        AskedBox asked;
        for (int axis = 0; axis < 3; ++axis) {
            asked.x[axis] = static_cast<float>(screen.x[axis]);
            asked.y[axis] = static_cast<float>(screen.y[axis]);
            asked.w[axis] = static_cast<float>(screen.w[axis]);
            asked.half[axis] = static_cast<float>(half[axis] * (1 + 1e-6));
        }
        asked.x[3] = static_cast<float>(glm::dot(screen.x, glm::dvec4(centre, 1)));
        asked.y[3] = static_cast<float>(glm::dot(screen.y, glm::dvec4(centre, 1)));
        asked.w[3] = static_cast<float>(glm::dot(screen.w, glm::dvec4(centre, 1)));
        return isOpen(image_, box.x0, box.y0, box.x1, box.y1, box.nearness, &asked);
    }

    /// Whether a cluster may show something, by its box.
    bool isClusterOpen(const Screen& rows, const PlaneMesh::Cluster& cluster) {
        const BoxImage box = imageOf(rows, glm::dvec3(0.0), glm::dvec3(cluster.centre), glm::dvec3(cluster.half));
        return !box.bounded || isOpen(image_, box.x0, box.y0, box.x1, box.y1, box.nearness, nullptr);
    }

    const Scene& scene_;
    std::vector<Box3d> boxes_;
    FlatBoxes flat_;
    std::vector<PlaneMesh> meshes_;
    std::vector<uint8_t> mirrored_;
    std::vector<BoxImage> images_;
    std::vector<std::pair<float, uint32_t>> order_;
    std::vector<uint32_t> kept_;
    DepthBlocks image_;
};

}  // namespace

std::unique_ptr<Contestant> makeOnePassContestant(const Scene& scene) { return std::make_unique<OnePass>(scene); }

}  // namespace sightline::bench
