// Sightline in VTK: a culler that leaves of a renderer's props what may be seen.
// SPDX-License-Identifier: MIT
#include "integrations/vtk/culler.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkMatrix4x4.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

namespace {

/// An actor as the world knows it.
struct Known {
    slObjectId id{};
    vtkMTimeType place = 0, shape = 0;  ///< when these changed last
    unsigned frame = 0;                 ///< in which it was met last
};

/// VTK's matrices lie row by row.
void columnMajor(const vtkMatrix4x4& from, double to[16]) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) to[4 * column + row] = from.Element[row][column];
}

vtkPolyData* polygonsOf(vtkActor& actor) {
    auto* const mapper = vtkPolyDataMapper::SafeDownCast(actor.GetMapper());
    return mapper ? mapper->GetInput() : nullptr;
}

/// When an actor's data, its mapper or its property changed last. What feeds the mapper is brought up to date.
vtkMTimeType shapeTime(vtkActor& actor) {
    if (!actor.GetMapper()->GetStatic()) actor.GetMapper()->Update();
    vtkPolyData* const polygons = polygonsOf(actor);
    if (!polygons) return actor.GetMapper()->GetMTime();
    return std::max({polygons->GetMTime(), actor.GetMapper()->GetMTime(), actor.GetProperty()->GetMTime()});
}

bool isOpaqueSurface(vtkActor& actor) {
    vtkProperty& property = *actor.GetProperty();
    return property.GetRepresentation() == VTK_SURFACE && property.GetOpacity() >= 1 &&
           !property.GetFrontfaceCulling() && !actor.HasTranslucentPolygonalGeometry() && !actor.GetTexture() &&
           actor.GetMapper()->GetNumberOfClippingPlanes() == 0;
}

/// Positions in single precision, as VTK draws them unless it shifts and scales, and its triangles: polygons are fans.
slOccluder* occluderOf(vtkActor& actor) {
    vtkPolyData* const polygons = polygonsOf(actor);
    if (!polygons || !polygons->GetPoints() || !isOpaqueSurface(actor)) return nullptr;
    vtkPoints& points = *polygons->GetPoints();
    std::vector<float> positions(3 * static_cast<size_t>(points.GetNumberOfPoints()));
    for (vtkIdType i = 0; i < points.GetNumberOfPoints(); ++i) {
        double p[3];
        points.GetPoint(i, p);
        for (int axis = 0; axis < 3; ++axis)
            positions[3 * static_cast<size_t>(i) + static_cast<size_t>(axis)] = static_cast<float>(p[axis]);
    }
    std::vector<uint32_t> indices;
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    vtkCellArray& cells = *polygons->GetPolys();
    for (cells.InitTraversal(); cells.GetNextCell(count, corners);)
        for (vtkIdType k = 2; k < count; ++k)
            for (const vtkIdType corner : {corners[0], corners[k - 1], corners[k]})
                indices.push_back(static_cast<uint32_t>(corner));
    if (indices.empty()) return nullptr;
    slOccluderDef def = slDefaultOccluderDef();
    def.mesh.positions = positions.data();
    def.mesh.vertex_count = positions.size() / 3;
    def.mesh.indices = indices.data();
    def.mesh.index_count = indices.size();
    def.both_sides = !actor.GetProperty()->GetBackfaceCulling();
    slOccluder* occluder = nullptr;
    return slPrepareOccluder(&def, &occluder) == SL_OK ? occluder : nullptr;
}

}  // namespace

struct vtkSightlineCuller::State {
    slWorld* world = nullptr;
    slQuery* query = nullptr;
    slSnapshot* snapshot = nullptr;
    std::unordered_map<vtkActor*, Known> known;
    std::set<vtkProp*> ignored;
    /// By polygons, their time, and whether both sides hide.
    std::map<std::tuple<vtkPolyData*, vtkMTimeType, bool>, slOccluderId> occluders;
    unsigned frame = 0;

    State() {
        const slWorldDef def = slDefaultWorldDef();
        slCreateWorld(&def, &world);
        slCreateQuery(nullptr, &query);
    }
    ~State() {
        slReleaseSnapshot(snapshot);
        slDestroyQuery(query);
        slDestroyWorld(world);
    }

    slOccluderId occluder(vtkActor& actor) {
        vtkPolyData* const polygons = polygonsOf(actor);
        if (!polygons || !isOpaqueSurface(actor)) return {};
        const auto [at, fresh] =
            occluders.try_emplace({polygons, polygons->GetMTime(), !actor.GetProperty()->GetBackfaceCulling()});
        if (!fresh) return at->second;
        if (slOccluder* const prepared = occluderOf(actor)) {
            slAddOccluder(world, prepared, &at->second);
            slDestroyOccluder(prepared);
        }
        return at->second;
    }

    /// Adds an actor, or what has become of it.
    void add(vtkActor& actor, Known& as) {
        if (as.id.index) slRemoveObject(world, as.id);
        slObjectDef def = slDefaultObjectDef();
        if (vtkPolyData* const polygons = polygonsOf(actor)) {
            double bounds[6];
            polygons->GetBounds(bounds);
            for (int axis = 0; axis < 3; ++axis) {
                def.bounds.low[axis] = bounds[2 * axis];
                def.bounds.high[axis] = bounds[2 * axis + 1];
            }
        }
        columnMajor(*actor.GetMatrix(), def.transform);
        def.key = reinterpret_cast<uintptr_t>(static_cast<vtkProp*>(&actor));
        def.occluder = def.shape = occluder(actor);
        slAddObject(world, &def, &as.id);
        as.place = actor.GetMTime();
    }

    /// Takes up what the renderer has now. Returns whether anything has changed.
    bool follow(vtkProp** props, int count) {
        ++frame;
        bool changed = !snapshot;
        size_t met = 0;
        for (int i = 0; i < count; ++i) {
            vtkActor* const actor = vtkActor::SafeDownCast(props[i]);
            if (!actor || !actor->GetMapper() || ignored.count(actor)) continue;
            actor->ComputeMatrix();
            Known& as = known[actor];
            as.frame = frame;
            ++met;
            const vtkMTimeType shape = shapeTime(*actor);
            if (as.id.index == 0 || as.shape != shape) {
                as.shape = shape;
                add(*actor, as);
                changed = true;
            } else if (as.place != actor->GetMTime()) {
                double transform[16];
                columnMajor(*actor->GetMatrix(), transform);
                slMoveObject(world, as.id, transform);
                as.place = actor->GetMTime();
                changed = true;
            }
        }
        if (met == known.size()) return changed;
        for (auto at = known.begin(); at != known.end();) {
            if (at->second.frame == frame) {
                ++at;
                continue;
            }
            slRemoveObject(world, at->second.id);
            at = known.erase(at);
        }
        return true;
    }
};

vtkStandardNewMacro(vtkSightlineCuller);

vtkSightlineCuller::vtkSightlineCuller() : Own(new State) {}
vtkSightlineCuller::~vtkSightlineCuller() { delete Own; }

void vtkSightlineCuller::Ignore(vtkProp* prop) { Own->ignored.insert(prop); }

double vtkSightlineCuller::Cull(vtkRenderer* renderer, vtkProp** props, int& count, int& initialized) {
    State& own = *Own;
    if (own.follow(props, count)) {
        slReleaseSnapshot(own.snapshot);
        slCommit(own.world, &own.snapshot);
    }
    slView view = slDefaultView();
    const int* const size = renderer->GetSize();
    vtkCamera& camera = *renderer->GetActiveCamera();
    columnMajor(*camera.GetModelViewTransformMatrix(), view.view);
    columnMajor(*camera.GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1), view.projection);
    view.width = static_cast<uint32_t>(std::max(size[0], 1));
    view.height = static_cast<uint32_t>(std::max(size[1], 1));
    slVisibleSet set{};
    const bool answered = slQueryVisible(own.query, own.snapshot, &view, nullptr, &set) == SL_OK;
    slQueryStats stats{};
    slQueryGetStats(own.query, &stats);
    QueryTime = static_cast<double>(stats.nanoseconds) / 1000;

    std::set<uint64_t> seen;
    for (uint32_t i = 0; i < set.count; ++i) seen.insert(set.objects[i].key);
    // In the renderer's order: where depths are equal, it decides.
    int kept = 0;
    double time = 0;
    Visible.clear();
    for (int i = 0; i < count; ++i) {
        vtkActor* const actor = vtkActor::SafeDownCast(props[i]);
        if (answered && actor && own.known.count(actor) && !seen.count(reinterpret_cast<uintptr_t>(props[i]))) continue;
        if (!initialized) props[i]->SetRenderTimeMultiplier(1.0);
        time += props[i]->GetRenderTimeMultiplier();
        Visible.push_back(props[i]);
        props[kept++] = props[i];
    }
    count = kept;
    initialized = 1;
    return time;
}
