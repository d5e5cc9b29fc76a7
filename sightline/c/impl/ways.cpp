// Ways of the C interface.
// SPDX-License-Identifier: MIT
#include "sightline/c/ways.h"

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/query/connectivity.h"

using namespace sightline;
using c::fail;

struct slWays {
    c::SharedHooks hooks;
    c::AskedHooks asked{};
    ConnectivityQuery query{hooks->memory()};
};

namespace {

slStatus failNull(const slWays* ways, const char* call) {
    return fail(ways ? ways->hooks->log() : slLog{}, SL_BAD_ARGUMENT, call, "a pointer is null");
}

}  // namespace

slWaySettings slDefaultWaySettings(void) {
    slWaySettings settings{};
    settings.narrowest = WaySettings().narrowest;
    settings.farthest = WaySettings().farthest;
    settings.cookie = c::kWayCookie;
    return settings;
}

slStatus slCreateWays(const slHooks* hooks, slWays** ways_out) {
    if (!ways_out) return fail(hooks ? hooks->log : slLog{}, SL_BAD_ARGUMENT, __func__, "ways_out is null");
    if (const slStatus status = c::checkHooks(hooks, __func__)) return status;
    *ways_out = c::makeHandle<slWays>(c::shareHooks(hooks));
    return SL_OK;
}

void slDestroyWays(slWays* ways) { c::destroyHandle(ways); }

slStatus slBeginWays(slWays* ways, const slSnapshot* snapshot, const double place[3], const slWaySettings* settings,
                     bool* known_out) {
    if (!ways || !snapshot || !place || !known_out) return failNull(ways, __func__);
    WaySettings how;
    if (settings) {
        if (settings->cookie != c::kWayCookie)
            return fail(ways->hooks->log(), SL_NO_DEFAULTS, __func__,
                        "the settings did not begin as slDefaultWaySettings()");
        how.narrowest = settings->narrowest;
        how.farthest = settings->farthest;
    }
    const c::SharedHooks before = ways->asked.exchange(snapshot->hooks);
    *known_out = ways->query.begin(snapshot->snapshot, c::vec(place), how);
    return SL_OK;
}

slStatus slWayTo(slWays* ways, const double place[3], slWay* way_out) {
    if (!ways || !place || !way_out) return failNull(ways, __func__);
    const Way way = ways->query.to(c::vec(place));
    static_assert(sizeof(glm::dvec3) == 3 * sizeof(double));
    *way_out = {way.known,
                way.connected,
                way.distance,
                way.narrowest,
                way.points.empty() ? nullptr : &way.points[0].x,
                static_cast<uint32_t>(way.points.size()),
                way.cells.data(),
                static_cast<uint32_t>(way.cells.size())};
    return SL_OK;
}
