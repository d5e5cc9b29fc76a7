// One scene written in many formats: texts.
// SPDX-License-Identifier: MIT
#include "foreign_files.h"

#include <fmt/format.h>

namespace sightline::test {

std::vector<glm::uvec3> Surface::triangles() const {
    std::vector<glm::uvec3> out;
    for (const auto& face : faces)
        for (size_t i = 1; i + 1 < face.size(); ++i) out.emplace_back(face[0], face[i], face[i + 1]);
    return out;
}

namespace {

Surface box(const std::string& name, glm::vec3 low, glm::vec3 high) {
    Surface out{name, {}, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {0, 4, 7, 3}}};
    for (const float z : {low.z, high.z}) {
        out.positions.emplace_back(low.x, low.y, z);
        out.positions.emplace_back(high.x, low.y, z);
        out.positions.emplace_back(high.x, high.y, z);
        out.positions.emplace_back(low.x, high.y, z);
    }
    return out;
}

/// "0 3 2 1"
std::string list(const std::vector<uint32_t>& face, const char* between = " ", uint32_t first = 0) {
    std::string out;
    for (const uint32_t i : face) out += fmt::format("{}{}", out.empty() ? "" : between, i + first);
    return out;
}

std::string point(const glm::vec3& p, const char* between = " ") {
    return fmt::format("{}{}{}{}{}", p.x, between, p.y, between, p.z);
}

/// All surfaces as one.
Surface merged(const std::vector<Surface>& surfaces) {
    Surface out;
    for (const Surface& surface : surfaces) {
        const auto first = static_cast<uint32_t>(out.positions.size());
        out.positions.insert(out.positions.end(), surface.positions.begin(), surface.positions.end());
        for (std::vector<uint32_t> face : surface.faces) {
            for (uint32_t& i : face) i += first;
            out.faces.push_back(face);
        }
    }
    return out;
}

}  // namespace

std::vector<Surface> twoBoxes() {
    return {box("Large", {1, 2, 3}, {5, 4.5f, 10}), box("Small", {-7, 0.25f, -3}, {-6.5f, 1.25f, -1})};
}

std::string objText(const std::vector<Surface>& surfaces) {
    std::string out = "# boxes\n";
    uint32_t first = 1;
    for (const Surface& surface : surfaces) {
        out += "o " + surface.name + "\n";
        for (const glm::vec3& p : surface.positions) out += "v " + point(p) + "\n";
        for (const auto& face : surface.faces) out += "f " + list(face, " ", first) + "\n";
        first += static_cast<uint32_t>(surface.positions.size());
    }
    return out;
}

std::string plyText(const std::vector<Surface>& surfaces) {
    const Surface all = merged(surfaces);
    std::string out = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        all.positions.size(), all.faces.size());
    for (const glm::vec3& p : all.positions) out += point(p) + "\n";
    for (const auto& face : all.faces) out += fmt::format("{} {}\n", face.size(), list(face));
    return out;
}

std::string stlText(const std::vector<Surface>& surfaces) {
    const Surface all = merged(surfaces);
    std::string out = "solid boxes\n";
    for (const glm::uvec3& t : all.triangles()) {
        out += "facet normal 0 0 0\nouter loop\n";
        for (int c = 0; c < 3; ++c) out += "vertex " + point(all.positions[t[c]]) + "\n";
        out += "endloop\nendfacet\n";
    }
    return out + "endsolid boxes\n";
}

std::string offText(const std::vector<Surface>& surfaces) {
    const Surface all = merged(surfaces);
    std::string out = fmt::format("OFF\n{} {} 0\n", all.positions.size(), all.faces.size());
    for (const glm::vec3& p : all.positions) out += point(p) + "\n";
    for (const auto& face : all.faces) out += fmt::format("{} {}\n", face.size(), list(face));
    return out;
}

std::string daeText(const std::vector<Surface>& surfaces) {
    // In centimetres and with z up: both are said in the file.
    std::string geometries, nodes;
    for (const Surface& surface : surfaces) {
        std::string points, counts, corners;
        for (const glm::vec3& p : surface.positions) points += point({p.x * 100, -p.z * 100, p.y * 100}) + " ";
        for (const auto& face : surface.faces) {
            counts += std::to_string(face.size()) + " ";
            corners += list(face) + " ";
        }
        const std::string& n = surface.name;
        geometries += fmt::format(
            "<geometry id=\"{0}-mesh\" name=\"{0}\"><mesh><source id=\"{0}-p\"><float_array id=\"{0}-a\" count=\"{1}\">"
            "{2}</float_array><technique_common><accessor source=\"#{0}-a\" count=\"{3}\" stride=\"3\">"
            "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
            "</accessor></technique_common></source><vertices id=\"{0}-v\"><input semantic=\"POSITION\" "
            "source=\"#{0}-p\"/></vertices><polylist count=\"{4}\" material=\"m\"><input semantic=\"VERTEX\" "
            "source=\"#{0}-v\" "
            "offset=\"0\"/><vcount>{5}</vcount><p>{6}</p></polylist></mesh></geometry>\n",
            n, 3 * surface.positions.size(), points, surface.positions.size(), surface.faces.size(), counts, corners);
        nodes += fmt::format(
            "<node id=\"{0}\" name=\"{0}\"><instance_geometry url=\"#{0}-mesh\"><bind_material><technique_common>"
            "<instance_material symbol=\"m\" target=\"#grey\"/></technique_common></bind_material>"
            "</instance_geometry></node>\n",
            n);
    }
    return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
           "<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>"
           "<unit name=\"centimeter\" meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset>\n"
           "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"t\"><lambert><diffuse><color>0.5 0.25 1 "
           "1"
           "</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
           "<library_materials><material id=\"grey\" name=\"grey\"><instance_effect url=\"#e\"/></material>"
           "</library_materials>\n<library_geometries>" +
           geometries +
           "</library_geometries>\n<library_visual_scenes><visual_scene id=\"s\"><node id=\"House\" name=\"House\">" +
           nodes +
           "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
           "</COLLADA>\n";
}

std::string xText(const std::vector<Surface>& surfaces) {
    // Left-handed: z is turned round, and so are the corners.
    std::string out = "xof 0303txt 0032\n";
    for (const Surface& surface : surfaces) {
        out += fmt::format("Frame {} {{\n Mesh {{\n  {};\n", surface.name, surface.positions.size());
        for (size_t i = 0; i < surface.positions.size(); ++i) {
            const glm::vec3& p = surface.positions[i];
            out += fmt::format("  {};{};{};{}\n", p.x, p.y, -p.z, i + 1 < surface.positions.size() ? "," : ";");
        }
        out += fmt::format("  {};\n", surface.faces.size());
        for (size_t i = 0; i < surface.faces.size(); ++i) {
            const std::vector<uint32_t> face(surface.faces[i].rbegin(), surface.faces[i].rend());
            out += fmt::format("  {};{};{}\n", face.size(), list(face, ","), i + 1 < surface.faces.size() ? "," : ";");
        }
        out += " }\n}\n";
    }
    return out;
}

std::string x3dText(const std::vector<Surface>& surfaces) {
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<X3D profile='Interchange' version='3.3'><Scene>\n";
    for (const Surface& surface : surfaces) {
        std::string faces, points;
        for (const auto& face : surface.faces) faces += list(face) + " -1 ";
        for (const glm::vec3& p : surface.positions) points += point(p) + " ";
        out += fmt::format(
            "<Transform DEF='{}'><Shape><IndexedFaceSet coordIndex='{}'><Coordinate point='{}'/>"
            "</IndexedFaceSet></Shape></Transform>\n",
            surface.name, faces, points);
    }
    return out + "</Scene></X3D>\n";
}

std::string dxfText(const std::vector<Surface>& surfaces) {
    const Surface all = merged(surfaces);
    std::string out = "0\nSECTION\n2\nENTITIES\n";
    for (const glm::uvec3& t : all.triangles()) {
        out += "0\n3DFACE\n8\nlayer\n";
        for (int c = 0; c < 4; ++c) {  // a triangle names its last corner twice
            const glm::vec3& p = all.positions[t[c < 3 ? c : 2]];
            out += fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", 10 + c, p.x, 20 + c, -p.z, 30 + c, p.y);  // z is up
        }
    }
    return out + "0\nENDSEC\n0\nEOF\n";
}

std::string amfText(const std::vector<Surface>& surfaces) {
    std::string out = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<amf unit=\"meter\" version=\"1.1\">\n";
    int id = 0;
    for (const Surface& surface : surfaces) {
        out += fmt::format("<object id=\"{}\"><mesh><vertices>\n", id++);
        for (const glm::vec3& p : surface.positions)
            out +=
                fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>\n", p.x, p.y, p.z);
        out += "</vertices><volume>\n";
        for (const glm::uvec3& t : surface.triangles())
            out += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>\n", t.x, t.y, t.z);
        out += "</volume></mesh></object>\n";
    }
    return out + "</amf>\n";
}

std::string acText(const std::vector<Surface>& surfaces) {
    std::string out = "AC3Db\nMATERIAL \"grey\" rgb 0.5 0.5 0.5 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n";
    out += fmt::format("OBJECT world\nkids {}\n", surfaces.size());
    for (const Surface& surface : surfaces) {
        out += fmt::format("OBJECT poly\nname \"{}\"\nnumvert {}\n", surface.name, surface.positions.size());
        for (const glm::vec3& p : surface.positions) out += point(p) + "\n";
        out += fmt::format("numsurf {}\n", surface.faces.size());
        for (const auto& face : surface.faces) {
            out += fmt::format("SURF 0x20\nmat 0\nrefs {}\n", face.size());
            for (const uint32_t i : face) out += fmt::format("{} 0 0\n", i);
        }
        out += "kids 0\n";
    }
    return out;
}

std::string ifcText(const std::string& schema) {
    const char* wall = schema == "IFC4" ? "IFCWALL('0000000000000000000008',#5,'North wall',$,$,#24,#31,$,.STANDARD.)"
                                        : "IFCWALLSTANDARDCASE('0000000000000000000008',#5,'North wall',$,$,#24,#31,$)";
    return fmt::format(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('w','2020-01-01T00:00:00',(''),(''),'','','')"
        ";\n"
        "FILE_SCHEMA(('{}'));\nENDSEC;\nDATA;\n"
        "#1=IFCORGANIZATION($,'o',$,$,$);\n#2=IFCPERSON($,'p',$,$,$,$,$,$);\n#3=IFCPERSONANDORGANIZATION(#2,#1,$);\n"
        "#4=IFCAPPLICATION(#1,'1','a','a');\n#5=IFCOWNERHISTORY(#3,#4,$,.ADDED.,$,$,$,0);\n"
        "#6=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);\n#7=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n"
        "#8=IFCUNITASSIGNMENT((#6,#7));\n#9=IFCCARTESIANPOINT((0.,0.,0.));\n#10=IFCDIRECTION((0.,0.,1.));\n"
        "#11=IFCDIRECTION((1.,0.,0.));\n#12=IFCAXIS2PLACEMENT3D(#9,#10,#11);\n"
        "#13=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#12,$);\n"
        "#14=IFCPROJECT('0000000000000000000001',#5,'Project',$,$,$,$,(#13),#8);\n#15=IFCLOCALPLACEMENT($,#12);\n"
        "#16=IFCSITE('0000000000000000000002',#5,'Site',$,$,#15,$,$,.ELEMENT.,$,$,$,$,$);\n"
        "#17=IFCLOCALPLACEMENT(#15,#12);\n"
        "#18=IFCBUILDING('0000000000000000000003',#5,'House',$,$,#17,$,$,.ELEMENT.,$,$,$);\n"
        "#19=IFCLOCALPLACEMENT(#17,#12);\n"
        "#20=IFCBUILDINGSTOREY('0000000000000000000004',#5,'Level 1',$,$,#19,$,$,.ELEMENT.,0.);\n"
        "#21=IFCRELAGGREGATES('0000000000000000000005',#5,$,$,#14,(#16));\n"
        "#22=IFCRELAGGREGATES('0000000000000000000006',#5,$,$,#16,(#18));\n"
        "#23=IFCRELAGGREGATES('0000000000000000000007',#5,$,$,#18,(#20));\n#24=IFCLOCALPLACEMENT(#19,#12);\n"
        "#25=IFCCARTESIANPOINT((2500.,100.));\n#26=IFCDIRECTION((1.,0.));\n#27=IFCAXIS2PLACEMENT2D(#25,#26);\n"
        "#28=IFCRECTANGLEPROFILEDEF(.AREA.,$,#27,5000.,200.);\n#29=IFCEXTRUDEDAREASOLID(#28,#12,#10,3000.);\n"
        "#30=IFCSHAPEREPRESENTATION(#13,'Body','SweptSolid',(#29));\n#31=IFCPRODUCTDEFINITIONSHAPE($,$,(#30));\n#32={};"
        "\n"
        "#33=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000009',#5,$,$,(#32),#20);\nENDSEC;\nEND-ISO-10303-21;"
        "\n",
        schema, wall);
}

std::vector<ForeignFile> foreignFiles(const std::vector<Surface>& surfaces) {
    return {{"boxes.obj", objText(surfaces)},
            {"text.ply", plyText(surfaces), false},
            {"bytes.ply", plyBytes(surfaces), false},
            {"text.stl", stlText(surfaces), false},
            {"bytes.stl", stlBytes(surfaces), false},
            {"boxes.off", offText(surfaces), false},
            {"boxes.dae", daeText(surfaces), true, true},
            {"text.fbx", fbxText(surfaces)},
            {"bytes.fbx", fbxBytes(surfaces)},
            {"boxes.x", xText(surfaces)},
            {"boxes.x3d", x3dText(surfaces), false},
            {"boxes.dxf", dxfText(surfaces), false},
            {"boxes.amf", amfText(surfaces), false},
            {"boxes.ac", acText(surfaces)},
            {"boxes.3ds", bytesOf3ds(surfaces), true, true},
            {"boxes.3mf", bytesOf3mf(surfaces), false}};
}

}  // namespace sightline::test
