// MaskedOcclusionCulling as a contestant: the loop of a renderer that calls it.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <MaskedOcclusionCulling.h>

#include "bench/contestant.h"
#include "bench/flat_boxes.h"
#include "sightline/geom/frustum.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint32_t kPeerWidth = 640, kPeerHeight = 360;

/// The triangles of a mesh that hide.
struct HidingTriangles {
    std::vector<unsigned> one_sided, two_sided;  ///< three indices each
};

/// An object's box in the image.
struct NdcRect {
    float x0, y0, x1, y1, w;  ///< in normalized device coordinates; the least w
    bool bounded;             ///< false: it reaches behind the near plane
};

class Masked final : public Contestant {
public:
    explicit Masked(const Scene& scene)
        : scene_(scene), boxes_(objectBoxes(scene)), flat_(boxes_), buffer_(MaskedOcclusionCulling::Create()) {
        buffer_->SetResolution(kPeerWidth, kPeerHeight);
        for (const Mesh& mesh : scene.meshes) {
            HidingTriangles& of = triangles_.emplace_back();
            if (mesh.deforms) continue;
            for (const Primitive& part : mesh.primitives) {
                const Material& material = scene.materials[part.material];
                if (!material.hides()) continue;
                std::vector<unsigned>& to = material.double_sided ? of.two_sided : of.one_sided;
                const auto begin = mesh.indices.begin() + 3 * std::ptrdiff_t(part.first_triangle);
                to.insert(to.end(), begin, begin + 3 * std::ptrdiff_t(part.triangle_count));
            }
        }
        for (const SceneObject& object : scene.objects)
            mirrored_.push_back(glm::determinant(glm::dmat3(object.transform)) < 0);
    }
    ~Masked() override { MaskedOcclusionCulling::Destroy(buffer_); }

    const char* name() const override { return "MaskedOcclusionCulling 640"; }

    size_t answer(const View& view) override {
        const Frustum frustum = makeFrustum(view);
        const glm::dmat4 to_clip = view.projection * view.view;
        buffer_->ClearBuffer();
        near_ = view.projection[3][2] / (view.projection[2][2] - 1);
        buffer_->SetNearClipPlane(float(near_));
        const size_t in_view = cullFrustum(frustum, flat_.arrays, flat_.kept);
        order_.clear();
        for (size_t i = 0; i < in_view; ++i) {
            const uint32_t object = flat_.kept[i];
            rects_.resize(scene_.objects.size());
            rects_[object] = rectOf(to_clip, boxes_[object]);
            order_.push_back({rects_[object].bounded ? rects_[object].w : 0.0f, object});
        }
        std::sort(order_.begin(), order_.end());
        drawn_.clear();
        for (const auto& [w, object] : order_) {
            if (isHidden(object)) continue;
            draw(to_clip, object);
            drawn_.push_back(object);
        }
        return static_cast<size_t>(
            std::count_if(drawn_.begin(), drawn_.end(), [&](uint32_t object) { return !isHidden(object); }));
    }

private:
    NdcRect rectOf(const glm::dmat4& to_clip, const Box3d& box) const {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        NdcRect out{kInfinity, kInfinity, -kInfinity, -kInfinity, kInfinity, true};
        for (int corner = 0; corner < 8; ++corner) {
            glm::dvec3 at;
            for (int axis = 0; axis < 3; ++axis) at[axis] = corner >> axis & 1 ? box.max[axis] : box.min[axis];
            const glm::dvec4 clip = to_clip * glm::dvec4(at, 1);
            if (!(clip.w > near_) || !(clip.z > -clip.w)) return {-1, -1, 1, 1, 0, false};
            const float x = float(clip.x / clip.w), y = float(clip.y / clip.w);
            out.x0 = std::min(out.x0, x);
            out.y0 = std::min(out.y0, y);
            out.x1 = std::max(out.x1, x);
            out.y1 = std::max(out.y1, y);
            out.w = std::min(out.w, float(clip.w));
        }
        return out;
    }

    bool isHidden(uint32_t object) const {
        const NdcRect& rect = rects_[object];
        return rect.bounded &&
               buffer_->TestRect(rect.x0, rect.y0, rect.x1, rect.y1, rect.w) != MaskedOcclusionCulling::VISIBLE;
    }

    void draw(const glm::dmat4& to_clip, uint32_t object) {
        using Winding = MaskedOcclusionCulling::BackfaceWinding;
        const SceneObject& of = scene_.objects[object];
        const Mesh& mesh = scene_.meshes[of.mesh];
        const glm::mat4 matrix(to_clip * of.transform);
        const auto render = [&](const std::vector<unsigned>& indices, Winding back) {
            if (indices.empty()) return;
            buffer_->RenderTriangles(&mesh.positions[0].x, indices.data(), int(indices.size() / 3), &matrix[0][0], back,
                                     MaskedOcclusionCulling::CLIP_PLANE_ALL,
                                     MaskedOcclusionCulling::VertexLayout(sizeof(glm::vec3), 4, 8));
        };
        render(triangles_[of.mesh].one_sided,
               mirrored_[object] ? MaskedOcclusionCulling::BACKFACE_CCW : MaskedOcclusionCulling::BACKFACE_CW);
        render(triangles_[of.mesh].two_sided, MaskedOcclusionCulling::BACKFACE_NONE);
    }

    const Scene& scene_;
    std::vector<Box3d> boxes_;
    FlatBoxes flat_;
    MaskedOcclusionCulling* buffer_;
    std::vector<HidingTriangles> triangles_;  ///< by mesh
    std::vector<uint8_t> mirrored_;           ///< by object
    std::vector<NdcRect> rects_;
    std::vector<std::pair<float, uint32_t>> order_;
    std::vector<uint32_t> drawn_;
    double near_ = 0;  ///< the view's near plane  [w]
};

}  // namespace

std::unique_ptr<Contestant> makeMaskedContestant(const Scene& scene) { return std::make_unique<Masked>(scene); }

}  // namespace sightline::bench
