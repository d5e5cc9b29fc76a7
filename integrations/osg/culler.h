// Sightline in OpenSceneGraph: a cull callback that draws of a scene graph what may be seen, and visits nothing else of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include <osg/Drawable>
#include <osg/NodeCallback>
#include <osg/Transform>

#include <sightline/c/sightline.h>

namespace osgUtil {
class CullVisitor;
}

namespace sightline_osg {

/// What the last frame of one view cost.
struct CullerStats {
    uint32_t objects = 0, visible = 0;
    double microseconds = 0;  ///< of the query
};

/// The cull callback of a subgraph. It draws the same as OpenSceneGraph's own traversal would, without the small-feature
/// culling that this one does by default.
///
///     camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
///     root->setCullCallback(new sightline_osg::Culler(*root));
///
/// Each drawable under groups, geodes and transforms is an object, which hides others if it is opaque geometry of plain
/// vertices whose state is known to hide nothing less. Every other node (a level of detail, a switch, a node with callbacks
/// of its own) is one object that hides nothing, and is left to OpenSceneGraph where it may be seen. Always drawn are lights,
/// clip planes and cameras, lines, points and text, what may change by itself, and what is drawn without the depth test or
/// beside its depth.
///
/// Transforms whose data variance is DYNAMIC, or that have an update callback, are read anew each frame. What else changes (nodes that come and go, masks,
/// state, vertices) must be told by changed(). The planes of near and far must be known before the traversal: while the
/// camera computes them from what it draws, the subgraph is traversed as ever. Any number of cameras may cull at once.
class Culler : public osg::NodeCallback {
public:
    /// Reads the graph under a node, and the state above it.
    explicit Culler(osg::Node& root);

    /// The graph is read again before it is culled the next time.
    void changed() { stale_ = true; }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

    /// Of the view that was culled last.
    CullerStats stats() const;
    /// What was drawn for it: from below the root down to a drawable, or to a node that was left to OpenSceneGraph.
    std::vector<osg::NodePath> drawn() const;

protected:
    ~Culler() override;

private:
    struct Object {
        osg::NodePath path;  ///< below the root, down to what is drawn
        slObjectId id{};
        bool dynamic = false;  ///< a transform above it may move
    };
    struct Reader;

    void read();
    void follow();
    slObjectId addAlways(uint64_t key, uint32_t mask);
    slQuery* queryOf(osgUtil::CullVisitor& visitor);
    void draw(osgUtil::CullVisitor& visitor) const;

    osg::Node& root_;
    mutable std::mutex mutex_;
    slWorld* world_ = nullptr;
    slSnapshot* snapshot_ = nullptr;
    std::vector<Object> objects_;
    std::vector<uint32_t> visible_;                      ///< of the last view, in the graph's order
    std::vector<uint32_t> dynamic_;                      ///< objects that may move
    std::map<osgUtil::CullVisitor*, slQuery*> queries_;  ///< one a view
    /// Nodes that are left to OpenSceneGraph and may be left out, with the bounds that they were read with.
    std::vector<std::pair<osg::Node*, osg::BoundingSphere>> spheres_;
    unsigned frame_ = ~0u;  ///< that was followed last
    std::atomic<bool> stale_{true};
    bool warned_ = false;
    CullerStats stats_;
};

}  // namespace sightline_osg
