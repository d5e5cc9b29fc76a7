// The depth of groups in the image, and which tiles they may meet.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_DEPTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_DEPTH_INL_H
#undef SIGHTLINE_BUFFER_DRAW_DEPTH_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_DEPTH_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/buffer/draw/project-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Nearness a x + b y + c of the groups' planes, less what vertices lie off them and what is not known of their place; or, with
/// kNearest, more by as much.
///
/// Let X, Y, W and D be the rows of the screen at a point, so that its pixel is (X/W, Y/W) and its nearness D/W. In perspective D is
/// 1, and the normal n is a sum of the first three rows' by some p, q and r. Over points n.v = nd that sum is
/// p X + q Y + r W = -h, with h the eye's height over the plane: so 1/W = -(p x + q y + r) / h; a point that lies t off the
/// plane has h - t instead. In parallel projection W is the same everywhere, n is a sum of X, Y and D by p, q and r, and
/// D = (t + nd - p (X - Xo) - q (Y - Yo)) / r + Do, where o is the origin.
template <bool kNearest>
void planesOf(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Part& c, const glm::dvec3& eye,
              float width, float height, GroupPlanes& out) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    const auto set = [&](double v) HWY_ATTR { return hn::Set(d, v); };
    const auto atCentre = [&](const glm::dvec4& row) {
        return glm::dot(glm::dvec3(row), glm::dvec3(c.centre)) + row.w;
    };
    const double w = frame.w.w, xo = atCentre(frame.x) / w, yo = atCentre(frame.y) / w, zo = atCentre(frame.d) / w;
    for (uint32_t g = 0; g < c.groups; g += static_cast<uint32_t>(hn::Lanes(d))) {
        const size_t at = size_t{c.first_group} + g;
        const auto load = [&](const Array<float>& from) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(f, &from[at])); };
        const auto nx = load(mesh.nx), ny = load(mesh.ny), nz = load(mesh.nz);
        const auto dot = [&](double x, double y, double z) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(nx, set(x)), hn::Mul(ny, set(y))), hn::Mul(nz, set(z)));
        };
        const glm::dmat3& m = frame.to_image;
        const auto p = dot(m[0][0], m[1][0], m[2][0]), q = dot(m[0][1], m[1][1], m[2][1]),
                   r = dot(m[0][2], m[1][2], m[2][2]);
        const auto thick = hn::Add(load(mesh.thick), set(double{frame.place_error}));
        auto a = p, b = q, e = r;
        if (frame.perspective) {
            const auto h = hn::Sub(dot(eye.x, eye.y, eye.z), load(mesh.nd));
            // Of what may be as near as the eye there is no bound: infinite.
            const auto away = kNearest ? hn::Max(hn::Sub(hn::Abs(h), thick), hn::Zero(d)) : hn::Add(hn::Abs(h), thick);
            const auto scale = hn::Div(hn::IfThenElse(hn::Gt(h, hn::Zero(d)), set(-1), set(1)), away);
            a = hn::Mul(p, scale);
            b = hn::Mul(q, scale);
            e = hn::Mul(r, scale);
        } else {
            const auto scale = hn::Div(set(1), r);
            a = hn::Neg(hn::Mul(p, scale));
            b = hn::Neg(hn::Mul(q, scale));
            const auto from_origin = hn::Sub(set(zo), hn::Add(hn::Mul(a, set(xo)), hn::Mul(b, set(yo))));
            const auto off = hn::Abs(hn::Mul(thick, scale)), plane = hn::Mul(load(mesh.nd), scale);
            const auto along = kNearest ? hn::Add(plane, off) : hn::Sub(plane, off);
            e = hn::Add(from_origin, hn::Mul(along, set(1 / w)));
        }
        // Rounding of the three to floats, and of what is computed with them.
        const auto size =
            hn::Add(hn::Add(hn::Mul(hn::Abs(a), set(width)), hn::Mul(hn::Abs(b), set(height))), hn::Abs(e));
        hn::StoreU(hn::DemoteTo(f, a), f, out.a + g);
        hn::StoreU(hn::DemoteTo(f, b), f, out.b + g);
        const auto room = hn::Mul(size, set(0x1p-20));
        hn::StoreU(hn::DemoteTo(f, kNearest ? hn::Add(e, room) : hn::Sub(e, room)), f, out.c + g);
    }
}

/// For each tile of a block the least depth of the groups that may be in it, infinite where there are none.
struct TileDepths {
    alignas(32) float z[kBlockTiles], first[kBlockTiles], last[kBlockTiles];  ///< of the groups, as numbers
    uint32_t single = 0, two = 0;  ///< tiles of one group, and of two, as bits
};

/// The middles of a block's tiles.
struct TileMiddles {
    alignas(32) float x[kBlockTiles], y[kBlockTiles];

    TileMiddles(int column, int row) {
        for (int t = 0; t < kBlockTiles; ++t) {
            x[t] = static_cast<float>(kBlockWidth * column + 8 * (t % 4) + 4);
            y[t] = static_cast<float>(kBlockHeight * row + 8 * (t / 4) + 4);
        }
    }
};

/// Which middles of tiles are where a group may be.
template <class D, class V>
HWY_INLINE hn::Mask<D> areIn(D f, const GroupRect& rect, V x, V y) {
    const auto within = [&](V v, float low, float high)
                            HWY_ATTR { return hn::And(hn::Ge(v, hn::Set(f, low)), hn::Le(v, hn::Set(f, high))); };
    return hn::And(hn::And(within(x, rect.x0, rect.x1), within(y, rect.y0, rect.y1)),
                   hn::And(within(hn::Add(x, y), rect.s0, rect.s1), within(hn::Sub(x, y), rect.t0, rect.t1)));
}

/// The least depth of a group in tiles.
template <class D, class V>
HWY_INLINE V depthAt(D f, const GroupDepth& of, V x, V y) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(f, of.a), x), hn::Mul(hn::Set(f, of.b), y)), hn::Set(f, of.bound));
}

inline void depthOfTiles(int column, int row, const GroupDepth* groups, int count, TileDepths& out) {
    const hn::CappedTag<float, kBlockTiles> f;
    const TileMiddles middles(column, row);
    out.single = out.two = 0;
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto x = hn::Load(f, middles.x + t), y = hn::Load(f, middles.y + t);
        auto z = hn::Set(f, std::numeric_limits<float>::infinity()), meets = hn::Zero(f), first = hn::Zero(f),
             last = hn::Zero(f);
        for (int g = 0; g < count; ++g) {
            const auto near_by = areIn(f, groups[g].rect, x, y);
            z = hn::IfThenElse(near_by, hn::Min(z, depthAt(f, groups[g], x, y)), z);
            first =
                hn::IfThenElse(hn::And(near_by, hn::Eq(meets, hn::Zero(f))), hn::Set(f, static_cast<float>(g)), first);
            meets = hn::Add(meets, hn::IfThenElseZero(near_by, hn::Set(f, 1.0f)));
            last = hn::IfThenElse(near_by, hn::Set(f, static_cast<float>(g)), last);
        }
        hn::Store(z, f, out.z + t);
        hn::Store(first, f, out.first + t);
        hn::Store(last, f, out.last + t);
        out.single |= static_cast<uint32_t>(bitsFromMask(f, hn::Eq(meets, hn::Set(f, 1.0f)))) << t;
        out.two |= static_cast<uint32_t>(bitsFromMask(f, hn::Eq(meets, hn::Set(f, 2.0f)))) << t;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
