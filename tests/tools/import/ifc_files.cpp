// IFC files, written entity by entity.
// SPDX-License-Identifier: MIT
#include "ifc_files.h"

#include <array>
#include <utility>

#include <fmt/core.h>

namespace sightline::test {
namespace {

/// A number of STEP, which has a dot.
std::string real(double x) {
    std::string out = fmt::format("{}", x);
    if (out.find_first_of(".e") == std::string::npos) out += '.';
    if (const size_t e = out.find('e'); e != std::string::npos) {
        if (out.find('.') == std::string::npos) out.insert(e, ".");
        out[out.find('e')] = 'E';
    }
    return out;
}

std::string triple(const glm::dvec3& p) { return fmt::format("({},{},{})", real(p.x), real(p.y), real(p.z)); }

glm::dvec3 cornerOf(const glm::dvec3& corner, const glm::dvec3& size, int i) {
    return corner + size * glm::dvec3(i & 1, (i >> 1) & 1, (i >> 2) & 1);
}

/// Corners of a box's faces, counter-clockwise as seen from outside.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

}  // namespace

IfcFile::IfcFile(const std::string& schema, const std::string& unit) : schema_(schema) {
    data_ = fmt::format(
        "#1=IFCPROJECT('0000000000000000000000',$,$,$,$,$,$,(#5),#2);\n#2=IFCUNITASSIGNMENT((#3));\n#3={};\n"
        "#4=IFCAXIS2PLACEMENT3D(#6,$,$);\n#5=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,$,#4,$);\n"
        "#6=IFCCARTESIANPOINT((0.,0.,0.));\n#7=IFCDIRECTION((0.,0.,1.));\n",
        unit);
}

uint32_t IfcFile::add(const std::string& entity) {
    data_ += fmt::format("#{}={};\n", next_, entity);
    return next_++;
}

std::string IfcFile::text() const {
    return fmt::format(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
        "FILE_SCHEMA(('{}'));\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
        schema_, data_);
}

std::string IfcFile::globalId() { return fmt::format("'{:022}'", ++ids_); }

std::string IfcFile::refs(const std::vector<uint32_t>& ids) {
    std::string out;
    for (const uint32_t id : ids) out += fmt::format("{}#{}", out.empty() ? "" : ",", id);
    return "(" + out + ")";
}

uint32_t IfcFile::point(const glm::dvec3& p) { return add(fmt::format("IFCCARTESIANPOINT({})", triple(p))); }

uint32_t IfcFile::place(const glm::dvec3& at) {
    const uint32_t axes = add(fmt::format("IFCAXIS2PLACEMENT3D(#{},$,$)", point(at)));
    return add(fmt::format("IFCLOCALPLACEMENT($,#{})", axes));
}

uint32_t IfcFile::extruded(const glm::dvec3& corner, const glm::dvec3& size) {
    const uint32_t centre = add(fmt::format("IFCCARTESIANPOINT(({},{}))", real(size.x / 2), real(size.y / 2)));
    const uint32_t middle = add(fmt::format("IFCAXIS2PLACEMENT2D(#{},$)", centre));
    const uint32_t profile =
        add(fmt::format("IFCRECTANGLEPROFILEDEF(.AREA.,$,#{},{},{})", middle, real(size.x), real(size.y)));
    const uint32_t axes = add(fmt::format("IFCAXIS2PLACEMENT3D(#{},$,$)", point(corner)));
    return add(fmt::format("IFCEXTRUDEDAREASOLID(#{},#{},#7,{})", profile, axes, real(size.z)));
}

uint32_t IfcFile::brep(const glm::dvec3& corner, const glm::dvec3& size) {
    std::vector<uint32_t> points, faces;
    for (int i = 0; i < 8; ++i) points.push_back(point(cornerOf(corner, size, i)));
    for (const auto& face : kFaces) {
        std::vector<uint32_t> loop;
        for (const int i : face) loop.push_back(points[i]);
        const uint32_t bound = add(fmt::format("IFCFACEOUTERBOUND(#{},.T.)", add("IFCPOLYLOOP(" + refs(loop) + ")")));
        faces.push_back(add("IFCFACE(" + refs({bound}) + ")"));
    }
    return add(fmt::format("IFCFACETEDBREP(#{})", add("IFCCLOSEDSHELL(" + refs(faces) + ")")));
}

uint32_t IfcFile::triangulated(const glm::dvec3& corner, const glm::dvec3& size) {
    std::string points, triangles;
    for (int i = 0; i < 8; ++i) points += (i > 0 ? "," : "") + triple(cornerOf(corner, size, i));
    for (const auto& f : kFaces)
        triangles += fmt::format("{}({},{},{}),({},{},{})", triangles.empty() ? "" : ",", f[0] + 1, f[1] + 1, f[2] + 1,
                                 f[0] + 1, f[2] + 1, f[3] + 1);
    const uint32_t list = add("IFCCARTESIANPOINTLIST3D((" + points + "))");
    return add(fmt::format("IFCTRIANGULATEDFACESET(#{},$,.T.,({}),$)", list, triangles));
}

uint32_t IfcFile::polygonal(const glm::dvec3& corner, const glm::dvec3& size) {
    std::string points;
    for (int i = 0; i < 8; ++i) points += (i > 0 ? "," : "") + triple(cornerOf(corner, size, i));
    std::vector<uint32_t> faces;
    for (const auto& f : kFaces)
        faces.push_back(
            add(fmt::format("IFCINDEXEDPOLYGONALFACE(({},{},{},{}))", f[0] + 1, f[1] + 1, f[2] + 1, f[3] + 1)));
    const uint32_t list = add("IFCCARTESIANPOINTLIST3D((" + points + "))");
    return add(fmt::format("IFCPOLYGONALFACESET(#{},.T.,{},$)", list, refs(faces)));
}

uint32_t IfcFile::representation(const std::vector<uint32_t>& items, const std::string& identifier,
                                 const std::string& type) {
    return add(fmt::format("IFCSHAPEREPRESENTATION(#5,{},{},{})", identifier, type, refs(items)));
}

uint32_t IfcFile::product(const std::string& type, const std::string& name,
                          const std::vector<uint32_t>& representations, const std::string& more, uint32_t placement) {
    const uint32_t shape = add("IFCPRODUCTDEFINITIONSHAPE($,$," + refs(representations) + ")");
    return add(fmt::format("{}({},$,{},$,$,{},#{}{})", type, globalId(), name.empty() ? "$" : "'" + name + "'",
                           placement == 0 ? "$" : fmt::format("#{}", placement), shape, more));
}

uint32_t IfcFile::solid(const std::string& type, const std::string& name, uint32_t item, const std::string& more) {
    return product(type, name, {representation({item})}, more);
}

uint32_t IfcFile::spatial(const std::string& type, const std::string& name, const std::string& more) {
    return add(fmt::format("{}({},$,{},$,$,$,${})", type, globalId(), name.empty() ? "$" : "'" + name + "'", more));
}

void IfcFile::cut(uint32_t host, uint32_t opening) {
    add(fmt::format("IFCRELVOIDSELEMENT({},$,$,$,#{},#{})", globalId(), host, opening));
}

void IfcFile::aggregate(uint32_t whole, const std::vector<uint32_t>& parts) {
    add(fmt::format("IFCRELAGGREGATES({},$,$,$,#{},{})", globalId(), whole, refs(parts)));
}

void IfcFile::contain(uint32_t place, const std::vector<uint32_t>& things) {
    add(fmt::format("IFCRELCONTAINEDINSPATIALSTRUCTURE({},$,$,$,{},#{})", globalId(), refs(things), place));
}

uint32_t IfcFile::surfaceStyle(const std::string& transparency) {
    const uint32_t colour = add("IFCCOLOURRGB($,0.25,0.5,0.75)");
    const uint32_t rendering =
        add(fmt::format("IFCSURFACESTYLERENDERING(#{},{},$,$,$,$,$,$,.NOTDEFINED.)", colour, transparency));
    return add(fmt::format("IFCSURFACESTYLE($,.BOTH.,(#{}))", rendering));
}

void IfcFile::style(uint32_t item, const std::string& transparency) {
    add(fmt::format("IFCSTYLEDITEM(#{},(#{}),$)", item, surfaceStyle(transparency)));
}

}  // namespace sightline::test
