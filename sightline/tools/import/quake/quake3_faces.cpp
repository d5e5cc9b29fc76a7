// Of a Quake 3 .bsp: shaders, and surfaces that are polygons, patches or meshes.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "sightline/tools/import/quake/quake_lumps.h"

namespace sightline::tools::quake {
namespace {

constexpr uint32_t kShared = 64;  // as often may surfaces show a vertex or an index, in the mean

enum : int32_t { kPolygonSurface = 1, kPatchSurface = 2, kMeshSurface = 3 };

struct Surface {
    uint32_t shader = 0;
    int32_t type = 0;
    uint32_t first_point = 0, points = 0, first_index = 0, indices = 0;
    uint32_t width = 0, height = 0;
};

Surface takeSurface(const Records& faces, uint32_t index) {
    constexpr size_t kSizeOfPatch = 96;
    ByteCursor cursor = faces.record(index);
    Surface out;
    out.shader = cursor.take<uint32_t>();
    cursor.take<int32_t>();  // fog
    out.type = cursor.take<int32_t>();
    out.first_point = cursor.take<uint32_t>();
    out.points = cursor.take<uint32_t>();
    out.first_index = cursor.take<uint32_t>();
    out.indices = cursor.take<uint32_t>();
    cursor = faces.record(index, kSizeOfPatch);
    out.width = cursor.take<uint32_t>();
    out.height = cursor.take<uint32_t>();
    return out;
}

void readShaders(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    constexpr size_t kName = 64;
    const Records shaders = lumpRecords(bytes, directory, Lump::kTextures);
    const Bytes all = lumpBytes(bytes, directory, Lump::kTextures);
    for (uint32_t i = 0; i < shaders.count(); ++i) {
        const Bytes name = all.subspan(i * size_t(72), kName);
        ByteCursor flags = shaders.record(i, kName);
        QuakeTexture& texture = map.textures.emplace_back();
        texture.name.assign(name.begin(), std::find(name.begin(), name.end(), 0));
        texture.surface_flags = flags.take<uint32_t>();
        texture.contents = flags.take<uint32_t>();
    }
}

/// The indices of a surface count from its first point; two of each three change places, because the file is clockwise.
void readIndices(const Records& indices, const Surface& surface, uint32_t number, QuakeFace& face, QuakeMapFile& map) {
    if (surface.indices % 3 != 0) fail(at("faces", number), "{} indices are no triangles", surface.indices);
    if (uint64_t(surface.first_index) + surface.indices > indices.count())
        fail(at("faces", number), "indices {} to {} of {}", surface.first_index,
             uint64_t(surface.first_index) + surface.indices, indices.count());
    if (map.indices.size() + surface.indices > size_t(kShared) * indices.count())
        fail(at("faces", number), "it shares its indices with too many others");
    face.first_index = static_cast<uint32_t>(map.indices.size());
    face.index_count = surface.indices;
    for (uint32_t k = 0; k < surface.indices; ++k) {
        const uint32_t turned = k % 3 == 0 ? k : k % 3 == 1 ? k + 1 : k - 1;
        const auto index = indices.record(surface.first_index + turned).take<uint32_t>();
        if (index >= surface.points) fail(at("faces", number), "point {} of {}", index, surface.points);
        map.indices.push_back(index);
    }
}

/// Control points: an odd number each way, 3 or more, as many as the surface has points.
void checkPatch(const Surface& surface, uint32_t number) {
    const bool odd = surface.width % 2 == 1 && surface.height % 2 == 1;
    if (!odd || surface.width < 3 || surface.height < 3 || uint64_t(surface.width) * surface.height != surface.points)
        fail(at("faces", number), "a patch of {} x {} control points that has {}", surface.width, surface.height,
             surface.points);
}

}  // namespace

void readQuake3Faces(Bytes bytes, const Directory& directory, QuakeMapFile& map) {
    readShaders(bytes, directory, map);
    const Records faces = lumpRecords(bytes, directory, Lump::kFaces);
    const Records vertices = lumpRecords(bytes, directory, Lump::kVertices);
    const Records indices = lumpRecords(bytes, directory, Lump::kMeshIndices);
    for (uint32_t i = 0; i < faces.count(); ++i) {
        const Surface surface = takeSurface(faces, i);
        QuakeFace face;
        if (surface.shader >= map.textures.size())
            fail(at("faces", i), "shader {} of {}", surface.shader, map.textures.size());
        face.texture = surface.shader;
        const bool drawn = surface.type >= kPolygonSurface && surface.type <= kMeshSurface && surface.points >= 3;
        if (drawn) {
            if (uint64_t(surface.first_point) + surface.points > vertices.count())
                fail(at("faces", i), "vertices {} to {} of {}", surface.first_point,
                     uint64_t(surface.first_point) + surface.points, vertices.count());
            if (map.points.size() + surface.points > size_t(kShared) * vertices.count())
                fail(at("faces", i), "it shares its vertices with too many others");
            face.first_point = static_cast<uint32_t>(map.points.size());
            face.point_count = surface.points;
            for (uint32_t k = 0; k < surface.points; ++k) {
                ByteCursor numbers = vertices.record(surface.first_point + k);
                map.points.push_back(takePoint(numbers, "vertices", surface.first_point + k));
            }
        }
        if (drawn && surface.type == kPatchSurface) {
            checkPatch(surface, i);
            face.kind = QuakeFace::Kind::kPatch;
            face.patch_width = surface.width;
            face.patch_height = surface.height;
        } else if (drawn) {
            readIndices(indices, surface, i, face, map);
            const bool flat = surface.type == kPolygonSurface;
            face.kind = face.index_count == 0 ? QuakeFace::Kind::kNothing
                        : flat                ? QuakeFace::Kind::kPolygon
                                              : QuakeFace::Kind::kTriangles;
        }
        map.faces.push_back(face);
    }
}

}  // namespace sightline::tools::quake
