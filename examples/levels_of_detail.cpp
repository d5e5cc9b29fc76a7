// Levels of detail: a chain with proved errors, a world that knows them, and a walk that fades from one to the next.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <sightline/prepare/lod/lod_chain.h>
#include <sightline/sightline.h>

namespace {

struct Ball {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
};

/// A ball of radius 1 with bumps.
Ball makeBall(uint32_t rings) {
    Ball ball;
    const uint32_t around = 2 * rings;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t k = 0; k < around; ++k) {
            const double theta = std::numbers::pi * ring / rings, phi = 2 * std::numbers::pi * k / around;
            const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            ball.positions.emplace_back(d * (1.0 + 0.05 * std::sin(7 * d.x) * std::sin(6 * d.y + d.z)));
        }
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t k = 0; k < around; ++k) {
            const uint32_t a = ring * around + k, b = ring * around + (k + 1) % around;
            for (const uint32_t corner : {a, b, a + around, b, b + around, a + around}) ball.indices.push_back(corner);
        }
    return ball;
}

}  // namespace

int main() {
    // Once a mesh: levels that are simpler and simpler, each with a bound on how far its surface is from the mesh's.
    const Ball ball = makeBall(60);
    const sightline::LodChain chain = sightline::makeLods({ball.positions, ball.indices});
    for (const sightline::LodLevel& level : chain.levels)
        std::printf("%6u triangles, off by %.4f at most\n", level.triangles, level.error);

    sightline::World world;
    sightline::ObjectDef def;
    for (const glm::vec3& p : ball.positions) def.bounds.grow(glm::dvec3(p));
    def.lods = world.addLods(chain.levels);
    world.add(def);
    const sightline::Snapshot now = world.commit();

    // Away from the ball: each level is drawn while it errs by no more than a pixel, and faded into the next one.
    sightline::QuerySettings settings;
    settings.lod_error = 1;
    sightline::Query query;
    sightline::View view;
    view.projection = sightline::perspective(1.0, 16.0 / 9.0, 0.1);
    uint8_t coarsest = 0;
    bool good = true;
    for (double distance = 2; distance < 400; distance *= 1.01) {
        view.view = sightline::lookAt({0, 0, distance}, {0, 0, 0}, {0, 1, 0});
        const sightline::VisibleLod lod = query.visible(now, view, settings).lods[0];
        if (lod.from != lod.level) {
            // One pixel of the checked pattern: it shows this level, or that.
            const bool shows_new = sightline::showsFadedIn(640, 360, lod.fade);
            std::printf("%6.1f away: level %u comes in for %u, by %3.0f %%; a pixel shows level %u\n", distance,
                        lod.level, lod.from, 100 * static_cast<double>(lod.fade), shows_new ? lod.level : lod.from);
        }
        good &= lod.level >= coarsest;  // never to and fro
        coarsest = lod.level;
    }
    good &= coarsest > 2;
    return good ? 0 : 1;
}
