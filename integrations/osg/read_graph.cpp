// What of a scene graph hides: the state that its drawables inherit, and their triangles.
// SPDX-License-Identifier: MIT
#include "integrations/osg/read_graph.h"

#include <algorithm>
#include <iterator>

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

/// Modes that may be on of what hides. Any other may let what is behind be seen.
constexpr GLenum kHarmlessModes[] = {
    GL_LIGHTING,       GL_LIGHT0, GL_LIGHT1,          GL_LIGHT2,      GL_LIGHT3,       GL_LIGHT4,         GL_LIGHT5,
    GL_LIGHT6,         GL_LIGHT7, GL_DEPTH_TEST,      GL_CULL_FACE,   GL_NORMALIZE,    GL_RESCALE_NORMAL, GL_FOG,
    GL_COLOR_MATERIAL, GL_DITHER, GL_MULTISAMPLE_ARB, GL_LINE_SMOOTH, GL_POINT_SMOOTH, GL_LINE_STIPPLE,
};
constexpr GLenum kOffsetModes[] = {GL_POLYGON_OFFSET_FILL, GL_POLYGON_OFFSET_LINE, GL_POLYGON_OFFSET_POINT};

/// Attributes that do nothing to where and whether a surface covers what is behind it, or only if a mode is on, or of which
/// isSeenThrough() looks at the values. Any other may draw a thing elsewhere than it is.
constexpr osg::StateAttribute::Type kKnownAttributes[] = {
    osg::StateAttribute::MATERIAL,       osg::StateAttribute::LIGHT,
    osg::StateAttribute::LIGHTMODEL,     osg::StateAttribute::FOG,
    osg::StateAttribute::CULLFACE,       osg::StateAttribute::DEPTH,
    osg::StateAttribute::SHADEMODEL,     osg::StateAttribute::FRONTFACE,
    osg::StateAttribute::POLYGONMODE,    osg::StateAttribute::LINEWIDTH,
    osg::StateAttribute::LINESTIPPLE,    osg::StateAttribute::POINT,
    osg::StateAttribute::COLORMASK,      osg::StateAttribute::BLENDFUNC,
    osg::StateAttribute::BLENDEQUATION,  osg::StateAttribute::BLENDCOLOR,
    osg::StateAttribute::ALPHAFUNC,      osg::StateAttribute::STENCIL,
    osg::StateAttribute::POLYGONSTIPPLE, osg::StateAttribute::POLYGONOFFSET,
    osg::StateAttribute::LOGICOP,        osg::StateAttribute::TEXENV,
    osg::StateAttribute::TEXMAT,         osg::StateAttribute::HINT,
    osg::StateAttribute::CLIPPLANE,      osg::StateAttribute::PROGRAM,
    osg::StateAttribute::VERTEXPROGRAM,  osg::StateAttribute::FRAGMENTPROGRAM,
};

template <class Range, class Value>
bool isAmong(const Range& range, const Value& value) {
    return std::find(std::begin(range), std::end(range), value) != std::end(range);
}

template <class Attribute>
const Attribute* attributeOf(const osg::StateSet& state, osg::StateAttribute::Type type) {
    return static_cast<const Attribute*>(state.getAttribute(type));
}

/// Whether what is nearer hides it, by its depth as it is.
/// @param whole  it is state of all that is culled: a viewport is then the image's own
bool keepsItsDepth(const osg::StateSet& state, bool whole) {
    if (const auto* depth = attributeOf<osg::Depth>(state, osg::StateAttribute::DEPTH))
        if ((depth->getFunction() != osg::Depth::LESS && depth->getFunction() != osg::Depth::LEQUAL) ||
            depth->getZNear() != 0 || depth->getZFar() != 1)
            return false;
    for (const GLenum mode : kOffsetModes)
        if (state.getMode(mode) & osg::StateAttribute::ON) return false;
    for (const auto& [key, attribute] : state.getAttributeList())
        if (!isAmong(kKnownAttributes, key.first) && !(whole && key.first == osg::StateAttribute::VIEWPORT))
            return false;
    const osg::StateAttribute::GLModeValue test = state.getMode(GL_DEPTH_TEST);
    return test & (osg::StateAttribute::INHERIT | osg::StateAttribute::ON);
}

/// Whether attributes let what is behind a triangle be seen, or draw it elsewhere than where its vertices are.
bool isSeenThrough(const osg::StateSet& state) {
    using Kind = osg::StateAttribute;
    if (const auto* depth = attributeOf<osg::Depth>(state, Kind::DEPTH))
        if (!depth->getWriteMask()) return true;
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

Style Style::with(const osg::StateSet* state, bool whole) const {
    if (!state) return *this;
    Style style = *this;
    if (!keepsItsDepth(*state, whole)) style.keeps_depth = style.opaque = false;
    if (isSeenThrough(*state)) style.opaque = false;
    for (const auto& [mode, value] : state->getModeList())
        if (value & osg::StateAttribute::ON && !isAmong(kHarmlessModes, mode)) style.opaque = false;
    if (state->getRenderingHint() == osg::StateSet::TRANSPARENT_BIN) style.opaque = false;
    const osg::StateAttribute::GLModeValue culls = state->getMode(GL_CULL_FACE);
    if (culls & kForced) style.opaque = false;
    if (!(culls & osg::StateAttribute::INHERIT)) style.both_sides = !(culls & osg::StateAttribute::ON);
    return style;
}

Style styleAbove(const osg::Node& node) {
    Style all;
    bool first = true;
    for (const osg::NodePath& path : node.getParentalNodePaths()) {
        Style style;
        for (const osg::Node* above : path) style = style.with(above->getStateSet(), true);
        // Of several ways to the node the one counts by which it hides least.
        all.opaque = (first || all.opaque) && style.opaque;
        all.keeps_depth = (first || all.keeps_depth) && style.keeps_depth;
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
