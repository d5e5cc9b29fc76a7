// A scene of Sightline's tools as a graph of OpenSceneGraph's, for the programs that try both.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

#include "sightline/tools/scene/scene.h"

namespace sightline_osg {

/// A group for each node of the scene's tree, and below these a transform with a geode for each object. Colours are those of
/// the materials, lit by the viewer's headlight; what is not opaque is blended.
/// The transforms are named by their object's index.
/// @param queries  each object is asked by an occlusion query of OpenSceneGraph's
osg::ref_ptr<osg::Group> sceneGraph(const sightline::tools::Scene& scene, bool queries = false);

}  // namespace sightline_osg
