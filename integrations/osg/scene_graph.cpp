// A scene of Sightline's tools as a graph of OpenSceneGraph's, for the programs that try both.
// SPDX-License-Identifier: MIT
#include "integrations/osg/scene_graph.h"

#include <string>
#include <vector>

#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/OcclusionQueryNode>

namespace sightline_osg {
using namespace sightline::tools;
namespace {

osg::ref_ptr<osg::StateSet> stateOf(const Material& material) {
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    const glm::vec4 c = material.base_color;
    const osg::ref_ptr<osg::Material> color = new osg::Material;
    color->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(c.r, c.g, c.b, c.a));
    color->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(c.r, c.g, c.b, c.a));
    state->setAttribute(color);
    if (!material.double_sided) state->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
    if (!material.hides()) {
        state->setAttributeAndModes(new osg::BlendFunc);
        state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    }
    return state;
}

/// The triangles of one material, flat.
osg::ref_ptr<osg::Geometry> geometryOf(const Mesh& mesh, const Primitive& primitive) {
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
        osg::Vec3 corners[3];
        for (int k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[mesh.indices[3 * t + static_cast<uint32_t>(k)]];
            corners[k] = osg::Vec3(p.x, p.y, p.z);
        }
        osg::Vec3 normal = (corners[1] - corners[0]) ^ (corners[2] - corners[0]);
        normal.normalize();
        for (const osg::Vec3& corner : corners) {
            vertices->push_back(corner);
            normals->push_back(normal);
        }
    }
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(vertices->size())));
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    return geometry;
}

osg::ref_ptr<osg::Geode> geodeOf(const Mesh& mesh, const std::vector<osg::ref_ptr<osg::StateSet>>& states) {
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    for (const Primitive& primitive : mesh.primitives) {
        const osg::ref_ptr<osg::Geometry> geometry = geometryOf(mesh, primitive);
        geometry->setStateSet(states[primitive.material]);
        geode->addDrawable(geometry);
    }
    return geode;
}

}  // namespace

osg::ref_ptr<osg::Group> sceneGraph(const Scene& scene, bool queries) {
    std::vector<osg::ref_ptr<osg::StateSet>> states;
    for (const Material& material : scene.materials) states.push_back(stateOf(material));
    std::vector<osg::ref_ptr<osg::Geode>> geodes;
    for (const Mesh& mesh : scene.meshes) geodes.push_back(geodeOf(mesh, states));
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
    std::vector<osg::ref_ptr<osg::Group>> groups;
    for (size_t i = 0; i < scene.nodes.size(); ++i) groups.push_back(new osg::Group);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const uint32_t parent = scene.nodes[i].parent;
        (parent == SceneNode::kNone ? root : groups[parent])->addChild(groups[i]);
    }
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const osg::ref_ptr<osg::MatrixTransform> placed =
            new osg::MatrixTransform(osg::Matrixd(&object.transform[0][0]));
        placed->setName(std::to_string(i));
        placed->addChild(geodes[object.mesh]);
        osg::Group& group = *(object.node == SceneNode::kNone ? root : groups[object.node]);
        if (queries) {
            const osg::ref_ptr<osg::OcclusionQueryNode> asked = new osg::OcclusionQueryNode;
            asked->setVisibilityThreshold(0);
            asked->addChild(placed);
            group.addChild(asked);
        } else {
            group.addChild(placed);
        }
    }
    return root;
}

}  // namespace sightline_osg
