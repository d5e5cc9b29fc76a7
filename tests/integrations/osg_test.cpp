// The cull callback for OpenSceneGraph: what is drawn of small graphs, without a GL.
// SPDX-License-Identifier: MIT
#include <set>

#include <gtest/gtest.h>
#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/PolygonMode>
#include <osg/PolygonOffset>
#include <osg/Switch>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include "integrations/osg/culler.h"
#include "sightline/base/random.h"

namespace sightline_osg {
namespace {

/// A box of its own vertices; counter-clockwise from outside.
osg::ref_ptr<osg::Geometry> box(const osg::Vec3& low, const osg::Vec3& high) {
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (int i = 0; i < 8; ++i)
        corners->push_back({i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()});
    const osg::ref_ptr<osg::DrawElementsUInt> faces = new osg::DrawElementsUInt(GL_QUADS);
    for (const auto& face :
         {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, std::initializer_list<int>{1, 3, 7, 5}})
        for (const int corner : face) faces->push_back(static_cast<GLuint>(corner));
    geometry->setVertexArray(corners);
    geometry->addPrimitiveSet(faces);
    return geometry;
}

osg::ref_ptr<osg::Geode> geode(osg::Drawable* drawable) {
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(drawable);
    return geode;
}

using Leaf = std::pair<const osg::Drawable*, std::vector<double>>;  ///< and its matrix

void addLeaves(const osgUtil::StateGraph& graph, std::multiset<Leaf>& leaves) {
    for (const auto& leaf : graph._leaves)
        leaves.insert({leaf->getDrawable(), {leaf->_modelview->ptr(), leaf->_modelview->ptr() + 16}});
    for (const auto& [state, child] : graph._children) addLeaves(*child, leaves);
}

/// An eye at z = 10 that looks at the origin, and a graph.
struct Looked {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgUtil::CullVisitor> visitor = osgUtil::CullVisitor::create();
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osg::ref_ptr<Culler> culler;
    osg::Matrixd view = osg::Matrixd::lookAt(osg::Vec3d(0, 0, 10), osg::Vec3d(), osg::Vec3d(0, 1, 0));

    /// What is drawn: by the callback, once there is one.
    std::multiset<Leaf> draw(unsigned mask = ~0u) {
        stamp->setFrameNumber(stamp->getFrameNumber() + 1);
        visitor->reset();
        const osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
        const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
        visitor->setFrameStamp(stamp);
        visitor->setTraversalMask(mask);
        visitor->setComputeNearFarMode(near_far);
        visitor->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
        visitor->setStateGraph(graph);
        visitor->setRenderStage(stage);
        const osg::ref_ptr<osg::Viewport> viewport = new osg::Viewport(0, 0, 640, 360);
        stage->setViewport(viewport);
        visitor->pushViewport(viewport);
        visitor->pushProjectionMatrix(new osg::RefMatrix(osg::Matrixd::perspective(70, 640.0 / 360, 0.1, 1000)));
        visitor->pushModelViewMatrix(new osg::RefMatrix(view), osg::Transform::ABSOLUTE_RF);
        root->accept(*visitor);
        visitor->popModelViewMatrix();
        visitor->popProjectionMatrix();
        visitor->popViewport();
        std::multiset<Leaf> leaves;
        addLeaves(*graph, leaves);
        return leaves;
    }
    void cullBySightline() { root->setCullCallback(culler = new Culler(*root)); }

    osg::CullSettings::ComputeNearFarMode near_far = osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR;
};

/// A wall and a box behind it.
struct Wall : Looked {
    osg::ref_ptr<osg::Geode> wall = geode(box({-5, -5, 0}, {5, 5, 0.5f}));
    osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(osg::Matrixd::translate(0, 0, -8));

    Wall() {
        placed->addChild(geode(box({-1, -1, -1}, {1, 1, 1})));
        root->addChild(wall);
        root->addChild(placed);
    }
    size_t drawn() {
        cullBySightline();
        return draw().size();
    }
};

TEST(OsgCuller, LeavesOutWhatAWallHides) {
    Wall looked;
    EXPECT_EQ(looked.draw().size(), 2u);
    looked.cullBySightline();
    EXPECT_EQ(looked.draw().size(), 1u);
    EXPECT_EQ(looked.culler->stats().objects, 2u);
    EXPECT_EQ(looked.culler->stats().visible, 1u);
    ASSERT_EQ(looked.culler->drawn().size(), 1u);
    EXPECT_EQ(looked.culler->drawn()[0][0], looked.wall.get());
    looked.view = osg::Matrixd::lookAt(osg::Vec3d(20, 0, -2), osg::Vec3d(0, 0, -2), osg::Vec3d(0, 1, 0));
    EXPECT_EQ(looked.draw().size(), 2u) << "from beside the wall";
}

TEST(OsgCuller, FollowsWhatMoves) {
    Wall looked;
    looked.placed->setDataVariance(osg::Object::DYNAMIC);
    looked.cullBySightline();
    EXPECT_EQ(looked.draw().size(), 1u);
    looked.placed->setMatrix(osg::Matrixd::translate(0, 0, 4));
    const std::multiset<Leaf> leaves = looked.draw();
    EXPECT_EQ(leaves.size(), 2u);
    Looked own = looked;
    own.root->setCullCallback(nullptr);
    EXPECT_EQ(own.draw(), leaves) << "with the matrices of its own traversal";
}

TEST(OsgCuller, ReadsTheGraphAgainWhenItIsTold) {
    Wall looked;
    looked.cullBySightline();
    EXPECT_EQ(looked.draw().size(), 1u);
    looked.root->removeChild(looked.wall);
    looked.culler->changed();
    EXPECT_EQ(looked.draw().size(), 1u) << "the box alone";
    EXPECT_EQ(looked.culler->stats().objects, 1u);
}

/// State that lets what is behind be seen.
TEST(OsgCuller, LetsNothingHideThatIsSeenThrough) {
    const std::vector<osg::ref_ptr<osg::StateAttribute>> attributes = {
        new osg::BlendFunc, new osg::AlphaFunc,
        new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE),
        new osg::Depth(osg::Depth::LESS, 0, 1, false), new osg::CullFace(osg::CullFace::FRONT)};
    for (const auto& attribute : attributes) {
        Wall looked;
        looked.wall->getOrCreateStateSet()->setAttributeAndModes(attribute, osg::StateAttribute::ON);
        EXPECT_EQ(looked.drawn(), 2u) << attribute->className();
    }
    {
        Wall looked;
        looked.root->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc, osg::StateAttribute::ON);
        EXPECT_EQ(looked.drawn(), 2u) << "from above";
    }
    {
        Wall looked;
        looked.wall->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc, osg::StateAttribute::OFF);
        EXPECT_EQ(looked.drawn(), 1u) << "a mode that is off";
    }
    {
        Wall looked;
        looked.wall->getDrawable(0)->setDataVariance(osg::Object::DYNAMIC);
        EXPECT_EQ(looked.drawn(), 2u) << "vertices that may move";
    }
}

/// State by which a thing is drawn although something stands before it.
TEST(OsgCuller, LeavesOutNothingThatIsDrawnBesideItsDepth) {
    const std::vector<osg::ref_ptr<osg::StateAttribute>> attributes = {
        new osg::Depth(osg::Depth::ALWAYS), new osg::Depth(osg::Depth::GREATER),
        new osg::Depth(osg::Depth::LESS, 0, 0.0001), new osg::PolygonOffset(-10, -1e6f),
        new osg::Viewport(0, 0, 10, 10)};
    for (const auto& attribute : attributes) {
        Wall looked;
        looked.placed->getOrCreateStateSet()->setAttributeAndModes(attribute, osg::StateAttribute::ON);
        EXPECT_EQ(looked.drawn(), 2u) << attribute->className();
        Wall hides;
        hides.wall->getOrCreateStateSet()->setAttributeAndModes(attribute, osg::StateAttribute::ON);
        EXPECT_EQ(hides.drawn(), 2u) << attribute->className() << " of the wall";
    }
    Wall looked;
    looked.placed->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    EXPECT_EQ(looked.drawn(), 2u);
    for (const GLenum mode : {GL_SCISSOR_TEST, GL_CLIP_PLANE0 + 6, GL_SAMPLE_COVERAGE_ARB}) {
        Wall cut;
        cut.wall->getOrCreateStateSet()->setMode(static_cast<GLenum>(mode), osg::StateAttribute::ON);
        EXPECT_EQ(cut.drawn(), 2u) << mode;
    }
}

/// A drawable that is opaque in one place and glass in another.
TEST(OsgCuller, SharedDrawablesHideWhereTheyAreOpaque) {
    Wall looked;
    const osg::ref_ptr<osg::MatrixTransform> aside = new osg::MatrixTransform(osg::Matrixd::translate(100, 0, 0));
    aside->addChild(looked.wall);
    const osg::ref_ptr<osg::Group> glass = new osg::Group;
    glass->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc, osg::StateAttribute::ON);
    glass->addChild(looked.wall);
    looked.root->removeChild(looked.wall);
    looked.root->insertChild(0, aside);
    looked.root->insertChild(1, glass);
    EXPECT_EQ(looked.drawn(), 2u) << "the glass, and the box behind it";
}

TEST(OsgCuller, MirroredFacesHideNothing) {
    Wall looked;
    const osg::ref_ptr<osg::MatrixTransform> mirror = new osg::MatrixTransform(osg::Matrixd::scale(-1, 1, 1));
    mirror->addChild(looked.wall);
    looked.wall->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace);
    looked.root->removeChild(looked.wall);
    looked.root->insertChild(0, mirror);
    EXPECT_EQ(looked.drawn(), 2u);
}

TEST(OsgCuller, FollowsTheBoundsOfOtherNodes) {
    Wall looked;
    const osg::ref_ptr<osg::Switch> either = new osg::Switch;
    either->addChild(geode(box({-1, -1, -9}, {1, 1, -8})), true);
    either->addChild(geode(box({-1, -1, 3}, {1, 1, 4})), false);
    looked.root->addChild(either);
    looked.cullBySightline();
    EXPECT_EQ(looked.draw().size(), 1u);
    either->setValue(0, false);
    either->setValue(1, true);
    EXPECT_EQ(looked.draw().size(), 2u) << "it shows what stands before the wall now";
    const osg::ref_ptr<osg::MatrixTransform> moving = new osg::MatrixTransform(osg::Matrixd::translate(0, 0, -20));
    moving->setDataVariance(osg::Object::DYNAMIC);
    moving->addChild(geode(box({-1, -1, -1}, {1, 1, 1})));
    const osg::ref_ptr<osg::Switch> above = new osg::Switch;
    above->addChild(moving, true);
    looked.root->addChild(above);
    looked.culler->changed();
    EXPECT_EQ(looked.draw().size(), 3u) << "what may move below a switch is always drawn";
}

TEST(OsgCuller, HidesByTheSidesThatAreDrawn) {
    Wall looked;
    const osg::ref_ptr<osg::Geometry> face = new osg::Geometry;
    const osg::Vec3 corners[] = {{-5, -5, 0}, {-5, 5, 0}, {5, 5, 0}, {5, -5, 0}};  // turned away
    face->setVertexArray(new osg::Vec3Array(4, corners));
    face->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
    looked.root->removeChild(looked.wall);
    const osg::ref_ptr<osg::Geode> turned = geode(face);
    looked.root->insertChild(0, turned);
    EXPECT_EQ(looked.drawn(), 1u) << "both sides are drawn";
    turned->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace);
    looked.culler->changed();
    EXPECT_EQ(looked.draw().size(), 2u) << "it is not drawn from behind";
}

TEST(OsgCuller, KeepsToNodeMasks) {
    Wall looked;
    looked.wall->setNodeMask(2);
    looked.cullBySightline();
    EXPECT_EQ(looked.draw(1).size(), 1u) << "the wall is not drawn, and hides nothing";
    EXPECT_EQ(looked.draw(2).size(), 1u) << "it is drawn, and hides the box";
    const osg::ref_ptr<osg::Group> above = new osg::Group;
    above->setNodeMask(4);
    looked.root->removeChild(looked.wall);
    above->addChild(looked.wall);
    looked.root->insertChild(0, above);
    looked.culler->changed();
    EXPECT_EQ(looked.draw(2).size(), 1u) << "two masks, of which one leaves it out";
    EXPECT_EQ(looked.draw(6).size(), 2u) << "both let it through; it hides nothing, to be sure";
}

TEST(OsgCuller, LeavesOtherNodesToTheirOwnTraversal) {
    Wall looked;
    const osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->addChild(geode(box({-1, -1, -1}, {1, 1, 1})), 0, 5);
    lod->addChild(geode(box({-1, -1, -1}, {1, 1, 1})), 5, 1e9f);
    const osg::ref_ptr<osg::MatrixTransform> before = new osg::MatrixTransform(osg::Matrixd::translate(0, 0, 3));
    before->addChild(lod);
    const osg::ref_ptr<osg::MatrixTransform> behind = new osg::MatrixTransform(osg::Matrixd::translate(0, 0, -20));
    behind->addChild(lod);
    const osg::ref_ptr<osg::Switch> off = new osg::Switch;
    off->addChild(geode(box({-1, -1, 4}, {1, 1, 5})), false);
    looked.root->addChild(before);
    looked.root->addChild(behind);
    looked.root->addChild(off);
    looked.root->addChild(new osg::LightSource);
    looked.cullBySightline();
    const std::multiset<Leaf> leaves = looked.draw();
    EXPECT_EQ(leaves.size(), 2u) << "the wall, and one level of what stands before it";
    std::set<const osg::Drawable*> drawables;
    for (const Leaf& leaf : leaves) drawables.insert(leaf.first);
    EXPECT_TRUE(drawables.count(lod->getChild(1)->asGeode()->getDrawable(0)));
}

TEST(OsgCuller, DoesNotCullWhileNearAndFarAreNotKnown) {
    Wall looked;
    looked.near_far = osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES;
    looked.cullBySightline();
    EXPECT_EQ(looked.draw().size(), 2u);
}

/// Of graphs with many levels, what is drawn is drawn with the same state and the same matrices.
TEST(OsgCuller, DrawsAPartOfWhatTheOwnTraversalDraws) {
    sightline::Random random(7);
    for (int world = 0; world < 10; ++world) {
        Looked looked;
        std::vector<osg::ref_ptr<osg::Group>> groups = {looked.root};
        for (int i = 0; i < 300; ++i) {
            const osg::ref_ptr<osg::Group> above = groups[random.below(groups.size())];
            const auto at = [&](double size) { return random.uniform(-size, size); };
            if (random.below(3) == 0) {
                const osg::ref_ptr<osg::MatrixTransform> transform =
                    new osg::MatrixTransform(osg::Matrixd::rotate(at(3), osg::Vec3d(at(1), at(1), 1)) *
                                             osg::Matrixd::translate(at(3), at(3), at(3)));
                if (random.below(3) == 0)
                    transform->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
                above->addChild(transform);
                groups.push_back(transform);
            } else {
                const osg::Vec3 low(at(6), at(6), at(6));
                above->addChild(geode(box(low, low + osg::Vec3(1 + at(0.9), 1 + at(0.9), 1 + at(0.9)) * 3)));
            }
        }
        const std::multiset<Leaf> all = looked.draw();
        looked.cullBySightline();
        const std::multiset<Leaf> some = looked.draw();
        EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()));
        EXPECT_LT(some.size(), all.size());
        EXPECT_GT(some.size(), 0u);
    }
}

}  // namespace
}  // namespace sightline_osg
