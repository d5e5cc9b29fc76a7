// Shadow casters: which objects a shadow map must draw for one view, and which it can leave out.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include <sightline/sightline.h>

namespace {

enum Key : uint64_t { kGround = 1, kTower, kBird, kFarTower, kCount };

sightline::ObjectDef object(Key key, glm::dvec3 low, glm::dvec3 high) {
    sightline::ObjectDef def;
    def.key = key;
    def.bounds = {low, high};
    return def;
}

}  // namespace

int main() {
    sightline::World world;
    world.add(object(kGround, {-100, -1, -100}, {100, 0, 100}));
    world.add(object(kTower, {-2, 0, -22}, {2, 10, -18}));   // before the eye
    world.add(object(kBird, {4, 30, -16}, {5, 31, -15}));    // above the image; its shadow lies in it
    world.add(object(kFarTower, {-2, 0, 60}, {2, 10, 64}));  // behind the eye; its shadow, too
    const sightline::Snapshot now = world.commit();

    // The eye stands at the origin, and looks a little down.
    sightline::View view;
    view.view = sightline::lookAt({0, 5, 0}, {0, 2, -20}, {0, 1, 0});
    view.projection = sightline::perspective(1.0, 16.0 / 9.0, 0.1, 200.0);

    sightline::Query query;
    const sightline::VisibleSet visible = query.visible(now, view);
    bool seen[kCount] = {};
    for (const sightline::Visible& one : visible.objects) seen[one.key] = true;

    // A sun nearly overhead, with a shadow map of two cascades: to 30 units from the eye, and to 100.
    sightline::Light sun;
    sun.direction = {0.2, -1, 0.1};
    const double cascades[] = {30, 100};
    sightline::CasterSettings settings;
    settings.cascades = cascades;
    sightline::ShadowQuery shadows;
    const sightline::CasterSet set = shadows.casters(now, view, visible.objects, sun, settings);
    uint32_t casts[kCount] = {};
    for (size_t i = 0; i < set.casters.size(); ++i) casts[set.casters[i].key] = set.cascades[i];

    const char* const names[kCount] = {"", "ground", "tower", "bird", "tower behind"};
    for (uint64_t key = kGround; key < kCount; ++key)
        std::printf("%-13s seen %d, drawn into cascades %s%s%s\n", names[key], seen[key], casts[key] & 1 ? "0 " : "",
                    casts[key] & 2 ? "1 " : "", casts[key] ? "" : "none");

    // What is not seen may still darken what is; what is far behind the eye may not.
    const bool good = !seen[kBird] && casts[kBird] && casts[kTower] && !seen[kFarTower] && !casts[kFarTower];
    return good ? 0 : 1;
}
