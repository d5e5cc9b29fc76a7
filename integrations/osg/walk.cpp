// Draws a path through a scene with OpenSceneGraph's own culling and with Sightline, compares the images, and times both.
// SPDX-License-Identifier: MIT
//
//     osg_walk SCENE [FRAMES [SEED [walk|scatter [queries]]]]    queries: also by osg::OcclusionQueryNode, an object each
//
// Needs neither a display nor a graphics card. Where pixels differ, the lines of sight through them say whether they are cracks of
// the driver's (Tally). Exit code 1 if one was culled wrongly.
#include <GL/gl.h>

#include <chrono>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include <osgViewer/Viewer>

#include "integrations/osg/culler.h"
#include "integrations/osg/scene_graph.h"
#include "integrations/walk/headless.h"

namespace {
using namespace sightline;
using namespace sightline::integrations;

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
};

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
    const Result<Walked> walked = readArguments(argc, argv);
    if (!walked) return std::fprintf(stderr, "osg_walk: %s\n", walked.error().message.c_str()), 3;
    if (!makeContext()) return std::fprintf(stderr, "osg_walk: no EGL, or no software driver\n"), 3;
    const tools::Scene nothing;
    Way own(walked->scene, false), ours(walked->scene, true),
        queries(walked->queries ? walked->scene : nothing, false, true);
    Tally tally(walked->scene);
    double visible = 0, query = 0;
    for (const tools::CameraFrame& frame : walked->path) {
        const View view = tools::makeView(frame, kWidth, kHeight);
        // Who comes first finds colder caches: they take turns.
        Way* const turns[2] = {tally.frames % 2 ? &own : &ours, tally.frames % 2 ? &ours : &own};
        for (Way* const way : turns) way->draw(view);
        if (walked->queries) queries.draw(view);
        tally.add(view, own.image, ours.image, drawnObjects(*ours.culler));
        visible += ours.culler->stats().visible;
        query += ours.culler->stats().microseconds / 1000;
    }
    const double count = static_cast<double>(tally.frames), own_time = median(own.times), our_time = median(ours.times);
    std::printf(
        "%s: %llu frames, %llu of one colour, %u drawables; images that differ: %llu, in %llu pixels, of which by "
        "culling %llu\n",
        argv[1], static_cast<unsigned long long>(tally.frames), static_cast<unsigned long long>(tally.blank),
        ours.culler->stats().objects, static_cast<unsigned long long>(tally.differ),
        static_cast<unsigned long long>(tally.pixels), static_cast<unsigned long long>(tally.wrong));
    std::printf("frame: own culling %.2f ms, Sightline %.2f ms (%.3fx), of it the query %.3f ms; %.1f drawables kept\n",
                own_time, our_time, our_time / own_time, query / count, visible / count);
    if (walked->queries)
        std::printf("with occlusion queries of its own %.2f ms (%.3fx)\n", median(queries.times),
                    median(queries.times) / own_time);
    return tally.good() ? 0 : 1;
}
