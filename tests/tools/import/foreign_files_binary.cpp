// One scene written in many formats: bytes, and FBX, whose text and bytes hold the same tree.
// SPDX-License-Identifier: MIT
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "foreign_files.h"
#include "gltf_builder.h"

namespace sightline::test {
namespace {

template <class T>
std::string raw(T value) {
    std::string out(sizeof value, '\0');
    std::memcpy(out.data(), &value, sizeof value);
    return out;
}

std::string raw(const glm::vec3& p) { return raw(p.x) + raw(p.y) + raw(p.z); }

std::string tagged(char tag, const std::string& bytes) {
    std::string out(1, tag);
    return out.append(bytes);
}

/// A record of FBX: a name, properties that are numbers, words or arrays, and records inside.
struct Fbx {
    std::string name;
    std::string words;  ///< properties as text: `1234, "Model::x", "Mesh"`
    std::string bytes;  ///< and as bytes
    uint32_t count = 0;
    std::vector<Fbx> inside;

    Fbx& number(int64_t value) { return add(std::to_string(value), tagged('L', raw(value))); }
    Fbx& whole(int32_t value) { return add(std::to_string(value), tagged('I', raw(value))); }
    Fbx& real(double value) { return add(fmt::format("{}", value), tagged('D', raw(value))); }
    /// @param kind  as in "Model"; empty: none
    Fbx& word(const std::string& text, const std::string& kind = "") {
        const std::string in_text = kind.empty() ? text : kind + "::" + text;
        const std::string in_bytes = kind.empty() ? text : text + std::string("\0\1", 2) + kind;
        return add(fmt::format("\"{}\"", in_text), tagged('S', raw(uint32_t(in_bytes.size())) + in_bytes));
    }
    Fbx& reals(const std::vector<double>& values) {
        std::string list, data;
        for (const double v : values) {
            list += fmt::format("{}{}", list.empty() ? "" : ",", v);
            data += raw(v);
        }
        return array(list, 'd', values.size(), data);
    }
    Fbx& wholes(const std::vector<int32_t>& values) {
        std::string list, data;
        for (const int32_t v : values) {
            list += fmt::format("{}{}", list.empty() ? "" : ",", v);
            data += raw(v);
        }
        return array(list, 'i', values.size(), data);
    }

    std::string text(const std::string& indent = "") const {
        std::string out = indent + name + ": " + words;
        if (inside.empty()) return out + "\n";
        out += " {\n";
        for (const Fbx& record : inside) out += record.text(indent + "\t");
        return out + indent + "}\n";
    }

    /// @param at  where in the file it will stand
    std::string binary(size_t at) const {
        std::string body;
        const size_t head = 13 + name.size();
        for (const Fbx& record : inside) body += record.binary(at + head + bytes.size() + body.size());
        if (!inside.empty()) body += std::string(13, '\0');
        return raw(uint32_t(at + head + bytes.size() + body.size())) + raw(count) + raw(uint32_t(bytes.size())) +
               raw(uint8_t(name.size())) + name + bytes + body;
    }

private:
    Fbx& add(const std::string& in_text, const std::string& in_bytes) {
        words += (words.empty() ? "" : ", ") + in_text;
        bytes += in_bytes;
        ++count;
        return *this;
    }
    Fbx& array(const std::string& list, char type, size_t size, const std::string& data) {
        return add(fmt::format("*{} {{\n\t\t\ta: {}\n\t\t}}", size, list),
                   type + raw(uint32_t(size)) + raw(uint32_t(0)) + raw(uint32_t(data.size())) + data);
    }
};

Fbx record(const std::string& name) {
    Fbx out;
    out.name = name;
    return out;
}

/// Centimetres, z up: both are said in the file.
std::vector<Fbx> fbxTree(const std::vector<Surface>& surfaces) {
    Fbx header = record("FBXHeaderExtension");
    header.inside = {record("FBXHeaderVersion").whole(1003), record("FBXVersion").whole(7400)};
    Fbx settings = record("GlobalSettings"), properties = record("Properties70");
    const auto whole = [](const char* name, int32_t value) {
        return record("P").word(name).word("int").word("Integer").word("").whole(value);
    };
    properties.inside = {whole("UpAxis", 2),
                         whole("UpAxisSign", 1),
                         whole("FrontAxis", 1),
                         whole("FrontAxisSign", -1),
                         whole("CoordAxis", 0),
                         whole("CoordAxisSign", 1),
                         record("P").word("UnitScaleFactor").word("double").word("Number").word("").real(1)};
    settings.inside = {record("Version").whole(1000), properties};
    Fbx objects = record("Objects"), connections = record("Connections");
    int64_t id = 1000;
    for (const Surface& surface : surfaces) {
        std::vector<double> points;
        std::vector<int32_t> corners;
        for (const glm::vec3& p : surface.positions)
            points.insert(points.end(), {p.x * 100.0, -p.z * 100.0, p.y * 100.0});
        for (const auto& face : surface.faces)
            for (size_t i = 0; i < face.size(); ++i)
                corners.push_back(i + 1 < face.size() ? int32_t(face[i]) : ~int32_t(face[i]));  // the last closes
        Fbx geometry = record("Geometry").number(id).word(surface.name, "Geometry").word("Mesh");
        geometry.inside = {record("Vertices").reals(points), record("PolygonVertexIndex").wholes(corners),
                           record("GeometryVersion").whole(124)};
        Fbx model = record("Model").number(id + 1).word(surface.name, "Model").word("Mesh");
        model.inside = {record("Version").whole(232)};
        objects.inside.push_back(geometry);
        objects.inside.push_back(model);
        connections.inside.push_back(record("C").word("OO").number(id + 1).number(0));
        connections.inside.push_back(record("C").word("OO").number(id).number(id + 1));
        id += 2;
    }
    return {header, settings, objects, connections};
}

std::string chunk(uint16_t id, const std::string& body) { return raw(id) + raw(uint32_t(6 + body.size())) + body; }

uint32_t checksum(const std::string& bytes) {
    uint32_t crc = ~0u;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

}  // namespace

std::string plyBytes(const std::vector<Surface>& surfaces) {
    size_t positions = 0, faces = 0;
    std::string points, corners;
    for (const Surface& surface : surfaces) {
        for (const glm::vec3& p : surface.positions) points += raw(p);
        for (const auto& face : surface.faces) {
            corners += raw(uint8_t(face.size()));
            for (const uint32_t i : face) corners += raw(int32_t(i + positions));
        }
        positions += surface.positions.size();
        faces += surface.faces.size();
    }
    return fmt::format(
               "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
               "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
               positions, faces) +
           points + corners;
}

std::string stlBytes(const std::vector<Surface>& surfaces) {
    std::string body;
    uint32_t count = 0;
    for (const Surface& surface : surfaces)
        for (const glm::uvec3& t : surface.triangles()) {
            body += raw(glm::vec3(0));
            for (int c = 0; c < 3; ++c) body += raw(surface.positions[t[c]]);
            body += std::string(2, '\0');
            ++count;
        }
    return std::string(80, ' ') + raw(count) + body;
}

std::string fbxText(const std::vector<Surface>& surfaces) {
    std::string out = "; FBX 7.4.0 project file\n";
    for (const Fbx& record : fbxTree(surfaces)) out += record.text();
    return out;
}

std::string fbxBytes(const std::vector<Surface>& surfaces) {
    std::string out = std::string("Kaydara FBX Binary  \0\x1a\0", 23) + raw(uint32_t(7400));
    for (const Fbx& record : fbxTree(surfaces)) out += record.binary(out.size());
    return out + std::string(13, '\0') + std::string(160, '\0');  // the end of the tree, and a footer that none reads
}

std::string bytesOf3ds(const std::vector<Surface>& surfaces) {
    std::string objects, tree = chunk(0xb008, raw(uint32_t(0)) + raw(uint32_t(0)));
    uint16_t id = 0;
    for (const Surface& surface : surfaces) {
        std::string points = raw(uint16_t(surface.positions.size())), faces;
        for (const glm::vec3& p : surface.positions) points += raw(glm::vec3(p.x, -p.z, p.y));  // z is up
        const std::vector<glm::uvec3> triangles = surface.triangles();
        faces = raw(uint16_t(triangles.size()));
        for (const glm::uvec3& t : triangles)
            faces += raw(uint16_t(t.x)) + raw(uint16_t(t.y)) + raw(uint16_t(t.z)) + raw(uint16_t(7));
        objects += chunk(0x4000, surface.name + '\0' + chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces)));
        const std::string no_parent = raw(uint16_t(0)) + raw(uint16_t(0)) + raw(uint16_t(0xffff));
        tree += chunk(0xb002, chunk(0xb030, raw(id++)) + chunk(0xb010, surface.name + '\0' + no_parent));
    }
    return chunk(0x4d4d, chunk(0x0002, raw(uint32_t(3))) + chunk(0x3d3d, objects) + chunk(0xb000, tree));
}

std::string zipBytes(const std::vector<std::pair<std::string, std::string>>& files) {
    std::string out, directory;
    for (const auto& [name, bytes] : files) {
        const std::string facts = raw(uint16_t(20)) + raw(uint16_t(0)) + raw(uint16_t(0)) + raw(uint32_t(0x21)) +
                                  raw(checksum(bytes)) + raw(uint32_t(bytes.size())) + raw(uint32_t(bytes.size())) +
                                  raw(uint16_t(name.size())) + raw(uint16_t(0));
        directory += "PK\x01\x02" + raw(uint16_t(20)) + facts + raw(uint16_t(0)) + raw(uint16_t(0)) + raw(uint16_t(0)) +
                     raw(uint32_t(0)) + raw(uint32_t(out.size())) + name;
        out += "PK\x03\x04" + facts + name + bytes;
    }
    return out + directory + "PK\x05\x06" + raw(uint32_t(0)) + raw(uint16_t(files.size())) +
           raw(uint16_t(files.size())) + raw(uint32_t(directory.size())) + raw(uint32_t(out.size())) + raw(uint16_t(0));
}

std::string bytesOf3mf(const std::vector<Surface>& surfaces) {
    std::string objects, items;
    int id = 1;
    for (const Surface& surface : surfaces) {
        objects += fmt::format("<object id=\"{}\" type=\"model\" name=\"{}\"><mesh><vertices>", id, surface.name);
        for (const glm::vec3& p : surface.positions)
            objects += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", p.x, p.y, p.z);
        objects += "</vertices><triangles>";
        for (const glm::uvec3& t : surface.triangles())
            objects += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", t.x, t.y, t.z);
        objects += "</triangles></mesh></object>\n";
        items += fmt::format("<item objectid=\"{}\"/>", id++);
    }
    return zipBytes(
        {{"[Content_Types].xml",
          "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
          "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
          "<Default Extension=\"model\" "
          "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
         {"_rels/.rels",
          "<?xml version=\"1.0\"?><Relationships "
          "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
          "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
          "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
         {"3D/3dmodel.model",
          "<?xml version=\"1.0\"?><model unit=\"meter\" "
          "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>" +
              objects + "</resources><build>" + items + "</build></model>"}});
}

std::string glbBytes(const std::vector<Surface>& surfaces) {
    GltfBuilder builder;
    for (const Surface& surface : surfaces) {
        std::vector<float> points;
        std::vector<uint16_t> corners;
        for (const glm::vec3& p : surface.positions) points.insert(points.end(), {p.x, p.y, p.z});
        for (const glm::uvec3& t : surface.triangles())
            corners.insert(corners.end(), {uint16_t(t.x), uint16_t(t.y), uint16_t(t.z)});
        const uint32_t mesh = builder.mesh(builder.accessor("VEC3", points), int(builder.accessor("SCALAR", corners)));
        builder.node({{"mesh", mesh}, {"name", surface.name}});
    }
    return builder.glb();
}

}  // namespace sightline::test
