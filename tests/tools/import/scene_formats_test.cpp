// The same boxes in every format are the same scene: triangles, sides, names and tree.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/core.h>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "foreign_files.h"
#include "foreign_reading.h"
#include "gltf_builder.h"
#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

using SceneFormats = SceneFiles;

/// Triangles in the world, each from its smallest corner on, rounded to micrometres, sorted.
using Corners = std::array<std::array<long, 3>, 3>;

std::vector<Corners> worldTriangles(const Scene& scene, bool oriented = true) {
    std::vector<Corners> out;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        for (size_t t = 0; t < mesh.triangles(); ++t) {
            Corners corners;
            for (size_t c = 0; c < 3; ++c) {
                const glm::dvec4 p =
                    object.transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * t + c]]), 1);
                for (int axis = 0; axis < 3; ++axis) corners[c][axis] = std::lround(p[axis] * 1e6);
            }
            if (oriented) std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
            else std::sort(corners.begin(), corners.end());
            out.push_back(corners);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<std::string> paths(const Scene& scene) {
    std::vector<std::string> out;
    for (const SceneObject& object : scene.objects) out.push_back(objectPath(scene, object));
    return out;
}

size_t corners(const Scene& scene) {
    size_t out = 0;
    for (const Mesh& mesh : scene.meshes) out += mesh.positions.size();
    return out;
}

[[maybe_unused]] double area(const Scene& scene) {
    double out = 0;
    for (const Corners& t : worldTriangles(scene)) {
        const auto at = [&](int c) { return glm::dvec3(t[c][0], t[c][1], t[c][2]) * 1e-6; };
        out += 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    }
    return out;
}

TEST_F(SceneFormats, AllGiveTheSceneThatGltfGives) {
    const std::vector<Surface> boxes = twoBoxes();
    const Result<Scene> expected = load(write("boxes.glb", glbBytes(boxes)));
    ASSERT_TRUE(expected.ok()) << expected.error().message;
    ASSERT_EQ(worldTriangles(*expected).size(), 24u);
#ifndef SIGHTLINE_IMPORT_PROGRAM
    GTEST_SKIP() << "this build has no Assimp";
#endif
    for (const ForeignFile& file : foreignFiles(boxes)) {
        SCOPED_TRACE(file.name);
        const Result<Scene> scene = load(write(file.name, file.bytes));
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        EXPECT_EQ(sceneFault(*scene), "");
        EXPECT_EQ(worldTriangles(*scene), worldTriangles(*expected));
        EXPECT_EQ(corners(*scene), 16u) << "corners are shared";
        ASSERT_FALSE(scene->materials.empty());
        for (const Material& material : scene->materials) {
            EXPECT_EQ(material.double_sided, !file.single_sided);
            EXPECT_TRUE(material.hides());
        }
        for (uint64_t i = 0; i < scene->objects.size(); ++i) EXPECT_EQ(scene->objects[i].key, i);
        ASSERT_EQ(scene->files.size(), 1u);
        EXPECT_EQ(scene->files[0].name, path(file.name));
        if (!file.objects) continue;
        ASSERT_EQ(scene->objects.size(), 2u);
        EXPECT_TRUE(paths(*scene)[0].ends_with("Large")) << paths(*scene)[0];
        EXPECT_TRUE(paths(*scene)[1].ends_with("Small")) << paths(*scene)[1];
    }
}

#ifdef SIGHTLINE_IMPORT_PROGRAM

/// A triangle on two bones: the first at (0, 2, 0), the second 3 above it.
std::string skinnedX() {
    const auto matrix = [](double y) {
        return "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0," + std::to_string(y) + ",0.0,1.0;;";
    };
    return "xof 0303txt 0032\nFrame Root {\n Frame Bone1 {\n  FrameTransformMatrix { " + matrix(2) +
           " }\n  Frame Bone2 {\n   FrameTransformMatrix { " + matrix(3) +
           " }\n  }\n }\n Mesh Skin {\n  3;\n  0.0;2.0;0.0;,\n  0.0;5.0;0.0;,\n  0.0;6.0;1.0;;\n  1;\n  3;0,1,2;;\n"
           "  XSkinMeshHeader { 1; 1; 2; }\n  SkinWeights { \"Bone1\"; 1; 0; 1.0; " +
           matrix(-2) + " }\n  SkinWeights { \"Bone2\"; 2; 1,2; 1.0,1.0; " + matrix(-5) + " }\n }\n}\n";
}

TEST_F(SceneFormats, BoundsOfSkinsHoldForEveryPose) {
    const Result<Scene> scene = load(write("skin.x", skinnedX()));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(sceneFault(*scene), "");
    ASSERT_EQ(scene->objects.size(), 1u);
    EXPECT_TRUE(scene->meshes[0].deforms);
    const Box3d bounds = worldBounds(*scene);
    // The second bone turns about the first, 3 away; its farthest vertex is the root of 2 away from it.
    const double reach = 3 + std::sqrt(2.0);
    EXPECT_LT(glm::length(bounds.min - glm::dvec3(-reach, 2 - reach, -reach)), 1e-5);
    EXPECT_LT(glm::length(bounds.max - glm::dvec3(reach, 2 + reach, reach)), 1e-5);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const auto turn = [&] {
            glm::dvec4 q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            q = glm::normalize(q);
            return glm::dmat3(glm::dquat(q.w, q.x, q.y, q.z));
        };
        const glm::dmat3 first = turn(), second = turn();
        const glm::dvec3 elbow = glm::dvec3(0, 2, 0) + first * glm::dvec3(0, 3, 0);
        const glm::dvec3 tip = elbow + first * (second * glm::dvec3(0, 1, -1));
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(tip[axis], bounds.min[axis]);
            EXPECT_LE(tip[axis], bounds.max[axis]);
        }
    }
}

TEST_F(SceneFormats, ABoneWithoutANodeIsAnError) {
    std::string text = skinnedX();
    text.replace(text.find("Frame Bone2"), 11, "Frame Other");
    expectRefused(write("skin.x", text), "mesh 'Root': bone 'Bone2' is no node, so that its poses have no bounds");
}

TEST_F(SceneFormats, MaterialsOfAnObjSayWhatMayHide) {
    write("clear.png", std::string("\x89PNG\r\n\x1a\n", 8));  // no picture that could be looked at
    write("m.mtl",
          "newmtl wall\nKd 0.25 0.5 1\nnewmtl glass\nd 0.4\nnewmtl leaf\nmap_Kd clear.png\nnewmtl brick\nmap_Kd b.jpg\n"
          "newmtl cut\nmap_d holes.jpg\n");
    std::string text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const char* name : {"wall", "glass", "leaf", "brick", "cut"})
        text += std::string("o ") + name + "\nusemtl " + name + "\nf 1 2 3\n";
    std::string noted;
    settings_.note = [&](const std::string& words) { noted += words + "\n"; };
    const Result<Scene> scene = load(write("m.obj", text));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    // Only where it changes what hides: a JPEG has no alpha, and what is cut out by a picture hides nothing anyway.
    EXPECT_NE(noted.find("1 texture could not be read, so that what shows it hides nothing: clear.png"),
              std::string::npos)
        << noted;
    EXPECT_EQ(noted.find(".jpg"), std::string::npos) << noted;
    std::map<std::string, Material> materials;
    for (const Material& material : scene->materials) materials[material.name] = material;
    EXPECT_TRUE(materials["wall"].hides());
    EXPECT_EQ(glm::vec3(materials["wall"].base_color), glm::vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(materials["glass"].alpha_mode, AlphaMode::kBlend);
    EXPECT_EQ(materials["leaf"].alpha_mode, AlphaMode::kMask);
    EXPECT_TRUE(materials["brick"].hides());
    EXPECT_EQ(materials["cut"].alpha_mode, AlphaMode::kBlend);
    EXPECT_EQ(scene->objects.size(), 5u);
}

TEST_F(SceneFormats, FacesOfAnObjNeedTheirPositionsAlone) {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    const Result<Scene> plain = load(write("plain.obj", points + "f 1 2 3\nf 2 4 3\n"));
    ASSERT_TRUE(plain.ok()) << plain.error().message;
    ASSERT_EQ(worldTriangles(*plain).size(), 2u);
    const std::string normal = "vn 0 0 1\n", place = "vt 0 0\n";
    for (const std::string& faces :
         {std::string("f 1/1 2/2 3/3\nf 2/2 4/4 3/3\n"), std::string("f 1/1/1 2/2/2 3/3/3\nf 2/2/2 4/4/4 3/3/3\n"),
          std::string("f 1//9 2//9 3//9\nf 2//9 4//9 3//9\n"), normal + "f 1/1/1 2/2/1 3/3/1\nf 2/2/1 4/4/1 3/3/1\n",
          normal + "f 1//1 2//1 3//1\nf 2/7 4/7 3/7\n", place + "f 1/1 2/1 3/2\nf 2/1 4/1 3/1\n",
          place + "f 1/1/5 2/1/5 3/1/5\nf 2/1/5 4/1/5 3/1/5\n",
          std::string("f -4/-1 -3/-1 -2/-1\nf -3/-9 -1/-9 -2/-9\n"),
          std::string("f\t1/1\t2/1\t3/1\n\t f 2/1 4/1 3/1\n"), std::string("f 1/1 2/1 3/1 # a / b\nf 2/1 4/1 3/1\n"),
          std::string("f 1/1 \\\n2/2 3/3\nf 2/2 4/4 \\\n3/3\n"), std::string("f 1/1 2/1 3/1\r\nf 2/1 4/1 3/1\r\n"),
          std::string("f 1/ 2/ 3/\nf 2// 4// 3//\n"), std::string("f 1/1/1 2/2/2 3/3/3\nf 2/2/2 4/4/4 3/3/3")}) {
        SCOPED_TRACE(faces);
        const Result<Scene> scene = load(write("faces.obj", points + faces));
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        EXPECT_EQ(worldTriangles(*scene), worldTriangles(*plain));
    }
    // Names, materials and remarks may have slashes.
    const Result<Scene> named = load(write("named.obj", points + "o a/b\n# f 1/2\nusemtl x/y\nf 1/1 2/1 3/1\n"));
    ASSERT_TRUE(named.ok()) << named.error().message;
    EXPECT_TRUE(paths(*named)[0].ends_with("a/b")) << paths(*named)[0];
}

// What stands still at its key, as exporters write of every node, may hide.
TEST_F(SceneFormats, WhatAnAnimationMovesIsKnown) {
    const auto changesOf = [&](const std::string& keys, const std::string& of) {
        const std::string mesh = "Mesh { 3; 0.0;0.0;0.0;, 1.0;0.0;0.0;, 0.0;1.0;0.0;; 1; 3;0,1,2;; }\n";
        const auto frame = [&](const std::string& name, const std::string& below) {
            return "Frame " + name +
                   " { FrameTransformMatrix { 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,2.0,0.0,0.0,1.0;; }\n" +
                   mesh + below + "}\n";
        };
        const std::string animation =
            keys.empty() ? "" : "AnimationSet Open { Animation { {" + of + "} " + keys + " } }\n";
        const Result<Scene> scene = load(
            write("door.x", "xof 0303txt 0032\n" + frame("Wall", "") + frame("Door", frame("Knob", "")) + animation));
        EXPECT_TRUE(scene.ok()) << scene.error().message;
        std::string out;
        for (size_t i = 0; scene.ok() && i < scene->objects.size(); ++i)
            if (scene->objects[i].changes == SceneObject::kAnimated) out += scene->objects[i].name + " ";
        return out;
    };
    const auto places = [](double first, double second) {
        return fmt::format("AnimationKey {{ 2; 2; 0;3;{:f},0.0,0.0;;, 10;3;{:f},0.0,0.0;;; }}", first, second);
    };
    const std::string turn = "AnimationKey { 0; 1; 0;4;1.0,0.0,0.0,0.0;;; } ";
    const std::string size = "AnimationKey { 1; 1; 0;3;1.0,1.0,1.0;;; } ";
    EXPECT_EQ(changesOf("", ""), "");
    EXPECT_EQ(changesOf(turn + size + places(2, 3), "Door"), "Door Knob ");
    EXPECT_EQ(changesOf(turn + size + places(2, 3), "Knob"), "Knob ");
    EXPECT_EQ(changesOf(turn + size + places(2, 2), "Door"), "") << "it stands where it stands";
    EXPECT_EQ(changesOf(turn + size + places(5, 5), "Door"), "Door Knob ") << "it stands elsewhere";
}

// At 5,400 km, as maps of countries have it, a float has steps of half a metre, and of centimetres it has steps of 64.
TEST_F(SceneFormats, WhatFloatsLoseIsNoted) {
    std::vector<Surface> boxes = twoBoxes();
    const auto noteOf = [&](const std::string& name, const std::string& bytes) {
        std::string noted;
        settings_.note = [&](const std::string& words) { noted += words; };
        EXPECT_TRUE(load(write(name, bytes)).ok());
        return noted;
    };
    for (const bool far : {false, true}) {
        if (far)
            for (Surface& surface : boxes)
                for (glm::vec3& position : surface.positions) position.x += 5.4e6f;
        for (const std::string& noted : {noteOf("a.obj", objText(boxes)), noteOf("a.fbx", fbxText(boxes))})
            EXPECT_EQ(noted.find("points may be off by up to 322 mm: coordinates reach 5400 km") != std::string::npos,
                      far)
                << noted;
    }
}

TEST_F(SceneFormats, AMissingMaterialFileIsNoted) {
    std::string noted;
    settings_.note = [&](const std::string& text) { noted += text; };
    const std::string file = write("m.obj", "mtllib gone.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_TRUE(load(file).ok());
    EXPECT_TRUE(noted.starts_with(file + ": ")) << noted;
    EXPECT_NE(noted.find("gone.mtl"), std::string::npos) << noted;
}

TEST_F(SceneFormats, ConcavePolygonsKeepTheirShape) {
    // A comb: fans would cover its gaps, and would hide what is seen through them.
    std::string text, face = "f";
    const std::vector<glm::vec2> comb = {{0, 0}, {7, 0}, {7, 5}, {6, 5}, {6, 1}, {4, 1},
                                         {4, 5}, {3, 5}, {3, 1}, {1, 1}, {1, 5}, {0, 5}};
    for (size_t i = 0; i < comb.size(); ++i) {
        text += "v " + std::to_string(comb[i].x) + " " + std::to_string(comb[i].y) + " 0.5\n";
        face += " " + std::to_string(i + 1);
    }
    for (const bool reversed : {false, true}) {
        if (reversed) {
            face = "f";
            for (size_t i = comb.size(); i-- > 0;) face += " " + std::to_string(i + 1);
        }
        const Result<Scene> scene = load(write("comb.obj", text + face + "\n"));
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        EXPECT_EQ(scene->meshes[0].triangles(), comb.size() - 2);
        EXPECT_NEAR(area(*scene), 7 + 3 * 4, 1e-9);
        for (const Corners& t : worldTriangles(*scene)) {
            const glm::dvec2 a(t[0][0], t[0][1]), b(t[1][0], t[1][1]), c(t[2][0], t[2][1]);
            const double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            EXPECT_GE(reversed ? -turn : turn, 0);
            const glm::dvec2 middle = (a + b + c) / 3e6;
            const bool gap = middle.y > 1 && ((middle.x > 1 && middle.x < 3) || (middle.x > 4 && middle.x < 6));
            EXPECT_FALSE(gap) << middle.x << " " << middle.y;
        }
    }
}

TEST_F(SceneFormats, NearAndThinThingsStayAsTheyAre) {
    // Closer than what Assimp's own joining takes for the same, and a triangle without area.
    const Result<Scene> scene = load(
        write("fine.obj", "v 0 0 0\nv 0.000001 0 0\nv 0 0.000001 0\nv 0 0 0\nv -0 0 0\nf 1 2 3\nf 1 2 2\nf 4 3 5\n"));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->meshes[0].triangles(), 3u);
    EXPECT_EQ(scene->meshes[0].positions.size(), 3u);
}

TEST_F(SceneFormats, PositionsThatAreNotFiniteNameTheMesh) {
    expectRefused(write("nan.ply",
                        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                        "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\nnan 0 "
                        "0\n0 1 0\n3 0 1 2\n"),
                  "not finite");
    expectRefused(write("far.obj", "o Far\nv 0 0 0\nv 1e60 0 0\nv 0 1 0\nf 1 2 3\n"), "'Far'");
}

TEST_F(SceneFormats, CloudsOfPointsDrawNothing) {
    expectRefused(write("cloud.ply",
                        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
                        "float z\nend_header\n0 0 0\n1 0 0\n"),
                  "");
    expectRefused(write("cloud.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n"), "");
}

TEST_F(SceneFormats, ColladaSharesMeshesAndPlacesNodes) {
    std::string text = daeText({twoBoxes()[0]});
    const std::string node = "<node id=\"Large\" name=\"Large\">";
    const size_t at = text.find(node), end = text.find("</node>", at) + 7;
    std::string second = text.substr(at, end - at);
    second.replace(0, node.size(), "<node id=\"Again\" name=\"Again\"><translate>0 0 1000</translate>");
    text.insert(end, second);
    const Result<Scene> scene = load(write("two.dae", text));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 2u);
    EXPECT_EQ(scene->meshes.size(), 1u);
    EXPECT_EQ(paths(*scene), (std::vector<std::string>{"House/Large", "House/Again"}));
    EXPECT_NEAR(scene->objects[1].transform[3].y - scene->objects[0].transform[3].y, 10, 1e-5);
}

TEST_F(SceneFormats, UpUnitAndSidesHoldForAllOfAScene) {
    const std::string file = write("boxes.obj", objText(twoBoxes()));
    settings_.up = UpAxis::kZ;
    settings_.scale = 0.5;
    settings_.sides = Sides::kOne;
    const Result<Scene> scene = load(file);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const Box3d bounds = worldBounds(*scene);  // from -7 0.25 -3 to 5 4.5 10: z becomes y, y becomes -z
    EXPECT_LT(glm::length(bounds.min - glm::dvec3(-3.5, -1.5, -2.25)), 1e-9);
    EXPECT_LT(glm::length(bounds.max - glm::dvec3(2.5, 5, -0.125)), 1e-9);
    EXPECT_FALSE(scene->materials[0].double_sided);
    settings_.up = UpAxis::kX;
    settings_.scale = 1;
    const Result<Scene> turned = load(file);
    ASSERT_TRUE(turned.ok());
    EXPECT_LT(glm::length(worldBounds(*turned).min - glm::dvec3(-4.5, -7, -3)), 1e-9);
    EXPECT_GT(glm::determinant(glm::dmat3(turned->objects[0].transform)), 0);
}

#endif

}  // namespace
}  // namespace sightline
