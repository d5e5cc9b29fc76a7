// What a file is, by its first bytes and its suffix, and who reads it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/scene_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kOurs = "sightline", kAssimp = "assimp", kWebIfc = "web-ifc";
constexpr SidesRule kBoth = SidesRule::kNothing, kSaid = SidesRule::kMaterial;

// Left out of what Assimp reads: game models whose vertices move from frame to frame (md2, md3, mdl, mdc, 3d, smd),
// because their bounds would not hold; skeletons without a surface; maps; its own dumps; height fields without a size.
constexpr std::array kFormats = std::to_array<SceneFormat>({
    {"glb gltf", "glTF 2.0", kOurs, true, kSaid},
    {"obj", "Wavefront OBJ, with its MTL", kAssimp, true, kBoth},
    {"ply", "Stanford PLY", kAssimp, true, kBoth},
    {"stl", "Stereolithography", kAssimp, true, kBoth},
    {"fbx", "Autodesk FBX", kAssimp, true, kBoth},
    {"ifc ifczip", "Industry Foundation Classes (IFC2x3, IFC4, IFC4x3)", kWebIfc, true, kBoth},
    {"dae zae", "Collada", kAssimp, true, kSaid},
    {"3ds prj", "3D Studio", kAssimp, true, kSaid},
    {"3mf", "3D Manufacturing Format", kAssimp, true, kBoth},
    {"off", "Object File Format", kAssimp, true, kBoth},
    {"x", "DirectX", kAssimp, true, kBoth},
    {"x3d", "Extensible 3D", kAssimp, true, kBoth},
    {"dxf", "AutoCAD DXF (3D faces and meshes)", kAssimp, true, kBoth},
    {"amf", "Additive Manufacturing File", kAssimp, true, kBoth},
    {"ac acc ac3d", "AC3D", kAssimp, true, kBoth},
    {"bsp", "Compiled map of Quake, Half-Life, Quake 2 or 3", kOurs, true, kSaid},
    {"pk3 pak", "Archive of Quake with a map in it", kOurs, true, kSaid},
    {"ase ask", "3D Studio ASCII export", kAssimp, false, kSaid},
    {"b3d", "Blitz3D", kAssimp, false, kSaid},
    {"blend", "Blender, before 2.8", kAssimp, false, kBoth},
    {"cob scn", "trueSpace", kAssimp, false, kBoth},
    {"iqm", "Inter-Quake Model", kAssimp, false, kBoth},
    {"irr irrmesh", "Irrlicht", kAssimp, false, kSaid},
    {"lwo lws lxo", "LightWave, Modo", kAssimp, false, kSaid},
    {"md5mesh", "Doom 3 model", kAssimp, false, kBoth},
    {"ms3d", "MilkShape 3D", kAssimp, false, kBoth},
    {"nff enff", "Neutral File Format", kAssimp, false, kBoth},
    {"ogex", "Open Game Engine Exchange", kAssimp, false, kBoth},
    {"pmx", "MikuMikuDance", kAssimp, false, kBoth},
    {"q3o q3s", "Quick3D", kAssimp, false, kBoth},
    {"xgl zgl", "XGL", kAssimp, false, kBoth},
});

/// What begins so is certainly that. An empty `suffix` is a file that is not read, for the reason in `words`.
struct Magic {
    std::string_view bytes;
    std::string_view suffix;
    std::string_view words;
    size_t at = 0;
};

constexpr std::array kMagics = std::to_array<Magic>({
    {"glTF"sv, "glb", ""},
    {"Kaydara FBX Binary"sv, "fbx", ""},
    {"ply\n"sv, "ply", ""},
    {"ply\r"sv, "ply", ""},
    {"BLENDER"sv, "blend", ""},
    {"INTERQUAKEMODEL\0"sv, "iqm", ""},
    {"MS3D000000"sv, "ms3d", ""},
    {"xof 030"sv, "x", ""},
    {"AC3D"sv, "ac", ""},
    {"FORM"sv, "lwo", ""},
    {"version https://git-lfs.github.com/spec/"sv, "", "is a pointer of Git LFS, not the file: run git lfs pull"},
    {"\x1f\x8b"sv, "", "is compressed with gzip: unpack it first (gunzip)"},
    {"\x28\xb5\x2f\xfd"sv, "", "is compressed with Zstandard: unpack it first (unzstd)"},
    {"\xfd"
     "7zXZ\0"sv,
     "", "is compressed with xz: unpack it first (unxz)"},
    {"BZh"sv, "", "is compressed with bzip2: unpack it first (bunzip2)"},
    {"\x04\x22\x4d\x18"sv, "", "is compressed with LZ4: unpack it first (unlz4)"},
    {"7z\xbc\xaf\x27\x1c"sv, "", "is a 7z archive: unpack it first"},
    {"Rar!\x1a\x07"sv, "", "is a RAR archive: unpack it first"},
    {"ustar"sv, "", "is a tar archive: unpack it first", 257},
    {"PXR-USDC"sv, "", "is USD, which is not read: export it as glTF"},
    {"#usda"sv, "", "is USD, which is not read: export it as glTF"},
    {"//Maya ASCII"sv, "", "is a Maya scene, which is not read: export it as FBX or glTF"},
    {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv, "",
     "is a Revit family or project, a 3ds Max scene or an Office file, none of which is read: export it as IFC or "
     "glTF"},
    {"QC4DC4D6"sv, "", "is a Cinema 4D scene, which is not read: export it as glTF or FBX"},
    {"\xff\xfe\xff\x0eS\0k\0e\0t\0c\0h\0U\0p\0"sv, "", "is a SketchUp model, which is not read: export it as glTF"},
    {"AC10"sv, "", "is an AutoCAD drawing (DWG), which is not read: export it as glTF, FBX or DXF"},
    {"IBSP"sv, "bsp", ""},
    {"BSP2"sv, "bsp", ""},
    {"2PSB"sv, "bsp", ""},
    {"PACK"sv, "pak", ""},
    {"VBSP"sv, "", "is a map of Source, which is not read"},
    {"PRT1"sv, "", "holds a map's portals, which vis and info read, and is no scene: name the .bsp"},
    {"PRT2"sv, "", "holds a map's portals, which vis and info read, and is no scene: name the .bsp"},
    {"sightline cells\n"sv, "", "is a visibility file, not a scene: give it with --visibility"},
    {"LASF"sv, "", "is a point cloud: it has no surfaces that could hide anything"},
    {"# .PCD"sv, "", "is a point cloud: it has no surfaces that could hide anything"},
    {"\x89PNG"sv, "", "is a picture, not a scene"},
    {"\xff\xd8\xff"sv, "", "is a picture, not a scene"},
    {"%PDF"sv, "", "is a PDF, not a scene"},
    {"\x7f"
     "ELF"sv,
     "", "is a program, not a scene"},
});

struct Refused {
    std::string_view suffixes, words;
};

constexpr std::array kRefused = std::to_array<Refused>({
    {"step stp stpz p21", "is STEP, a CAD exchange format without triangles: export it as glTF or IFC"},
    {"iges igs", "is IGES, a CAD exchange format without triangles: export it as glTF or IFC"},
    {"rvt rfa rte", "is a Revit file, which is not read: export it as IFC or glTF"},
    {"skp", "is a SketchUp model, which is not read: export it as glTF or IFC"},
    {"dwg", "is an AutoCAD drawing (DWG), which is not read: export it as glTF, FBX or DXF"},
    {"dgn", "is a MicroStation drawing, which is not read: export it as glTF or IFC"},
    {"max", "is a 3ds Max scene, which is not read: export it as glTF or FBX"},
    {"ma mb", "is a Maya scene, which is not read: export it as glTF or FBX"},
    {"c4d", "is a Cinema 4D scene, which is not read: export it as glTF or FBX"},
    {"usd usda usdc usdz", "is USD, which is not read: export it as glTF"},
    {"3dm", "is a Rhino model, which is not read: export it as glTF or OBJ"},
    {"sldprt sldasm catpart catproduct ipt iam jt x_t x_b sat",
     "is a CAD model, which is not read: export it as glTF or IFC"},
    {"nwd nwc nwf", "is a Navisworks file, which is not read: export it as IFC or FBX"},
    {"ifcxml", "is IFC as XML, which is not read: export it as .ifc"},
    {"map", "is the source of a game map, which vis and bake read, and is no scene: name the .bsp"},
    {"prt", "holds a map's portals, which vis and info read, and is no scene: name the .bsp"},
    {"wad", "is an archive of a game's textures, which is not read"},
    {"md2 md3 mdl mdc smd vta 3d",
     "moves its vertices from frame to frame, so that its bounds are not known: export it as glTF"},
    {"bvh csm", "is a motion without a surface"},
    {"vrml wrl", "is VRML, which is not read: export it as glTF or X3D"},
    {"las laz e57 pcd xyz pts", "is a point cloud: it has no surfaces that could hide anything"},
    {"mtl", "holds the materials of an .obj file: name that file instead"},
    {"bin", "holds the buffers of a .gltf file: name that file instead"},
    {"vox", "is a voxel model, which is not read: export it as glTF or OBJ"},
});

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

bool listed(std::string_view list, std::string_view word) {
    if (word.empty()) return false;
    for (size_t at = list.find(word); at != std::string_view::npos; at = list.find(word, at + 1)) {
        const size_t end = at + word.size();
        if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' ')) return true;
    }
    return false;
}

SceneKind read(std::string_view suffix) { return {sceneFormat(suffix), std::string(suffix), {}}; }
SceneKind refuse(std::string_view words) { return {nullptr, {}, std::string(words)}; }

std::string readable() {
    std::string out;
    for (const SceneFormat& format : kFormats) {
        const std::string_view first = format.suffixes.substr(0, format.suffixes.find(' '));
        if (format.tested) out += (out.empty() ? "." : ", .") + std::string(first);
    }
    return out;
}

/// A binary STL has no magic, but its length says how many triangles it has.
bool isBinaryStl(std::string_view head, uint64_t size) {
    if (head.size() < 84) return false;
    uint32_t triangles = 0;
    std::memcpy(&triangles, head.data() + 80, sizeof triangles);
    return triangles > 0 && size == 84 + uint64_t(50) * triangles;
}

std::string_view trimmed(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    return text;
}

/// JSON: glTF or something else that Sightline or others write.
SceneKind jsonKind(std::string_view head, bool whole, std::string_view suffix) {
    const auto has = [&](std::string_view key) { return head.find(key) != std::string_view::npos; };
    if (has("\"asset\"") || (suffix == "gltf" && !whole)) return read("gltf");
    if (has("\"sightline.")) return refuse("is a result of Sightline, not a scene");
    if (has("\"frames\"")) return refuse("is a camera path, not a scene: give it with --cameras");
    if (has("\"CityJSON\"") || has("\"CityJSONFeature\""))
        return refuse("is CityJSON, which is not read: export it as glTF");
    if (has("\"FeatureCollection\"")) return refuse("is GeoJSON, which is not read: export it as glTF");
    if (suffix == "gltf") return read("gltf");  // whose reader says what is missing
    return refuse("is JSON, but not glTF");
}

/// An entity of a map's source begins as JSON does, but between a key and its value stands no colon.
bool isMapSource(std::string_view text) {
    const size_t open = text.find_first_not_of(" \t\r\n", 1);
    if (open == std::string_view::npos || text[open] != '"') return false;
    const size_t close = text.find('"', open + 1);
    const size_t next = close == std::string_view::npos ? close : text.find_first_not_of(" \t\r\n", close + 1);
    return next != std::string_view::npos && text[next] == '"';
}

/// STEP is the text that IFC is written in, too.
SceneKind stepKind(const std::string& head) {
    const size_t schema = head.find("file_schema");
    const size_t end = schema == std::string::npos ? schema : head.find(';', schema);
    const size_t ifc = schema == std::string::npos ? schema : head.find("ifc", schema);
    if (ifc < end) return read("ifc");
    return refuse("is STEP, a CAD exchange format without triangles: export it as glTF or IFC");
}

SceneKind zipKind(std::string_view head, std::string_view suffix) {
    for (const char* zipped : {"3mf", "zae", "ifczip", "pk3"})
        if (suffix == zipped) return read(zipped);
    if (suffix == "skp") return refuse("is a SketchUp model, which is not read: export it as glTF or IFC");
    if (suffix == "usdz") return refuse("is USD, which is not read: export it as glTF");
    if (head.find("3D/3dmodel.model") != std::string_view::npos) return read("3mf");
    return refuse("is a zip archive: unpack it first");
}

/// XML that is told apart by its first element.
SceneKind xmlKind(const std::string& head) {
    const auto has = [&](std::string_view tag) { return head.find(tag) != std::string::npos; };
    if (has("<collada")) return read("dae");
    if (has("<x3d")) return read("x3d");
    if (has("<amf")) return read("amf");
    if (has("<ifcxml") || has(":ifcxml")) return refuse("is IFC as XML, which is not read: export it as .ifc");
    if (has("<html")) return refuse("is a web page, not the file: download the file itself");
    if (has("<svg")) return refuse("is a picture, not a scene");
    if (has("citymodel")) return refuse("is CityGML, which is not read: export it as glTF");
    if (has("<kml")) return refuse("is KML, not a scene");
    return {};
}

/// The version stands behind the magic: "BLENDER-v279", of late "BLENDER17-01v0500".
SceneKind blendKind(std::string_view head) {
    const std::string_view after = head.substr(7, 10);
    const size_t v = after.find_first_of("vV");
    if (v == std::string_view::npos) return read("blend");
    unsigned version = 0;
    for (size_t i = v + 1; i < after.size() && std::isdigit(static_cast<unsigned char>(after[i])); ++i)
        version = 10 * version + static_cast<unsigned>(after[i] - '0');
    if (version < 280) return read("blend");
    return refuse(
        fmt::format("is of Blender {}.{}, which is not read: export it as glTF", version / 100, version % 100));
}

bool isText(std::string_view head) { return head.find('\0') == std::string_view::npos; }

/// False if a file can certainly not be what its suffix says.
bool looksLike(std::string_view suffix, std::string_view head, const std::string& low) {
    const auto has = [&](std::string_view word) { return low.find(word) != std::string::npos; };
    const auto line = [&](std::string_view word) {
        for (size_t at = low.find(word); at != std::string::npos; at = low.find(word, at + 1)) {
            const size_t before = low.find_last_not_of(" \t", at == 0 ? std::string::npos : at - 1);
            if (at == 0 || before == std::string::npos || low[before] == '\n' || low[before] == '\r') return true;
        }
        return false;
    };
    if (suffix == "obj")
        return isText(head) && (line("v ") || line("v\t") || line("#") || line("mtllib") || line("o ") || line("g "));
    if (suffix == "stl") return !isText(head) || trimmed(low).starts_with("solid");
    if (suffix == "ply") return low.starts_with("ply");
    if (suffix == "off") return has("off");
    if (suffix == "ifc") return has("iso-10303-21");
    if (suffix == "fbx") return !isText(head) || has("fbx") || has("objects");
    if (suffix == "3ds" || suffix == "prj") return head.size() >= 6 && head[0] == 'M' && head[1] == 'M';
    if (suffix == "x") return low.starts_with("xof ");
    if (suffix == "dxf") return has("section") || head.starts_with("AutoCAD Binary DXF");
    if (suffix == "dae" || suffix == "x3d" || suffix == "amf") return has("<");
    if (suffix == "3mf" || suffix == "zae" || suffix == "ifczip") return head.starts_with("PK");
    if (suffix == "bsp") return head.size() >= 4 && (head[0] == 29 || head[0] == 30) && head.substr(1, 3) == "\0\0\0"sv;
    if (suffix == "pk3" || suffix == "pak") return head.starts_with("PK");
    if (suffix == "glb") return head.starts_with("glTF"sv.substr(0, head.size()));
    return true;
}

}  // namespace

std::span<const SceneFormat> sceneFormats() { return kFormats; }

const SceneFormat* sceneFormat(std::string_view suffix) {
    for (const SceneFormat& format : kFormats)
        if (listed(format.suffixes, suffix)) return &format;
    return nullptr;
}

SceneKind sceneKind(const std::string& file, std::string_view head, uint64_t size) {
    std::string suffix = lower(std::filesystem::path(file).extension().string());
    if (!suffix.empty()) suffix.erase(0, 1);
    if (size == 0) return refuse("is empty");
    if (isBinaryStl(head, size)) return read("stl");
    if (head.starts_with("PK\x03\x04")) return zipKind(head, suffix);
    const bool zipped = suffix == "blend" || suffix == "zgl";  // compressed by design
    for (const Magic& magic : kMagics)
        if (head.size() >= magic.at && head.substr(magic.at).starts_with(magic.bytes)) {
            if (magic.suffix == "lwo" && !listed("lwo lxo", suffix)) continue;  // other formats are IFF, too
            if (zipped && head.starts_with("\x1f\x8b")) break;
            if (magic.suffix == "blend") return blendKind(head);
            return magic.suffix.empty() ? refuse(magic.words) : read(magic.suffix);
        }

    const std::string low = lower(head);
    const std::string_view text = trimmed(low);
    if (text.starts_with('{') && !isMapSource(text)) return jsonKind(head, size <= head.size(), suffix);
    if (text.starts_with("iso-10303-21")) return stepKind(low);
    if (text.starts_with("<!doctype html")) return refuse("is a web page, not the file: download the file itself");
    if (text.starts_with('<'))
        if (SceneKind xml = xmlKind(low); xml.format || !xml.refusal.empty()) return xml;

    if (isMapSource(text)) suffix = "map";
    for (const Refused& refused : kRefused)
        if (listed(refused.suffixes, suffix)) return refuse(refused.words);
    const SceneFormat* format = sceneFormat(suffix);
    if (!format)
        return refuse(fmt::format("not a scene that can be read: {} and more (sightline info --formats)", readable()));
    if (!looksLike(suffix, head, low))
        return refuse(fmt::format("is not what its suffix .{} says ({})", suffix, format->name));
    return read(suffix);
}

}  // namespace sightline::tools
