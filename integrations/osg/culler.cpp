// Sightline in OpenSceneGraph: a cull callback that draws of a scene graph what may be seen, and visits nothing else of it.
// SPDX-License-Identifier: MIT
#include "integrations/osg/culler.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <typeinfo>

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osgUtil/CullVisitor>

#include "integrations/osg/read_graph.h"

namespace sightline_osg {
namespace {

constexpr slBox kNoBox = {{1, 1, 1}, {-1, -1, -1}};  ///< of what is always drawn

bool isPlainGroup(const osg::Node& node) {
    return typeid(node) == typeid(osg::Group) || typeid(node) == typeid(osg::Geode);
}
bool isPlainTransform(const osg::Node& node) {
    return (typeid(node) == typeid(osg::MatrixTransform) || typeid(node) == typeid(osg::PositionAttitudeTransform)) &&
           node.asTransform()->getReferenceFrame() == osg::Transform::RELATIVE_RF;
}

/// What draws by itself whatever of it is in view, or sets state for others.
bool actsAtADistance(const osg::Node& node) {
    return node.asCamera() || node.asTerrain() || std::strcmp(node.className(), "LightSource") == 0 ||
           std::strcmp(node.className(), "ClipNode") == 0 || std::strcmp(node.className(), "TexGenNode") == 0 ||
           std::strcmp(node.className(), "ClearNode") == 0 || std::strcmp(node.className(), "OccluderNode") == 0 ||
           std::strcmp(node.className(), "Projection") == 0 ||
           std::strcmp(node.className(), "CoordinateSystemNode") == 0;
}

/// Its place, its vertices or its children may change while it is drawn.
bool mayChange(const osg::Node& node) {
    return node.getDataVariance() == osg::Object::DYNAMIC || node.getUpdateCallback() || node.getEventCallback();
}

/// Its image may be larger than its box: lines and points have a width, and text turns to the eye.
bool drawsBeyondItsBox(osg::Drawable& drawable) {
    if (typeid(drawable) != typeid(osg::Geometry) && typeid(drawable) != typeid(osg::ShapeDrawable)) return true;
    const osg::Geometry* const geometry = drawable.asGeometry();
    for (unsigned i = 0; geometry && i < geometry->getNumPrimitiveSets(); ++i)
        switch (geometry->getPrimitiveSet(i)->getMode()) {
            case GL_TRIANGLES:
            case GL_TRIANGLE_STRIP:
            case GL_TRIANGLE_FAN:
            case GL_QUADS:
            case GL_QUAD_STRIP:
            case GL_POLYGON:
                break;
            default:
                return true;
        }
    return false;
}

/// Looks at all that a node may draw which is left to OpenSceneGraph.
class Inspection : public osg::NodeVisitor {
public:
    /// @param above  how what is below the node is drawn
    Inspection(osg::Node& node, const Style& above) : NodeVisitor(TRAVERSE_ALL_CHILDREN), style_(above) {
        setTraversalMask(~0u);
        setNodeMaskOverride(~0u);
        node.accept(*this);
    }
    /// Whether all of it stays in the node's bound, may be hidden, and does nothing to others.
    bool mayBeLeftOut() const { return left_out_; }

    void apply(osg::Node& node) override {
        const bool loads =
            std::strcmp(node.className(), "PagedLOD") == 0 || std::strcmp(node.className(), "ProxyNode") == 0;
        const bool turns = node.asTransform() && !isPlainTransform(node);
        const Style above = style_;
        style_ = style_.with(node.getStateSet());
        if (mayChange(node) || actsAtADistance(node) || node.getCullCallback() || !node.getCullingActive() || loads ||
            turns || !style_.keeps_depth || (node.asDrawable() && drawsBeyondItsBox(*node.asDrawable())) ||
            std::strcmp(node.className(), "Billboard") == 0)
            left_out_ = false;
        if (left_out_) traverse(node);
        style_ = above;
    }

private:
    Style style_;
    bool left_out_ = true;
};

/// Where faces are culled, OpenGL takes the other side of what a matrix mirrors.
bool mirrors(const osg::Matrixd& m) {
    const osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)), z(m(2, 0), m(2, 1), m(2, 2));
    return (x ^ y) * z < 0;
}

osg::Matrixd matrixOf(const osg::NodePath& path) {
    osg::Matrixd matrix;
    for (osg::Node* const node : path)
        if (isPlainTransform(*node)) node->asTransform()->computeLocalToWorldMatrix(matrix, nullptr);
    return matrix;
}

}  // namespace

/// Reads a graph into objects, depth first: so their order is that in which OpenSceneGraph would draw them.
struct Culler::Reader {
    Culler& to;
    std::map<std::pair<osg::Drawable*, bool>, slOccluderId> known = {};  ///< by drawable and whether both sides hide
    osg::NodePath path = {};
    bool dynamic = false;

    /// @param mask   nodes above are drawn for these bits of the traversal's mask
    /// @param plain  no node above is drawn for some traversals and not for others, but as `mask` says
    void visit(osg::Node& node, const Style& above, uint32_t mask, bool plain, bool active) {
        if (node.getNodeMask() != ~0u) {
            plain = plain && (mask == ~0u || mask == node.getNodeMask());
            mask = node.getNodeMask();
        }
        active = active && node.getCullingActive();
        path.push_back(&node);
        const Style style = above.with(node.getStateSet());
        osg::Drawable* const drawable = node.asDrawable();
        const bool moved = dynamic;
        if (node.getCullCallback()) {
            add(node, plain ? mask : ~0u, {}, false);
        } else if (drawable) {
            const bool known_side = style.both_sides || (!dynamic && !mirrors(matrixOf(path)));
            add(node, plain ? mask : ~0u, plain && known_side ? occluder(*drawable, style) : slOccluderId{},
                active && style.keeps_depth);
        } else if (isPlainGroup(node) || isPlainTransform(node)) {
            dynamic |= node.asTransform() && mayChange(node);
            osg::Group& group = *node.asGroup();
            for (unsigned i = 0; i < group.getNumChildren(); ++i) visit(*group.getChild(i), style, mask, plain, active);
        } else {
            add(node, plain ? mask : ~0u, {},
                active && node.isCullingActive() && Inspection(node, above).mayBeLeftOut());
        }
        dynamic = moved;
        path.pop_back();
    }

    slOccluderId occluder(osg::Drawable& drawable, const Style& style) {
        if (!style.opaque) return {};
        const auto [at, fresh] = known.try_emplace({&drawable, style.both_sides});
        if (!fresh) return at->second;
        if (slOccluder* const prepared = occluderOf(drawable, style)) {
            slAddOccluder(to.world_, prepared, &at->second);
            slDestroyOccluder(prepared);
        }
        return at->second;
    }

    /// @param bounded  it may be left out where its box is not seen
    void add(osg::Node& node, uint32_t mask, slOccluderId occluder, bool bounded) {
        Object object{path, {}, dynamic};
        slObjectDef def = slDefaultObjectDef();
        osg::BoundingBox box;
        if (osg::Drawable* const drawable = node.asDrawable()) {
            box = drawable->getBoundingBox();
            bounded &= !mayChange(node) && !drawsBeyondItsBox(*drawable);
        } else {
            const osg::BoundingSphere& sphere = node.getBound();
            if (sphere.valid()) box.expandBy(sphere);
            if (bounded) to.spheres_.push_back({&node, sphere});
            // Its own transform is in its bound already.
            object.path.pop_back();
        }
        const osg::Matrixd matrix = matrixOf(object.path);
        object.path = path;
        def.bounds = bounded && box.valid() ? boxOf(box) : kNoBox;
        std::memcpy(def.transform, matrix.ptr(), sizeof def.transform);
        def.key = to.objects_.size();
        def.layers = mask;
        def.occluder = def.shape = occluder;
        if (slAddObject(to.world_, &def, &object.id) != SL_OK) object.id = to.addAlways(def.key, mask);
        if (dynamic) to.dynamic_.push_back(static_cast<uint32_t>(to.objects_.size()));
        to.objects_.push_back(std::move(object));
    }
};

Culler::Culler(osg::Node& root) : root_(root) {}

Culler::~Culler() {
    for (const auto& [visitor, query] : queries_) slDestroyQuery(query);
    slReleaseSnapshot(snapshot_);
    slDestroyWorld(world_);
}

CullerStats Culler::stats() const {
    const std::lock_guard lock(mutex_);
    return stats_;
}

std::vector<osg::NodePath> Culler::drawn() const {
    const std::lock_guard lock(mutex_);
    std::vector<osg::NodePath> paths;
    for (const uint32_t index : visible_) paths.push_back(objects_[index].path);
    return paths;
}

void Culler::read() {
    slReleaseSnapshot(snapshot_);
    slDestroyWorld(world_);
    objects_.clear();
    visible_.clear();
    dynamic_.clear();
    spheres_.clear();
    const slWorldDef def = slDefaultWorldDef();
    slCreateWorld(&def, &world_);
    Reader reader{*this};
    const Style above = styleAbove(root_);
    if (osg::Group* const group = root_.asGroup())
        for (unsigned i = 0; i < group->getNumChildren(); ++i)
            reader.visit(*group->getChild(i), above, ~0u, true, true);
    slCommit(world_, &snapshot_);
    stats_.objects = static_cast<uint32_t>(objects_.size());
}

/// An object that is always visible, and hides nothing.
slObjectId Culler::addAlways(uint64_t key, uint32_t mask) {
    slObjectDef def = slDefaultObjectDef();
    def.bounds = kNoBox;
    def.key = key;
    def.layers = mask;
    slObjectId id{};
    slAddObject(world_, &def, &id);
    return id;
}

/// Moves what may have moved, or reads the graph anew if a node that is left to OpenSceneGraph has another bound now.
void Culler::follow() {
    for (const auto& [node, sphere] : spheres_)
        if (node->getBound() != sphere) return read();
    if (dynamic_.empty()) return;
    for (const uint32_t index : dynamic_) {
        osg::NodePath path = objects_[index].path;
        if (!path.back()->asDrawable()) path.pop_back();
        const osg::Matrixd matrix = matrixOf(path);
        if (slMoveObject(world_, objects_[index].id, matrix.ptr()) == SL_OK) continue;
        // No affine matrix: from now on it is always drawn.
        slRemoveObject(world_, objects_[index].id);
        objects_[index].id = addAlways(index, ~0u);
    }
    slReleaseSnapshot(snapshot_);
    slCommit(world_, &snapshot_);
}

slQuery* Culler::queryOf(osgUtil::CullVisitor& visitor) {
    slQuery*& query = queries_[&visitor];
    if (!query) slCreateQuery(nullptr, &query);
    return query;
}

void Culler::operator()(osg::Node* node, osg::NodeVisitor* visitor) {
    osgUtil::CullVisitor* const cull = visitor->asCullVisitor();
    const bool culls = cull && cull->getViewport() && cull->getNodeMaskOverride() == 0 &&
                       (cull->getCullingMode() & osg::CullSettings::VIEW_FRUSTUM_SIDES_CULLING);
    if (!culls) return (void)traverse(node, visitor);
    if (cull->getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR) {
        if (!warned_)
            OSG_WARN << "sightline: the camera computes its near and far planes from what it draws: nothing is culled "
                        "by occlusion"
                     << std::endl;
        warned_ = true;
        return (void)traverse(node, visitor);
    }
    slView view = slDefaultView();
    std::memcpy(view.view, cull->getModelViewMatrix()->ptr(), sizeof view.view);
    std::memcpy(view.projection, cull->getProjectionMatrix()->ptr(), sizeof view.projection);
    view.width = static_cast<uint32_t>(cull->getViewport()->width());
    view.height = static_cast<uint32_t>(cull->getViewport()->height());
    view.layers = cull->getTraversalMask();

    // Views that cull at once take turns here, and nowhere else in a frame that changes nothing.
    const std::lock_guard lock(mutex_);
    const unsigned frame = visitor->getFrameStamp() ? visitor->getFrameStamp()->getFrameNumber() : frame_ + 1;
    if (stale_.exchange(false)) read();
    else if (frame != frame_) follow();
    frame_ = frame;
    slVisibleSet set{};
    slQuery* const query = queryOf(*cull);
    if (slQueryVisible(query, snapshot_, &view, nullptr, &set) != SL_OK) return (void)traverse(node, visitor);
    slQueryStats stats;
    slQueryGetStats(query, &stats);
    stats_.visible = set.count;
    stats_.microseconds = static_cast<double>(stats.nanoseconds) / 1000;
    visible_.resize(set.count);
    for (uint32_t i = 0; i < set.count; ++i) visible_[i] = static_cast<uint32_t>(set.objects[i].key);
    std::sort(visible_.begin(), visible_.end());
    draw(*cull);
}

/// Goes the ways to what is visible, in the graph's order, each part of them once.
void Culler::draw(osgUtil::CullVisitor& visitor) const {
    osg::NodePath inside;  // nodes whose state and matrix are set
    const auto leave = [&](size_t depth) {
        for (; inside.size() > depth; inside.pop_back()) {
            if (inside.back()->asTransform()) visitor.popModelViewMatrix();
            if (inside.back()->getStateSet()) visitor.popStateSet();
            visitor.popFromNodePath();
        }
    };
    for (const uint32_t index : visible_) {
        const osg::NodePath& path = objects_[index].path;
        const size_t shared = static_cast<size_t>(
            std::mismatch(inside.begin(), inside.end(), path.begin(), path.end() - 1).first - inside.begin());
        leave(shared);
        bool drawn = true;
        for (size_t k = shared; drawn && k + 1 < path.size(); ++k) {
            osg::Node* const node = path[k];
            drawn = visitor.validNodeMask(*node);
            if (!drawn) break;
            visitor.pushOntoNodePath(node);
            if (node->getStateSet()) visitor.pushStateSet(node->getStateSet());
            if (osg::Transform* const transform = node->asTransform()) {
                const osg::ref_ptr<osg::RefMatrix> matrix = new osg::RefMatrix(*visitor.getModelViewMatrix());
                transform->computeLocalToWorldMatrix(*matrix, &visitor);
                visitor.pushModelViewMatrix(matrix, transform->getReferenceFrame());
            }
            inside.push_back(node);
        }
        if (drawn) path.back()->accept(visitor);
    }
    leave(0);
}

}  // namespace sightline_osg
