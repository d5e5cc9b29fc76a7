// Nodes that are marked as cells and portals become those, and are not drawn.
// SPDX-License-Identifier: MIT
#include <cmath>

#include "gltf_reading.h"
#include "sightline/tools/import/scene_file.h"

namespace sightline::test {
using namespace tools;
namespace {

double insideBy(const SceneCell& cell, const glm::dvec3& point) {
    double least = cell.planes.empty() ? -1 : 1e300;
    for (const glm::dvec4& plane : cell.planes) least = std::min(least, glm::dot(glm::dvec3(plane), point) + plane.w);
    return least;
}

glm::dvec3 areaOf(const std::vector<glm::dvec3>& outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += 0.5 * glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return area;
}

/// A text of nodes alone.
std::string nodesOnly(const Json& nodes) { return Json{{"asset", {{"version", "2.0"}}}, {"nodes", nodes}}.dump(); }

Json box(const std::string& kind, const std::string& name, const Json& ends, const Json& more = Json::object()) {
    Json mark = {{kind, name}, {"box", ends}};
    mark.update(more);
    return {{"extras", {{"sightline", mark}}}};
}

TEST(GltfCells, ReadsMeshesAndBoxesAsCells) {
    const Scene scene = loadSample("cells.glb");
    ASSERT_EQ(scene.objects.size(), 1u) << "marks are not drawn";
    EXPECT_EQ(scene.objects[0].key, 0u);
    ASSERT_EQ(scene.cells.size(), 2u);
    EXPECT_EQ(scene.cells[0].name, "kitchen");
    EXPECT_EQ(scene.cells[0].planes.size(), 6u);
    EXPECT_NEAR(scene.cells[0].overhang, 0, 1e-6);
    EXPECT_NEAR(insideBy(scene.cells[0], {12, 1.5, 2}), 1.5, 1e-6) << "whichever way its faces are wound";
    EXPECT_EQ(scene.cells[1].name, "hall");
    EXPECT_NEAR(insideBy(scene.cells[1], {16, 1.5, 2}), 1.5, 1e-12);
    expectNear(scene.cells[1].bounds.min, {14, 0, 0}, 1e-9, "a corner");
}

TEST(GltfCells, ReadsPortals) {
    const Scene scene = loadSample("cells.glb");
    ASSERT_EQ(scene.portals.size(), 2u);
    const ScenePortal& way = scene.portals[0];
    EXPECT_EQ(way.name, "way");
    EXPECT_EQ(way.cells[0], 1u) << "hall";
    EXPECT_EQ(way.cells[1], 0u) << "kitchen";
    EXPECT_EQ(way.polygon.size(), 4u) << "the hull of six corners";
    expectNear(areaOf(way.polygon), {2, 0, 0}, 1e-9, "the area, towards the hall,");
    EXPECT_EQ(way.door, 0u);
    expectNear(way.slide, {0, 0, 1}, 0, "the slide");
    const ScenePortal& window = scene.portals[1];
    EXPECT_EQ(window.name, "window");
    const glm::dvec3 towards = areaOf(window.polygon);
    EXPECT_EQ(window.cells[0], towards.x > 0 ? 1u : 0u) << "it lies between them";
    EXPECT_EQ(window.cells[1], towards.x > 0 ? 0u : 1u);
    EXPECT_EQ(window.door, ScenePortal::kNone);
}

TEST(GltfCells, AFileMayHoldNothingElse) {
    const Scene scene =
        load(nodesOnly({box("cell", "a", {{0, 0, 0}, {1, 1, 1}}), box("cell", "b", {{1, 0, 0}, {2, 1, 1}}),
                        box("portal", "p", {{1, 0.25, 0.25}, {1, 0.75, 0.75}})}));
    EXPECT_TRUE(scene.objects.empty());
    EXPECT_EQ(scene.cells.size(), 2u);
    ASSERT_EQ(scene.portals.size(), 1u);
    EXPECT_EQ(scene.portals[0].cells[0] + scene.portals[0].cells[1], 1u);
}

// Modellers name the copies of what is called "cell" so.
TEST(GltfCells, LeavesOtherNamesAlone) {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    for (const char* name : {"cell", "cell.001", "cellar.door", "cell_phone", "Cell.x", "portal", "cell."})
        b.node({{"name", name}, {"mesh", mesh}});
    const Scene scene = load(b.glb());
    EXPECT_EQ(scene.objects.size(), 7u);
    EXPECT_TRUE(scene.cells.empty());
}

TEST(GltfCells, MarksCountWhereNodesAreHidden) {
    GltfBuilder b = GltfBuilder::triangle();
    Json hidden = box("cell", "a", {{0, 0, 0}, {1, 1, 1}});
    hidden["extensions"]["KHR_node_visibility"]["visible"] = false;
    b.node(hidden);
    EXPECT_EQ(load(b.glb()).cells.size(), 1u);
}

TEST(GltfCells, TurnsBoxesWithTheirNodes) {
    Json turned = box("cell", "a", {{-1, -1, -1}, {1, 1, 1}});
    turned["rotation"] = {0, 0, std::sin(M_PI / 8), std::cos(M_PI / 8)};
    turned["translation"] = {100, 0, 0};
    turned["scale"] = {2, 1, -1};
    const Scene scene = load(nodesOnly(Json::array({turned})));
    ASSERT_EQ(scene.cells.size(), 1u);
    const double d = std::sqrt(0.5);
    EXPECT_NEAR(insideBy(scene.cells[0], {100 + 2 * d, 2 * d, 0}), 0, 1e-12) << "on the far face";
    EXPECT_NEAR(insideBy(scene.cells[0], {100, 0, 0}), 1, 1e-12);
}

TEST(GltfCells, WhatIsNoCellIsNotLost) {
    GltfBuilder b;
    b.node({{"name", "cell.flat"}, {"mesh", b.triangleMesh()}});
    b.node({{"name", "cell.nothing"}});
    b.node(box("cell", "thin", {{0, 0, 0}, {1, 0, 1}}));
    // A tetrahedron and a point beyond one of its faces.
    const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, -1});
    const uint32_t indices =
        b.accessor<uint16_t>("SCALAR", {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 1, 4, 0, 2, 4, 0, 3, 4});
    b.node({{"name", "cell.hollow"}, {"mesh", b.mesh(positions, int(indices))}});
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.cells.size(), 4u);
    for (const SceneCell& cell : scene.cells) EXPECT_GT(cell.overhang, 0.5) << cell.name;
    EXPECT_TRUE(scene.objects.empty());
}

TEST(GltfCells, PortalsOfOneFileJoinCellsOfAnother) {
    Scene cells = load(nodesOnly({box("cell", "a", {{0, 0, 0}, {1, 1, 1}}), box("cell", "b", {{1, 0, 0}, {2, 1, 1}})}));
    const Json ends = {{1, 0.25, 0.25}, {1, 0.75, 0.75}};
    Scene portals = load(nodesOnly({box("portal", "by place", ends),
                                    box("portal", "by name", ends, {{"cells", {"b", "a"}}, {"door", "leaf"}}),
                                    box("portal", "unknown", ends, {{"cells", {"b", "c"}}})}));
    EXPECT_EQ(portals.portals[0].cells[0], ScenePortal::kNone);
    GltfBuilder b;
    b.node({{"name", "leaf"}, {"mesh", b.triangleMesh()}});
    const Scene joined = joinScenes({load(gltfSample("list.glb")), portals, cells, load(b.glb())});
    EXPECT_EQ(sceneFault(joined), "");
    ASSERT_EQ(joined.portals.size(), 3u);
    EXPECT_EQ(joined.portals[0].cells[0] + joined.portals[0].cells[1], 1u);
    EXPECT_EQ(joined.portals[1].cells[0], 1u);
    EXPECT_EQ(joined.portals[1].cells[1], 0u);
    EXPECT_GT(areaOf(joined.portals[1].polygon).x, 0) << "seen from b";
    ASSERT_LT(joined.portals[1].door, joined.objects.size());
    EXPECT_EQ(joined.objects[joined.portals[1].door].name, "leaf");
    EXPECT_EQ(joined.portals[2].cells[1], ScenePortal::kNone);
}

TEST(GltfCells, MarksThatMeanNothingAreErrors) {
    const auto expectFault = [](const Json& mark, const std::string& message) {
        const Result<Scene> scene = parse(nodesOnly(Json::array({{{"extras", {{"sightline", mark}}}}})));
        ASSERT_FALSE(scene.ok()) << mark;
        EXPECT_EQ(scene.error().message, "test.glb: nodes[0].extras.sightline: " + message);
    };
    expectFault(3, "is not an object");
    expectFault({{"room", "a"}}, "is neither a cell nor a portal, or both");
    expectFault({{"cell", 3}}, "cell is not a string");
    expectFault({{"cell", "a"}, {"box", {1, 2}}}, "box is not 3 numbers");
    expectFault({{"cell", "a"}, {"box", {1, 2, 3}}}, "box is not two corners");
    expectFault({{"portal", "a"}, {"cells", {"a"}}}, "cells are not two names");
    expectFault({{"portal", "a"}, {"cells", {"a", 1}}}, "cells are not two names");
    expectFault({{"portal", "a"}, {"door", 7}}, "door 7 is out of range of 1");
    expectFault({{"portal", "a"}, {"slide", {1, 2}}}, "slide is not 3 numbers");
}

}  // namespace
}  // namespace sightline::test
