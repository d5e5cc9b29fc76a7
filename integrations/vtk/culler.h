// Sightline in VTK: a culler that leaves of a renderer's props what may be seen.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <vtkCuller.h>
#include <vtkObjectFactory.h>

#include <sightline/c/sightline.h>

class vtkActor;
class vtkProp;

/// In place of VTK's own culler, or after it:
///
///     renderer->GetCullers()->RemoveAllItems();
///     renderer->AddCuller(culler);
///
/// Actors of plain polygons are objects, each under its matrix. One hides what is behind it if it draws opaque polygons, as
/// surfaces and where their points are. All other props are always drawn: other classes of actors and mappers, lines, points,
/// wireframes, shaders of one's own, and what is offset in depth. What is added, moved, or changed is found in each frame. For one renderer; the camera's clipping range must be set before the frame, as
/// vtkRenderer::ResetCameraClippingRange() does.
///
/// Ignore() is for actors that change while they are drawn.
class vtkSightlineCuller : public vtkCuller {
public:
    static vtkSightlineCuller* New();
    vtkTypeMacro(vtkSightlineCuller, vtkCuller)

        double Cull(vtkRenderer* renderer, vtkProp** props, int& count, int& initialized) override;

    /// A prop that is always drawn, and hides nothing.
    void Ignore(vtkProp* prop);

    /// Props that were kept in the last frame.
    const std::vector<vtkProp*>& GetVisible() const { return Visible; }
    /// What its query took [microseconds].
    double GetQueryTime() const { return QueryTime; }

protected:
    vtkSightlineCuller();
    ~vtkSightlineCuller() override;

private:
    struct State;

    State* const Own;
    std::vector<vtkProp*> Visible;
    double QueryTime = 0;

    vtkSightlineCuller(const vtkSightlineCuller&) = delete;
    void operator=(const vtkSightlineCuller&) = delete;
};
