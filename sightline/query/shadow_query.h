// Which objects can darken what a view shows, for one light: the casters that a shadow map has to draw.
// SPDX-License-Identifier: MIT
//
// Jiri Bittner, Oliver Mattausch, Ari Silvennoinen, Michael Wimmer. Shadow Caster Culling for Efficient Shadow Mapping.
// 2011.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/geom/light.h"
#include "sightline/geom/view.h"
#include "sightline/query/query.h"
#include "sightline/world/world.h"

namespace sightline {

struct CasterSettings {
    uint32_t mask_size = 512;  ///< of the receivers' mask in the light's image; its longer side  [texels, 1 to 4096]
    double filter = 0;  ///< how far from a ray shadows are looked up: the radius of the filter, and a texel of the
                        ///< shadow map  [world units across a sun's rays; of other lights, at distance one]
    double bias = 0;    ///< of the depth comparison: a receiver may seem so much farther from the light  [world units]
    /// Where cascades end: rising distances from the eye along the direction of view. Nothing beyond the last one is
    /// shadowed. Empty: one cascade without an end. Must be empty for spots and point lights.  [size: <= 32]
    std::span<const double> cascades;
    bool occlusion = true;  ///< cull what lies wholly in the shadow of other casters
};

/// Counts objects of the view's layers.
struct CasterStats {
    uint64_t receivers = 0;
    uint64_t in_light = 0;   ///< in the light's frustum: those that a shadow map without culling draws
    uint64_t beside = 0;     ///< culled: no ray through them meets a receiver
    uint64_t behind = 0;     ///< culled: they lie behind all receivers on their rays
    uint64_t in_shadow = 0;  ///< culled: other casters hide them from the light
    uint64_t nanoseconds = 0;
};

/// The casters of one light.
struct CasterSet {
    std::span<const Visible> casters;  ///< valid until the next call
    std::span<const uint32_t>
        cascades;       ///< per caster: bit per cascade, or per face of a point light (+x -x +y -y +z -z)
    CasterStats stats;  ///< of all cascades or faces; an object counts once, where it passed the most tests
};

/// Scratch of one thread, as Query.
class ShadowQuery {
public:
    explicit ShadowQuery(Memory* memory = defaultMemory());
    ~ShadowQuery();
    ShadowQuery(ShadowQuery&&) noexcept;
    ShadowQuery& operator=(ShadowQuery&&) noexcept;

    /// The objects that may darken a point that the view shows, inside the view or outside of it.
    ///
    /// Conservative: if a ray from a light to a point of a receiver in the view meets an object, the object is in the
    /// set, or all of it that the light could reach lies behind others of the set. So a shadow map that draws the set
    /// alone shows the same. Both sides of a surface cast; every receiver may be lit from both sides.
    ///
    /// If the view has sections, casters in the shadow of others are kept: a renderer may cut casters or draw them
    /// whole, and finds all that it needs in either case.
    ///
    /// @param view       whose image is lit; its frustum, jitter, layers and sections count
    /// @param receivers  what it shows: Query::visible() of the same snapshot and view
    /// If the view or the light is not usable, all objects of the layers are casters.
    CasterSet casters(const Snapshot& now, const View& view, std::span<const Visible> receivers, const Light& light,
                      const CasterSettings& settings = {});

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
