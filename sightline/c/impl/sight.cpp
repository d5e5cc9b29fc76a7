// Lines of sight and regions of the C interface.
// SPDX-License-Identifier: MIT
#include "sightline/c/sight.h"

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/query/sight_query.h"

using namespace sightline;
using c::fail;

struct slSight {
    c::SharedHooks hooks;
    c::AskedHooks asked{};
    SightQuery query{hooks->memory()};
    Array<ObjectId> ignored{hooks->memory()};
};

namespace {

slStatus failNull(const slSight* sight, const char* call) {
    return fail(sight ? sight->hooks->log() : slLog{}, SL_BAD_ARGUMENT, call, "a pointer is null");
}

}  // namespace

slSightSettings slDefaultSightSettings(void) {
    slSightSettings settings{};
    settings.layers = SightSettings().layers;
    settings.cookie = c::kSightCookie;
    return settings;
}

slStatus slCreateSight(const slHooks* hooks, slSight** sight_out) {
    if (!sight_out) return fail(hooks ? hooks->log : slLog{}, SL_BAD_ARGUMENT, __func__, "sight_out is null");
    if (const slStatus status = c::checkHooks(hooks, __func__)) return status;
    *sight_out = c::makeHandle<slSight>(c::shareHooks(hooks));
    return SL_OK;
}

void slDestroySight(slSight* sight) { c::destroyHandle(sight); }

slStatus slSightLook(slSight* sight, const slSnapshot* snapshot, const double from[3], const double to[3],
                     const slSightSettings* settings, slSightLine* line_out) {
    if (!sight || !snapshot || !from || !to || !line_out) return failNull(sight, __func__);
    SightSettings how;
    if (settings) {
        if (settings->cookie != c::kSightCookie)
            return fail(sight->hooks->log(), SL_NO_DEFAULTS, __func__,
                        "the settings did not begin as slDefaultSightSettings()");
        if (!settings->ignored && settings->ignored_count > 0) return failNull(sight, __func__);
        how.layers = settings->layers;
        sight->ignored.clear();
        for (size_t i = 0; i < settings->ignored_count; ++i) sight->ignored.push_back(c::id(settings->ignored[i]));
        how.ignored = sight->ignored;
    }
    const c::SharedHooks before = sight->asked.exchange(snapshot->hooks);
    const SightLine line = sight->query.look(snapshot->snapshot, c::vec(from), c::vec(to), how);
    *line_out = {line.blocked, c::visible(line.by)};
    return SL_OK;
}

slStatus slSightFrom(slSight* sight, const slSnapshot* snapshot, const slBox* region, uint32_t layers,
                     slRegionSet* set_out) {
    if (!sight || !snapshot || !region || !set_out) return failNull(sight, __func__);
    const c::SharedHooks before = sight->asked.exchange(snapshot->hooks);
    const RegionSet set = sight->query.seenFrom(snapshot->snapshot, c::box(*region), layers);
    *set_out = {c::visibles(set.objects), static_cast<uint32_t>(set.objects.size()), set.known};
    return SL_OK;
}
