// The second witness of the occlusion scenes: rays aimed at boxes, through whatever may show them.
// SPDX-License-Identifier: MIT
#include "bench/box_witness.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "bench/open_places.h"
#include "sightline/studies/hidden/threads.h"
#include "sightline/tools/truth/aim.h"
#include "sightline/tools/truth/exact.h"
#include "sightline/tools/truth/rays.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr int kMostTries = 32;  // sightings of a box that may fail to be confirmed before it is left alone

/// The batches of a scene as objects, and after them its boxes if asked for: those are seen, and hide nothing.
Scene sceneOf(const OcclusionScene& from, bool with_boxes) {
    static constexpr uint32_t kCorners[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                              2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].alpha_mode = AlphaMode::kBlend;
    for (const OccluderBatch& batch : from.batches) {
        Mesh& mesh = scene.meshes.emplace_back();
        mesh.positions = batch.positions;
        mesh.indices = batch.indices;
        mesh.primitives = {{0, static_cast<uint32_t>(mesh.triangles()), 0}};
        for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
        scene.objects.emplace_back().mesh = static_cast<uint32_t>(scene.meshes.size()) - 1;
    }
    if (!with_boxes) return scene;
    Mesh& cube = scene.meshes.emplace_back();
    for (int k = 0; k < 8; ++k) cube.positions.emplace_back(k & 1, k >> 1 & 1, k >> 2 & 1);
    cube.indices.assign(std::begin(kCorners), std::end(kCorners));
    cube.primitives = {{0, 12, 1}};
    cube.bounds.grow(glm::dvec3(0.0));
    cube.bounds.grow(glm::dvec3(1.0));
    for (const Box3f& box : from.boxes) {
        SceneObject& object = scene.objects.emplace_back();
        object.mesh = static_cast<uint32_t>(scene.meshes.size()) - 1;
        // The difference of two floats is exact in double, and so are the corners.
        for (int axis = 0; axis < 3; ++axis) object.transform[axis][axis] = double{box.max[axis]} - box.min[axis];
        object.transform[3] = glm::dvec4(glm::dvec3(box.min), 1.0);
    }
    return scene;
}

/// Where a line of sight enters a box, relative to the eye; infinity if it misses it.
double entryOf(const SightRay& ray, const glm::dvec3& eye, const Box3f& box) {
    double from = ray.t_near, to = ray.t_far;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis] - eye[axis] - ray.origin[axis];
        const double high = box.max[axis] - eye[axis] - ray.origin[axis];
        if (ray.direction[axis] == 0) {
            if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
            continue;
        }
        const double a = low / ray.direction[axis], b = high / ray.direction[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to ? from : std::numeric_limits<double>::infinity();
}

}  // namespace

struct BoxWitness::Parts {
    explicit Parts(const OcclusionScene& from)
        : scene(from),
          all(sceneOf(from, true)),
          all_facts(all),
          walls(sceneOf(from, false)),
          wall_facts(walls),
          rays(wall_facts),
          edges(from) {}

    uint32_t objectOf(uint32_t box) const { return static_cast<uint32_t>(scene.batches.size()) + box; }

    const OcclusionScene& scene;
    Scene all;
    SceneFacts all_facts;
    Scene walls;
    SceneFacts wall_facts;
    RayScene rays;  ///< of the walls alone: boxes hide nothing
    SceneEdges edges;
};

namespace {

/// One view's rays at one box after the other.
class Caster {
public:
    Caster(const BoxWitness::Parts& witness, const View& view, const SightLines& sight, const OpenPlaces& places,
           const BoxRays& settings)
        : witness_(witness),
          view_(view),
          sight_(sight),
          exact_(witness.all_facts, sight),
          places_(places),
          settings_(settings) {}

    BoxVerdict::Row cast(uint32_t box) {
        Random random(mixSeed(settings_.seed, box));
        row_ = {};
        tries_ = 0;
        const uint32_t object = witness_.objectOf(box);
        Target target;
        for (uint32_t i = 0; i < settings_.at_boxes && !row_.seen && tries_ < kMostTries; ++i) {
            if (!aimAt(witness_.all_facts, sight_, exact_, object, random, target)) break;
            const SightRay ray = sight_.rayThrough(target.place);
            ++rays;
            if (!reaches(ray, glm::dot(target.point - ray.origin, ray.direction))) continue;
            glm::dvec2 place;
            note(exact_.seesPoint(object, target.triangle, target.point, place), target.place);
        }
        const PlaceRect rect = places_.rectOf(view_, witness_.scene.boxes[box]);
        for (uint32_t i = 0; i < settings_.through_edges && !row_.seen && tries_ < kMostTries; ++i) {
            glm::dvec2 place;
            double entry = std::numeric_limits<double>::infinity();
            SightRay ray;
            for (int k = 0; k < 8 && std::isinf(entry) && places_.pick(rect, random, place); ++k) {
                ray = sight_.rayThrough(place);
                entry = entryOf(ray, sight_.eye(), witness_.scene.boxes[box]);
            }
            if (std::isinf(entry)) continue;
            ++rays;
            ++edge_rays;
            // What float cannot tell apart is asked exactly each fourth time.
            if (i % 4 != 3 && !reaches(ray, entry)) continue;
            const bool sure = i % 4 != 3;
            if (exact_.seesObject(place, object)) note(true, place);
            else if (sure) note(false, place);
        }
        return row_;
    }

    uint64_t rays = 0, edge_rays = 0, unconfirmed = 0;

private:
    /// Whether nothing that float knows of lies clearly before a point of a line of sight.
    bool reaches(const SightRay& ray, double t) {
        witness_.rays.look(ray, sight_.eye(), sighting_);
        return sighting_.t >= t - 1e-5 * std::abs(t) - sighting_.rounding;
    }
    void note(bool confirmed, const glm::dvec2& place) {
        if (!confirmed) {
            ++tries_;
            ++unconfirmed;
            return;
        }
        row_.seen = true;
        row_.pixel = sight_.pixel(place);
    }

    const BoxWitness::Parts& witness_;
    const View& view_;
    const SightLines& sight_;
    const ExactSight exact_;
    const OpenPlaces& places_;
    const BoxRays& settings_;
    RaySighting sighting_;
    BoxVerdict::Row row_;
    int tries_ = 0;
};

}  // namespace

BoxWitness::BoxWitness(const OcclusionScene& scene) : parts_(std::make_unique<Parts>(scene)) {}
BoxWitness::~BoxWitness() = default;

BoxVerdict BoxWitness::judge(const View& view, std::span<const uint32_t> boxes, const BoxRays& settings) const {
    BoxVerdict verdict;
    verdict.boxes.resize(boxes.size());
    if (!isUsable(view) || settings.at_boxes + settings.through_edges == 0) return verdict;
    const SightLines sight(view);
    OpenPlaces places;
    if (settings.through_edges > 0)
        places = OpenPlaces(parts_->edges, parts_->rays, sight, view, settings.places, settings.seed);
    std::atomic<size_t> next{0};
    std::atomic<uint64_t> rays{0}, edge_rays{0}, unconfirmed{0};
    FirstFault fault;
    const auto work = [&](uint32_t) {
        fault.guard([&] {
            constexpr size_t kAtOnce = 64;
            Caster caster(*parts_, view, sight, places, settings);
            for (size_t first; (first = next.fetch_add(kAtOnce)) < boxes.size() && !fault.any();)
                for (size_t i = first; i < std::min(first + kAtOnce, boxes.size()); ++i)
                    verdict.boxes[i] = caster.cast(boxes[i]);
            rays += caster.rays;
            edge_rays += caster.edge_rays;
            unconfirmed += caster.unconfirmed;
        });
    };
    std::vector<std::thread> others = startThreads(settings.threads, work);
    work(0);
    for (std::thread& other : others) other.join();
    fault.rethrow();
    verdict.rays = rays;
    verdict.edge_rays = edge_rays;
    verdict.unconfirmed = unconfirmed;
    return verdict;
}

}  // namespace sightline::bench
