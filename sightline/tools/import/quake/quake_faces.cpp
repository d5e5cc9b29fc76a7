// Of a .bsp: faces by their edges, textures by their texinfo, and the models that own the faces.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_lumps.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace sightline::tools::quake {
namespace {

/// Text up to its first zero.
std::string takeText(Bytes bytes) {
    const auto end = std::find(bytes.begin(), bytes.end(), 0);
    return {bytes.begin(), end};
}

/// Names of Quake's and Half-Life's textures; empty where the file holds none.
std::vector<std::string> textureNames(Bytes lump) {
    constexpr size_t kName = 16;
    std::vector<std::string> out;
    if (lump.size() < 4) return out;
    ByteCursor cursor = cursorOf(lump);
    const auto count = cursor.take<uint32_t>();
    if (count > cursor.left() / 4) fail("", "its textures are {}, more than their lump has places for", count);
    for (uint32_t i = 0; i < count; ++i) {
        const auto place = cursor.take<int32_t>();
        if (place >= 0 && static_cast<size_t>(place) + kName > lump.size())
            fail(at("textures", i), "begins at byte {} of {}", place, lump.size());
        out.push_back(place < 0 ? "" : takeText(lump.subspan(static_cast<size_t>(place), kName)));
    }
    return out;
}

/// The texture of each texinfo. Those that look the same share one.
std::vector<uint32_t> readTexinfo(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    constexpr size_t kAxes = 32, kQuake2Name = 32;
    const Records texinfo = lumpRecords(bytes, directory, Lump::kTexinfo);
    const bool second = directory.format == QuakeFormat::kQuake2;
    const std::vector<std::string> names =
        second ? std::vector<std::string>() : textureNames(lumpBytes(bytes, directory, Lump::kTextures));
    std::map<std::tuple<std::string, uint32_t, uint32_t>, uint32_t>
        known;  // the middle: textures without a name differ
    std::vector<uint32_t> out;
    for (uint32_t i = 0; i < texinfo.count(); ++i) {
        ByteCursor record = texinfo.record(i, kAxes);
        QuakeTexture texture;
        uint32_t number = 0;
        if (second) {
            texture.surface_flags = record.take<uint32_t>();
            record.take<int32_t>();  // how bright
            const Bytes all = lumpBytes(bytes, directory, Lump::kTexinfo);
            texture.name = takeText(all.subspan(i * size_t(76) + kAxes + 8, kQuake2Name));
        } else {
            number = record.take<uint32_t>();
            texture.surface_flags = record.take<uint32_t>();
            if (!names.empty() && number >= names.size())
                fail(at("texinfo", i), "texture {} of {}", number, names.size());
            if (!names.empty()) texture.name = names[number];
        }
        const auto [found, fresh] = known.try_emplace({texture.name, number, texture.surface_flags},
                                                      static_cast<uint32_t>(map.textures.size()));
        if (fresh) map.textures.push_back(std::move(texture));
        out.push_back(found->second);
    }
    return out;
}

struct FaceRecord {
    int64_t first_edge = 0, edges = 0;
    uint32_t texinfo = 0;
};

FaceRecord takeFace(QuakeFormat format, ByteCursor cursor) {
    FaceRecord out;
    if (format == QuakeFormat::kBsp2 || format == QuakeFormat::kPsb2) {
        cursor.take<uint64_t>();  // plane and side: the outline's order says both
        out.first_edge = cursor.take<int32_t>();
        out.edges = cursor.take<int32_t>();
        out.texinfo = cursor.take<uint32_t>();
    } else {
        cursor.take<uint32_t>();
        out.first_edge = cursor.take<int32_t>();
        out.edges = cursor.take<uint16_t>();
        out.texinfo = cursor.take<uint16_t>();
    }
    return out;
}

class Edges {
public:
    Edges(Bytes bytes, const Directory& directory)
        : vertices_(lumpRecords(bytes, directory, Lump::kVertices)),
          edges_(lumpRecords(bytes, directory, Lump::kEdges)),
          of_faces_(lumpRecords(bytes, directory, Lump::kFaceEdges)),
          wide_(directory.format == QuakeFormat::kBsp2 || directory.format == QuakeFormat::kPsb2) {}

    uint32_t count() const { return of_faces_.count(); }

    /// Where a face's edge begins: a negative edge is walked the other way.
    glm::vec3 point(uint32_t face_edge) const {
        const int64_t signed_edge = of_faces_.record(face_edge).take<int32_t>();
        const uint32_t edge = edges_.checked(static_cast<uint64_t>(std::abs(signed_edge)), "face edges", face_edge);
        ByteCursor ends = edges_.record(edge);
        const uint32_t first = wide_ ? ends.take<uint32_t>() : ends.take<uint16_t>();
        const uint32_t last = wide_ ? ends.take<uint32_t>() : ends.take<uint16_t>();
        const uint32_t vertex = vertices_.checked(signed_edge < 0 ? last : first, "edges", edge);
        ByteCursor numbers = vertices_.record(vertex);
        return takePoint(numbers, "vertices", vertex);
    }

private:
    Records vertices_, edges_, of_faces_;
    bool wide_;
};

/// The file has outlines clockwise; the first point stays the first, so that the fan around it is the one engines draw.
void readOutlines(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    const std::vector<uint32_t> texinfo = readTexinfo(bytes, directory, map);
    const Records faces = lumpRecords(bytes, directory, Lump::kFaces);
    const Edges edges(bytes, directory);
    for (uint32_t i = 0; i < faces.count(); ++i) {
        const FaceRecord record = takeFace(directory.format, faces.record(i));
        if (record.first_edge < 0 || record.edges < 0 || record.first_edge + record.edges > edges.count())
            fail(at("faces", i), "face edges {} to {} of {}", record.first_edge, record.first_edge + record.edges,
                 edges.count());
        if (record.texinfo >= texinfo.size()) fail(at("faces", i), "texinfo {} of {}", record.texinfo, texinfo.size());
        // No face shares its list of edges: a file that says so is made to take memory.
        if (map.points.size() + static_cast<size_t>(record.edges) > size_t(2) * edges.count())
            fail(at("faces", i), "it shares its edges with other faces");
        QuakeFace face;
        face.kind = record.edges < 3 ? QuakeFace::Kind::kNothing : QuakeFace::Kind::kPolygon;
        face.texture = texinfo[record.texinfo];
        face.first_point = static_cast<uint32_t>(map.points.size());
        face.point_count = static_cast<uint32_t>(record.edges);
        for (int64_t k = 0; k < record.edges; ++k) {
            const int64_t turned = k == 0 ? 0 : record.edges - k;
            map.points.push_back(edges.point(static_cast<uint32_t>(record.first_edge + turned)));
        }
        map.faces.push_back(face);
    }
}

void readModels(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    const Records models = lumpRecords(bytes, directory, Lump::kModels);
    if (models.count() == 0) fail("", "has no model of the world");
    const size_t faces_at = directory.format == QuakeFormat::kQuake3   ? 24
                            : directory.format == QuakeFormat::kQuake2 ? 40
                                                                       : 56;
    for (uint32_t i = 0; i < models.count(); ++i) {
        ByteCursor record = models.record(i);
        QuakeModel model;
        model.bounds.grow(glm::dvec3(takePoint(record, "models", i)));
        model.bounds.grow(glm::dvec3(takePoint(record, "models", i)));
        ByteCursor faces = models.record(i, faces_at);
        model.first_face = faces.take<uint32_t>();
        model.face_count = faces.take<uint32_t>();
        const uint64_t end = uint64_t(model.first_face) + model.face_count;
        if (model.face_count > 0 && end > map.faces.size())
            fail(at("models", i), "faces {} to {} of {}", model.first_face, end, map.faces.size());
        if (model.face_count == 0) model.first_face = 0;
        for (uint32_t f = model.first_face; f < model.first_face + model.face_count; ++f) {
            if (map.faces[f].model != QuakeFace::kNone)
                fail(at("models", i), "face {} is model {}'s as well", f, map.faces[f].model);
            map.faces[f].model = i;
        }
        map.models.push_back(model);
    }
    map.tree.bounds = map.models[0].bounds;
    for (const QuakeFace& face : map.faces)
        if (face.model == 0)
            for (uint32_t k = 0; k < face.point_count; ++k)
                map.tree.bounds.grow(glm::dvec3(map.points[face.first_point + k]));
}

}  // namespace

void readFaces(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    if (directory.format == QuakeFormat::kQuake3) readQuake3Faces(bytes, directory, map);
    else readOutlines(bytes, directory, map);
    readModels(bytes, directory, map);
}

}  // namespace sightline::tools::quake
