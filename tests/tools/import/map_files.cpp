// A small compiled map, lump by lump, as each format's documents lay it out.
// SPDX-License-Identifier: MIT
#include "map_files.h"

#include <map>
#include <utility>

namespace sightline::test {
using namespace tools;
namespace {

using Format = QuakeFormat;

class Lumps {
public:
    explicit Lumps(size_t count) : lumps_(count) {}

    template <class T>
    void put(size_t lump, T value) {
        lumps_[lump].append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void put(size_t lump, const glm::vec3& v) {
        for (int axis = 0; axis < 3; ++axis) put(lump, v[axis]);
    }
    void text(size_t lump, const std::string& words, size_t room) {
        std::string padded = words;
        padded.resize(room, '\0');
        lumps_[lump] += padded;
    }
    /// A box that nobody reads.
    template <class T>
    void box(size_t lump) {
        for (int i = 0; i < 6; ++i) put(lump, T(0));
    }
    std::string& operator[](size_t lump) { return lumps_[lump]; }

    std::string file(const std::string& head) const {
        std::string list, body;
        for (const std::string& lump : lumps_) {
            const auto offset = static_cast<uint32_t>(head.size() + 8 * lumps_.size() + body.size());
            const auto size = static_cast<uint32_t>(lump.size());
            list.append(reinterpret_cast<const char*>(&offset), 4).append(reinterpret_cast<const char*>(&size), 4);
            body += lump;
            body.resize((body.size() + 3) / 4 * 4, '\0');
        }
        return head + list + body;
    }

private:
    std::vector<std::string> lumps_;
};

/// The numbers of the lumps that the formats but the third share in kind.
struct Numbers {
    size_t entities, planes, vertices, visibility, nodes, texinfo, faces, leaves, marks, edges, face_edges, models;
};
constexpr Numbers kFirst = {0, 1, 3, 4, 5, 6, 7, 10, 11, 12, 13, 14};
constexpr Numbers kSecond = {0, 1, 2, 3, 4, 5, 6, 8, 9, 11, 12, 13};

bool wide(Format format) { return format == Format::kBsp2 || format == Format::kPsb2; }

struct Plane {
    glm::vec3 normal;
    float distance;
};
/// Inside is in front of all but the last, which parts the rooms.
const Plane kPlanes[] = {{{1, 0, 0}, -64}, {{-1, 0, 0}, -64}, {{0, 1, 0}, -32}, {{0, -1, 0}, -32},
                         {{0, 0, 1}, 0},   {{0, 0, -1}, -48}, {{1, 0, 0}, 0}};

void putNodes(Lumps& lumps, Format format, size_t nodes, size_t planes) {
    for (const Plane& plane : kPlanes) {
        lumps.put(planes, plane.normal);
        lumps.put(planes, plane.distance);
        if (format != Format::kQuake3) lumps.put(planes, int32_t(0));
    }
    for (int32_t i = 0; i < 7; ++i) {
        const int32_t front = i < 6 ? i + 1 : -3, back = i < 6 ? -1 : -2;
        lumps.put(nodes, i);
        if (format == Format::kQuake || format == Format::kHalfLife) {
            lumps.put(nodes, static_cast<int16_t>(front));
            lumps.put(nodes, static_cast<int16_t>(back));
        } else {
            lumps.put(nodes, front);
            lumps.put(nodes, back);
        }
        if (format == Format::kBsp2 || format == Format::kQuake3) lumps.box<int32_t>(nodes);
        else lumps.box<int16_t>(nodes);
        if (wide(format)) lumps.put(nodes, int64_t(0));
        else if (format != Format::kQuake3) lumps.put(nodes, int32_t(0));
    }
}

void putLeaves(Lumps& lumps, const MadeMap& made, Format format, size_t leaves, size_t marks) {
    const auto faces = static_cast<uint32_t>(made.faces.size());
    for (int leaf = 0; leaf < 3; ++leaf) {
        // Leaf 1 lists all faces, leaf 2 the last two, the solid one none.
        const uint32_t first = leaf == 2 ? faces - 2 : 0, count = leaf == 0 ? 0 : faces - first;
        if (format == Format::kQuake3) {
            lumps.put(leaves, int32_t(leaf - 1));
            lumps.put(leaves, int32_t(0));
            lumps.box<int32_t>(leaves);
            lumps.put(leaves, first);
            lumps.put(leaves, count);
            lumps.put(leaves, int64_t(0));
        } else if (format == Format::kQuake2) {
            lumps.put(leaves, leaf == 0 ? 1 : leaf == 1 ? 0 : 32);
            lumps.put(leaves, static_cast<int16_t>(leaf - 1));
            lumps.put(leaves, int16_t(0));
            lumps.box<int16_t>(leaves);
            lumps.put(leaves, static_cast<uint16_t>(first));
            lumps.put(leaves, static_cast<uint16_t>(count));
            lumps.put(leaves, int32_t(0));
        } else {
            lumps.put(leaves, leaf == 0 ? -2 : leaf == 1 ? -1 : -3);
            lumps.put(leaves, leaf == 0 ? -1 : made.rows[leaf - 1]);
            if (format == Format::kBsp2) lumps.box<float>(leaves);
            else lumps.box<int16_t>(leaves);
            if (wide(format)) {
                lumps.put(leaves, first);
                lumps.put(leaves, count);
            } else {
                lumps.put(leaves, static_cast<uint16_t>(first));
                lumps.put(leaves, static_cast<uint16_t>(count));
            }
            lumps.put(leaves, int32_t(0));
        }
    }
    for (uint32_t face = 0; face < faces; ++face) {
        if (wide(format) || format == Format::kQuake3) lumps.put(marks, face);
        else lumps.put(marks, static_cast<uint16_t>(face));
    }
}

/// Vertices and edges, each once; the outlines clockwise, the first point first.
void putOutlines(Lumps& lumps, const MadeMap& made, Format format, const Numbers& at) {
    std::vector<glm::vec3> vertices;
    const auto vertex = [&](const glm::vec3& point) {
        for (size_t i = 0; i < vertices.size(); ++i)
            if (vertices[i] == point) return static_cast<uint32_t>(i);
        vertices.push_back(point);
        lumps.put(at.vertices, point);
        return static_cast<uint32_t>(vertices.size() - 1);
    };
    std::map<std::pair<uint32_t, uint32_t>, int32_t> edges;
    const auto putEdge = [&](uint32_t a, uint32_t b) {
        for (const uint32_t end : {a, b}) {
            if (wide(format)) lumps.put(at.edges, end);
            else lumps.put(at.edges, static_cast<uint16_t>(end));
        }
    };
    putEdge(0, 0);  // no edge has the number 0, which has no sign
    int32_t first_edge = 0;
    for (const MadeFace& face : made.faces) {
        const size_t count = face.points.size();
        for (size_t i = 0; i < count; ++i) {
            const uint32_t a = vertex(face.points[(count - i) % count]);
            const uint32_t b = vertex(face.points[(2 * count - i - 1) % count]);
            if (edges.count({b, a})) {
                lumps.put(at.face_edges, -edges[{b, a}]);
                continue;
            }
            const auto number = static_cast<int32_t>(edges.size() + 1);
            edges[{a, b}] = number;
            putEdge(a, b);
            lumps.put(at.face_edges, number);
        }
        if (wide(format)) {
            lumps.put(at.faces, int64_t(0));
            lumps.put(at.faces, first_edge);
            lumps.put(at.faces, static_cast<int32_t>(count));
            lumps.put(at.faces, int32_t(face.texture));
        } else {
            lumps.put(at.faces, int32_t(0));
            lumps.put(at.faces, first_edge);
            lumps.put(at.faces, static_cast<int16_t>(count));
            lumps.put(at.faces, static_cast<int16_t>(face.texture));
        }
        lumps.put(at.faces, int64_t(0));
        first_edge += static_cast<int32_t>(count);
    }
}

void putTexinfo(Lumps& lumps, const MadeMap& made, Format format, const Numbers& at) {
    const auto count = static_cast<int32_t>(made.textures.size());
    for (int32_t i = 0; i < count; ++i) {
        for (int k = 0; k < 8; ++k) lumps.put(at.texinfo, 0.0f);
        if (format == Format::kQuake2) {
            constexpr int32_t kSky = 4, kWarpTrans = 8 | 16;
            lumps.put(at.texinfo, i == 1 ? kWarpTrans : i == 2 ? kSky : 0);
            lumps.put(at.texinfo, int32_t(0));
            lumps.text(at.texinfo, made.textures[static_cast<size_t>(i)], 32);
            lumps.put(at.texinfo, int32_t(-1));
        } else {
            lumps.put(at.texinfo, i);
            lumps.put(at.texinfo, int32_t(0));
        }
    }
    if (format == Format::kQuake2) return;
    constexpr size_t kTextures = 2;
    lumps.put(kTextures, count);
    int32_t place = 4 + 4 * count;
    for (const std::string& name : made.textures) {
        lumps.put(kTextures, name.empty() ? -1 : place);
        place += name.empty() ? 0 : 40;
    }
    for (const std::string& name : made.textures) {
        if (name.empty()) continue;
        lumps.text(kTextures, name, 16);
        lumps.text(kTextures, "", 24);
    }
}

void putModels(Lumps& lumps, const MadeMap& made, Format format, size_t models) {
    const auto faces = static_cast<int32_t>(made.faces.size());
    for (int model = 0; model < 2; ++model) {
        lumps.put(models, glm::vec3(-64, -32, 0));
        lumps.put(models, glm::vec3(64, 32, 48));
        if (format != Format::kQuake3) lumps.put(models, glm::vec3(0));
        if (format == Format::kQuake2) {
            lumps.put(models, int32_t(0));
        } else if (format != Format::kQuake3) {
            for (int hull = 0; hull < 4; ++hull) lumps.put(models, int32_t(0));
            lumps.put(models, model == 0 ? 2 : 0);
        }
        lumps.put(models, model == 0 ? 0 : faces - 1);
        lumps.put(models, model == 0 ? faces - 1 : 1);
        if (format == Format::kQuake3) lumps.put(models, int64_t(0));
    }
}

/// Surfaces with their own vertices and fans of triangles; and a patch of nine control points, which has no key of its own
/// in the other formats.
void putSurfaces(Lumps& lumps, const MadeMap& made) {
    constexpr size_t kShaders = 1, kVertices = 10, kIndices = 11, kFaces = 13;
    for (size_t i = 0; i < made.textures.size(); ++i) {
        constexpr int32_t kSky = 4, kSolid = 1, kWater = 32, kTranslucent = 0x20000000;
        lumps.text(kShaders, made.textures[i], 64);
        lumps.put(kShaders, i == 2 ? kSky : 0);
        lumps.put(kShaders, i == 1 ? kWater | kTranslucent : i == 3 ? kSolid | kTranslucent : kSolid);
    }
    int32_t vertices = 0, indices = 0;
    for (const MadeFace& face : made.faces) {
        const auto count = static_cast<int32_t>(face.points.size());
        for (const glm::vec3& point : face.points) {
            lumps.put(kVertices, point);
            for (int k = 0; k < 8; ++k) lumps.put(kVertices, 0.0f);
        }
        for (int32_t k = 1; k + 1 < count; ++k)
            for (const int32_t index : {0, k + 1, k}) lumps.put(kIndices, index);
        for (const int32_t number : {face.texture, -1, 1, vertices, count, indices, 3 * (count - 2)})
            lumps.put(kFaces, number);
        for (int k = 0; k < 19; ++k) lumps.put(kFaces, int32_t(0));
        vertices += count;
        indices += 3 * (count - 2);
    }
}

std::string quake3Bytes(const MadeMap& made) {
    constexpr size_t kLumps = 17;
    Lumps lumps(kLumps);
    lumps[0] = made.entities + '\0';
    putNodes(lumps, Format::kQuake3, 3, 2);
    putLeaves(lumps, made, Format::kQuake3, 4, 5);
    putSurfaces(lumps, made);
    putModels(lumps, made, Format::kQuake3, 7);
    lumps[16] = made.visibility;
    return lumps.file(std::string("IBSP\x2e\0\0\0", 8));
}

}  // namespace

MadeMap::MadeMap() {
    const glm::vec3 low(-64, -32, 0), high(64, 32, 48);
    for (int axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            glm::vec3 corner = low;
            corner[axis] = far ? high[axis] : low[axis];
            std::vector<glm::vec3> points(4, corner);
            points[1][u] = points[2][u] = high[u];
            points[2][v] = points[3][v] = high[v];
            if (far) std::swap(points[1], points[3]);  // the far walls look back
            faces.push_back({points, 0});
        }
    faces.push_back({{{0, -32, 0}, {0, -32, 48}, {0, 32, 48}, {0, 32, 0}}, 1});
    faces.push_back({{{-32, -8, 0}, {-32, -8, 24}, {-32, 0, 30}, {-32, 8, 24}, {-32, 8, 0}}, 0});
}

void madeVisibility(QuakeFormat format, bool open, MadeMap& map) {
    const auto put = [&](int32_t value) { map.visibility.append(reinterpret_cast<const char*>(&value), 4); };
    const char a = open ? 3 : 1, b = open ? 3 : 2;
    map.visibility.clear();
    if (format == QuakeFormat::kQuake3) {
        put(2);
        put(8);
        map.visibility += std::string(1, a) + std::string(7, '\0') + std::string(1, b) + std::string(7, '\0');
    } else if (format == QuakeFormat::kQuake2) {
        put(2);
        for (const int32_t offset : {20, 20, 21, 21}) put(offset);
        map.visibility += {a, b};
    } else {
        map.visibility = {a, b};
        map.rows[0] = 0;
        map.rows[1] = 1;
    }
}

std::string mapBytes(QuakeFormat format, const MadeMap& made) {
    if (format == Format::kQuake3) return quake3Bytes(made);
    const bool second = format == Format::kQuake2;
    const Numbers& at = second ? kSecond : kFirst;
    Lumps lumps(second ? 19 : 15);
    lumps[at.entities] = made.entities + '\0';
    putNodes(lumps, format, at.nodes, at.planes);
    putLeaves(lumps, made, format, at.leaves, at.marks);
    putOutlines(lumps, made, format, at);
    putTexinfo(lumps, made, format, at);
    putModels(lumps, made, format, at.models);
    lumps[at.visibility] = made.visibility;
    switch (format) {
        case Format::kQuake:
            return lumps.file(std::string("\x1d\0\0\0", 4));
        case Format::kHalfLife:
            return lumps.file(std::string("\x1e\0\0\0", 4));
        case Format::kBsp2:
            return lumps.file("BSP2");
        case Format::kPsb2:
            return lumps.file("2PSB");
        default:
            return lumps.file(std::string("IBSP\x26\0\0\0", 8));
    }
}

MadeLump lumpOf(const std::string& bytes, int number) {
    const size_t table = bytes.compare(0, 4, "IBSP") == 0 ? 8 : 4;
    MadeLump out;
    std::memcpy(&out, bytes.data() + table + 8 * static_cast<size_t>(number), sizeof out);
    return out;
}

}  // namespace sightline::test
