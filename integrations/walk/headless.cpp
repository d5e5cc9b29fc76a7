// What programs share that draw a path both ways: a context without a display, and what it means if two images differ.
// SPDX-License-Identifier: MIT
#include "integrations/walk/headless.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/truth/rays.h"

namespace sightline::integrations {

void useSoftwareDriver() {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", "1", 0);
}

bool makeContext() {
    useSoftwareDriver();
    const auto platform =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!platform) return false;
    const EGLDisplay display = platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const EGLint wish[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_GREEN_SIZE,
                           8,
                           EGL_BLUE_SIZE,
                           8,
                           EGL_ALPHA_SIZE,
                           8,
                           EGL_DEPTH_SIZE,
                           24,
                           EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, kWidth, EGL_HEIGHT, kHeight, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) ||
        !eglChooseConfig(display, wish, &config, 1, &count) || count < 1)
        return false;
    const EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
    return surface != EGL_NO_SURFACE && context != EGL_NO_CONTEXT && eglMakeCurrent(display, surface, surface, context);
}

Result<Walked> readArguments(int argc, char** argv) {
    if (argc < 2) return Error{Error::Kind::kUsage, "usage: SCENE [FRAMES [SEED [walk|scatter [queries]]]]"};
    Result<tools::Scene> scene =
        tools::isProcedural(argv[1]) ? tools::makeProcedural(argv[1]) : tools::loadSceneFile(argv[1]);
    if (!scene) return scene.error();
    const uint32_t frames = argc > 2 ? static_cast<uint32_t>(std::strtoul(argv[2], nullptr, 10)) : 60;
    const uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
    const bool scattered = argc > 4 && std::strcmp(argv[4], "scatter") == 0;
    Walked walked{std::move(*scene), {}, argc > 5};
    walked.path = scattered ? tools::seededCameras(walked.scene, frames, seed).frames
                            : tools::walkThrough(walked.scene, {.frames = frames, .seed = seed}).frames;
    return walked;
}

struct Tally::Rays {
    tools::SceneFacts facts;
    tools::RayScene scene;
    explicit Rays(const tools::Scene& from) : facts(from), scene(facts) {}
};

Tally::Tally(const tools::Scene& scene) : rays_(new Rays(scene)) {}
Tally::~Tally() { delete rays_; }

void Tally::add(const View& view, const std::vector<unsigned char>& own, const std::vector<unsigned char>& ours,
                const std::set<uint32_t>& drawn) {
    const tools::SightLines lines(view);
    uint64_t different = 0, plain = 0;
    for (size_t pixel = 0; pixel < own.size() / 4; ++pixel) {
        plain += std::memcmp(&own[4 * pixel], own.data(), 4) == 0;
        if (std::memcmp(&own[4 * pixel], &ours[4 * pixel], 4) == 0) continue;
        ++different;
        const double x = static_cast<double>(pixel % kWidth) + 0.5, y = static_cast<double>(pixel / kWidth) + 0.5;
        tools::RaySighting sighting;
        rays_->scene.look(lines.rayThrough({2 * x / kWidth - 1, 2 * y / kHeight - 1}), lines.eye(), sighting);
        wrong += sighting.object != tools::RaySighting::kNone && drawn.count(sighting.object) == 0;
    }
    ++frames;
    differ += different > 0;
    pixels += different;
    blank += plain == own.size() / 4;
}

double median(const std::vector<double>& times) {
    std::vector<double> sorted(times.begin() + static_cast<ptrdiff_t>(times.size() > 2 ? 2 : 0), times.end());
    if (sorted.empty()) return 0;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
}

}  // namespace sightline::integrations
