// Draws a path through a scene with OpenSceneGraph's own culling and with Sightline, compares the images, and times both.
// SPDX-License-Identifier: MIT
//
//     osg_walk SCENE [FRAMES [SEED [walk|scatter [queries]]]]    queries: also by osg::OcclusionQueryNode, an object each
//
// Needs neither a display nor a graphics card: Mesa's software driver draws, by EGL. Where a pixel differs, the line of sight
// through its centre is followed by Embree, which shares nothing with either: the pixel is a crack that rounding opened between
// surfaces, or depths that fell together, if that line ends on what Sightline kept. Exit code 1 if it does not.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include <osgViewer/Viewer>

#include "integrations/osg/culler.h"
#include "integrations/osg/scene_graph.h"
#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/truth/rays.h"

namespace {
using namespace sightline;

constexpr int kWidth = 1280, kHeight = 720;

int fail(const std::string& message) {
    std::fprintf(stderr, "osg_walk: %s\n", message.c_str());
    return 3;
}

/// Makes a context with an image of its own current.
bool makeContext() {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", "1", 0);
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

/// One way to draw, with a graph and a viewer of its own.
struct Way {
    osgViewer::Viewer viewer;
    osg::ref_ptr<sightline_osg::Culler> culler;
    std::vector<double> times;  ///< of each frame [milliseconds]
    std::vector<unsigned char> image = std::vector<unsigned char>(size_t{4} * kWidth * kHeight);

    Way(const tools::Scene& scene, bool by_sightline, bool by_queries = false) {
        const osg::ref_ptr<osg::Group> root = sightline_osg::sceneGraph(scene, by_queries);
        viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        viewer.setUpViewerAsEmbeddedInWindow(0, 0, kWidth, kHeight);
        osg::Camera* const camera = viewer.getCamera();
        camera->setClearColor(osg::Vec4(0.2f, 0.3f, 0.4f, 1.0f));
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setCullingMode(camera->getCullingMode() & ~osg::CullSettings::SMALL_FEATURE_CULLING);
        viewer.setSceneData(root);
        viewer.realize();
        if (by_sightline) root->setCullCallback(culler = new sightline_osg::Culler(*root));
    }

    void draw(const View& view) {
        viewer.getCamera()->setViewMatrix(osg::Matrixd(&view.view[0][0]));
        viewer.getCamera()->setProjectionMatrix(osg::Matrixd(&view.projection[0][0]));
        const auto start = std::chrono::steady_clock::now();
        viewer.frame();
        glFinish();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        times.push_back(took.count());
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
    }
    double median() const {
        std::vector<double> sorted(times.begin() + static_cast<ptrdiff_t>(std::min<size_t>(2, times.size() - 1)),
                                   times.end());
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2), sorted.end());
        return sorted[sorted.size() / 2];
    }
};

/// Whether the line of sight through a pixel's centre ends on an object that was drawn.
bool endsOnDrawn(const tools::RayScene& rays, const View& view, size_t pixel, const std::set<uint32_t>& drawn) {
    const tools::SightLines lines(view);
    const double x = static_cast<double>(pixel % kWidth) + 0.5, y = static_cast<double>(pixel / kWidth) + 0.5;
    tools::RaySighting sighting;
    rays.look(lines.rayThrough({2 * x / kWidth - 1, 2 * y / kHeight - 1}), lines.eye(), sighting);
    return sighting.object == tools::RaySighting::kNone || drawn.count(sighting.object) > 0;
}

/// The objects of the scene that were drawn.
std::set<uint32_t> drawnObjects(const sightline_osg::Culler& culler) {
    std::set<uint32_t> objects;
    for (const osg::NodePath& path : culler.drawn())
        for (const osg::Node* const node : path)
            if (!node->getName().empty()) objects.insert(static_cast<uint32_t>(std::stoul(node->getName())));
    return objects;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return fail("usage: osg_walk SCENE [FRAMES [SEED [walk|scatter [queries]]]]"), 2;
    const size_t frames = argc > 2 ? static_cast<size_t>(std::atoi(argv[2])) : 60;
    const uint64_t seed = argc > 3 ? static_cast<uint64_t>(std::atoll(argv[3])) : 1;
    const bool made = tools::isProcedural(argv[1]);
    Result<tools::Scene> scene = made ? tools::makeProcedural(argv[1]) : tools::loadSceneFile(argv[1]);
    if (!scene) return fail(scene.error().message);
    std::vector<tools::CameraFrame> path;
    if (argc > 4 && std::string(argv[4]) == "scatter") path = tools::seededCameras(*scene, frames, seed).frames;
    else path = tools::walkThrough(*scene, {.frames = static_cast<uint32_t>(frames), .seed = seed}).frames;
    const bool with_queries = argc > 5;
    if (!makeContext()) return fail("no EGL, or no software driver");

    Way own(*scene, false), ours(*scene, true), queries(with_queries ? *scene : tools::Scene(), false, true);
    const tools::SceneFacts facts(*scene);
    const tools::RayScene rays(facts);
    uint64_t differ = 0, sparkles = 0, wrong = 0, objects = 0, visible = 0, blank = 0;
    double query = 0;
    for (size_t i = 0; i < path.size(); ++i) {
        const View view = tools::makeView(path[i], kWidth, kHeight);
        // Who comes first finds colder caches: they take turns.
        (i % 2 ? own : ours).draw(view);
        (i % 2 ? ours : own).draw(view);
        if (with_queries) queries.draw(view);
        size_t pixels = 0, same = 0;
        const std::set<uint32_t> drawn = drawnObjects(*ours.culler);
        for (size_t p = 0; p < own.image.size(); p += 4) {
            if (std::memcmp(&own.image[p], &ours.image[p], 4) != 0) {
                ++pixels;
                wrong += !endsOnDrawn(rays, view, p / 4, drawn);
            }
            same += std::memcmp(&own.image[p], &own.image[0], 4) == 0;
        }
        differ += pixels > 0;
        sparkles += pixels;
        blank += same == own.image.size() / 4;
        const sightline_osg::CullerStats stats = ours.culler->stats();
        objects = stats.objects;
        visible += stats.visible;
        query += stats.microseconds;
    }
    const double count = static_cast<double>(path.size());
    std::printf(
        "%s: %zu frames, %llu of one colour, %llu drawables; images that differ: %llu, in %llu pixels, of which by "
        "culling %llu\n",
        argv[1], path.size(), static_cast<unsigned long long>(blank), static_cast<unsigned long long>(objects),
        static_cast<unsigned long long>(differ), static_cast<unsigned long long>(sparkles),
        static_cast<unsigned long long>(wrong));
    std::printf("frame: own culling %.2f ms, Sightline %.2f ms (%.3fx), of it the query %.3f ms; %.1f drawables kept\n",
                own.median(), ours.median(), ours.median() / own.median(), query / count / 1000,
                static_cast<double>(visible) / count);
    if (with_queries)
        std::printf("with occlusion queries of its own %.2f ms (%.3fx)\n", queries.median(),
                    queries.median() / own.median());
    return wrong > 0 || blank == path.size() ? 1 : 0;
}
