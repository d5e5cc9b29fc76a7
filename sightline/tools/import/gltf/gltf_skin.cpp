// Poses skinned meshes at rest and bounds them for every pose of their joints.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "sightline/tools/import/gltf/gltf_accessor.h"
#include "sightline/tools/import/gltf/gltf_deform.h"

namespace sightline::tools::gltf {
namespace {

constexpr double kSlack = 1 + 1e-5;  // a renderer blends in single precision
constexpr double kBindTolerance = 1e-4;

struct Joint {
    glm::dmat4 inverse_bind{1.0};
    glm::dmat4 rest{1.0};  // from the mesh to the world's axes at the anchor
    double reach = -1;     // how far from the joint the vertices that it moves are bound; < 0: none
};

std::vector<Joint> readJoints(Document& document, const NodeTree& tree, const Skin& skin, const glm::dvec3& anchor,
                              const std::string& place) {
    document.budget.charge(skin.joints.size(), sizeof(Joint), place);
    std::vector<Joint> joints(skin.joints.size());
    std::vector<float> binds;
    if (skin.inverse_binds) binds = decodeFloats(document, *skin.inverse_binds, 16, "inverse bind matrix");
    if (skin.inverse_binds && binds.size() < joints.size() * 16)
        fail(accessorPlace(document, *skin.inverse_binds), "{} inverse bind matrices for {} joints", binds.size() / 16,
             joints.size());
    for (size_t j = 0; j < joints.size(); ++j) {
        glm::dmat4& bind = joints[j].inverse_bind;
        for (int column = 0; !binds.empty() && column < 4; ++column) {
            for (int row = 0; row < 4; ++row) bind[column][row] = binds[j * 16 + size_t(4 * column + row)];
            const double wanted = column == 3 ? 1 : 0;
            if (std::abs(bind[column][3] - wanted) > kBindTolerance)
                fail(accessorPlace(document, *skin.inverse_binds), "inverse bind matrix {} is not affine", j);
            bind[column][3] = wanted;
        }
        glm::dmat4 world = tree.nodes[skin.joints[j]].world;
        if (!finiteMatrix(world)) fail(at("nodes", skin.joints[j]), "its world transform is not finite");
        world[3] -= glm::dvec4(anchor, 0.0);
        joints[j].rest = world * bind;
    }
    return joints;
}

// The farthest that a point of the box may be from the origin once carried through an affine transform.
double farthest(const glm::dmat4& transform, const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 center = 0.5 * low + 0.5 * high, half = 0.5 * high - 0.5 * low;
    glm::dvec3 extent;
    for (int row = 0; row < 3; ++row) {
        double sum = transform[3][row];
        double spread = 0;
        for (int column = 0; column < 3; ++column) {
            sum += transform[column][row] * center[column];
            spread += std::abs(transform[column][row]) * half[column];
        }
        extent[row] = std::abs(sum) + spread;
    }
    return glm::length(extent);
}

struct InfluenceSet {
    std::vector<uint32_t> joints;  // [size: 4 * vertices]
    std::vector<float> weights;    // [size: 4 * vertices]
};

std::vector<InfluenceSet> readSets(Document& document, const PrimitiveSource& primitive, size_t joints) {
    if (primitive.influences.empty()) fail(primitive.place, "is skinned but has no JOINTS_0 and WEIGHTS_0");
    std::vector<InfluenceSet> sets;
    const uint64_t vertices = document.accessors[primitive.positions].count;
    for (const auto& [joint_accessor, weight_accessor] : primitive.influences) {
        for (const uint32_t accessor : {joint_accessor, weight_accessor})
            if (document.accessors[accessor].count != vertices)
                fail(accessorPlace(document, accessor), "{} joints or weights for {} vertices",
                     document.accessors[accessor].count, vertices);
        sets.push_back({decodeIntegers(document, joint_accessor, 4, "joints"),
                        decodeFloats(document, weight_accessor, 4, "weight")});
        const InfluenceSet& set = sets.back();
        for (size_t i = 0; i < set.weights.size(); ++i) {
            if (set.weights[i] < 0)
                fail(accessorPlace(document, weight_accessor), "weight {} of vertex {} is negative", set.weights[i],
                     i / 4);
            if (set.weights[i] > 0 && set.joints[i] >= joints)
                fail(accessorPlace(document, joint_accessor), "joint {} is out of range of {}", set.joints[i], joints);
        }
    }
    return sets;
}

// Poses the vertices of one run at rest and notes how far each joint's vertices are from it. Weights count
// by their share; a vertex without any follows the first joint.
void poseRun(const std::vector<InfluenceSet>& sets, const VertexRun& run, const MorphReach& reach,
             std::vector<Joint>& joints, Mesh& mesh) {
    for (size_t i = 0; i < run.source.size(); ++i) {
        const size_t vertex = run.first + i, first = size_t(run.source[i]) * 4;
        double total = 0;
        for (const InfluenceSet& set : sets)
            for (size_t c = first; c < first + 4; ++c) total += set.weights[c];
        glm::dvec3 posed(0.0);
        const auto follow = [&](Joint& joint, double share) {
            joint.reach = std::max(joint.reach, farthest(joint.inverse_bind, reach.low[vertex], reach.high[vertex]));
            posed += share * glm::dvec3(joint.rest * glm::dvec4(reach.rest[vertex], 1.0));
        };
        for (const InfluenceSet& set : sets)
            for (size_t c = first; c < first + 4; ++c)
                if (set.weights[c] > 0) follow(joints[set.joints[c]], set.weights[c] / total);
        if (total == 0) follow(joints[0], 1);
        mesh.positions[vertex] = glm::vec3(posed);
    }
}

// A node above or among the joints.
struct Step {
    uint32_t node = kNoNode;
    double reach = -1;  // in the node's own frame; < 0: nothing hangs from it
    bool moves = false;
    bool carried = false;  // something above it moves
};

class Reach {
public:
    Reach(const NodeTree& tree, const std::vector<Motion>& motions) : tree_(tree), motions_(motions) {}

    void gather(Document& document, const Skin& skin, const std::vector<Joint>& joints, const std::string& place) {
        for (size_t j = 0; j < joints.size(); ++j) {
            for (uint32_t n = skin.joints[j]; n != kNoNode && places_.emplace(n, steps_.size()).second;
                 n = tree_.names[n].parent) {
                document.budget.charge(1, 96, place);
                steps_.push_back({n, -1, motions_[n].animated, false});
            }
            Step& step = steps_[places_.at(skin.joints[j])];
            step.moves = true;
            step.reach = std::max(step.reach, joints[j].reach);
        }
        std::sort(steps_.begin(), steps_.end(),
                  [&](const Step& a, const Step& b) { return tree_.rank[a.node] < tree_.rank[b.node]; });
        for (size_t i = 0; i < steps_.size(); ++i) places_[steps_[i].node] = i;
    }

    // From the leaves up: what hangs from a node that is carried adds to its parent's reach.
    Box3d bound(const glm::dvec3& anchor, const std::string& place) {
        for (Step& step : steps_)
            if (const Step* parent = above(step)) step.carried = parent->moves || parent->carried;
        Box3d out;
        for (size_t i = steps_.size(); i-- > 0;) {
            const Step& step = steps_[i];
            if (!(step.reach >= 0)) continue;
            const double radius = motions_[step.node].scale * step.reach * kSlack;
            const Box3d& translation = motions_[step.node].translation;
            const double offset = glm::length(glm::max(glm::abs(translation.min), glm::abs(translation.max)));
            const Box3d box = ballBox(translation, radius, tree_.names[step.node].parent, anchor);
            // Here and not on the union, which would lose a NaN.
            if (!std::isfinite(offset + radius) || (!step.carried && !box.finite()))
                fail(place, "its bounds over all poses are not finite");
            if (!step.carried) {
                out.grow(box);
                continue;
            }
            Step* parent = above(step);
            parent->reach = std::max(parent->reach, offset + radius);
        }
        return out;
    }

private:
    Step* above(const Step& step) {
        const uint32_t parent = tree_.names[step.node].parent;
        return parent == kNoNode ? nullptr : &steps_[places_.at(parent)];
    }

    // Around balls with centres in a box of the parent's frame.
    Box3d ballBox(const Box3d& centers, double radius, uint32_t parent, const glm::dvec3& anchor) const {
        glm::dmat4 frame = parent == kNoNode ? glm::dmat4(1.0) : tree_.nodes[parent].world;
        frame[3] -= glm::dvec4(anchor, 0.0);
        Box3d box = transformBox(centers, frame);
        for (int row = 0; row < 3; ++row) {
            const double extent = radius * glm::length(glm::dvec3(frame[0][row], frame[1][row], frame[2][row]));
            box.min[row] -= extent;
            box.max[row] += extent;
        }
        return box;
    }

    const NodeTree& tree_;
    const std::vector<Motion>& motions_;
    std::vector<Step> steps_;
    std::unordered_map<uint32_t, size_t> places_;
};

}  // namespace

std::vector<Skin> readSkins(const Document& document, size_t nodes) {
    const JsonTable array = document.json.table("skins");
    std::vector<Skin> out(array.size());
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("skins", i);
        const Json json = array.object(i, place);
        const Json& joints = table(json, "joints", place);
        if (joints.empty()) fail(place, "has no joints");
        for (size_t j = 0; j < joints.size(); ++j) out[i].joints.push_back(indexAt(joints, j, "joints", nodes, place));
        out[i].inverse_binds = index(json, "inverseBindMatrices", document.accessors.size(), place);
    }
    return out;
}

glm::dvec3 applySkin(Document& document, const NodeTree& tree, const std::vector<Motion>& motions, const Skin& skin,
                     const MorphReach& reach, const std::string& place, BuiltMesh& built) {
    const glm::dvec3 anchor(tree.nodes[skin.joints[0]].world[3]);
    std::vector<Joint> joints = readJoints(document, tree, skin, anchor, place);
    for (const VertexRun& run : built.runs)
        poseRun(readSets(document, *run.primitive, joints.size()), run, reach, joints, built.mesh);

    Reach chains(tree, motions);
    chains.gather(document, skin, joints, place);
    built.mesh.deforms = true;
    built.mesh.bounds = chains.bound(anchor, place);
    for (const glm::vec3& position : built.mesh.positions) built.mesh.bounds.grow(glm::dvec3(position));
    for (const glm::vec3& position : built.mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(position[axis])) fail(place, "its skinned positions are not finite");
    return anchor;
}

}  // namespace sightline::tools::gltf
