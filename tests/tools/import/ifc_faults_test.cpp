// IFC: what is lost is counted and named, and what is broken is one line with its place.
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "ifc_reading.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

#ifdef SIGHTLINE_IMPORT_PROGRAM

TEST_F(Ifc, WhatIsLostIsCountedAndNamed) {
    IfcFile file;
    file.solid("IFCWALL", "good", file.brep({0, 0, 0}, {1, 1, 1}), ",$,$");
    for (const char* name : {"a", "b", "c", "d"}) file.solid("IFCBEAM", name, file.add("IFCNOSUCHSOLID(1.)"), ",$,$");
    file.solid("IFCNOSUCHPRODUCT", "e", file.brep({0, 0, 0}, {1, 1, 1}), ",$,$");
    file.solid("IFCSLAB", "f", 99999999, ",$,$");
    const Scene scene = read(file);
    EXPECT_EQ(scene.objects.size(), 1u);
    expectNoted("read 1 of 6 products with a shape");
    expectNoted("without triangles: 5 (IfcBeam #");
    expectNoted("of types that are not known: 4 IFCNOSUCHSOLID, 1 IFCNOSUCHPRODUCT");
    expectNoted("references that lead nowhere: 1");
    IfcFile none;
    none.solid("IFCSPACE", "", none.brep({0, 0, 0}, {1, 1, 1}), ",$,$,$");
    expectRefused(write("none.ifc", none.text()), "draws nothing: read 0 of 1 products with a shape; rooms");
}

TEST_F(Ifc, ArchivesAreUnpacked) {
    IfcFile file;
    file.solid("IFCWALL", "", file.brep({0, 0, 0}, {1, 1, 1}), ",$,$");
    const std::string zip = zipBytes({{"notes.txt", "x"}, {"House.IFC", file.text()}});
    EXPECT_EQ(read(zip, "a.ifczip").objects.size(), 1u);
    for (size_t size = 0; size < zip.size(); size += zip.size() / 7 + 1)
        expectRefused(write("cut.ifczip", "PK" + zip.substr(2, size)), "zip archive");
    expectRefused(write("empty.ifczip", zipBytes({{"notes.txt", "x"}})), "holds no .ifc file");
}

TEST_F(Ifc, WhatIsBrokenIsOneLineWithItsPlace) {
    IfcFile file;
    file.solid("IFCWALL", "wall", file.triangulated({0, 0, 0}, {1, 1, 1}), ",$,$");
    const std::string good = file.text();
    const auto broken = [&](const std::string& was, const std::string& is, const std::string& words) {
        std::string text = good;
        text.replace(text.find(was), was.size(), is);
        expectRefused(write("broken.ifc", text), words);
    };
    for (const double share : {0.3, 0.5, 0.7, 0.9, 0.99}) {
        SCOPED_TRACE(share);
        const Result<Scene> scene = load(write("cut.ifc", good.substr(0, size_t(share * double(good.size())))));
        ASSERT_FALSE(scene.ok());
        EXPECT_EQ(messageFault(scene.error(), path("cut.ifc")), "");
    }
    broken("END-ISO-10303-21;\n", "", "ends too early: END-ISO-10303-21 is missing behind line");
    broken("(#5),#2);", "(#5),#2)", "line 8: a semicolon is missing behind: #1=IFCPROJECT");
    broken("IFCUNITASSIGNMENT((#3))", "IFCUNITASSIGNMENT((#3)", "line 9: a bracket is not closed: #2=");
    broken("IFCUNITASSIGNMENT((#3))", "IFCUNITASSIGNMENT((#3)))", "line 9: a bracket closes");
    broken("'wall'", "'wall", "a text has no end");
    broken("#6=IFC", "/* #6=IFC", "line 13: a comment has no end");
    broken("#6=IFC", "#6 IFC", "line 13: this is no statement of STEP");
    broken(".T.,((1", ".T,((1", "neither a number nor a word between dots");
    broken("((1,3,4)", "((1,3,9)", "(IFCTRIANGULATEDFACESET) has no point 9");
    broken("((1,3,4)", "((0,3,4)", "(IFCTRIANGULATEDFACESET) has no point 0");
    broken(")),$);", ")),(2,1,3,4,5,6,7,8));", "(IFCTRIANGULATEDFACESET) numbers its points anew");
    broken("#2=IFCUNIT", "#2=IFCPROJECT('x',$,$,$,$,$,$,$,$);\n#8=IFCUNIT", "holds 2 IfcProject");
    broken("FILE_SCHEMA(('IFC4'))", "FILE_SCHEMA(('IFC2X2_FINAL'))", "is of the schema IFC2X2_FINAL");
    broken("#1=IFCPROJECT(", "#99999999999=IFCPROJECT(", "no number of a statement");
}

TEST_F(Ifc, PointsMayBeNumberedAsTheyAre) {
    for (const bool triangles : {false, true}) {
        IfcFile file;
        const uint32_t set = triangles ? file.triangulated({0, 0, 0}, {1, 1, 1}) : file.polygonal({0, 0, 0}, {1, 1, 1});
        file.solid("IFCWALL", "wall", set, ",$,$");
        std::string text = file.text();
        const size_t at = text.rfind(",$);", text.find(fmt::format("#{}=", set + 1)));
        ASSERT_NE(at, std::string::npos);
        EXPECT_EQ(read(text.replace(at, 2, ",(1,2,3,4,5,6,7,8)")).objects.size(), 1u);
        expectRefused(write("anew.ifc", text.replace(text.find("(1,2,3,4,5"), 4, "(2,1")), "numbers its points anew");
    }
}

TEST_F(Ifc, LimitsHoldAndNameThePart) {
    IfcFile file;
    file.solid("IFCWALL", "", file.brep({0, 0, 0}, {1, 1, 1}), ",$,$");
    const std::string name = write("a.ifc", file.text());
    settings_.memory_limit = uint64_t(100) << 20;
    expectRefused(name, "needs more memory than 100 MiB (--import-memory)");
    settings_.memory_limit = uint64_t(2) << 30;
    settings_.time_limit = 0.01;
    expectRefused(name, "took longer than 0.01 s to read (--import-time)");
}

TEST_F(Ifc, WhatIsMissingIsSaid) {
    IfcFile file;
    file.solid("IFCWALL", "", file.brep({0, 0, 0}, {1, 1, 1}), ",$,$");
    const std::string name = write("a.ifc", file.text());
    const std::string search = std::getenv("PATH") ? std::getenv("PATH") : "";
    ::setenv("PATH", path("nowhere").c_str(), 1);
    expectRefused(name, "IFC is read by Node.js, which is not installed: install it (apt install nodejs)");
    const std::string boxes = write("boxes.obj", objText(twoBoxes()));
    EXPECT_TRUE(load(boxes).ok()) << "other formats need none of it";
    ::setenv("PATH", search.c_str(), 1);
    settings_.worker = path("sightline-import");
    std::filesystem::copy_file(SIGHTLINE_IMPORT_PROGRAM, settings_.worker);
    expectRefused(name, "IFC is read by web-ifc, which this build lacks");
    EXPECT_TRUE(load(boxes).ok());
}

#endif

}  // namespace
}  // namespace sightline
