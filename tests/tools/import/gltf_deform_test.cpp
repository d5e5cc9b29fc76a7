// The bounds of skinned and morphed meshes hold for every pose.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "gltf_reading.h"
#include "sightline/base/random.h"

namespace sightline::test {
using namespace tools;
namespace {

void expectBox(const Box3d& box, const glm::dvec3& min, const glm::dvec3& max) {
    expectNear(box.min, min, 1e-3, "min");
    expectNear(box.max, max, 1e-3, "max");
}

TEST(GltfDeform, PosesASkinAtRestWithoutItsNode) {
    const Scene scene = loadSample("skin.glb");
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].key, 2u);
    EXPECT_EQ(scene.objects[0].name, "body");
    EXPECT_TRUE(scene.meshes[0].deforms);
    expectCorners(cornersOf(scene, 0), {{0, 10, 0}, {5, 10, 0}, {2, 11, 0}});
}

// Vertex 1 is 3 from the elbow, which is 2 from the root joint; vertex 2 is nearer.
TEST(GltfDeform, BoundsASkinByItsStretchedChain) {
    expectBox(boundsOf(loadSample("skin.glb"), 0), {-5, 5, -5}, {5, 15, 5});
}

// The elbow's places span a box whose far corner is (2, 4, 0), and it grows to twice its size: 2 * 3 beyond that.
TEST(GltfDeform, CountsAnimatedTranslationsAndScales) {
    const double reach = std::sqrt(20.0) + 6;
    expectBox(boundsOf(loadSample("skin_animated.glb"), 0), glm::dvec3(0, 10, 0) - reach, glm::dvec3(0, 10, 0) + reach);
}

TEST(GltfDeform, KeepsASkinnedAndAPlainUseApart) {
    const Scene scene = loadSample("skin_and_plain.glb");
    ASSERT_EQ(scene.objects.size(), 2u);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_NE(scene.objects[0].mesh, scene.objects[1].mesh);
    EXPECT_TRUE(scene.meshes[scene.objects[0].mesh].deforms);
    EXPECT_FALSE(scene.meshes[scene.objects[1].mesh].deforms);
    expectCorners(cornersOf(scene, 1), {{50, 0, 0}, {55, 0, 0}, {52, 1, 0}});
}

// Weight 0 is 0.5 at rest; both go from 0 to 1.
TEST(GltfDeform, BoundsMorphTargets) {
    const Scene scene = loadSample("morph.glb");
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_TRUE(scene.meshes[0].deforms);
    expectCorners(cornersOf(scene, 0), {{10, 0, 1}, {11, 0, 1}, {10, 1, 1}});
    expectBox(boundsOf(scene, 0), {7, 0, 0}, {11, 1, 2});
}

// Weight 0 goes up to 3, weight 1 from -1 to 1.
TEST(GltfDeform, CountsAnimatedWeights) {
    expectBox(boundsOf(loadSample("morph_animated.glb"), 0), {7, 0, 0}, {15, 1, 6});
}

// The curve of weight 0 passes 1 by no more than 4 / 27 * (27 + 27); it does reach about 7.
TEST(GltfDeform, CountsTheOvershootOfSplines) {
    const Box3d box = boundsOf(loadSample("morph_spline.glb"), 0);
    double highest = 0;
    for (double t = 0; t <= 1; t += 0x1p-10) {
        const double t2 = t * t, t3 = t2 * t;
        highest = std::max(highest, (t3 - 2 * t2 + t) * 27 + (-2 * t3 + 3 * t2) * 1 + (t3 - t2) * -27);
    }
    EXPECT_GT(highest, 6.0);
    EXPECT_GE(box.max.z, 2 * highest);
    EXPECT_LE(box.max.z, 2 * 9.01);
}

// A random skeleton: each joint hangs from an earlier one.
struct Skeleton {
    struct Joint {
        int parent = -1;
        glm::dvec3 translation;
        double scale = 1;
    };
    std::vector<Joint> joints;
    std::vector<glm::vec3> positions;
    std::vector<uint8_t> owners;  // of joints, 4 a vertex
    std::vector<float> weights;   // 4 a vertex
    std::vector<glm::dmat4> binds;
};

glm::dmat4 randomRotation(Random& random) {
    const glm::dvec3 axis = glm::normalize(
        glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) + glm::dvec3(1e-3, 0, 0));
    const double angle = random.uniform(-4, 4), c = std::cos(angle), s = std::sin(angle);
    glm::dmat4 out(1.0);
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 e(0.0);
        e[i] = 1;
        out[i] = glm::dvec4(e * c + glm::cross(axis, e) * s + axis * glm::dot(axis, e) * (1 - c), 0.0);
    }
    return out;
}

Skeleton randomSkeleton(Random& random) {
    Skeleton out;
    const auto vector = [&](double size) {
        return glm::dvec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    };
    const size_t count = 1 + random.below(5);
    for (size_t j = 0; j < count; ++j) {
        out.joints.push_back({j == 0 ? -1 : int(random.below(j)), vector(3), random.uniform(0.5, 1.5)});
        glm::dmat4 bind(1.0);
        bind[3] = glm::dvec4(vector(2), 1.0);
        out.binds.push_back(glm::dmat4(glm::mat4(randomRotation(random) * bind)));
    }
    for (int v = 0; v < 9; ++v) {
        out.positions.push_back(glm::vec3(vector(2)));
        const uint8_t first = uint8_t(random.below(count)), second = uint8_t(random.below(count));
        const float share = float(random.uniform());
        out.owners.insert(out.owners.end(), {first, second, 0, 0});
        out.weights.insert(out.weights.end(), {share, 1 - share, 0, 0});
    }
    return out;
}

std::string fileOf(const Skeleton& skeleton) {
    GltfBuilder b;
    std::vector<float> positions, binds;
    for (const glm::vec3& p : skeleton.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
    for (const glm::dmat4& bind : skeleton.binds)
        for (int i = 0; i < 16; ++i) binds.push_back(float(bind[i / 4][i % 4]));
    const Json attributes = {{"POSITION", b.accessor("VEC3", positions)},
                             {"JOINTS_0", b.accessor("VEC4", skeleton.owners)},
                             {"WEIGHTS_0", b.accessor("VEC4", skeleton.weights)}};
    const uint32_t mesh = b.mesh(0, -1, {{"attributes", attributes}});
    Json joints = Json::array();
    for (size_t j = 0; j < skeleton.joints.size(); ++j) {
        const Skeleton::Joint& joint = skeleton.joints[j];
        const glm::dvec3 t = joint.translation;
        b.node({{"translation", {t.x, t.y, t.z}}, {"scale", {joint.scale, joint.scale, joint.scale}}});
        joints.push_back(j);
        if (joint.parent >= 0) b.json["nodes"][size_t(joint.parent)]["children"].push_back(j);
    }
    b.add("skins", {{"joints", joints}, {"inverseBindMatrices", b.accessor("MAT4", binds)}});
    b.node({{"mesh", mesh}, {"skin", 0}});
    return b.glb();
}

TEST(GltfDeform, BoundsHoldForRandomPoses) {
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Skeleton skeleton = randomSkeleton(random);
        const Scene scene = load(fileOf(skeleton));
        ASSERT_EQ(scene.objects.size(), 1u);
        const Box3d box = boundsOf(scene, 0);
        for (int pose = 0; pose < 20; ++pose) {
            std::vector<glm::dmat4> world;
            for (const Skeleton::Joint& joint : skeleton.joints) {
                glm::dmat4 local = randomRotation(random);
                for (int column = 0; column < 3; ++column) local[column] *= joint.scale;
                local[3] = glm::dvec4(joint.translation, 1.0);
                world.push_back(joint.parent < 0 ? local : world[size_t(joint.parent)] * local);
            }
            for (size_t v = 0; v < skeleton.positions.size(); ++v) {
                glm::dvec3 posed(0.0);
                for (size_t k = 0; k < 2; ++k) {
                    const size_t j = skeleton.owners[4 * v + k];
                    posed += double(skeleton.weights[4 * v + k]) *
                             glm::dvec3(world[j] * skeleton.binds[j] * glm::dvec4(skeleton.positions[v], 1));
                }
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_TRUE(posed[axis] >= box.min[axis] && posed[axis] <= box.max[axis]) << "vertex " << v;
            }
        }
    }
}

}  // namespace
}  // namespace sightline::test
