// The software z-buffer beside Mesa's software GL: the same lists, views and threads, in turns.
// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <thread>

#include "apps/gl/renderers.h"
#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/shade/light.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr uint64_t kSeed = 1;
constexpr uint32_t kWidth = 1920, kHeight = 1080;
constexpr uint32_t kThreads[] = {1, 2};
/// Without workers Mesa fills pixels in the caller's thread; with them the caller waits.
constexpr uint32_t kMesaWorkers[] = {0, 2};
constexpr int kSettings = 2;

/// Per surface: red, green, blue, alpha, low byte first.
std::vector<uint32_t> coloursOf(const RenderList& in_view) {
    const DrawList& list = in_view.list();
    std::vector<uint32_t> colours;
    colours.reserve(list.surfaces());
    for (uint32_t item = 0; item < list.items().size(); ++item)
        for (uint32_t t = 0; t < list.items()[item].mesh.triangles(); ++t) {
            const glm::u8vec3 bytes = toBytes(in_view.colourOf(item, t));
            colours.push_back(0xff000000u | uint32_t{bytes.b} << 16 | uint32_t{bytes.g} << 8 | bytes.r);
        }
    return colours;
}

void inParallel(uint32_t threads, size_t count, const std::function<void(size_t begin, size_t end)>& work) {
    std::vector<std::jthread> others;
    for (uint32_t i = 1; i < threads; ++i) others.emplace_back(work, count * i / threads, count * (i + 1) / threads);
    work(0, count / threads);
}

/// The light of a triangle, taken anew wherever a run of its samples begins.
class FlatColours {
public:
    FlatColours(const DrawList& list, std::vector<uint32_t> base) : base_(std::move(base)) {
        for (const DrawItem& item : list.items()) {
            const glm::dmat3 turn(item.transform);
            const double side = glm::determinant(turn) < 0 ? -1.0 : 1.0;
            for (size_t t = 0; t < item.mesh.triangles(); ++t) {
                const uint32_t* corners = &item.mesh.indices[3 * t];
                const glm::dvec3 a = turn * glm::dvec3(item.mesh.positions[corners[0]]),
                                 b = turn * glm::dvec3(item.mesh.positions[corners[1]]),
                                 c = turn * glm::dvec3(item.mesh.positions[corners[2]]);
                const glm::dvec3 normal = side * glm::cross(b - a, c - a);
                const double length = glm::length(normal);
                normals_.emplace_back(length > 0 ? normal / length : normal);
            }
        }
    }

    void shade(const std::vector<uint32_t>& surfaces, uint32_t threads) {
        pixels_.resize(surfaces.size());
        inParallel(threads, surfaces.size(), [&](size_t begin, size_t end) {
            uint32_t surface = HiddenImage::kNone, colour = 0;
            for (size_t i = begin; i < end; ++i) {
                if (surfaces[i] != surface) {
                    surface = surfaces[i];
                    colour = surface == HiddenImage::kNone ? 0 : lit(surface);
                }
                pixels_[i] = colour;
            }
        });
    }

    const std::vector<uint32_t>& pixels() const { return pixels_; }

private:
    uint32_t lit(uint32_t surface) const {
        const glm::vec3 sun = glm::normalize(glm::vec3(0.4f, 0.8f, 0.45f));
        const float light = 0.35f + 0.65f * std::max(glm::dot(normals_[surface], sun), 0.0f);
        const uint32_t part = static_cast<uint32_t>(256.0f * light), base = base_[surface];
        const uint32_t even = ((base & 0xff00ffu) * part >> 8) & 0xff00ffu;
        return even | (((base >> 8 & 0xffu) * part) & 0xff00u) | 0xff000000u;
    }

    std::vector<uint32_t> base_;  ///< per surface, as coloursOf() packs them
    std::vector<glm::vec3> normals_;
    std::vector<uint32_t> pixels_;
};

/// Medians of one view, per entry of kThreads [milliseconds].
struct ViewCost {
    double gl_flat[kSettings] = {}, gl_ids[kSettings] = {}, flat[kSettings] = {}, ids[kSettings] = {};
    double triangles = 0;  ///< given to both
    double unlike = 0;     ///< pixels of one thread's pictures
};

/// Pixels where two pictures differ by more than rounding.
double countUnlike(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
    double count = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        bool like = true;
        for (int shift = 0; shift < 24; shift += 8)
            like = like && std::abs(int(a[i] >> shift & 0xff) - int(b[i] >> shift & 0xff)) <= 3;
        count += !like;
    }
    return count;
}

void tell(const Status& status) {
    if (!status) std::fprintf(stderr, "%s\n", status.error().message.c_str());
}

std::optional<ViewCost> measureView(const Scene& scene, const View& view, const GlContext* contexts, int repeat) {
    const RenderList in_view(scene, view);
    const DrawList& list = in_view.list();
    const std::vector<uint32_t> base = coloursOf(in_view);
    FlatColours colours(list, base);
    std::vector<GlFlatRenderer> gl_flat;
    std::vector<GlIdRenderer> gl_ids;
    for (int i = 0; i < kSettings; ++i) {
        Result<GlFlatRenderer> flat = GlFlatRenderer::create(contexts[i], list, base);
        Result<GlIdRenderer> ids = GlIdRenderer::create(contexts[i], list);
        if (!flat || !ids) return std::nullopt;
        gl_flat.push_back(std::move(*flat));
        gl_ids.push_back(std::move(*ids));
    }
    RenderSettings settings[kSettings];  // method: kZBuffer
    std::vector<std::function<void()>> jobs;
    for (int i = 0; i < kSettings; ++i) {
        settings[i].threads = kThreads[i];
        jobs.push_back([&, i] { tell(gl_flat[i].draw(view)); });
        jobs.push_back([&, i] { tell(gl_ids[i].draw(view)); });
        jobs.push_back([&, i] { colours.shade(render(list, view, settings[i]).surface, kThreads[i]); });
        jobs.push_back([&, i] { render(list, view, settings[i]); });
    }
    const std::vector<double> times = timeInterleaved(jobs, repeat);
    ViewCost cost;
    for (int i = 0; i < kSettings; ++i) {
        cost.gl_flat[i] = 1e-3 * times[4 * i];
        cost.gl_ids[i] = 1e-3 * times[4 * i + 1];
        cost.flat[i] = 1e-3 * times[4 * i + 2];
        cost.ids[i] = 1e-3 * times[4 * i + 3];
    }
    cost.triangles = list.surfaces();
    const Result<std::vector<uint32_t>> picture = gl_flat[0].read();
    if (!picture) return std::nullopt;
    cost.unlike = countUnlike(*picture, colours.pixels());
    return cost;
}

void measurePath(const Scene& scene, const CameraPath& path, const GlContext* contexts, int repeat, Table& table) {
    ViewCost sum;
    const double part = 1.0 / static_cast<double>(path.frames.size());
    for (const CameraFrame& frame : path.frames) {
        const std::optional<ViewCost> cost = measureView(scene, makeView(frame, kWidth, kHeight), contexts, repeat);
        if (!cost) return;
        for (int i = 0; i < kSettings; ++i) {
            sum.gl_flat[i] += part * cost->gl_flat[i];
            sum.gl_ids[i] += part * cost->gl_ids[i];
            sum.flat[i] += part * cost->flat[i];
            sum.ids[i] += part * cost->ids[i];
        }
        sum.triangles += part * cost->triangles;
        sum.unlike += part * cost->unlike;
    }
    for (int i = 0; i < kSettings; ++i) {
        const std::string threads = fmt::format(", {} thread{}", kThreads[i], kThreads[i] == 1 ? "" : "s");
        table.rows.push_back({scene.name, "z-buffer, flat shading" + threads, sum.flat[i], "ms",
                              "Mesa llvmpipe, flat shading" + threads, sum.gl_flat[i]});
        table.rows.push_back(
            {scene.name, "z-buffer, ids" + threads, sum.ids[i], "ms", "Mesa llvmpipe, ids" + threads, sum.gl_ids[i]});
    }
    table.rows.push_back({scene.name, "pixels unlike Mesa's", sum.unlike, "pixels", "of the picture",
                          static_cast<double>(kWidth) * kHeight});
    table.rows.push_back({scene.name, "triangles in view", sum.triangles, "triangles", "of the scene",
                          static_cast<double>(drawnTriangles(scene))});
}

}  // namespace

Table benchGl(const Options& options) {
    Table table{"gl", {}};
    std::vector<GlContext> contexts;
    for (const uint32_t workers : kMesaWorkers) {
        Result<GlContext> context = GlContext::create(workers);
        if (!context) {
            std::fprintf(stderr, "sightline: %s\n", context.error().message.c_str());
            return table;
        }
        contexts.push_back(std::move(*context));
    }
    const int repeat = options.repeat ? options.repeat : 15;
    if (options.scene) {
        measurePath(*options.scene, seededCameras(*options.scene, 4, kSeed), contexts.data(), repeat, table);
    } else {
        const Scene city = makeCity(kSeed, 10000);
        measurePath(city, cityStreetPath(kSeed, 4), contexts.data(), repeat, table);
    }
    return table;
}

}  // namespace sightline::bench
