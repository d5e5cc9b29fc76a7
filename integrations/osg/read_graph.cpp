// What of a scene graph hides: the state that its drawables inherit, and their triangles.
// SPDX-License-Identifier: MIT
#include "integrations/osg/read_graph.h"

#include <osg/ColorMask>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/FragmentProgram>
#include <osg/FrontFace>
#include <osg/Geometry>
#include <osg/PolygonMode>
#include <osg/PolygonStipple>
#include <osg/Program>
#include <osg/TriangleIndexFunctor>
#include <osg/VertexProgram>

namespace sightline_osg {
namespace {

constexpr unsigned kForced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;

constexpr GLenum kSeenThroughModes[] = {
    GL_BLEND,
    GL_ALPHA_TEST,
    GL_STENCIL_TEST,
    GL_POLYGON_STIPPLE,
    GL_COLOR_LOGIC_OP,
    GL_SAMPLE_ALPHA_TO_COVERAGE_ARB,
    GL_VERTEX_PROGRAM_ARB,
    GL_FRAGMENT_PROGRAM_ARB,
    GL_CLIP_PLANE0,
    GL_CLIP_PLANE1,
    GL_CLIP_PLANE2,
    GL_CLIP_PLANE3,
    GL_CLIP_PLANE4,
    GL_CLIP_PLANE5,
};

template <class Attribute>
const Attribute* attributeOf(const osg::StateSet& state, osg::StateAttribute::Type type) {
    return static_cast<const Attribute*>(state.getAttribute(type));
}

/// Whether attributes let what is behind a triangle be seen, or draw it elsewhere than where its vertices are.
bool isSeenThrough(const osg::StateSet& state) {
    using Kind = osg::StateAttribute;
    if (const auto* depth = attributeOf<osg::Depth>(state, Kind::DEPTH))
        if (!depth->getWriteMask() ||
            (depth->getFunction() != osg::Depth::LESS && depth->getFunction() != osg::Depth::LEQUAL))
            return true;
    if (const auto* mask = attributeOf<osg::ColorMask>(state, Kind::COLORMASK))
        if (!mask->getRedMask() || !mask->getGreenMask() || !mask->getBlueMask()) return true;
    if (const auto* front = attributeOf<osg::FrontFace>(state, Kind::FRONTFACE))
        if (front->getMode() != osg::FrontFace::COUNTER_CLOCKWISE) return true;
    if (const auto* face = attributeOf<osg::CullFace>(state, Kind::CULLFACE))
        if (face->getMode() != osg::CullFace::BACK) return true;
    if (const auto* fill = attributeOf<osg::PolygonMode>(state, Kind::POLYGONMODE))
        if (fill->getMode(osg::PolygonMode::FRONT) != osg::PolygonMode::FILL ||
            fill->getMode(osg::PolygonMode::BACK) != osg::PolygonMode::FILL)
            return true;
    const auto* const program = attributeOf<osg::Program>(state, Kind::PROGRAM);
    return program && !program->isFixedFunction();
}

}  // namespace

Style Style::with(const osg::StateSet* state) const {
    if (!state) return *this;
    Style style = *this;
    if (isSeenThrough(*state)) style.opaque = false;
    for (const GLenum mode : kSeenThroughModes)
        if (state->getMode(mode) & osg::StateAttribute::ON) style.opaque = false;
    if (state->getRenderingHint() == osg::StateSet::TRANSPARENT_BIN) style.opaque = false;
    const osg::StateAttribute::GLModeValue culls = state->getMode(GL_CULL_FACE);
    if (culls & kForced) style.opaque = false;
    if (!(culls & osg::StateAttribute::INHERIT)) style.both_sides = !(culls & osg::StateAttribute::ON);
    const osg::StateAttribute::GLModeValue depth = state->getMode(GL_DEPTH_TEST);
    if (!(depth & osg::StateAttribute::INHERIT) && !(depth & osg::StateAttribute::ON)) style.opaque = false;
    return style;
}

Style styleAbove(const osg::Node& node) {
    Style all;
    bool first = true;
    for (const osg::NodePath& path : node.getParentalNodePaths()) {
        Style style;
        for (const osg::Node* above : path) style = style.with(above->getStateSet());
        // Of several ways to the node the one counts by which it hides least.
        all.opaque = (first || all.opaque) && style.opaque;
        all.both_sides = (first || all.both_sides) && style.both_sides;
        first = false;
    }
    return all;
}

namespace {

struct CollectIndices {
    std::vector<uint32_t> indices;
    void operator()(unsigned a, unsigned b, unsigned c) {
        if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
    }
};

}  // namespace

slOccluder* occluderOf(osg::Drawable& drawable, const Style& style) {
    osg::Geometry* const geometry = drawable.asGeometry();
    if (!style.opaque || !geometry || geometry->getDrawCallback() || geometry->getUpdateCallback() ||
        geometry->getDataVariance() == osg::Object::DYNAMIC)
        return nullptr;
    const auto* const vertices = dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray());
    if (!vertices || vertices->empty()) return nullptr;
    osg::TriangleIndexFunctor<CollectIndices> triangles;
    geometry->accept(triangles);
    if (triangles.indices.empty()) return nullptr;
    slOccluderDef def = slDefaultOccluderDef();
    def.mesh.positions = vertices->front().ptr();
    def.mesh.vertex_count = vertices->size();
    def.mesh.indices = triangles.indices.data();
    def.mesh.index_count = triangles.indices.size();
    def.both_sides = style.both_sides;
    slOccluder* occluder = nullptr;
    return slPrepareOccluder(&def, &occluder) == SL_OK ? occluder : nullptr;
}

slBox boxOf(const osg::BoundingBox& box) {
    return {{box.xMin(), box.yMin(), box.zMin()}, {box.xMax(), box.yMax(), box.zMax()}};
}

}  // namespace sightline_osg
