// Judges visible sets by witnesses that share no code with what they judge.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/verify.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/base/random.h"
#include "sightline/tools/truth/aim.h"
#include "sightline/tools/truth/cull_proof.h"
#include "sightline/tools/truth/exact.h"
#include "sightline/tools/truth/id_buffer.h"
#include "sightline/tools/truth/rays.h"
#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {
namespace {

/// Sightings of one object that may fail to be confirmed before it is left alone.
constexpr uint8_t kMostTries = 100;
/// The same for points that were aimed at: objects that touch a wall from behind have many that nearly show.
constexpr uint8_t kMostAimedTries = 32;
/// So many rays are cast between two questions whether to stop.
constexpr uint64_t kRaysAtOnce = 256;

/// Everything that is seen of one frame.
class Trial {
public:
    Trial(const SceneFacts& facts, const SightLines& sight, std::span<const uint8_t> culled,
          const std::function<bool()>& stop)
        : sight_(sight),
          culled_(culled),
          stop_(stop),
          exact_(facts, sight),
          tries_(culled.size(), 0),
          aimed_tries_(culled.size(), 0) {
        verdict.seen.assign(culled.size(), 0);
    }

    const ExactSight& exact() const { return exact_; }
    /// To be asked between pieces of work.
    bool isStopped() {
        verdict.stopped = verdict.stopped || (stop_ && stop_());
        return verdict.stopped;
    }
    bool open(uint32_t object) const { return culled_[object] && !verdict.seen[object]; }

    /// A witness saw the object at a place.
    void sighted(uint32_t object, const glm::dvec2& place, const char* witness) {
        if (!culled_[object]) {
            verdict.seen[object] = 1;
            return;
        }
        if (!open(object) || tries_[object] >= kMostTries) return;
        if (exact_.seesObject(place, object)) {
            convict(object, place, witness);
        } else {
            ++tries_[object];
            ++verdict.unconfirmed;
        }
    }

    /// A ray got as far as a point of the object, or nearly.
    void reached(uint32_t object, const Target& target) {
        if (!open(object) || aimed_tries_[object] >= kMostAimedTries) return;
        glm::dvec2 place;
        if (exact_.seesPoint(object, target.triangle, target.point, place)) convict(object, place, "rays");
        else ++aimed_tries_[object];
    }

    /// A point of the object was found that nothing hides.
    void found(uint32_t object, double x, double y) {
        if (open(object)) verdict.false_culls.push_back({object, x, y, "proof"});
        verdict.seen[object] = 1;
    }

    /// It was convicted, and is hidden.
    void acquit(uint32_t object) {
        verdict.seen[object] = 0;
        std::erase_if(verdict.false_culls, [&](const FalseCull& cull) { return cull.object == object; });
        ++verdict.unconfirmed;
    }

    FrameVerdict finish() {
        std::sort(verdict.false_culls.begin(), verdict.false_culls.end(),
                  [](const FalseCull& a, const FalseCull& b) { return a.object < b.object; });
        verdict.exactly_visible = static_cast<uint64_t>(std::count(verdict.seen.begin(), verdict.seen.end(), 1));
        return std::move(verdict);
    }

    FrameVerdict verdict;

private:
    void convict(uint32_t object, const glm::dvec2& place, const char* witness) {
        verdict.seen[object] = 1;
        const glm::dvec2 pixel = sight_.pixel(place);
        verdict.false_culls.push_back({object, pixel.x, pixel.y, witness});
    }

    const SightLines& sight_;
    std::span<const uint8_t> culled_;
    const std::function<bool()>& stop_;
    ExactSight exact_;
    std::vector<uint8_t> tries_, aimed_tries_;
};

}  // namespace

struct Witness::Impl {
    explicit Impl(const Scene& scene) : facts(scene), rays(facts) {}

    void look(Trial& trial, const SightLines& sight, const glm::dvec2& place, const SightRay& ray,
              RaySighting& sighting) const {
        rays.look(ray, sight.eye(), sighting);
        ++trial.verdict.rays;
        for (const RaySighting::Passed& passed : sighting.passed) trial.sighted(passed.object, place, "rays");
        if (sighting.object != RaySighting::kNone) trial.sighted(sighting.object, place, "rays");
    }

    void castAimed(Trial& trial, const SightLines& sight, std::span<const uint8_t> culled,
                   const WitnessSettings& settings) const {
        RaySighting sighting;
        Target target;
        for (const Aim& aim : chooseAims(facts, sight, culled, std::min(settings.aimed_rays, settings.rays))) {
            if (trial.isStopped()) return;
            Random random(mixSeed(settings.seed, aim.object));
            for (uint32_t i = 0; i < aim.rays && trial.open(aim.object); ++i) {
                if (!aimAt(facts, sight, trial.exact(), aim.object, random, target)) continue;
                const SightRay ray = sight.rayThrough(target.place);
                look(trial, sight, target.place, ray, sighting);
                ++trial.verdict.aimed_rays;
                // Float cannot tell what is this close to the point: the exact test may.
                const double t = glm::dot(target.point - ray.origin, ray.direction);
                if (sighting.t >= t - 1e-5 * std::abs(t) - sighting.rounding) trial.reached(aim.object, target);
            }
        }
    }

    /// One ray in each cell of a grid over the viewport, the rest anywhere.
    void castUniform(Trial& trial, const SightLines& sight, const View& view, uint64_t count, uint64_t seed) const {
        if (count == 0) return;
        const double aspect = static_cast<double>(view.width) / view.height;
        const uint64_t columns = std::clamp<uint64_t>(
            static_cast<uint64_t>(std::llround(std::sqrt(static_cast<double>(count) * aspect))), 1, count);
        const uint64_t rows = count / columns;
        Random random(seed);
        RaySighting sighting;
        for (uint64_t i = 0; i < count; ++i) {
            if (i % kRaysAtOnce == 0 && trial.isStopped()) return;
            const double x = random.uniform(), y = random.uniform();
            const bool in_grid = i < columns * rows;
            const glm::dvec2 place =
                in_grid ? glm::dvec2((i % columns + x) / columns, (i / columns + y) / rows) : glm::dvec2(x, y);
            const glm::dvec2 clip = 2.0 * place - 1.0;
            look(trial, sight, clip, sight.rayThrough(clip), sighting);
        }
    }

    /// Decides of each object whether it is seen.
    void prove(Trial& trial, const View& view, std::span<const uint8_t> culled, bool lines_are_hidden) const {
        constexpr uint64_t kMostWork = 1000000;  // shadows of an object
        CullProver prover(facts, view, kMostWork, [&] { return trial.isStopped(); });
        ProofCounts counts;
        const std::vector<uint8_t> together = prover.hiddenTogether();
        for (uint32_t object = 0; object < culled.size() && !trial.isStopped(); ++object) {
            const bool convicted = culled[object] && trial.verdict.seen[object];
            if (trial.verdict.seen[object] && !(convicted && lines_are_hidden)) continue;
            const CullProof proof = together[object] ? CullProof() : prover.prove(object);
            if (convicted && proof.result != ProofResult::kProved) continue;
            if (convicted) trial.acquit(object);
            if (proof.result == ProofResult::kSeen) trial.found(object, proof.x, proof.y);
            else if (proof.result == ProofResult::kProved)
                ++(culled[object] ? counts.culled_hidden : counts.kept_hidden);
            else ++(culled[object] ? counts.culled_undecided : counts.kept_undecided);
        }
        trial.verdict.proofs = counts;
    }

    SceneFacts facts;
    RayScene rays;
};

Witness::Witness(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Witness::~Witness() = default;

FrameVerdict Witness::judge(const View& view, std::span<const uint8_t> culled, const WitnessSettings& settings) const {
    SIGHTLINE_ASSERT(culled.size() == impl_->facts.scene().objects.size());
    FrameVerdict nothing;
    nothing.seen.assign(culled.size(), 0);
    if (!isUsable(view)) return nothing;

    const SightLines sight(view);
    Trial trial(impl_->facts, sight, culled, settings.stop);
    impl_->castAimed(trial, sight, culled, settings);
    impl_->castUniform(trial, sight, view, settings.rays - trial.verdict.aimed_rays, mixSeed(settings.seed, ~0ull));
    if (settings.supersampling > 0 && !trial.isStopped()) {
        IdBufferSettings pass;
        pass.supersampling = settings.supersampling;
        pass.seed = mixSeed(settings.seed, ~1ull);
        pass.stop = [&] { return trial.isStopped(); };
        const uint64_t pixels = uint64_t(view.width) * view.height;
        while (pass.supersampling > 1 && pixels * pass.supersampling * pass.supersampling > settings.id_sample_limit)
            --pass.supersampling;
        trial.verdict.supersampling = pass.supersampling;
        trial.verdict.id_samples =
            drawIdBuffer(impl_->facts, view, sight, pass,
                         [&](uint32_t object, const glm::dvec2& place) { trial.sighted(object, place, "id-buffer"); });
    }
    if (settings.prove && !trial.isStopped()) impl_->prove(trial, view, culled, settings.lines_are_hidden);
    return trial.finish();
}

}  // namespace sightline::tools
