// Bounds of meshes that bones or morph targets move, for every pose.
// SPDX-License-Identifier: MIT
#include "apps/import/poses.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "apps/import/fault.h"
#include "sightline/math/stretch.h"
#include "sightline/tools/import/gltf/gltf_nodes.h"

namespace sightline::import {
using namespace tools;
namespace {

glm::dvec3 toVector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

glm::dmat4 worldOf(const aiNode* node) {
    glm::dmat4 out(1.0);
    for (; node; node = node->mParent) out = toMatrix(node->mTransformation) * out;
    return out;
}

/// Whether some key's value is not that of the first.
template <class Key>
bool differ(const Key* keys, unsigned count) {
    return std::any_of(keys, keys + count, [&](const Key& key) { return !(key.mValue == keys[0].mValue); });
}

}  // namespace

glm::dmat4 toMatrix(const aiMatrix4x4& m) {
    return {{m.a1, m.b1, m.c1, 0}, {m.a2, m.b2, m.c2, 0}, {m.a3, m.b3, m.c3, 0}, {m.a4, m.b4, m.c4, 1}};
}

Poses::Poses(const aiScene& scene) {
    std::vector<const aiNode*> todo{scene.mRootNode};
    while (!todo.empty()) {
        const aiNode* node = todo.back();
        todo.pop_back();
        nodes_.try_emplace(node->mName.C_Str(), node);
        todo.insert(todo.end(), node->mChildren, node->mChildren + node->mNumChildren);
    }
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b)
            joints_.insert(scene.mMeshes[m]->mBones[b]->mName.C_Str());
    for (unsigned a = 0; a < scene.mNumAnimations; ++a) readMotions(*scene.mAnimations[a]);
}

void Poses::readMotions(const aiAnimation& animation) {
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
        const aiNodeAnim& channel = *animation.mChannels[c];
        Motion& motion = motions_[channel.mNodeName.C_Str()];
        motion.changes = motion.changes || differ(channel.mPositionKeys, channel.mNumPositionKeys) ||
                         differ(channel.mRotationKeys, channel.mNumRotationKeys) ||
                         differ(channel.mScalingKeys, channel.mNumScalingKeys);
        if (channel.mNumPositionKeys > 0 && channel.mNumRotationKeys > 0 && channel.mNumScalingKeys > 0)
            motion.first.emplace_back(channel.mScalingKeys[0].mValue, channel.mRotationKeys[0].mValue,
                                      channel.mPositionKeys[0].mValue);
        else motion.changes = true;  // what has no key is not at rest, but at its default
        for (unsigned k = 0; k < channel.mNumPositionKeys; ++k) {
            motion.longest_shift =
                std::max(motion.longest_shift, glm::length(toVector(channel.mPositionKeys[k].mValue)));
            motion.shifts = true;
        }
        for (unsigned k = 0; k < channel.mNumScalingKeys; ++k)
            for (unsigned axis = 0; axis < 3; ++axis)
                motion.largest_scale =
                    std::max(motion.largest_scale, std::abs(double(channel.mScalingKeys[k].mValue[axis])));
    }
    for (unsigned c = 0; c < animation.mNumMorphMeshChannels; ++c) {
        const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[c];
        for (unsigned k = 0; k < channel.mNumKeys; ++k)
            for (unsigned w = 0; w < channel.mKeys[k].mNumValuesAndWeights; ++w)
                largest_weight_ = std::max(largest_weight_, std::abs(channel.mKeys[k].mWeights[w]));
    }
}

bool Poses::moves(const aiNode& node) const {
    const Motion* motion = motionOf(node);
    if (!motion || motion->changes) return motion != nullptr;
    // Exporters write a key for what stands still: it is the node's place but for rounding.
    constexpr double kRounding = 1e-5;
    const glm::dmat4 rest = toMatrix(node.mTransformation);
    for (const aiMatrix4x4& first : motion->first) {
        const glm::dmat4 there = toMatrix(first);
        for (int column = 0; column < 4; ++column) {
            const double size = column < 3 ? largestStretch(rest) : glm::length(glm::dvec3(rest[3]));
            if (!(glm::length(there[column] - rest[column]) <= kRounding * size)) return true;
        }
    }
    return false;
}

const Poses::Motion* Poses::motionOf(const aiNode& node) const {
    const auto found = motions_.find(node.mName.C_Str());
    return found == motions_.end() ? nullptr : &found->second;
}

double Poses::scaleOf(const aiNode& node) const {
    const double rest = largestStretch(toMatrix(node.mTransformation));
    const Motion* motion = motionOf(node);
    return motion ? std::max(rest, motion->largest_scale) : rest;
}

double Poses::shiftOf(const aiNode& node) const {
    const double rest = glm::length(glm::dvec3(toMatrix(node.mTransformation)[3]));
    const Motion* motion = motionOf(node);
    return motion ? std::max(rest, motion->longest_shift) : rest;
}

Poses::Reach Poses::reachOf(const aiNode& joint) const {
    std::vector<const aiNode*> path;  // from the joint up to the first that may move
    size_t moving = 0;
    for (const aiNode* node = &joint; node; node = node->mParent) {
        path.push_back(node);
        if (joints_.count(node->mName.C_Str()) || motionOf(*node)) moving = path.size();
    }
    path.resize(std::max<size_t>(moving, 1));
    const aiNode& first = *path.back();
    const glm::dmat4 anchor = worldOf(first.mParent);
    Reach out;
    out.scale = largestStretch(anchor);
    // The first turns about where it stands, unless an animation shifts it.
    const Motion* motion = motionOf(first);
    const bool stands = !(motion && motion->shifts);
    out.center = glm::dvec3(stands ? anchor * toMatrix(first.mTransformation)[3] : anchor[3]);
    if (!stands) out.distance = out.scale * shiftOf(first);
    out.scale *= scaleOf(first);
    for (size_t i = path.size() - 1; i-- > 0;) {
        out.distance += out.scale * shiftOf(*path[i]);
        out.scale *= scaleOf(*path[i]);
    }
    return out;
}

double Poses::morphReach(const aiMesh& mesh, unsigned vertex) const {
    double reach = 0;
    for (unsigned t = 0; t < mesh.mNumAnimMeshes; ++t) {
        const aiAnimMesh& target = *mesh.mAnimMeshes[t];
        if (!target.mVertices || vertex >= target.mNumVertices) continue;
        reach += largest_weight_ * glm::length(toVector(target.mVertices[vertex]) - toVector(mesh.mVertices[vertex]));
    }
    return reach;
}

Box3d Poses::morphBounds(const aiMesh& mesh) const {
    Box3d box;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const glm::dvec3 position = toVector(mesh.mVertices[v]);
        const double reach = mesh.mNumAnimMeshes > 0 ? morphReach(mesh, v) * (1 + 1e-12) : 0;
        box.grow(position - reach);
        box.grow(position + reach);
    }
    return box;
}

Box3d Poses::bounds(const aiMesh& mesh, const glm::dmat4& world) const {
    Box3d box = morphBounds(mesh);  // as it stands, and for vertices without a bone
    const auto fail = [&](const std::string& what) -> Fault {
        return {fmt::format("mesh '{}': {}", mesh.mName.C_Str(), what)};
    };
    Box3d posed;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const auto node = nodes_.find(bone.mName.C_Str());
        if (node == nodes_.end())
            throw fail(fmt::format("bone '{}' is no node, so that its poses have no bounds", bone.mName.C_Str()));
        const Reach reach = reachOf(*node->second);
        const glm::dmat4 offset = toMatrix(bone.mOffsetMatrix);
        const double stretch = largestStretch(offset);
        double radius = 0;
        for (unsigned w = 0; w < bone.mNumWeights; ++w) {
            const unsigned vertex = bone.mWeights[w].mVertexId;
            if (vertex >= mesh.mNumVertices) throw fail("a bone moves a vertex that there is not");
            if (bone.mWeights[w].mWeight == 0) continue;
            const glm::dvec3 arm(offset * glm::dvec4(toVector(mesh.mVertices[vertex]), 1));
            radius = std::max(radius, glm::length(arm) + stretch * morphReach(mesh, vertex));
        }
        const double far = (reach.distance + reach.scale * radius) * (1 + 1e-9);
        posed.grow(reach.center - far);
        posed.grow(reach.center + far);
    }
    if (!posed.empty()) {
        if (!(std::abs(glm::determinant(glm::dmat3(world))) > 0))
            throw fail("its node is flat, so that its poses have no bounds");
        box.grow(transformBox(posed, glm::inverse(world)));
    }
    if (!box.finite()) throw fail("its poses have no bounds");
    return box;
}

}  // namespace sightline::import
