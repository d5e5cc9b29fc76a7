// The culler for VTK: what is left of small renderers, without a GL.
// SPDX-License-Identifier: MIT
#include <set>

#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCubeSource.h>
#include <vtkFollower.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "integrations/vtk/culler.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);

namespace {

/// An eye at z = 10 that looks at the origin, a wall there, and a cube behind it.
struct Wall : testing::Test {
    vtkNew<vtkRenderWindow> window;
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkSightlineCuller> culler;
    vtkNew<vtkCubeSource> wall_source, cube_source;
    vtkNew<vtkActor> wall, cube;
    std::vector<vtkProp*> props{wall, cube};

    Wall() {
        window->SetOffScreenRendering(1);
        window->SetSize(640, 360);
        window->AddRenderer(renderer);
        renderer->GetActiveCamera()->SetPosition(0, 0, 10);
        renderer->GetActiveCamera()->SetFocalPoint(0, 0, 0);
        renderer->GetActiveCamera()->SetViewAngle(70);
        renderer->GetActiveCamera()->SetClippingRange(0.1, 100);
        wall_source->SetBounds(-5, 5, -5, 5, 0, 0.5);
        cube_source->SetBounds(-1, 1, -1, 1, -9, -8);
        show(wall_source, wall);
        show(cube_source, cube);
    }
    static void show(vtkCubeSource* source, vtkActor* actor) {
        vtkNew<vtkPolyDataMapper> mapper;
        mapper->SetInputConnection(source->GetOutputPort());
        actor->SetMapper(mapper);
    }
    /// Once the turn of everything has come: what was kept is kept unasked for a few answers.
    std::set<vtkProp*> kept() {
        for (int answer = 0; answer < 20; ++answer) ask();
        return ask();
    }
    std::set<vtkProp*> ask() {
        std::vector<vtkProp*> list = props;
        int count = static_cast<int>(list.size()), initialized = 0;
        culler->Cull(renderer, list.data(), count, initialized);
        EXPECT_EQ(initialized, 1);
        EXPECT_EQ(culler->GetVisible().size(), static_cast<size_t>(count));
        return {list.begin(), list.begin() + count};
    }
};

using VtkCuller = Wall;

TEST_F(VtkCuller, LeavesOutWhatAWallHides) {
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall}));
    renderer->GetActiveCamera()->SetPosition(20, 0, -2);
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall, cube}));
}

TEST_F(VtkCuller, FollowsWhatChanges) {
    EXPECT_EQ(kept().size(), 1u);
    cube->SetPosition(0, 0, 12);
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall, cube})) << "before the wall";
    cube->SetPosition(0, 0, 0);
    EXPECT_EQ(kept().size(), 1u);
    cube_source->SetBounds(-1, 1, -1, 1, 2, 3);
    EXPECT_EQ(kept().size(), 2u) << "its source moved it";
    cube_source->SetBounds(-1, 1, -1, 1, -9, -8);
    EXPECT_EQ(kept().size(), 1u);
    wall->GetProperty()->SetOpacity(0.5);
    EXPECT_EQ(kept().size(), 2u) << "the wall is glass";
    wall->GetProperty()->SetOpacity(1);
    EXPECT_EQ(kept().size(), 1u);
    wall->GetProperty()->SetRepresentationToWireframe();
    EXPECT_EQ(kept().size(), 2u);
    wall->GetProperty()->SetRepresentationToSurface();
    props = {cube};
    EXPECT_EQ(kept().size(), 1u) << "the wall is gone";
    EXPECT_EQ(kept(), (std::set<vtkProp*>{cube}));
    props = {wall, cube};
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall})) << "and back";
}

TEST_F(VtkCuller, KeepsWhatItDoesNotKnow) {
    vtkNew<vtkActor2D> label;
    vtkNew<vtkActor> empty;
    props.push_back(label);
    props.push_back(empty);
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall, label, empty}));
    culler->Ignore(cube);
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall, cube, label, empty}));
    culler->Ignore(wall);
    EXPECT_EQ(kept().size(), 4u);
}

/// One thing in another's place, which no latest time tells.
TEST_F(VtkCuller, NoticesWhatIsReplaced) {
    vtkNew<vtkCubeSource> before;
    before->SetBounds(-1, 1, -1, 1, 3, 4);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(before->GetOutputPort());
    mapper->Update();
    vtkNew<vtkProperty> glass;
    glass->SetOpacity(0.5);
    cube->GetProperty()->SetColor(1, 0, 0);
    EXPECT_EQ(kept().size(), 1u);
    vtkSmartPointer<vtkMapper> old = cube->GetMapper();
    cube->SetMapper(mapper);
    EXPECT_EQ(ask().size(), 2u) << "another mapper, before the wall";
    cube->SetMapper(old);
    EXPECT_EQ(kept().size(), 1u);
    wall->SetProperty(glass);
    EXPECT_EQ(ask().size(), 2u) << "another property";
    vtkNew<vtkProperty> solid;
    wall->SetProperty(solid);
    EXPECT_EQ(kept().size(), 1u);
    wall->ForceTranslucentOn();
    EXPECT_EQ(ask().size(), 2u);
}

TEST_F(VtkCuller, KeepsWhatDrawsBeyondItsBox) {
    vtkNew<vtkFollower> follower;
    show(cube_source, follower);
    vtkNew<vtkActor> lines;
    show(cube_source, lines);
    lines->GetProperty()->SetRepresentationToWireframe();
    vtkNew<vtkActor> on_top;
    show(cube_source, on_top);
    on_top->GetMapper()->SetRelativeCoincidentTopologyPolygonOffsetParameters(0, -66000);
    props = {wall, cube, follower, lines, on_top};
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall, follower, lines, on_top}));
}

/// A polygon like a U, through whose opening the cube is seen.
TEST_F(VtkCuller, PolygonsThatAreNotConvexHideNothing) {
    vtkNew<vtkPoints> points;
    for (const auto& p : {std::pair(-5, -5), {5, -5}, {5, 5}, {2, 5}, {2, -3}, {-2, -3}, {-2, 5}, {-5, 5}})
        points->InsertNextPoint(p.first, p.second, 0);
    vtkNew<vtkCellArray> cells;
    cells->InsertNextCell({0, 1, 2, 3, 4, 5, 6, 7});
    vtkNew<vtkPolyData> u;
    u->SetPoints(points);
    u->SetPolys(cells);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(u);
    wall->SetMapper(mapper);
    EXPECT_EQ(kept().size(), 2u);
}

TEST_F(VtkCuller, HidesByTheSidesThatAreDrawn) {
    wall->GetProperty()->SetBackfaceCulling(1);
    EXPECT_EQ(kept().size(), 1u) << "from outside the wall's front is seen";
    renderer->GetActiveCamera()->SetPosition(0, 0, 0.25);
    renderer->GetActiveCamera()->SetFocalPoint(0, 0, -5);
    renderer->GetActiveCamera()->SetClippingRange(0.01, 100);
    EXPECT_EQ(kept(), (std::set<vtkProp*>{cube})) << "from inside its back is not drawn, and it shows nothing";
    wall->GetProperty()->SetBackfaceCulling(0);
    EXPECT_EQ(kept(), (std::set<vtkProp*>{wall}));
}

}  // namespace
