// A viewer of a few lines: OpenSceneGraph's own, with Sightline as its cull callback.
// SPDX-License-Identifier: MIT
//
//     osg_view SCENE
#include <cstdio>

#include <osgViewer/Viewer>

#include "integrations/osg/culler.h"
#include "integrations/osg/scene_graph.h"
#include "sightline/tools/import/scene_file.h"

int main(int argc, char** argv) {
    const auto scene = sightline::tools::loadSceneFile(argc == 2 ? argv[1] : "");
    if (!scene) return std::fprintf(stderr, "osg_view: %s\n", scene.error().message.c_str()), 3;
    const osg::ref_ptr<osg::Group> root = sightline_osg::sceneGraph(*scene);
    const double size = root->getBound().radius();

    osgViewer::Viewer viewer;
    viewer.getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    viewer.getCamera()->setProjectionMatrixAsPerspective(60, 16.0 / 9, 0.0005 * size, 8 * size);
    viewer.setSceneData(root);
    root->setCullCallback(new sightline_osg::Culler(*root));
    return viewer.run();
}
