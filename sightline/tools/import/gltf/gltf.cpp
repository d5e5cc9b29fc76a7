// Reads the geometry of a glTF 2.0 file into a scene.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf.h"

#include <optional>

#include "sightline/tools/import/gltf/gltf_objects.h"
#include "sightline/tools/import/gltf/gltf_open.h"

namespace sightline::tools {
namespace {

using namespace gltf;

Scene sceneOf(Document document, const std::string& name) {
    Scene scene = makeScene(document);
    scene.name = name;
    document.progress.reach(Progress::kBuilt, Progress::kTotal, 1);
    return scene;
}

}  // namespace

Result<Scene> loadGltf(const std::string& path, const std::function<void(size_t done, size_t total)>& progress) {
    return guarded(path, [&]() -> Result<Scene> { return sceneOf(openGltf(path, progress), path); });
}

Result<Scene> parseGltf(std::span<const unsigned char> bytes, const std::string& name) {
    return guarded(name,
                   [&]() -> Result<Scene> { return sceneOf(openDocument(ByteSource(bytes), std::nullopt), name); });
}

}  // namespace sightline::tools
