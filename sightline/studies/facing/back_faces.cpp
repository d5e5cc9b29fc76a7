// The back faces of a mesh, triangle by triangle: by planes and the eye, and by the corners' places in clip space or on the screen.
// SPDX-License-Identifier: MIT
#include "sightline/studies/facing/back_faces.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cull/answer_bits.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/facing/back_faces.cpp"
#include <hwy/foreach_target.h>
#include "sightline/cull/mask_bits-inl.h"

#ifndef SIGHTLINE_STUDIES_FACING_BACK_FACES_ONCE
#define SIGHTLINE_STUDIES_FACING_BACK_FACES_ONCE
namespace sightline::studies::detail {

/// Back iff x * nx + y * ny + z * nz + w * d < limit.
struct FloatEye {
    float x, y, z, w, limit;
};

struct IndexedTriangles {
    const float* x;
    const float* y;
    const float* w;  ///< null on the screen
    const uint32_t* indices;
    size_t count;
    bool turned;  ///< clockwise triangles are front faces
};

}  // namespace sightline::studies::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
using namespace sightline::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;

void planeFacesKernel(const TrianglePlanes& planes, const detail::FloatEye& eye, uint8_t* back) {
    const FaceLanes d;
    const auto x = hn::Set(d, eye.x), y = hn::Set(d, eye.y), z = hn::Set(d, eye.z), w = hn::Set(d, eye.w);
    const auto limit = hn::Set(d, eye.limit);
    const float* const nx = planes.x.data();
    const float* const ny = planes.y.data();
    const float* const nz = planes.z.data();
    const float* const nd = planes.d.data();
    storeAnswers(d, planes.count, back, [&](size_t i) HWY_ATTR {
        const auto xy = hn::Add(hn::Mul(x, hn::LoadU(d, nx + i)), hn::Mul(y, hn::LoadU(d, ny + i)));
        const auto zw = hn::Add(hn::Mul(z, hn::LoadU(d, nz + i)), hn::Mul(w, hn::LoadU(d, nd + i)));
        return hn::Lt(hn::Add(xy, zw), limit);
    });
}

/// The corners of as many triangles as there are lanes: corner k's vertex numbers.
template <class DI>
HWY_INLINE hn::Vec<DI> cornersOf(DI di, const detail::IndexedTriangles& mesh, size_t first, size_t corner) {
    HWY_ALIGN int32_t numbers[16];
    for (size_t lane = 0; lane < hn::Lanes(di); ++lane) {
        const size_t triangle = std::min(first + lane, mesh.count - 1);
        numbers[lane] = static_cast<int32_t>(mesh.indices[3 * triangle + corner]);
    }
    return hn::Load(di, numbers);
}

void homogeneousFacesKernel(const detail::IndexedTriangles& mesh, uint8_t* back) {
    const FaceLanes d;
    const hn::RebindToSigned<FaceLanes> di;
    // Each term rounds five times by 2^-24 of its size; what underflows is covered by the least sizes.
    const auto rounding = hn::Set(d, 0x1p-20f), least = hn::Set(d, 0x1p-100f);
    storeAnswers(d, mesh.count, back, [&](size_t i) HWY_ATTR {
        const auto a = cornersOf(di, mesh, i, 0);
        const auto b = cornersOf(di, mesh, i, mesh.turned ? 2 : 1), c = cornersOf(di, mesh, i, mesh.turned ? 1 : 2);
        const auto ax = hn::GatherIndex(d, mesh.x, a), bx = hn::GatherIndex(d, mesh.x, b);
        const auto ay = hn::GatherIndex(d, mesh.y, a), by = hn::GatherIndex(d, mesh.y, b);
        const auto aw = hn::GatherIndex(d, mesh.w, a), bw = hn::GatherIndex(d, mesh.w, b);
        const auto cx = hn::GatherIndex(d, mesh.x, c), cy = hn::GatherIndex(d, mesh.y, c);
        const auto cw = hn::GatherIndex(d, mesh.w, c);
        const auto bycw = hn::Mul(by, cw), bwcy = hn::Mul(bw, cy);
        const auto bwcx = hn::Mul(bw, cx), bxcw = hn::Mul(bx, cw);
        const auto bxcy = hn::Mul(bx, cy), bycx = hn::Mul(by, cx);
        const auto one = hn::Mul(ax, hn::Sub(bycw, bwcy));
        const auto two = hn::Mul(ay, hn::Sub(bwcx, bxcw));
        const auto three = hn::Mul(aw, hn::Sub(bxcy, bycx));
        const auto determinant = hn::Add(hn::Add(one, two), three);
        const auto size_one = hn::Mul(hn::Abs(ax), hn::Add(hn::Add(hn::Abs(bycw), hn::Abs(bwcy)), least));
        const auto size_two = hn::Mul(hn::Abs(ay), hn::Add(hn::Add(hn::Abs(bwcx), hn::Abs(bxcw)), least));
        const auto size_three = hn::Mul(hn::Abs(aw), hn::Add(hn::Add(hn::Abs(bxcy), hn::Abs(bycx)), least));
        const auto size = hn::Add(hn::Add(hn::Add(size_one, size_two), size_three), least);
        return hn::Lt(determinant, hn::Neg(hn::Mul(rounding, size)));
    });
}

void screenFacesKernel(const detail::IndexedTriangles& mesh, uint8_t* back) {
    const FaceLanes d;
    const hn::RebindToSigned<FaceLanes> di;
    const auto rounding = hn::Set(d, 0x1p-21f), tiny = hn::Set(d, 0x1p-120f);
    storeAnswers(d, mesh.count, back, [&](size_t i) HWY_ATTR {
        const auto a = cornersOf(di, mesh, i, 0);
        const auto b = cornersOf(di, mesh, i, mesh.turned ? 2 : 1), c = cornersOf(di, mesh, i, mesh.turned ? 1 : 2);
        const auto ax = hn::GatherIndex(d, mesh.x, a), ay = hn::GatherIndex(d, mesh.y, a);
        const auto left =
            hn::Mul(hn::Sub(hn::GatherIndex(d, mesh.x, b), ax), hn::Sub(hn::GatherIndex(d, mesh.y, c), ay));
        const auto right =
            hn::Mul(hn::Sub(hn::GatherIndex(d, mesh.x, c), ax), hn::Sub(hn::GatherIndex(d, mesh.y, b), ay));
        const auto bound = hn::Add(hn::Mul(rounding, hn::Add(hn::Abs(left), hn::Abs(right))), tiny);
        return hn::Lt(hn::Sub(left, right), hn::Neg(bound));
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies {
namespace {

HWY_EXPORT(planeFacesKernel);
HWY_EXPORT(homogeneousFacesKernel);
HWY_EXPORT(screenFacesKernel);

size_t findIndexed(const detail::IndexedTriangles& mesh, std::span<uint8_t> back) {
    SIGHTLINE_ASSERT(back.size() >= sightline::detail::answerBytes(mesh.count));
    if (mesh.count == 0) return 0;
    if (mesh.w) HWY_DYNAMIC_DISPATCH(homogeneousFacesKernel)(mesh, back.data());
    else HWY_DYNAMIC_DISPATCH(screenFacesKernel)(mesh, back.data());
    return sightline::detail::finishAnswers(mesh.count, back);
}

}  // namespace

size_t findBackFaces(const TrianglePlanes& planes, const FacingEye& eye, std::span<uint8_t> back) {
    SIGHTLINE_ASSERT(back.size() >= sightline::detail::answerBytes(planes.count));
    const glm::dvec3 q = eye.point - eye.w * planes.origin;
    const double size = std::abs(q.x) + std::abs(q.y) + std::abs(q.z) + eye.w * planes.reach;
    // Normal, eye and distance round by 2^-24 each, and so do the products and sums: less than a dozen times in all. The
    // origin's own subtraction is done in double.
    const double far_away = glm::length(eye.point) + eye.w * glm::length(planes.origin);
    const double margin = 0x1p-20 * size + 2.0 * eye.error + 0x1p-50 * far_away + 0x1p-100;
    if (!eye.known() || !(size < 0x1p100) || !(margin < 0x1p100)) {
        std::fill_n(back.begin(), sightline::detail::answerBytes(planes.count), uint8_t{0});
        return 0;
    }
    const double turn = eye.front == FrontFace::kClockwise ? -1.0 : 1.0;
    const glm::vec3 point(turn * q);
    HWY_DYNAMIC_DISPATCH(planeFacesKernel)
    (planes, {point.x, point.y, point.z, static_cast<float>(turn * eye.w), static_cast<float>(-margin)}, back.data());
    return sightline::detail::finishAnswers(planes.count, back);
}

size_t findBackFaces(const HomogeneousVertices& vertices, std::span<const uint32_t> indices, FrontFace front,
                     bool mirrored, std::span<uint8_t> back) {
    const bool turned = (front == FrontFace::kClockwise) != mirrored;
    return findIndexed(
        {vertices.x.data(), vertices.y.data(), vertices.w.data(), indices.data(), indices.size() / 3, turned}, back);
}

size_t findBackFaces(const ScreenVertices& vertices, std::span<const uint32_t> indices, FrontFace front, bool mirrored,
                     std::span<uint8_t> back) {
    const bool turned = (front == FrontFace::kClockwise) != mirrored;
    return findIndexed({vertices.x.data(), vertices.y.data(), nullptr, indices.data(), indices.size() / 3, turned},
                       back);
}

}  // namespace sightline::studies
#endif  // HWY_ONCE
