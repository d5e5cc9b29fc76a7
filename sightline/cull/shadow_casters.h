// Which casters can darken a visible receiver: a mask of the receivers as a light sees them, with their farthest depth.
// SPDX-License-Identifier: MIT
//
// Jiri Bittner, Oliver Mattausch, Ari Silvennoinen, Michael Wimmer. Shadow Caster Culling for Efficient Shadow Mapping.
// 2011.
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline {

/// A light's image in texels, and the rays through them. Nearness is 1/w in perspective and minus the depth in a parallel
/// view: larger is nearer to the light.
struct LightGrid {
    uint32_t width = 0, height = 0;  ///< [texels]
    bool perspective = false;
    glm::dvec3 eye{0.0};  ///< the light, or the origin of its parallel view
    glm::dvec3 start{
        0.0};            ///< of the ray at texel corner (0, 0): its direction at depth one, or in a parallel view its
                         ///< position at depth 0; from the eye
    glm::dvec3 step[2];  ///< a texel to the right, and up
    glm::dvec3 toward{0.0};  ///< unit direction of view of a parallel light
    glm::dvec4 rows[3];      ///< of a position from the eye: texels across and up times w, and w
};

/// @param light  isUsable(light); width and height are the mask's
LightGrid makeLightGrid(const View& light);

/// Why a mask keeps or culls a caster.
enum class CasterAnswer : uint8_t {
    kMayDarken,
    kBesideReceivers,  ///< no ray through it meets a receiver
    kBehindReceivers,  ///< all receivers on its rays lie before it
};

/// A buffer in the light's image with the nearness of the farthest point of all receivers at each texel.
///
/// The argument. A receiver is a convex body, a set of half spaces: its box, cut by the camera's frustum. Each half space
/// bounds the nearness along a light's ray by a number that is linear in the ray's place in the image, from above where
/// the ray enters it and from below where it leaves. Over a texel the most permissive place is taken for each by itself, so
/// what the texel says holds for every ray in it. A caster that darkens a point of a receiver lies on a ray of that point,
/// nearer to the light, and so is nearer than the farthest point that the ray's texel knows.
class ReceiverMask {
public:
    static constexpr uint32_t kMostPlanes = 24;

    explicit ReceiverMask(Memory* memory = defaultMemory()) : farthest_(memory), blocks_(memory) {}

    /// Empties the mask.
    /// @param spread  of the filter that shadows are looked up with: receivers reach so far into neighbours  [texels]
    /// @param bias    receivers count as so much farther from the light  [world units, >= 0]
    void begin(const LightGrid& grid, double spread = 0, double bias = 0);

    /// Adds a box, cut by half spaces: dot(n, p - eye of the grid) + d >= 0.
    /// @param cuts  [limit: kMostPlanes - 6]
    void addReceiver(const Box3d& box, std::span<const glm::dvec4> cuts);

    /// Must be called after the last receiver.
    void finish();

    /// Whether a box may darken a receiver. Boxes that are not finite may.
    CasterAnswer ask(const Box3d& box) const;
    /// The same of a node's box: looks at its rectangle alone, and so keeps more.
    bool mayHoldCaster(const Box3d& box) const;

    bool empty() const { return receivers_ == 0; }
    const LightGrid& grid() const { return grid_; }
    /// The share of texels that some receiver may lie in.
    double coverage() const;

private:
    /// A half space along the rays: constant + x right + y up + slope * nearness >= 0.
    struct Along {
        double constant = 0, right = 0, up = 0, slope = 0;
    };
    struct Rect {
        int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  ///< texels, inclusive
        double nearest = 0;                        ///< no point is nearer to the light
    };
    struct Span {
        double nearest = 0, farthest = 0;  ///< nearness of any point on any ray
        bool any = false;                  ///< some ray may meet the body
    };

    Along along(const glm::dvec4& plane) const;
    Rect rectOf(const Box3d& box, double spread) const;
    uint32_t planesOf(const Box3d& box, Along* planes) const;
    Span spanAt(std::span<const Along> planes, int32_t x, int32_t y, double spread) const;

    LightGrid grid_;
    double spread_ = 0, bias_ = 0;
    uint32_t receivers_ = 0;
    Array<double> farthest_;  ///< nearness per texel; infinity where no receiver is
    Array<double> blocks_;    ///< the least of eight by eight texels
};

}  // namespace sightline
