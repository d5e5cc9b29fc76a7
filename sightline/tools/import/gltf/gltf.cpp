// Reads the geometry of a glTF 2.0 file into a scene.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf.h"

#include <optional>

#include "sightline/tools/import/gltf/gltf_objects.h"
#include "sightline/tools/import/gltf/gltf_open.h"

namespace sightline::tools {
namespace {

using namespace gltf;

/// Extensions that are not known, with how often each was met.
std::string unknownText(const std::map<std::string, size_t>& unknown) {
    std::string text;
    size_t named = 0;
    for (const auto& [name, count] : unknown) {
        if (named++ == 3) break;
        text += fmt::format("{}{} ({} times)", text.empty() ? "" : ", ", printable(name), count);
    }
    if (unknown.size() > 3) text += fmt::format(" and {} more", unknown.size() - 3);
    return "extensions that are not known: " + text + "; what carries one hides nothing";
}

Scene sceneOf(Document document, const std::string& name, const std::function<void(const std::string&)>& note) {
    Scene scene = makeScene(document);
    if (note && !document.unknown.empty()) note(unknownText(document.unknown));
    for (const std::string& text : document.notes)
        if (note) note(text);
    scene.name = name;
    document.progress.reach(Progress::kBuilt, Progress::kTotal, 1);
    return scene;
}

}  // namespace

Result<Scene> loadGltf(const std::string& path, const std::function<void(size_t done, size_t total)>& progress,
                       const std::function<void(const std::string& text)>& note) {
    return guarded(path, [&]() -> Result<Scene> { return sceneOf(openGltf(path, progress), path, note); });
}

Result<Scene> parseGltf(std::span<const unsigned char> bytes, const std::string& name) {
    return guarded(name,
                   [&]() -> Result<Scene> { return sceneOf(openDocument(ByteSource(bytes), std::nullopt), name, {}); });
}

}  // namespace sightline::tools
