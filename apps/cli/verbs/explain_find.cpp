// Which object of a scene a word or a pixel means.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/explain_find.h"

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/format.h>

#include "apps/cli/verbs/common.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace studies;
using namespace tools;
namespace {

constexpr size_t kLongestCall = 200;  // of a path, in sentences  [bytes]

/// The objects of which a test holds, if they have one key; else empty, and `keys` has all of theirs.
template <class Test>
std::vector<uint32_t> withOneKey(const Scene& scene, Test test, std::set<uint64_t>& keys) {
    keys.clear();
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (!test(scene.objects[i])) continue;
        found.push_back(i);
        keys.insert(scene.objects[i].key);
    }
    if (keys.size() > 1) found.clear();
    return found;
}

Error ambiguous(const Scene& scene, const std::string& word, const std::set<uint64_t>& keys) {
    constexpr size_t kMost = 10;
    std::string list;
    std::set<uint64_t> listed;
    for (uint32_t i = 0; i < scene.objects.size() && listed.size() < kMost; ++i) {
        const uint64_t key = scene.objects[i].key;
        if (!keys.count(key) || !listed.insert(key).second) continue;
        list += fmt::format("{}{} '{}'", list.empty() ? "" : ", ", key,
                            oneLine(objectPath(scene, scene.objects[i]), kLongestCall));
    }
    if (keys.size() > kMost) list += ", ...";
    return {Error::Kind::kUsage, fmt::format("--object {}: {} objects are called so: {}", word, keys.size(), list)};
}

/// The view through one pixel alone.
View throughPixel(const View& view, uint32_t x, uint32_t y) {
    View pixel = view;
    const double centre_x = 2.0 * (x + 0.5) / view.width - 1.0, centre_y = 1.0 - 2.0 * (y + 0.5) / view.height;
    glm::dmat4 pick(1.0);
    pick[0][0] = view.width;
    pick[1][1] = view.height;
    pick[3][0] = -centre_x * view.width;
    pick[3][1] = -centre_y * view.height;
    pixel.projection = pick * view.projection;
    pixel.width = pixel.height = 1;
    pixel.jitter = 0;
    return pixel;
}

}  // namespace

Result<std::vector<uint32_t>> findObjects(const Scene& scene, const std::string& word) {
    std::set<uint64_t> keys;
    std::vector<uint32_t> found;
    uint64_t key = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), key);
    if (fault == std::errc() && end == word.data() + word.size()) {
        found = withOneKey(
            scene, [&](const SceneObject& object) { return object.key == key; }, keys);
        if (!found.empty()) return found;
    }
    found = withOneKey(
        scene, [&](const SceneObject& object) { return objectPath(scene, object) == word; }, keys);
    if (!found.empty()) return found;
    if (!keys.empty()) return ambiguous(scene, word, keys);
    found = withOneKey(
        scene, [&](const SceneObject& object) { return object.name == word; }, keys);
    if (!found.empty()) return found;
    if (!keys.empty()) return ambiguous(scene, word, keys);
    const std::string part = lower(word);
    found = withOneKey(
        scene,
        [&](const SceneObject& object) { return lower(objectPath(scene, object)).find(part) != std::string::npos; },
        keys);
    if (word.empty() || keys.empty())
        return Error{Error::Kind::kUsage, fmt::format("--object {}: {} has no object of that key, name or path",
                                                      word.empty() ? "\"\"" : word, scene.name)};
    if (found.empty()) return ambiguous(scene, word, keys);
    return found;
}

std::vector<Layer> layersAt(const Scene& scene, const View& view, uint32_t x, uint32_t y, size_t most) {
    const View pixel = throughPixel(view, x, y);
    const RenderList list(scene, pixel);
    std::vector<DrawItem> items(list.list().items().begin(), list.list().items().end());
    std::vector<Layer> layers;
    const bool parallel = isOrthographic(view);
    while (layers.size() < most && !items.empty()) {
        const ZBufferImage image = renderZBuffer(items, pixel);
        const uint32_t object = image.id.front();
        if (object == ZBufferImage::kNone) break;
        layers.push_back({object, parallel ? -image.depth.front() : 1.0 / image.depth.front()});
        std::erase_if(items, [&](const DrawItem& item) { return item.id == object; });
    }
    return layers;
}

std::string titleOf(const Scene& scene, uint32_t object) {
    const std::string path = oneLine(objectPath(scene, scene.objects[object]), kLongestCall);
    const std::string key = fmt::format("object {}", scene.objects[object].key);
    return path.empty() ? key : fmt::format("{} '{}'", key, path);
}

std::string callOf(const Scene& scene, uint32_t object) {
    const std::string path = oneLine(objectPath(scene, scene.objects[object]), kLongestCall);
    return path.empty() ? fmt::format("object {}", scene.objects[object].key) : fmt::format("'{}'", path);
}

}  // namespace sightline::cli
