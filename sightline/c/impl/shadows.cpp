// Shadow casters of the C interface.
// SPDX-License-Identifier: MIT
#include "sightline/c/shadows.h"

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/query/shadow_query.h"

using namespace sightline;
using c::fail;

struct slShadows {
    c::SharedHooks hooks;
    c::AskedHooks asked{};
    ShadowQuery query{hooks->memory()};
};

slLight slDefaultLight(void) {
    const Light from;
    slLight to{};
    to.kind = static_cast<slLightKind>(from.kind);
    for (int axis = 0; axis < 3; ++axis) to.direction[axis] = from.direction[axis];
    to.half_angle = from.half_angle;
    to.z_near = from.near;
    to.range = from.range;
    to.cookie = c::kLightCookie;
    return to;
}

slCasterSettings slDefaultCasterSettings(void) {
    const CasterSettings from;
    slCasterSettings to{};
    to.mask_size = from.mask_size;
    to.filter = from.filter;
    to.bias = from.bias;
    to.occlusion = from.occlusion;
    to.cookie = c::kCasterCookie;
    return to;
}

slStatus slCreateShadows(const slHooks* hooks, slShadows** shadows_out) {
    if (!shadows_out) return fail(hooks ? hooks->log : slLog{}, SL_BAD_ARGUMENT, __func__, "shadows_out is null");
    if (const slStatus status = c::checkHooks(hooks, __func__)) return status;
    *shadows_out = c::makeHandle<slShadows>(c::shareHooks(hooks));
    return SL_OK;
}

void slDestroyShadows(slShadows* shadows) { c::destroyHandle(shadows); }

namespace {

slStatus toLight(const slLight& from, const slLog& log, const char* call, Light& to) {
    if (from.cookie != c::kLightCookie)
        return fail(log, SL_NO_DEFAULTS, call, "the light did not begin as slDefaultLight()");
    const uint32_t kind = c::numberOf(from.kind);
    if (kind > SL_POINT_LIGHT) return fail(log, SL_BAD_ARGUMENT, call, "there is no such kind of light");
    to.kind = static_cast<LightKind>(kind);
    to.direction = c::vec(from.direction);
    to.position = c::vec(from.position);
    to.half_angle = from.half_angle;
    to.near = from.z_near;
    to.range = from.range;
    return SL_OK;
}

slStatus toSettings(const slCasterSettings& from, const slLog& log, const char* call, CasterSettings& to) {
    if (from.cookie != c::kCasterCookie)
        return fail(log, SL_NO_DEFAULTS, call, "the settings did not begin as slDefaultCasterSettings()");
    if (from.mask_size < 1 || from.mask_size > 4096)
        return fail(log, SL_BAD_ARGUMENT, call, "the settings' mask_size must be 1 to 4096");
    if (from.cascade_count > 32 || (from.cascade_count > 0 && !from.cascades))
        return fail(log, SL_BAD_ARGUMENT, call, "the settings' cascades are null, or more than 32");
    to.mask_size = from.mask_size;
    to.filter = from.filter;
    to.bias = from.bias;
    to.cascades = {from.cascades, from.cascade_count};
    to.occlusion = from.occlusion;
    return SL_OK;
}

}  // namespace

slStatus slFindCasters(slShadows* shadows, const slSnapshot* snapshot, const slView* view,
                       const slVisibleSet* receivers, const slLight* light, const slCasterSettings* settings,
                       slCasterSet* set_out) {
    const slLog log = shadows ? shadows->hooks->log() : slLog{};
    if (!shadows || !snapshot || !receivers || (!receivers->objects && receivers->count > 0) || !light || !set_out)
        return fail(log, SL_BAD_ARGUMENT, __func__, "a pointer is null");
    View to;
    Light lamp;
    CasterSettings how;
    if (const slStatus status = c::toView(view, log, __func__, to)) return status;
    if (const slStatus status = toLight(*light, log, __func__, lamp)) return status;
    if (settings)
        if (const slStatus status = toSettings(*settings, log, __func__, how)) return status;
    if (lamp.kind != LightKind::kDirectional && !how.cascades.empty())
        return fail(log, SL_BAD_ARGUMENT, __func__, "only a sun has cascades");
    const std::span<const Visible> seen(reinterpret_cast<const Visible*>(receivers->objects), receivers->count);
    const c::SharedHooks before = shadows->asked.exchange(snapshot->hooks);
    const CasterSet set = shadows->query.casters(snapshot->snapshot, to, seen, lamp, how);
    *set_out = {c::visibles(set.casters), set.cascades.data(), static_cast<uint32_t>(set.casters.size()),
                set.stats.in_light};
    return SL_OK;
}
