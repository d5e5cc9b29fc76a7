// A scene of Sightline's tools as actors of VTK's, for the programs that try both.
// SPDX-License-Identifier: MIT
#include "integrations/vtk/scene_actors.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

namespace sightline_vtk {
using namespace sightline::tools;
namespace {

/// The triangles of one material, flat.
vtkSmartPointer<vtkPolyData> polygonsOf(const Mesh& mesh, const Primitive& primitive) {
    const auto polygons = vtkSmartPointer<vtkPolyData>::New();
    const auto points = vtkSmartPointer<vtkPoints>::New();
    const auto cells = vtkSmartPointer<vtkCellArray>::New();
    const auto normals = vtkSmartPointer<vtkFloatArray>::New();
    normals->SetNumberOfComponents(3);
    for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
        glm::vec3 p[3];
        vtkIdType ids[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = mesh.positions[mesh.indices[3 * t + static_cast<uint32_t>(k)]];
            ids[k] = points->InsertNextPoint(p[k].x, p[k].y, p[k].z);
        }
        const glm::vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        const glm::vec3 normal = glm::length(across) > 0 ? glm::normalize(across) : glm::vec3(0, 1, 0);
        for (int k = 0; k < 3; ++k) normals->InsertNextTuple3(normal.x, normal.y, normal.z);
        cells->InsertNextCell(3, ids);
    }
    polygons->SetPoints(points);
    polygons->SetPolys(cells);
    polygons->GetPointData()->SetNormals(normals);
    return polygons;
}

}  // namespace

SceneActors sceneActors(const Scene& scene) {
    std::vector<std::vector<vtkSmartPointer<vtkPolyData>>> meshes;
    for (const Mesh& mesh : scene.meshes)
        for (auto& of = meshes.emplace_back(); const Primitive& primitive : mesh.primitives)
            of.push_back(polygonsOf(mesh, primitive));
    SceneActors made;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) matrix->SetElement(row, column, object.transform[column][row]);
        const Mesh& mesh = scene.meshes[object.mesh];
        for (size_t k = 0; k < mesh.primitives.size(); ++k) {
            const Material& material = scene.materials[mesh.primitives[k].material];
            const auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
            mapper->SetInputData(meshes[object.mesh][k]);
            mapper->StaticOn();
            const auto actor = vtkSmartPointer<vtkActor>::New();
            actor->SetMapper(mapper);
            actor->SetUserMatrix(matrix);
            const glm::vec4 c = material.base_color;
            actor->GetProperty()->SetColor(c.r, c.g, c.b);
            actor->GetProperty()->SetBackfaceCulling(!material.double_sided);
            if (!material.hides()) actor->GetProperty()->SetOpacity(std::min(0.99, static_cast<double>(c.a)));
            made.actors.push_back(actor);
            made.objects.push_back(static_cast<uint32_t>(i));
        }
    }
    return made;
}

}  // namespace sightline_vtk
