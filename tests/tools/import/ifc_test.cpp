// IFC: what exporters really write is read as it is meant.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "ifc_reading.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

#ifdef SIGHTLINE_IMPORT_PROGRAM

Box3d boundsOf(const Scene& scene, size_t object) {
    Box3d out;
    const Mesh& mesh = scene.meshes[scene.objects[object].mesh];
    for (const glm::vec3& p : mesh.positions)
        out.grow(glm::dvec3(scene.objects[object].transform * glm::dvec4(glm::dvec3(p), 1)));
    return out;
}

void expectBox(const Scene& scene, size_t object, const glm::dvec3& min, const glm::dvec3& max, double slack = 1e-6) {
    ASSERT_LT(object, scene.objects.size());
    const Box3d box = boundsOf(scene, object);
    EXPECT_LT(glm::length(box.min - min), slack) << box.min.x << " " << box.min.y << " " << box.min.z;
    EXPECT_LT(glm::length(box.max - max), slack) << box.max.x << " " << box.max.y << " " << box.max.z;
}

/// How many triangles of hiding materials a line along an axis of the world meets, inside of them.
int covered(const Scene& scene, int axis, const glm::dvec3& at) {
    int out = 0;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        for (const Primitive& part : mesh.primitives) {
            if (!scene.materials[part.material].hides()) continue;
            for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
                glm::dvec2 flat[3];
                for (int c = 0; c < 3; ++c) {
                    const glm::dvec3 p(object.transform *
                                       glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * t + c]]), 1));
                    flat[c] = {p[(axis + 1) % 3] - at[(axis + 1) % 3], p[(axis + 2) % 3] - at[(axis + 2) % 3]};
                }
                const auto side = [&](int a, int b) { return flat[a].x * flat[b].y - flat[a].y * flat[b].x; };
                const double sides[3] = {side(0, 1), side(1, 2), side(2, 0)};
                out += (sides[0] > 0 && sides[1] > 0 && sides[2] > 0) || (sides[0] < 0 && sides[1] < 0 && sides[2] < 0);
            }
        }
    }
    return out;
}

std::vector<std::string> pathsOf(const Scene& scene) {
    std::vector<std::string> out;
    for (const SceneObject& object : scene.objects) out.push_back(objectPath(scene, object));
    return out;
}

std::string sharedCase(const std::string& name) {
    std::ifstream file(std::string(SIGHTLINE_SHARED_DIR) + "/cases/" + name, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

#define SIGHTLINE_NEEDS_CASE(name) \
    if (sharedCase(name).empty()) GTEST_SKIP() << "cases/" << name << " is not beside the repository"

TEST_F(Ifc, CaseOfACommentBetweenStatements) {
    SIGHTLINE_NEEDS_CASE("ifc-comment/comment.ifc");
    const Scene plain = read(sharedCase("ifc-comment/plain.ifc")), scene = read(sharedCase("ifc-comment/comment.ifc"));
    ASSERT_EQ(scene.objects.size(), plain.objects.size());
    EXPECT_EQ(scene.meshes[0].positions, plain.meshes[0].positions);
    EXPECT_EQ(scene.meshes[0].indices, plain.meshes[0].indices);
}

TEST_F(Ifc, CaseOfAnAbsentOwnerHistory) {
    SIGHTLINE_NEEDS_CASE("ifc4-optional-attributes/ownerhistory-absent.ifc");
    EXPECT_EQ(read(sharedCase("ifc4-optional-attributes/ownerhistory-absent.ifc")).meshes[0].triangles(), 4u);
}

TEST_F(Ifc, CaseOfFeet) {
    SIGHTLINE_NEEDS_CASE("ifc-feet/ratio.ifc");
    EXPECT_NEAR(boundsOf(read(sharedCase("ifc-feet/ratio.ifc")), 0).max.x, 3.048, 1e-6);
}

TEST_F(Ifc, CaseOfAnOpeningInABrep) {
    SIGHTLINE_NEEDS_CASE("ifc-brep-opening/ifc_brep_0_brep.ifc");
    for (const char* name : {"ifc_brep_0_brep.ifc", "ifc_brep_0_extrude.ifc"}) {
        const Scene scene = read(sharedCase(std::string("ifc-brep-opening/") + name));
        ASSERT_EQ(scene.objects.size(), 2u);
        Scene wall = scene;
        wall.objects.erase(wall.objects.begin() + 1);
        EXPECT_EQ(covered(wall, 2, {4.3, 1.5, 0}), 0) << name;
        EXPECT_EQ(covered(wall, 2, {2.3, 1.5, 0}), 2) << name;
    }
}

/// A type of product and its attributes behind the seventh.
struct Type {
    const char *name, *more;
};

TEST_F(Ifc, AllThatMayBeAbsentMay) {
    const std::vector<Type> common = {
        {"IFCBEAM", ""},    {"IFCCOLUMN", ""},   {"IFCCURTAINWALL", ""}, {"IFCMEMBER", ""}, {"IFCPLATE", ""},
        {"IFCRAILING", ""}, {"IFCRAMP", ""},     {"IFCROOF", ""},        {"IFCSLAB", ""},   {"IFCSTAIR", ""},
        {"IFCFOOTING", ""}, {"IFCCOVERING", ""}, {"IFCFLOWTERMINAL", ""}};
    for (const char* schema : {"IFC2X3", "IFC4", "IFC4X3", "IFC4X3_ADD2"}) {
        SCOPED_TRACE(schema);
        IfcFile file(schema);
        const bool old = std::string(schema) == "IFC2X3";
        std::vector<Type> types = common;
        types.push_back({"IFCWALL", old ? ",$" : ",$,$"});
        types.push_back({"IFCDOOR", old ? ",$,$,$" : ",$,$,$,$,$,$"});
        types.push_back({"IFCBUILDINGELEMENTPROXY", ",$,$"});
        types.push_back({"IFCFURNISHINGELEMENT", ",$"});
        double x = 0;
        for (const Type& type : types) {
            const uint32_t item = file.brep({x, 0, 0}, {1, 1, 1});
            // Nothing but its number and its shape.
            file.product(type.name, "", {file.representation({item}, "$")}, *type.more ? type.more : ",$,$");
            x += 2;
        }
        // IFC4 lets solids and profiles stand where they are.
        if (!old) {
            const uint32_t profile = file.add("IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.,1.)");
            file.solid("IFCSLAB", "", file.add(fmt::format("IFCEXTRUDEDAREASOLID(#{},$,#7,1.)", profile)), ",$,$");
        }
        const Scene scene = read(file);
        const size_t count = types.size() + !old;
        EXPECT_EQ(scene.objects.size(), count) << notes_;
        for (const Mesh& mesh : scene.meshes) EXPECT_EQ(mesh.triangles(), 12u);
        expectNoted(fmt::format("read {0} of {0} products", count));
    }
}

/// Puts a comment before each place in DATA and HEADER where a token of STEP may begin.
std::string commented(const std::string& text) {
    const std::string comment = "/* it's; a #1=IFCWALL( ' \" /* note **/";
    std::string out = comment + "\n";
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\'') quoted = !quoted;
        out += c;
        if (!quoted && std::string("(,=;)").find(c) != std::string::npos) out += comment;
    }
    return out;
}

TEST_F(Ifc, CommentsMayStandAnywhere) {
    IfcFile file;
    file.solid("IFCWALL", "it''s (a) /* wall */; #1=", file.extruded({0, 0, 0}, {4, 0.5, 3}));
    file.solid("IFCSLAB", "b", file.triangulated({0, 0, -1}, {4, 4, 0.5}));
    const Scene plain = read(file), scene = read(commented(file.text()));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(pathsOf(scene), pathsOf(plain));
    EXPECT_EQ(pathsOf(scene)[0], "IfcWall it's (a) /* wall */; #1=");
    for (size_t m = 0; m < 2; ++m) {
        EXPECT_EQ(scene.meshes[m].positions, plain.meshes[m].positions);
        EXPECT_EQ(scene.meshes[m].indices, plain.meshes[m].indices);
    }
}

TEST_F(Ifc, TextsMayBeLongAndTypesInSmallLetters) {
    IfcFile file;
    file.solid("IfcWall", "a",
               file.add("IfcFacetedBrep(#" + std::to_string(file.brep({0, 0, 0}, {1, 1, 1}) - 1) + ")"));
    file.add("IFCPERSON($,'" + std::string(70000, 'x') + "',$,$,$,$,$,$)");
    file.solid("IFCWALL", "", file.brep({3, 0, 0}, {1, 1, 1}), ",$,$");
    EXPECT_EQ(read(file).objects.size(), 2u) << notes_;
}

TEST_F(Ifc, UnitsBecomeMetres) {
    struct Unit {
        const char *entity, *more;
        double metres;
    };
    const char* si =
        "#900=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n#901=IFCSIUNIT(*,.LENGTHUNIT.,{},.METRE.);\n"
        "#902=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE({}),#901);\n";
    const std::string foot = fmt::format(fmt::runtime(si), "$", "0.3048"),
                      inch = fmt::format(fmt::runtime(si), ".MILLI.", "25.4"),
                      survey = fmt::format(fmt::runtime(si), "$", "0.304800609601219"),
                      yard = fmt::format(fmt::runtime(si), ".CENTI.", "91.44");
    for (const Unit& unit :
         {Unit{"IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)", "", 1},
          Unit{"IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)", "", 1e-3},
          Unit{"IFCSIUNIT(*,.LENGTHUNIT.,.CENTI.,.METRE.)", "", 1e-2},
          Unit{"IFCSIUNIT(*,.LENGTHUNIT.,.DECI.,.METRE.)", "", 1e-1},
          Unit{"IFCSIUNIT(*,.LENGTHUNIT.,.KILO.,.METRE.)", "", 1e3},
          Unit{"IFCCONVERSIONBASEDUNIT(#900,.LENGTHUNIT.,'FOOT',#902)", foot.c_str(), 0.3048},
          Unit{"IFCCONVERSIONBASEDUNIT(#900,.LENGTHUNIT.,'inch',#902)", inch.c_str(), 0.0254},
          Unit{"IFCCONVERSIONBASEDUNIT(#900,.LENGTHUNIT.,'US SURVEY FOOT',#902)", survey.c_str(), 0.304800609601219},
          Unit{"IFCCONVERSIONBASEDUNIT(#900,.LENGTHUNIT.,'YARD',#902)", yard.c_str(), 0.9144}}) {
        SCOPED_TRACE(unit.entity);
        IfcFile file("IFC4", unit.entity);
        file.product("IFCWALL", "", {file.representation({file.brep({1, 2, 3}, {10, 20, 30})})}, ",$,$",
                     file.place({100, 200, 300}));
        std::string text = file.text();
        text.insert(text.find("#1=IFCPROJECT"), unit.more);
        expectBox(read(text), 0, unit.metres * glm::dvec3(101, 303, -222), unit.metres * glm::dvec3(111, 333, -202),
                  1e-6 * unit.metres * 400);
    }
}

TEST_F(Ifc, AFileWithoutAUnitSaysSo) {
    std::string text = IfcFile("IFC4", "IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.)").text();
    IfcFile file("IFC4", "IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.)");
    file.solid("IFCWALL", "", file.brep({0, 0, 0}, {10, 20, 30}), ",$,$");
    expectBox(read(file), 0, {0, 0, -20}, {10, 30, 0});
    expectNoted("no unit of length: metres are taken");
}

TEST_F(Ifc, OpeningsAreCutOutOfEverySolid) {
    // A wall of 4 x 3 m with a hole of 1 x 1 m from (1.5, 1) on; the world's y is the file's z.
    const glm::dvec3 corner(0, 0, 0), size(4, 0.5, 3), hole(1.5, -1, 1), through(1, 3, 1);
    const auto expectOpen = [&](const IfcFile& file, const char* what) {
        const Scene scene = read(file);
        EXPECT_EQ(covered(scene, 2, {2.1, 1.45, 0}), 0) << what;
        for (const glm::dvec3& p :
             {glm::dvec3(0.7, 1.45, 0), glm::dvec3(3.3, 1.45, 0), glm::dvec3(2.1, 0.55, 0), glm::dvec3(2.1, 2.55, 0)})
            EXPECT_EQ(covered(scene, 2, p), 2) << what;
        expectNoted("cut out of others: 1 IfcOpeningElement");
    };
    using Solid = uint32_t (IfcFile::*)(const glm::dvec3&, const glm::dvec3&);
    for (const auto& [solid, what] : {std::pair<Solid, const char*>{&IfcFile::extruded, "extruded"},
                                      {&IfcFile::brep, "brep"},
                                      {&IfcFile::triangulated, "triangulated"},
                                      {&IfcFile::polygonal, "polygonal"}})
        for (const Solid by : {Solid(&IfcFile::extruded), Solid(&IfcFile::brep)}) {
            IfcFile file;
            const uint32_t wall = file.solid("IFCWALL", "", (file.*solid)(corner, size), ",$,$");
            file.cut(wall, file.solid("IFCOPENINGELEMENT", "", (file.*by)(hole, through), ",$,$"));
            expectOpen(file, what);
        }
    {
        IfcFile file("IFC2X3");  // in layers
        const uint32_t wall = file.solid("IFCWALLSTANDARDCASE", "", file.extruded(corner, size));
        const uint32_t brick = file.add("IFCMATERIAL('Brick')"), wool = file.add("IFCMATERIAL('Wool')");
        const uint32_t outer = file.add(fmt::format("IFCMATERIALLAYER(#{},0.3,$)", brick)),
                       inner = file.add(fmt::format("IFCMATERIALLAYER(#{},0.2,$)", wool));
        const uint32_t layers = file.add(fmt::format("IFCMATERIALLAYERSET((#{},#{}),$)", outer, inner));
        const uint32_t usage = file.add(fmt::format("IFCMATERIALLAYERSETUSAGE(#{},.AXIS2.,.POSITIVE.,0.)", layers));
        file.add(fmt::format("IFCRELASSOCIATESMATERIAL('0000000000000000000099',$,$,$,(#{}),#{})", wall, usage));
        file.cut(wall, file.solid("IFCOPENINGELEMENT", "", file.extruded(hole, through)));
        expectOpen(file, "layers");
    }
    {
        IfcFile file;  // a roof of parts: what is cut of the whole is cut of each
        const uint32_t slab = file.solid("IFCSLAB", "", file.extruded(corner, size), ",$,$");
        const uint32_t roof = file.spatial("IFCROOF", "", ",$,$");
        file.aggregate(roof, {slab});
        file.cut(slab, file.solid("IFCOPENINGELEMENT", "", file.brep(hole, through), ",$,$"));
        expectOpen(file, "roof");
    }
}

TEST_F(Ifc, FarFromTheOriginAMillimetreStaysOne) {
    const double north = 5.4e6, east = 3e5;
    for (const double unit : {1.0, 1e-3}) {
        SCOPED_TRACE(unit);
        IfcFile file("IFC4", unit == 1 ? IfcFile::kMetre : "IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)");
        const auto at = [&](double x, double y, double z) { return glm::dvec3(x, y, z) / unit; };
        double row = 0;
        for (const bool placed : {false, true})
            for (const double gap : {0.1, 0.001}) {
                for (const double x : {0.0, 2 + gap}) {
                    const glm::dvec3 corner = at(east + x, north + row, 0);
                    const uint32_t item = file.brep(placed ? glm::dvec3(0) : corner, at(2, 0.2, 3));
                    file.product("IFCWALL", "", {file.representation({item})}, ",$,$", placed ? file.place(corner) : 0);
                }
                row += 10;
            }
        const uint32_t wall = file.solid("IFCWALL", "", file.brep(at(east, north + row, 0), at(4, 0.2, 3)), ",$,$");
        file.cut(wall, file.solid("IFCOPENINGELEMENT", "", file.brep(at(east + 1.5, north + row - 1, 1), at(1, 3, 1)),
                                  ",$,$"));
        const Scene scene = read(file);
        ASSERT_EQ(scene.objects.size(), 9u);
        for (size_t i = 0; i < 8; i += 2) {
            const double gap = i % 4 == 0 ? 0.1 : 0.001, y = -(north + double(i / 2) * 10);
            const glm::dvec3 corner(east, 0, y - 0.2);
            expectBox(scene, i, corner, corner + glm::dvec3(2, 3, 0.2));
            expectBox(scene, i + 1, corner + glm::dvec3(2 + gap, 0, 0), corner + glm::dvec3(4 + gap, 3, 0.2));
            EXPECT_NEAR(boundsOf(scene, i + 1).min.x - boundsOf(scene, i).max.x, gap, 1e-6);
        }
        Scene cut = scene;
        cut.objects.erase(cut.objects.begin(), cut.objects.begin() + 8);
        EXPECT_EQ(covered(cut, 2, {east + 2.1, 1.45, 0}), 0);
        EXPECT_EQ(covered(cut, 2, {east + 0.7, 1.45, 0}), 2);
    }
}

TEST_F(Ifc, TurnsAreExact) {
    IfcFile file;
    file.solid("IFCWALL", "", file.brep({1, 2, 3}, {10, 20, 30}), ",$,$");
    const Scene scene = read(file);
    const glm::dmat4& m = scene.objects[0].transform;
    EXPECT_EQ(glm::dmat3(m), glm::dmat3({1, 0, 0}, {0, 0, -1}, {0, 1, 0}));
    const Box3d box = boundsOf(scene, 0);
    EXPECT_EQ(box.min, glm::dvec3(1, 3, -22));
    EXPECT_EQ(box.max, glm::dvec3(11, 33, -2));
}

TEST_F(Ifc, MappedItemsShareTheirMesh) {
    IfcFile file;
    const uint32_t frame = file.brep({0, 0, 0}, {1, 0.1, 2}), leaf = file.brep({0.1, 0, 0.1}, {0.8, 0.05, 1.8});
    file.style(leaf, "0.");
    const uint32_t map =
        file.add(fmt::format("IFCREPRESENTATIONMAP(#4,#{})", file.representation({frame, leaf}, "'Body'", "'Brep'")));
    const auto mapped = [&](const glm::dvec3& at, const char* axis1, const char* axis2, const char* scale) {
        const uint32_t origin = file.point(at), x = file.add(fmt::format("IFCDIRECTION({})", axis1)),
                       y = file.add(fmt::format("IFCDIRECTION({})", axis2));
        const uint32_t op =
            file.add(fmt::format("IFCCARTESIANTRANSFORMATIONOPERATOR3D(#{},#{},#{},{},$)", x, y, origin, scale));
        const uint32_t item = file.add(fmt::format("IFCMAPPEDITEM(#{},#{})", map, op));
        file.product("IFCFURNISHINGELEMENT", "", {file.representation({item}, "'Body'", "'MappedRepresentation'")},
                     ",$", file.place({0, 0, 10}));
    };
    mapped({5, 0, 0}, "(1.,0.,0.)", "(0.,1.,0.)", "$");
    mapped({3e5, 5.4e6, 0}, "(1.,0.,0.)", "(0.,1.,0.)", "1.");
    mapped({0, 7, 0}, "(0.,1.,0.)", "(-1.,0.,0.)", "2.");
    const Scene scene = read(file);
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].primitives.size(), 2u);
    expectBox(scene, 0, {5, 10, -0.1}, {6, 12, 0});
    expectBox(scene, 1, {3e5, 10, -5.4e6 - 0.1}, {3e5 + 1, 12, -5.4e6});
    expectBox(scene, 2, {-0.2, 10, -9}, {0, 14, -7});
}

TEST_F(Ifc, NamesStandInTheTreeOfPlaces) {
    IfcFile file;
    const uint32_t site = file.spatial("IFCSITE", "Hill", ",$,$,$,$,$,$,$"),
                   house = file.spatial("IFCBUILDING", "", ",$,$,$,$,$"),
                   level = file.spatial("IFCBUILDINGSTOREY", "Level 1", ",$,$,$");
    const uint32_t wall =
        file.solid("IFCWALL", "M\\X2\\00FC\\X0\\hle \\X\\E9 \\S\\d ''x''", file.brep({0, 0, 0}, {4, 1, 3}), ",$,$");
    const uint32_t hole = file.solid("IFCOPENINGELEMENT", "", file.brep({1, -1, 0}, {1, 3, 2}), ",$,$");
    const uint32_t door = file.solid("IFCDOOR", "Front", file.brep({1, 0, 0}, {1, 0.1, 2}), ",$,$,$,$,$,$");
    const uint32_t stair = file.spatial("IFCSTAIR", "Up", ",$,$");
    const uint32_t flight = file.solid("IFCSTAIRFLIGHT", "", file.brep({9, 0, 0}, {1, 3, 2}), ",$,$,$,$,$,$");
    const uint32_t room = file.solid("IFCSPACE", "Kitchen", file.brep({0, 1, 0}, {4, 3, 2.5}), ",$,$,$");
    file.cut(wall, hole);
    file.add(fmt::format("IFCRELFILLSELEMENT('0000000000000000000098',$,$,$,#{},#{})", hole, door));
    file.aggregate(file.project(), {site});
    file.aggregate(site, {house});
    file.aggregate(house, {level});
    file.aggregate(level, {room});
    file.aggregate(stair, {flight});
    file.contain(level, {wall, stair});
    const Scene scene = read(file);
    EXPECT_EQ(pathsOf(scene),
              (std::vector<std::string>{"Hill/IfcBuilding/Level 1/IfcWall Mühle é ä 'x'",
                                        "Hill/IfcBuilding/Level 1/IfcWall Mühle é ä 'x'/IfcDoor Front",
                                        "Hill/IfcBuilding/Level 1/IfcStair Up/IfcStairFlight 0000000000000000000008"}));
    // The room has a name and bounds, and no mesh.
    ASSERT_EQ(scene.rooms.size(), 1u);
    EXPECT_EQ(roomPath(scene, scene.rooms[0]), "Hill/IfcBuilding/Level 1/IfcSpace Kitchen");
    EXPECT_LT(glm::length(scene.rooms[0].bounds.min - glm::dvec3(0, 0, -4)), 1e-6);
    EXPECT_LT(glm::length(scene.rooms[0].bounds.max - glm::dvec3(4, 2.5, -1)), 1e-6);
    EXPECT_EQ(scene.meshes.size(), 3u);
    expectNoted(
        "read 3 of 5 products with a shape; cut out of others: 1 IfcOpeningElement; rooms, which hide nothing: 1 "
        "IfcSpace");
}

TEST_F(Ifc, WhatLightMayPassHidesNothing) {
    IfcFile file("IFC4");
    std::vector<bool> hides;
    double x = 0;
    const auto box = [&] { return file.brep({x += 3, 0, 0}, {1, 1, 1}); };
    const auto wall = [&](uint32_t item, bool hiding, const char* type = "IFCWALL", const char* more = ",$,$") {
        hides.push_back(hiding);
        return file.solid(type, "", item, more);
    };
    const auto styled = [&](const char* transparency) {
        const uint32_t item = box();
        file.style(item, transparency);
        return item;
    };
    wall(box(), true);
    wall(styled("$"), true);
    wall(styled("0."), true);
    wall(styled("0.3"), false);
    wall(styled("1.E-3"), false);
    wall(styled("IFCNORMALISEDRATIOMEASURE(0.5)"), false);
    {  // by an assignment, as IFC2x3 has it
        const uint32_t item = box();
        const uint32_t assignment =
            file.add(fmt::format("IFCPRESENTATIONSTYLEASSIGNMENT((#{}))", file.surfaceStyle("0.5")));
        file.add(fmt::format("IFCSTYLEDITEM(#{},(#{}),$)", item, assignment));
        wall(item, false);
    }
    for (const char* picture : {"leaf.png", "brick.jpg"}) {
        const uint32_t item = box();
        const uint32_t texture = file.add(fmt::format("IFCIMAGETEXTURE(.T.,.T.,$,$,$,'{}')", picture));
        const uint32_t textures = file.add(fmt::format("IFCSURFACESTYLEWITHTEXTURES((#{}))", texture));
        const uint32_t style = file.add(fmt::format("IFCSURFACESTYLE($,.BOTH.,(#{}))", textures));
        file.add(fmt::format("IFCSTYLEDITEM(#{},(#{}),$)", item, style));
        wall(item, std::string(picture) == "brick.jpg");
    }
    for (const bool own : {false, true}) {  // glass in a list of materials, of which the first is opaque
        const uint32_t item = own ? styled("0.") : box();
        const uint32_t product = wall(item, own);
        std::vector<uint32_t> materials;
        for (const char* transparency : {"0.", "0.8"}) {
            const uint32_t material = file.add("IFCMATERIAL('m',$,$)");
            const uint32_t look = file.add(fmt::format("IFCSTYLEDITEM($,(#{}),$)", file.surfaceStyle(transparency)));
            const uint32_t looks = file.add(fmt::format("IFCSTYLEDREPRESENTATION(#5,$,$,(#{}))", look));
            file.add(fmt::format("IFCMATERIALDEFINITIONREPRESENTATION($,$,(#{}),#{})", looks, material));
            materials.push_back(material);
        }
        const uint32_t list = file.add("IFCMATERIALLIST(" + IfcFile::refs(materials) + ")");
        file.add(fmt::format("IFCRELASSOCIATESMATERIAL('{:022}',$,$,$,(#{}),#{})", 90 + own, product, list));
    }
    for (const char* on : {".T.,.F.", ".F.,.F.", ".T.,.T."}) {  // a layer that is off or frozen may not be drawn
        const uint32_t item = box();
        wall(item, std::string(on) == ".T.,.F.");
        file.add(fmt::format("IFCPRESENTATIONLAYERWITHSTYLE('l',$,(#{}),$,{},.F.,())", item, on));
    }
    wall(box(), false, "IFCWINDOW", ",$,$,$,$,$,$");  // whose panes nothing tells of
    wall(styled("0."), true, "IFCWINDOW", ",$,$,$,$,$,$");
    {  // glass that something opaque is cut out of
        const uint32_t first = styled("0.5"), second = box();
        wall(file.add(fmt::format("IFCBOOLEANRESULT(.DIFFERENCE.,#{},#{})", first, second)), false);
    }
    const Scene scene = read(file);
    ASSERT_EQ(scene.objects.size(), hides.size()) << notes_;
    for (size_t i = 0; i < hides.size(); ++i) {
        const Material& material = scene.materials[scene.meshes[scene.objects[i].mesh].primitives[0].material];
        EXPECT_EQ(material.hides(), hides[i]) << i;
        EXPECT_EQ(material.alpha_mode, hides[i] ? AlphaMode::kOpaque : AlphaMode::kBlend) << i;
        EXPECT_TRUE(material.double_sided);
    }
}

TEST_F(Ifc, OnlyTheBodyIsDrawn) {
    IfcFile file;
    const uint32_t corner = file.point({0, 0, 0});
    const uint32_t box = file.add(fmt::format("IFCBOUNDINGBOX(#{},10.,10.,10.)", corner));
    const auto body = [&](const char* name, double size) {
        return file.representation({file.brep({0, 0, 0}, {size, 1, 1})}, name);
    };
    const uint32_t axis = file.add(fmt::format("IFCPOLYLINE((#{},#{}))", corner, file.point({99, 0, 0})));
    file.product("IFCWALL", "",
                 {file.representation({axis}, "'Axis'"), file.representation({box}, "'Box'", "'BoundingBox'"),
                  body("'Body'", 1), body("'Clearance'", 20), body("'Reference'", 30), body("'body'", 2)},
                 ",$,$");
    file.product("IFCWALL", "", {body("$", 3), body("'Box'", 20)}, ",$,$");
    file.product("IFCWALL", "boxed", {file.representation({box}, "'Box'", "'BoundingBox'")}, ",$,$");
    file.solid("IFCANNOTATION", "", file.brep({0, 0, 0}, {1, 1, 1}), "");
    file.solid("IFCVIRTUALELEMENT", "", file.brep({0, 0, 0}, {1, 1, 1}), ",$");
    const Scene scene = read(file);
    ASSERT_EQ(scene.objects.size(), 2u);
    expectBox(scene, 0, {0, 0, -1}, {2, 1, 0});
    expectBox(scene, 1, {0, 0, -1}, {3, 1, 0});
    expectNoted("read 2 of 5 products");
    expectNoted("not drawn: 1 IfcAnnotation, 1 IfcVirtualElement");
    expectNoted("without triangles: 1 (IfcWall #");
    expectNoted("'boxed')");
}

TEST_F(Ifc, BarsAreSweptAlongCurvesInPieces) {
    IfcFile file;
    const uint32_t line = file.add(
        fmt::format("IFCPOLYLINE((#{},#{},#{}))", file.point({0, 0, 0}), file.point({4, 0, 0}), file.point({8, 0, 0})));
    const uint32_t piece = file.add(fmt::format("IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#{})", line));
    const uint32_t curve = file.add(fmt::format("IFCCOMPOSITECURVE((#{}),.F.)", piece));
    const auto bar = [&](uint32_t along, const char* part) {
        file.solid("IFCREINFORCINGBAR", "", file.add(fmt::format("IFCSWEPTDISKSOLID(#{},0.1,$,{})", along, part)),
                   ",$,$,$,$,$,$,$,$");
    };
    bar(curve, "$,$");
    bar(curve, "0.,201.5");  // what the numbers mean differs from exporter to exporter
    bar(line, "0.,2.");
    bar(line, "0.,1.");
    const Scene scene = read(file);
    ASSERT_EQ(scene.objects.size(), 4u) << notes_;
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(boundsOf(scene, i).max.x, i == 3 ? 4 : 8, 1e-6) << i;
        EXPECT_EQ(scene.materials[scene.meshes[scene.objects[i].mesh].primitives[0].material].hides(), i != 1) << i;
    }
    expectNoted("swept along their whole curves, and so hiding nothing: 1 solids");
}

#endif

}  // namespace
}  // namespace sightline
