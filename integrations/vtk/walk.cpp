// Draws a path through a scene with VTK's own culling and with Sightline, compares the images, and times both.
// SPDX-License-Identifier: MIT
//
//     vtk_walk SCENE [FRAMES [SEED [walk|scatter]]]
//
// Needs an X server, which may be Xvfb (xvfb-run -a vtk_walk ...), and no graphics card. Where pixels differ, the lines of sight through them say whether they are cracks of
// the driver's (Tally). Exit code 1 if one was culled wrongly.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <vector>

#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkCullerCollection.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "integrations/vtk/culler.h"
#include "integrations/vtk/scene_actors.h"
#include "integrations/walk/headless.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);

namespace {
using namespace sightline;
using namespace sightline::integrations;

/// One way to draw, with actors and a window of its own.
struct Way {
    sightline_vtk::SceneActors scene;
    vtkNew<vtkRenderWindow> window;
    vtkNew<vtkRenderer> renderer;
    vtkSmartPointer<vtkSightlineCuller> culler;
    std::vector<double> times;  ///< of each frame [milliseconds]
    std::vector<unsigned char> image;

    Way(const tools::Scene& from, bool by_sightline) : scene(sightline_vtk::sceneActors(from)) {
        window->SetOffScreenRendering(1);
        window->SetMultiSamples(0);
        window->SetSize(kWidth, kHeight);
        window->AddRenderer(renderer);
        renderer->SetBackground(0.2, 0.3, 0.4);
        for (const auto& actor : scene.actors) renderer->AddActor(actor);
        if (by_sightline) {
            culler = vtkSmartPointer<vtkSightlineCuller>::New();
            renderer->GetCullers()->RemoveAllItems();
            renderer->AddCuller(culler);
        }
    }

    void draw(const tools::CameraFrame& frame, double far) {
        vtkCamera& camera = *renderer->GetActiveCamera();
        camera.SetPosition(frame.eye.x, frame.eye.y, frame.eye.z);
        camera.SetFocalPoint(frame.target.x, frame.target.y, frame.target.z);
        camera.SetViewUp(frame.up.x, frame.up.y, frame.up.z);
        camera.SetViewAngle(frame.fov_y_degrees);
        camera.SetClippingRange(frame.z_near, far);
        const auto start = std::chrono::steady_clock::now();
        window->Render();
        window->WaitForCompletion();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        times.push_back(took.count());
        vtkNew<vtkUnsignedCharArray> pixels;
        window->GetRGBACharPixelData(0, 0, kWidth - 1, kHeight - 1, 1, pixels);
        image.assign(pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues());
    }
};

/// The objects of the scene that were drawn.
std::set<uint32_t> drawnObjects(const Way& way) {
    std::map<const vtkProp*, uint32_t> object_of;
    for (size_t i = 0; i < way.scene.actors.size(); ++i) object_of[way.scene.actors[i]] = way.scene.objects[i];
    std::set<uint32_t> objects;
    for (const vtkProp* const prop : way.culler->GetVisible()) objects.insert(object_of[prop]);
    return objects;
}

}  // namespace

int main(int argc, char** argv) {
    const Result<Walked> walked = readArguments(argc, argv);
    if (!walked) return std::fprintf(stderr, "vtk_walk: %s\n", walked.error().message.c_str()), 3;
    if (!std::getenv("DISPLAY")) return std::fprintf(stderr, "vtk_walk: no X server: try xvfb-run -a\n"), 3;
    useSoftwareDriver();
    Way own(walked->scene, false), ours(walked->scene, true);
    double bounds[6];
    own.renderer->ComputeVisiblePropBounds(bounds);
    const double far = 3 * (bounds[1] - bounds[0] + bounds[3] - bounds[2] + bounds[5] - bounds[4]);
    Tally tally(walked->scene);
    double visible = 0, query = 0;
    for (const tools::CameraFrame& frame : walked->path) {
        // Who comes first finds colder caches: they take turns.
        Way* const turns[2] = {tally.frames % 2 ? &own : &ours, tally.frames % 2 ? &ours : &own};
        for (Way* const way : turns) way->draw(frame, far);
        tally.add(tools::makeView(frame, kWidth, kHeight), own.image, ours.image, drawnObjects(ours));
        visible += static_cast<double>(ours.culler->GetVisible().size());
        query += ours.culler->GetQueryTime() / 1000;
    }
    const double count = static_cast<double>(tally.frames), own_time = median(own.times), our_time = median(ours.times);
    std::printf(
        "%s: %llu frames, %llu of one colour, %zu actors; images that differ: %llu, in %llu pixels, of which by "
        "culling %llu\n",
        argv[1], static_cast<unsigned long long>(tally.frames), static_cast<unsigned long long>(tally.blank),
        ours.scene.actors.size(), static_cast<unsigned long long>(tally.differ),
        static_cast<unsigned long long>(tally.pixels), static_cast<unsigned long long>(tally.wrong));
    std::printf("frame: own culling %.2f ms, Sightline %.2f ms (%.3fx), of it the query %.3f ms; %.1f actors kept\n",
                own_time, our_time, our_time / own_time, query / count, visible / count);
    return tally.good() ? 0 : 1;
}
