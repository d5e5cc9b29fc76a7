// What clusters are merged by, measured on this machine: the cost of a cluster's test, and of a triangle that it spares.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/facing_costs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <glm/gtc/constants.hpp>
#include <hwy/targets.h>

#include "sightline/base/random.h"
#include "sightline/cull/facing_clusters.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/studies/hidden/render.h"

namespace sightline::tools {
using namespace studies;
namespace {

constexpr double kLeast = 1e-3;  // [ns]: what differences of clocks are worth at least

struct Ball {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
};

/// A ball with small bumps.
Ball makeBall(uint32_t rings) {
    Ball ball;
    Random random(1);
    const uint32_t around = 2 * rings;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t k = 0; k < around; ++k) {
            const bool pole = ring == 0 || ring == rings;
            const double theta = glm::pi<double>() * ring / rings, phi = 2 * glm::pi<double>() * k / around;
            const double r = pole ? 1.0 : 1.0 + 0.02 * random.uniform(-1, 1), across = pole ? 0.0 : std::sin(theta);
            ball.positions.emplace_back(r * across * std::cos(phi), r * std::cos(theta), r * across * std::sin(phi));
        }
    const auto at = [&](uint32_t ring, uint32_t k) { return ring * around + k % around; };
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t k = 0; k < around; ++k) {
            if (ring > 0) ball.indices.insert(ball.indices.end(), {at(ring, k), at(ring, k + 1), at(ring + 1, k)});
            if (ring + 1 < rings)
                ball.indices.insert(ball.indices.end(), {at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)});
        }
    return ball;
}

View viewOf(uint32_t size) {
    View view;
    view.width = view.height = size;
    view.view = lookAt({0, 0, 3.5}, glm::dvec3(0.0), {0, 1, 0});
    view.projection = perspective(0.7, 1.0, 0.1);
    return view;
}

/// Those that face the eye of viewOf().
std::vector<uint32_t> frontsOf(const Ball& ball) {
    std::vector<uint32_t> fronts;
    const glm::dvec3 eye(0, 0, 3.5);
    for (size_t i = 0; i < ball.indices.size(); i += 3) {
        const glm::dvec3 a(ball.positions[ball.indices[i]]), b(ball.positions[ball.indices[i + 1]]),
            c(ball.positions[ball.indices[i + 2]]);
        if (glm::dot(glm::cross(b - a, c - a), eye - a) > 0)
            fronts.insert(fronts.end(), ball.indices.begin() + static_cast<ptrdiff_t>(i),
                          ball.indices.begin() + static_cast<ptrdiff_t>(i) + 3);
    }
    return fronts;
}

/// Medians of jobs that take turns  [nanoseconds].
std::vector<double> timeInTurn(const std::vector<std::function<void()>>& jobs, uint32_t rounds) {
    std::vector<std::vector<double>> times(jobs.size());
    for (uint32_t round = 0; round <= rounds; ++round)
        for (size_t i = 0; i < jobs.size(); ++i) {
            const auto start = std::chrono::steady_clock::now();
            jobs[i]();
            const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
            if (round > 0) times[i].push_back(took.count());  // the first warms up
        }
    std::vector<double> medians;
    for (std::vector<double>& all : times) {
        std::nth_element(all.begin(), all.begin() + static_cast<ptrdiff_t>(all.size() / 2), all.end());
        medians.push_back(all[all.size() / 2]);
    }
    return medians;
}

double timeTest(const Ball& ball, const View& view, uint32_t rounds) {
    const MeshView mesh{ball.positions, ball.indices};
    const MeshPart all{0, static_cast<uint32_t>(mesh.triangles()), false};
    const DrawClusters clusters = prepareDrawClusters(mesh, {&all, 1});
    const FacingEye eye = facingEye(view, glm::dmat4(1.0));
    std::vector<uint8_t> back(clusters.count() / 8 + 16);
    constexpr int kTimes = 64;
    const std::vector<double> took = timeInTurn({[&] {
                                                    for (int i = 0; i < kTimes; ++i)
                                                        findBackClusters(clusters.facing, eye, kAllFacingTests, back);
                                                }},
                                                rounds);
    return took[0] / (kTimes * static_cast<double>(clusters.count()));
}

}  // namespace

std::string machineName() {
    std::string model = "unknown processor";
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
            model = line.substr(line.find(": ") + 2);
            break;
        }
    const int64_t targets = hwy::SupportedTargets();
    return fmt::format("{}, {}, {} cores", model, hwy::TargetName(targets & -targets),
                       std::thread::hardware_concurrency());
}

FacingCosts measureFacingCosts(const FacingCostSettings& settings) {
    const Ball ball = makeBall(std::max(settings.rings, 8u));
    const std::vector<uint32_t> fronts = frontsOf(ball);
    const View view = viewOf(std::max(settings.size, 1u));
    const uint32_t rounds = std::max(settings.rounds, 1u);
    DrawItem whole, front;
    whole.mesh = {ball.positions, ball.indices};
    front.mesh = {ball.positions, fronts};
    const DrawList all({&whole, 1}), seen({&front, 1});
    RenderSettings drops, draws;
    draws.projector.cull_back_faces = false;
    const std::vector<double> took = timeInTurn(
        {[&] { render(seen, view, drops); }, [&] { render(all, view, drops); }, [&] { render(all, view, draws); }},
        rounds);
    const double backs = static_cast<double>((ball.indices.size() - fronts.size()) / 3);
    FacingCosts costs;
    costs.test = std::max(timeTest(ball, view, rounds), kLeast);
    costs.dropped = std::max((took[1] - took[0]) / backs, kLeast);
    costs.drawn = std::max((took[2] - took[0]) / backs, kLeast);
    return costs;
}

}  // namespace sightline::tools
