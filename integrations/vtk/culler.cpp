// Sightline in VTK: a culler that leaves of a renderer's props what may be seen.
// SPDX-License-Identifier: MIT
#include "integrations/vtk/culler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
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
#include <vtkShaderProperty.h>
#include <vtkTexture.h>
#include <vtkVector.h>

namespace {

/// VTK's matrices lie row by row.
void columnMajor(const vtkMatrix4x4& from, double to[16]) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) to[4 * column + row] = from.Element[row][column];
}

bool isOneOf(vtkObject& object, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return std::strcmp(object.GetClassName(), name) == 0; });
}

/// What an actor draws, if it draws this and nothing else. Others (followers, levels of detail, glyphs, spheres of a shader) have
/// places and bounds of their own.
vtkPolyData* polygonsOf(vtkActor& actor) {
    if (!isOneOf(actor, {"vtkActor", "vtkOpenGLActor"}) ||
        !isOneOf(*actor.GetMapper(), {"vtkPolyDataMapper", "vtkOpenGLPolyDataMapper"}))
        return nullptr;
    return static_cast<vtkPolyDataMapper*>(actor.GetMapper())->GetInput();
}

/// Lines and points have a width in the image, and shaders do as they like.
bool staysInItsBox(vtkActor& actor, vtkPolyData& polygons) {
    vtkProperty& property = *actor.GetProperty();
    vtkShaderProperty& shaders = *actor.GetShaderProperty();
    return property.GetRepresentation() == VTK_SURFACE && !property.GetEdgeVisibility() &&
           !property.GetVertexVisibility() && polygons.GetNumberOfLines() == 0 && polygons.GetNumberOfVerts() == 0 &&
           !shaders.HasVertexShaderCode() && !shaders.HasGeometryShaderCode() && !shaders.HasFragmentShaderCode() &&
           shaders.GetNumberOfShaderReplacements() == 0;
}

/// All that decides what an actor draws and hides, but its place. Of pointers and times each counts by itself: the latest of the
/// times says nothing of one thing that took another's place.
struct Look {
    vtkPolyData* polygons = nullptr;
    std::array<vtkObject*, 5> parts{};
    std::array<vtkMTimeType, 5> times{};
    bool bounded = false;  ///< it draws nothing outside of the box around its polygons
    bool hides = false;
    bool both_sides = false;

    bool operator==(const Look&) const = default;
};

/// @pre what feeds the mapper is up to date
Look lookOf(vtkActor& actor) {
    Look look;
    vtkMapper& mapper = *actor.GetMapper();
    vtkProperty& property = *actor.GetProperty();
    look.polygons = polygonsOf(actor);
    look.parts = {look.polygons, &mapper, &property, actor.GetBackfaceProperty(), actor.GetTexture()};
    for (size_t i = 0; i < look.parts.size(); ++i)
        if (look.parts[i]) look.times[i] = look.parts[i]->GetMTime();
    if (!look.polygons) return look;
    double factor = 0, units = 0;
    mapper.GetRelativeCoincidentTopologyPolygonOffsetParameters(factor, units);
    const bool in_place = factor == 0 && units == 0;
    look.bounded = in_place && staysInItsBox(actor, *look.polygons);
    look.both_sides = !property.GetBackfaceCulling();
    look.hides = look.bounded && property.GetOpacity() >= 1 && !property.GetFrontfaceCulling() && !actor.GetTexture() &&
                 !actor.HasTranslucentPolygonalGeometry() && mapper.GetNumberOfClippingPlanes() == 0 &&
                 vtkMapper::GetResolveCoincidentTopology() == VTK_RESOLVE_OFF && look.polygons->GetPoints() &&
                 !look.polygons->GetCellGhostArray() &&
                 // It is not known which side is drawn of what a matrix mirrors.
                 (look.both_sides || actor.GetMatrix()->Determinant() > 0);
    return look;
}

/// An actor as the world knows it.
struct Known {
    slObjectId id{};
    Look look;
    std::array<double, 16> place{};  ///< its matrix
    unsigned frame = 0;              ///< in which it was met last
};

/// Whether every way to cut a polygon into triangles covers the same: it is flat and convex.
bool isConvex(vtkPoints& points, vtkIdType count, const vtkIdType* corners) {
    if (count == 3) return true;
    const auto at = [&](vtkIdType k) {
        vtkVector3d p;
        points.GetPoint(corners[k % count], p.GetData());
        return p;
    };
    const auto minus = [](const vtkVector3d& a, const vtkVector3d& b) {
        return vtkVector3d(a.GetX() - b.GetX(), a.GetY() - b.GetY(), a.GetZ() - b.GetZ());
    };
    const vtkVector3d normal = minus(at(1), at(0)).Cross(minus(at(2), at(0)));
    for (vtkIdType k = 0; k < count; ++k) {
        const vtkVector3d side = minus(at(k + 1), at(k)), next = minus(at(k + 2), at(k + 1)),
                          from = minus(at(k), at(0));
        if (!(side.Cross(next).Dot(normal) > 0)) return false;
        if (std::abs(from.Dot(normal)) > 1e-6 * normal.Norm() * from.Norm()) return false;
        // A star turns one way all around, too, but its corners do not lie around the first one in their order.
        if (k > 0 && k + 1 < count && !(from.Cross(minus(at(k + 1), at(0))).Dot(normal) > 0)) return false;
    }
    return true;
}

/// Positions in single precision, as VTK draws them unless it shifts and scales, and its triangles: convex polygons are fans, and others hide nothing.
/// @pre Look::hides
slOccluder* occluderOf(vtkActor& actor) {
    vtkPolyData* const polygons = polygonsOf(actor);
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
        for (vtkIdType k = isConvex(points, count, corners) ? 2 : count; k < count; ++k)
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

    /// Begins anew: occluders of what was are never given back by themselves.
    void restart() {
        slReleaseSnapshot(snapshot);
        slDestroyWorld(world);
        snapshot = nullptr;
        known.clear();
        occluders.clear();
        const slWorldDef def = slDefaultWorldDef();
        slCreateWorld(&def, &world);
    }

    slOccluderId occluder(vtkActor& actor, const Look& look) {
        const auto [at, fresh] = occluders.try_emplace({look.polygons, look.times[0], look.both_sides});
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
        const Look& look = as.look;
        if (look.bounded) {
            double bounds[6];
            look.polygons->GetBounds(bounds);
            for (int axis = 0; axis < 3; ++axis) {
                def.bounds.low[axis] = bounds[2 * axis];
                def.bounds.high[axis] = bounds[2 * axis + 1];
            }
        }
        std::copy(as.place.begin(), as.place.end(), def.transform);
        def.key = reinterpret_cast<uintptr_t>(static_cast<vtkProp*>(&actor));
        if (look.hides) def.occluder = def.shape = occluder(actor, look);
        if (slAddObject(world, &def, &as.id) == SL_OK) return;
        // No affine matrix: it is always drawn.
        slObjectDef always = slDefaultObjectDef();
        always.key = def.key;
        slAddObject(world, &always, &as.id);
    }

    /// Takes up what the renderer has now. Returns whether anything has changed.
    bool follow(vtkProp** props, int count) {
        if (occluders.size() > 1000 + 2 * known.size()) restart();
        ++frame;
        bool changed = !snapshot;
        size_t met = 0;
        for (int i = 0; i < count; ++i) {
            vtkActor* const actor = vtkActor::SafeDownCast(props[i]);
            if (!actor || !actor->GetMapper() || ignored.count(actor)) continue;
            if (!actor->GetMapper()->GetStatic()) actor->GetMapper()->Update();
            actor->ComputeMatrix();
            std::array<double, 16> place;
            columnMajor(*actor->GetMatrix(), place.data());
            const Look look = lookOf(*actor);
            Known& as = known[actor];
            as.frame = frame;
            ++met;
            const bool stays = as.id.index != 0 && as.look == look;
            if (stays && as.place == place) continue;
            changed = true;
            as.look = look;
            as.place = place;
            if (!stays || slMoveObject(world, as.id, place.data()) != SL_OK) add(*actor, as);
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
