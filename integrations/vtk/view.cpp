// A viewer of a few lines: VTK's own, with Sightline as its culler.
// SPDX-License-Identifier: MIT
//
//     vtk_view SCENE
#include <cstdio>

#include <vtkAutoInit.h>
#include <vtkCullerCollection.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "integrations/vtk/culler.h"
#include "integrations/vtk/scene_actors.h"
#include "sightline/tools/import/scene_file.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkInteractionStyle);

int main(int argc, char** argv) {
    const auto scene = sightline::tools::loadSceneFile(argc == 2 ? argv[1] : "");
    if (!scene) return std::fprintf(stderr, "vtk_view: %s\n", scene.error().message.c_str()), 3;
    vtkNew<vtkRenderer> renderer;
    for (const auto& actor : sightline_vtk::sceneActors(*scene).actors) renderer->AddActor(actor);
    vtkNew<vtkSightlineCuller> culler;
    renderer->GetCullers()->RemoveAllItems();
    renderer->AddCuller(culler);

    vtkNew<vtkRenderWindow> window;
    window->AddRenderer(renderer);
    window->SetSize(1280, 720);
    vtkNew<vtkRenderWindowInteractor> interactor;
    vtkNew<vtkInteractorStyleTrackballCamera> style;
    interactor->SetRenderWindow(window);
    interactor->SetInteractorStyle(style);
    renderer->ResetCamera();
    window->Render();
    interactor->Start();
    return 0;
}
