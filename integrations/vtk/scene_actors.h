// A scene of Sightline's tools as actors of VTK's, for the programs that try both.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include "sightline/tools/scene/scene.h"

namespace sightline_vtk {

/// An actor for each material of each object, in the scene's order; polygons are shared.
struct SceneActors {
    std::vector<vtkSmartPointer<vtkActor>> actors;
    std::vector<uint32_t> objects;  ///< per actor
};
SceneActors sceneActors(const sightline::tools::Scene& scene);

}  // namespace sightline_vtk
