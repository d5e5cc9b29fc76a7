// Reads a file with Assimp and sends what it holds: nodes, meshes, objects, cameras.
// SPDX-License-Identifier: MIT
#include "apps/import/send_scene.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <assimp/DefaultIOSystem.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/ProgressHandler.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/core.h>

#include "apps/import/fault.h"
#include "apps/import/obj_rewrite.h"
#include "apps/import/materials.h"
#include "apps/import/placement.h"
#include "apps/import/poses.h"
#include "apps/import/triangles.h"
#include "sightline/tools/import/foreign/scene_stream.h"
#include "sightline/tools/import/scene_kind.h"

namespace sightline::import {
using namespace tools;
namespace {

// What Assimp says of a file that it nevertheless reads: what is missing or was left out.

/// Listens from its construction on; one at a time.
class Warnings {
public:
    Warnings();
    ~Warnings();
    Warnings(const Warnings&) = delete;
    Warnings& operator=(const Warnings&) = delete;

    /// Takes down one line, if it tells of geometry or materials that are not there.
    void hear(std::string line);
    /// A note for each kind of thing that is missing, up to eight, with how often.
    void send(SceneStreamWriter& out) const;

private:
    std::map<std::string, uint64_t> heard_;
};

constexpr size_t kMostKinds = 1000, kMostNotes = 8;

class Ear : public Assimp::LogStream {
public:
    explicit Ear(Warnings& warnings) : warnings_(warnings) {}
    void write(const char* message) override { warnings_.hear(message); }

private:
    Warnings& warnings_;
};

/// "Warn,  T0: text\n" without what stands around the text, and without numbers that differ from line to line.
std::string plain(std::string line) {
    if (const size_t colon = line.find(": "); colon != std::string::npos && colon < 16) line.erase(0, colon + 2);
    if (const size_t id = line.find(" id is "); id != std::string::npos) line.resize(id);
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    return line;
}

bool tellsOfLoss(std::string_view line) {
    // Of things that are not taken anyway, and of versions that are read nevertheless.
    for (const char* word :
         {"LayerElement", "newer format version", "CONTENT_TYPES", "texture", "Texture", "animation"})
        if (line.find(word) != std::string_view::npos) return false;
    for (const char* word : {"skipping", "Skipping", "skipped", "Unable to locate material", "failed to", "Failed to",
                             "could not", "unsupported", "Unsupported", "not supported", "ignoring", "too many"})
        if (line.find(word) != std::string_view::npos) return true;
    return false;
}

Warnings::Warnings() {
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Ear(*this), Assimp::Logger::Warn | Assimp::Logger::Err);
}

Warnings::~Warnings() { Assimp::DefaultLogger::kill(); }

void Warnings::hear(std::string line) {
    line = plain(std::move(line));
    if (tellsOfLoss(line) && (heard_.size() < kMostKinds || heard_.count(line))) ++heard_[line];
}

void Warnings::send(SceneStreamWriter& out) const {
    size_t sent = 0;
    for (const auto& [line, times] : heard_) {
        if (sent++ == kMostNotes) {
            out.note(fmt::format("and {} more of this kind", heard_.size() - kMostNotes));
            return;
        }
        out.note(times == 1 ? line : fmt::format("{} ({} times)", line, times));
    }
}

// Assimp's view of the disk: regular files alone, read-only, the scene's file under the suffix of its format.

class FileAccess : public Assimp::DefaultIOSystem {
public:
    /// @param suffix  by which Assimp knows the format: "obj"
    FileAccess(std::string file, const std::string& suffix);

    /// The name to give to Assimp: the file's own, with another suffix where its own is not the format's.
    const std::string& alias() const { return alias_; }

    /// All of the file. Throws a Fault if it cannot be read.
    std::string text() const;
    /// From now on the file holds this.
    void replace(std::string text) { text_ = std::move(text); }

    bool Exists(const char* name) const override;
    Assimp::IOStream* Open(const char* name, const char* mode) override;

private:
    std::string realName(const char* name) const;

    std::string file_, alias_;
    std::string text_;  ///< instead of the file's own, unless empty
};

namespace fs = std::filesystem;

FileAccess::FileAccess(std::string file, const std::string& suffix) : file_(std::move(file)) {
    fs::path alias = file_;
    if (!alias.has_parent_path()) alias = fs::path(".") / alias;
    std::string own = alias.extension().string();
    std::transform(own.begin(), own.end(), own.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (own != "." + suffix) alias.replace_extension(suffix);
    alias_ = alias.string();
}

std::string FileAccess::text() const {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file_.c_str(), "rb"), &std::fclose);
    if (!stream) throw Fault{"cannot be opened"};
    std::error_code ignored;
    std::string out(fs::file_size(file_, ignored), '\0');
    if (ignored) throw Fault{"cannot be read"};
    out.resize(std::fread(out.data(), 1, out.size(), stream.get()));
    return out;
}

std::string FileAccess::realName(const char* name) const { return name == alias_ ? file_ : name; }

bool FileAccess::Exists(const char* name) const {
    std::error_code ignored;
    return fs::is_regular_file(realName(name), ignored);
}

Assimp::IOStream* FileAccess::Open(const char* name, const char* mode) {
    if (std::strpbrk(mode, "wa+") || !Exists(name)) return nullptr;
    if (!text_.empty() && name == alias_)
        return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(text_.data()), text_.size());
    return DefaultIOSystem::Open(realName(name).c_str(), mode);
}

constexpr uint64_t kSteps = 100, kReadSteps = 60;  ///< of progress; reading is most of it

class ReadProgress : public Assimp::ProgressHandler {
public:
    explicit ReadProgress(SceneStreamWriter& out) : out_(out) {}
    bool Update(float part) override {
        if (!(part >= 0 && part <= 1)) return true;
        const auto step = static_cast<uint64_t>(double(kReadSteps) * std::min(1.0f, 2 * part));  // it counts to a half
        if (step > told_) out_.progress(told_ = step, kSteps);
        return true;
    }

private:
    SceneStreamWriter& out_;
    uint64_t told_ = 0;
};

/// Walks a scene once; what it has to remember meanwhile.
class Sender {
public:
    Sender(const aiScene& scene, const std::string& file, const std::string& suffix, SceneStreamWriter& out)
        : scene_(scene),
          file_(file),
          suffix_(suffix),
          out_(out),
          place_(placementOf(scene, suffix)),
          poses_(scene),
          materials_(scene, suffix, std::filesystem::path(file).parent_path().string(), out) {}

    void send() {
        struct Todo {
            const aiNode* node;
            uint32_t parent;
            bool moves;  // with what is above it
        };
        std::vector<Todo> todo{{scene_.mRootNode, SceneNode::kNone, false}};
        while (!todo.empty()) {
            const auto [node, parent, goes_along] = todo.back();
            todo.pop_back();
            const uint32_t index = nodes_++;
            const bool moves = goes_along || poses_.moves(*node);
            out_.node({nodeName(*node), parent});
            sendObject(*node, index, moves);
            for (unsigned c = node->mNumChildren; c-- > 0;) todo.push_back({node->mChildren[c], index, moves});
        }
        if (objects_ == 0) throw Fault{nothing()};
        materials_.tellUnread();
        for (unsigned c = 0; c < scene_.mNumCameras; ++c) sendCamera(*scene_.mCameras[c]);
    }

private:
    std::string nodeName(const aiNode& node) const {
        const std::string name = node.mName.C_Str();
        // Names that Assimp made up: of the root, of what has no name.
        const bool root = !node.mParent;
        if (root && (name == std::filesystem::path(file_).filename().string() || name == "RootNode" || name == "ROOT" ||
                     name == "3MF" || name == "DXCC_ROOT" || name == "<DXF_ROOT>" || suffix_ == "dae" ||
                     suffix_ == "zae" || name == alias_))
            return {};
        if (name.starts_with('<') && name.ends_with('>')) return {};
        return name;
    }

    glm::dmat4 worldOf(const aiNode* node) const {
        glm::dmat4 out(1.0);
        for (; node; node = node->mParent) {
            const auto known = worlds_.find(node);
            if (known != worlds_.end()) return known->second * out;
            out = toMatrix(node->mTransformation) * out;
        }
        return out;
    }

    void sendObject(const aiNode& node, uint32_t index, bool moves) {
        const glm::dmat4 world = worldOf(&node);
        if (node.mNumChildren > 0) worlds_.emplace(&node, world);
        if (node.mNumMeshes == 0) return;
        std::vector<unsigned> group(node.mMeshes, node.mMeshes + node.mNumMeshes);
        for (const unsigned mesh : group)
            if (mesh >= scene_.mNumMeshes)
                throw Fault{fmt::format("node '{}': there is no mesh {}", node.mName.C_Str(), mesh)};
        const std::optional<uint32_t> mesh = meshOf(group, world, nodeName(node));
        if (!mesh) return;
        SceneObject object;
        object.mesh = *mesh;
        object.node = index;
        object.changes = moves ? SceneObject::kAnimated : 0;
        object.transform = place_ * world;
        object.name = nodeName(node);
        if (object.name.empty()) object.name = scene_.mMeshes[group[0]]->mName.C_Str();
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                if (!std::isfinite(object.transform[column][row]))
                    throw Fault{fmt::format("node '{}': its transform is not finite", node.mName.C_Str())};
        out_.object(object);
        ++objects_;
    }

    /// The mesh of these, which is sent when first asked for. None if they have no triangles.
    std::optional<uint32_t> meshOf(const std::vector<unsigned>& group, const glm::dmat4& world,
                                   const std::string& name) {
        const bool deforms =
            std::any_of(group.begin(), group.end(), [&](unsigned m) { return Poses::deforms(*scene_.mMeshes[m]); });
        // Bones do not move with the node, so that bounds differ from node to node.
        const auto known = sent_.find(group);
        if (!deforms && known != sent_.end()) return known->second;
        size_t corners = 0;
        for (const unsigned m : group) corners += scene_.mMeshes[m]->mNumVertices;
        PositionPool pool(corners);
        Mesh mesh;
        mesh.name = scene_.mMeshes[group[0]]->mName.C_Str();
        if (mesh.name.empty()) mesh.name = name;
        mesh.deforms = deforms;
        mesh.bounds = {glm::dvec3(0), glm::dvec3(0)};
        if (deforms) mesh.bounds = Box3d{};
        for (const unsigned m : group) {
            addPrimitive(*scene_.mMeshes[m], pool, mesh);
            if (deforms) mesh.bounds.grow(poses_.bounds(*scene_.mMeshes[m], world));
        }
        mesh.positions = std::move(pool.positions);
        std::optional<uint32_t> out;
        if (!mesh.indices.empty()) {
            out = meshes_++;
            out_.mesh(mesh);
            for (const unsigned m : group) done_ += scene_.mMeshes[m]->mNumFaces;
            tellProgress();
        }
        if (!deforms) sent_.emplace(group, out);
        return out;
    }

    void addPrimitive(const aiMesh& from, PositionPool& pool, Mesh& to) {
        const auto fail = [&](const std::string& what) -> Fault {
            return {fmt::format("mesh '{}': {}", from.mName.length > 0 ? from.mName.C_Str() : to.name, what)};
        };
        const size_t before = to.triangles();
        std::vector<uint32_t> map(from.mNumVertices, ~0u);
        const auto corner = [&](unsigned v) {
            if (v >= from.mNumVertices) throw fail(fmt::format("vertex {} of {}", v, from.mNumVertices));
            const aiVector3D& p = from.mVertices[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                throw fail(fmt::format("vertex {} is not finite", v));
            if (map[v] == ~0u) map[v] = pool.add({p.x, p.y, p.z});
            return map[v];
        };
        std::vector<glm::dvec3> polygon;
        std::vector<uint32_t> cut, ring;
        for (unsigned f = 0; f < from.mNumFaces; ++f) {
            const aiFace& face = from.mFaces[f];
            if (face.mNumIndices < 3) {
                ++thin_;
                continue;
            }
            ring.clear();
            for (unsigned i = 0; i < face.mNumIndices; ++i) ring.push_back(corner(face.mIndices[i]));
            if (ring.size() == 3) {
                to.indices.insert(to.indices.end(), ring.begin(), ring.end());
                continue;
            }
            polygon.clear();
            for (const uint32_t i : ring) polygon.emplace_back(pool.positions[i]);
            cut.clear();
            cutPolygon(polygon, cut);
            for (const uint32_t i : cut) to.indices.push_back(ring[i]);
        }
        const size_t count = to.triangles() - before;
        if (to.indices.size() > ~0u) throw fail("has more triangles than can be counted");
        if (count == 0) return;
        to.primitives.push_back({uint32_t(before), uint32_t(count), materials_.of(from)});
    }

    void tellProgress() {
        if (total_ == 0)
            for (unsigned m = 0; m < scene_.mNumMeshes; ++m) total_ += scene_.mMeshes[m]->mNumFaces;
        if (total_ == 0) return;
        const uint64_t step = kReadSteps + (kSteps - kReadSteps) * std::min(done_, total_) / total_;
        if (step > told_) out_.progress(told_ = step, kSteps);
    }

    std::string nothing() const {
        uint64_t points = 0;
        for (unsigned m = 0; m < scene_.mNumMeshes; ++m) points += scene_.mMeshes[m]->mNumVertices;
        if (points == 0) return "draws nothing: there is no surface in it";
        return fmt::format("draws nothing: it has {} points{}, but no triangle", points, thin_ > 0 ? " and lines" : "");
    }

    void sendCamera(const aiCamera& camera) {
        const aiNode* node = scene_.mRootNode->FindNode(camera.mName);
        if (const std::optional<SceneCamera> placed = cameraOf(camera, place_ * worldOf(node))) out_.camera(*placed);
    }

    const aiScene& scene_;
    const std::string& file_;
    const std::string suffix_;
    const std::string alias_ = std::filesystem::path(file_).stem().string() + "." + suffix_;
    SceneStreamWriter& out_;
    const glm::dmat4 place_;
    const Poses poses_;
    Materials materials_;
    std::map<std::vector<unsigned>, std::optional<uint32_t>> sent_;
    std::map<const aiNode*, glm::dmat4> worlds_;
    uint32_t nodes_ = 0, meshes_ = 0, objects_ = 0;
    uint64_t thin_ = 0, done_ = 0, total_ = 0, told_ = kReadSteps;
};

}  // namespace

void sendScene(const std::string& file, const std::string& suffix, SceneStreamWriter& out) {
    Warnings warnings;
    Assimp::Importer importer;
    FileAccess* const access = new FileAccess(file, suffix);  // the importer's from here on
    importer.SetIOHandler(access);
    if (suffix == "obj") access->replace(rewriteObj(access->text()));
    importer.SetProgressHandler(new ReadProgress(out));
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);  // one node a node
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);    // no surface that is not in the file
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_SEPARATE_BFCULL, false);
    // No steps after reading: joining and triangulating there moves or drops what is small.
    const aiScene* scene = importer.ReadFile(access->alias(), 0);
    if (!scene) throw importerFault(importer.GetErrorString());
    if (!scene->mRootNode) throw Fault{"draws nothing: there is no node in it"};
    out.progress(kReadSteps, kSteps);
    Sender(*scene, file, suffix, out).send();
    warnings.send(out);
}

}  // namespace sightline::import
