// Reads a scene from a file of any format that is known.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/scene_file.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "sightline/tools/import/foreign/foreign.h"
#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/import/scene_kind.h"

namespace sightline::tools {
namespace {

namespace fs = std::filesystem;

Error inputError(const std::string& file, const std::string& what) {
    return {Error::Kind::kInput, fmt::format("{}: {}", file.empty() ? "\"\"" : file, what)};
}

/// The first bytes of a regular file.
Result<std::string> headOf(const std::string& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) return inputError(file, "no such file");
    if (error) return inputError(file, error.message());
    if (fs::is_directory(status)) return inputError(file, "is a directory, not a scene");
    if (!fs::is_regular_file(status)) return inputError(file, "is not a regular file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rbe"), &std::fclose);
    if (!stream) return inputError(file, fmt::format("cannot be opened: {}", std::strerror(errno)));
    std::string head(kSceneHead, '\0');
    head.resize(std::fread(head.data(), 1, head.size(), stream.get()));
    if (std::ferror(stream.get())) return inputError(file, "cannot be read");
    return head;
}

bool isMapSuffix(const std::string& suffix) { return suffix == "bsp" || suffix == "pak" || suffix == "pk3"; }

/// A scale that takes objects out of the range of numbers is the settings' fault, but shows in the scene.
bool inRange(const Scene& scene) {
    Box3d bounds = worldBounds(scene);
    for (const SceneCell& cell : scene.cells) bounds.grow(cell.bounds);
    for (const ScenePortal& portal : scene.portals)
        for (const glm::dvec3& corner : portal.polygon) bounds.grow(corner);
    if (bounds.empty() && scene.objects.empty()) return true;  // marks without a shape, that is
    return bounds.finite() && glm::length(bounds.size()) < 1e100;
}

}  // namespace

Result<SceneKind> fileKind(const std::string& name) {
    const std::string file = splitMapName(name).file;  // of a map in an archive, the archive
    const Result<std::string> head = headOf(file);
    if (!head) return head.error();
    std::error_code error;
    const uint64_t size = fs::file_size(file, error);
    if (error) return inputError(file, error.message());
    return sceneKind(file, *head, size);
}

Result<Scene> loadSceneFile(const std::string& file, const ImportSettings& settings) {
    const Result<SceneKind> kind = fileKind(file);
    if (!kind) return kind.error();
    if (!kind->format) return inputError(file, kind->refusal);
    Result<Scene> scene = !kind->format->ours()       ? loadForeign(file, kind->suffix, settings)
                          : isMapSuffix(kind->suffix) ? loadQuakeScene(file)
                                                      : loadGltf(file, settings.progress, settings.note);
    if (!scene) return scene;
    scene->name = file;
    scene->files = {{file, 0}};
    placeScene(*scene, settings);
    if (!inRange(*scene)) return inputError(file, "its bounds in the world are too large");
    return scene;
}

}  // namespace sightline::tools
