// The one rasterizer as a contestant: a flat list, the nearest first; boxes asked, clusters drawn, boxes asked again.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "bench/contestant.h"
#include "bench/flat_boxes.h"
#include "bench/onepass/draw.h"
#include "sightline/geom/frustum.h"
#include "sightline/prepare/occluder/occluder.h"

namespace sightline::bench {
using namespace tools;
namespace {

/// Of what is smaller in the image, a look tells no more than the box.  [pixels]
constexpr float kLeastLook = 64;

/// The box of an object or a cluster in one frame.
struct Asked {
    AskedBox box;
    BoxImage image;
    bool bounded = false;  ///< else it reaches before the near plane
};

class OnePass final : public Contestant {
public:
    OnePass(const Scene& scene, const OnePassSettings& settings)
        : scene_(scene), settings_(settings), boxes_(objectBoxes(scene)), flat_(boxes_) {
        for (const Mesh& mesh : scene.meshes) {
            std::vector<uint8_t> hides(mesh.triangles(), 0), both(mesh.triangles(), 0);
            for (const Primitive& part : mesh.primitives)
                for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
                    hides[t] = !mesh.deforms && scene.materials[part.material].hides();
                    both[t] = scene.materials[part.material].double_sided;
                }
            const MeshView view{mesh.positions, mesh.indices};
            meshes_.push_back(makePlaneMesh(prepareOccluder(view, hides, both)));
            // What a look asks is all that is drawn, with no polygon left out.
            const std::vector<uint8_t> all(mesh.triangles(), 1);
            if (!mesh.deforms) looks_.push_back(makePlaneMesh(prepareOccluder(view, all, both)));
            else looks_.emplace_back();
            if (!looks_.back().is_whole) looks_.back() = PlaneMesh();
        }
        asked_.resize(boxes_.size());
        frames_.resize(boxes_.size());
        framed_.resize(boxes_.size(), 0);
        for (const SceneObject& object : scene.objects)
            mirrored_.push_back(glm::determinant(glm::dmat3(object.transform)) < 0);
    }

    const char* name() const override { return settings_.name; }

    size_t answer(const View& view) override {
        const Screen screen = makeScreen(view, settings_.size);
        image_.clear(screen.width, screen.height, 1e-6f / static_cast<float>(screen.near_w));
        const size_t in_view = cullFrustum(makeFrustum(view), flat_.arrays, flat_.kept);
        order_.clear();
        ++frames_asked_;
        for (size_t i = 0; i < in_view; ++i) {
            const uint32_t object = flat_.kept[i];
            Asked& asked = asked_[object];
            asked.box = askedBox(screen.x, screen.y, screen.w, boxes_[object].center() - screen.eye,
                                 0.5 * boxes_[object].size());
            asked.bounded = imageOf(asked.box, screen.near_w, asked.image);
            order_.push_back({asked.bounded ? -asked.image.nearness : -3e38f, object});
        }
        std::sort(order_.begin(), order_.end());
        kept_.clear();
        for (const auto& [nearness, object] : order_) {
            if (!isOpenTo(asked_[object])) continue;
            kept_.push_back(object);
            if (!isWorth(asked_[object], 12)) continue;
            const ObjectFrame& frame = frameOf(screen, object);
            const PlaneMesh& mesh = meshes_[scene_.objects[object].mesh];
            if (mesh.clusters.size() == 1) {
                if (isWorth(asked_[object], mesh.clusters[0].edges)) drawCluster(image_, frame, mesh, 0, *scratch_);
                continue;
            }
            clusters_.resize(mesh.clusters.size());
            const uint32_t count = clustersInView(image_, frame, mesh, clusters_.data());
            for (uint32_t i = 0; i < count; ++i)
                if (isClusterOpen(frame, mesh.clusters[clusters_[i]]))
                    drawCluster(image_, frame, mesh, clusters_[i], *scratch_);
        }
        return static_cast<size_t>(std::count_if(kept_.begin(), kept_.end(), [&](uint32_t object) {
            return isOpenTo(asked_[object]) &&
                   (!settings_.looks || areaOf(asked_[object]) < kLeastLook || isShown(screen, object));
        }));
    }

private:
    /// Of a box in the image; infinite where it is not bounded.
    static float areaOf(const Asked& asked) {
        const BoxImage& at = asked.image;
        return asked.bounded ? (at.x1 - at.x0) * (at.y1 - at.y0) : std::numeric_limits<float>::infinity();
    }
    /// Whether drawing may hide enough for what it costs.
    bool isWorth(const Asked& asked, uint32_t edges) const {
        return areaOf(asked) >= settings_.pixels_per_edge * static_cast<float>(edges);
    }
    /// Made once a frame.
    const ObjectFrame& frameOf(const Screen& screen, uint32_t object) {
        if (framed_[object] != frames_asked_) {
            framed_[object] = frames_asked_;
            frames_[object] = objectFrame(objectScreen(screen, scene_.objects[object].transform), mirrored_[object]);
        }
        return frames_[object];
    }
    bool isOpenTo(const Asked& asked) {
        if (!asked.bounded) return true;
        const auto pixel = [](float v, uint32_t size) {
            return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(size - 1)));
        };
        const BoxImage& at = asked.image;
        return isOpen(image_, pixel(at.x0, image_.width), pixel(at.y0, image_.height), pixel(at.x1, image_.width),
                      pixel(at.y1, image_.height), at.nearness, &asked.box);
    }

    /// Whether a cluster of an object may show something.
    bool isShown(const Screen& screen, uint32_t object) {
        const PlaneMesh& mesh = looks_[scene_.objects[object].mesh];
        if (mesh.clusters.empty()) return true;
        const ObjectFrame& frame = frameOf(screen, object);
        clusters_.resize(mesh.clusters.size());
        const uint32_t count = clustersInView(image_, frame, mesh, clusters_.data());
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t c = clusters_[i];
            const PlaneMesh::Cluster& cluster = mesh.clusters[c];
            Asked asked;
            asked.box = askedBox(frame.x, frame.y, frame.w, glm::dvec3(cluster.centre), glm::dvec3(cluster.half));
            if (mesh.clusters.size() > 1) {
                asked.bounded = imageOf(asked.box, frame.near_w, asked.image);
                const BoxImage& at = asked.image;
                if (asked.bounded && (at.x1 < 0 || at.y1 < 0 || at.x0 > static_cast<float>(image_.width) ||
                                      at.y0 > static_cast<float>(image_.height)))
                    continue;
                if (!isOpenTo(asked)) continue;
            }
            if (sightline::bench::isClusterOpen(image_, frame, mesh, c, asked.box, *scratch_)) return true;
        }
        return false;
    }

    /// Whether a cluster may show something, by its box.
    bool isClusterOpen(const ObjectFrame& frame, const PlaneMesh::Cluster& cluster) {
        Asked asked;
        asked.box = askedBox(frame.x, frame.y, frame.w, glm::dvec3(cluster.centre), glm::dvec3(cluster.half));
        asked.bounded = imageOf(asked.box, frame.near_w, asked.image);
        const BoxImage& at = asked.image;
        if (asked.bounded && (at.x1 < 0 || at.y1 < 0 || at.x0 > static_cast<float>(image_.width) ||
                              at.y0 > static_cast<float>(image_.height)))
            return false;
        return isWorth(asked, cluster.edges) && isOpenTo(asked);
    }

    const Scene& scene_;
    const OnePassSettings settings_;
    std::vector<Box3d> boxes_;
    FlatBoxes flat_;
    std::vector<PlaneMesh> meshes_, looks_;  ///< what hides; all that is drawn, none where it is not known so well
    std::vector<uint8_t> mirrored_;
    std::vector<Asked> asked_;
    std::vector<ObjectFrame> frames_;
    std::vector<uint64_t> framed_;  ///< in which frame it was made
    uint64_t frames_asked_ = 0;
    std::vector<std::pair<float, uint32_t>> order_;
    std::vector<uint32_t> kept_, clusters_;
    DepthBlocks image_;
    std::unique_ptr<DrawScratch> scratch_ = std::make_unique<DrawScratch>();
};

}  // namespace

std::unique_ptr<Contestant> makeOnePassContestant(const Scene& scene, const OnePassSettings& settings) {
    return std::make_unique<OnePass>(scene, settings);
}

}  // namespace sightline::bench
