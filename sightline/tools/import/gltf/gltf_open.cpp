// Opens a glTF: its container, what it requires, and its tables.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_open.h"

#include <filesystem>
#include <utility>

#include "sightline/tools/import/gltf/gltf_container.h"
#include "sightline/tools/import/gltf/gltf_features.h"

namespace sightline::tools::gltf {
namespace {

constexpr uint64_t kLargestFile = uint64_t(4) << 30;  // what a GLB's 32-bit lengths can say

void checkAsset(Document& document) {
    const Json members = document.json.members({"asset"});
    const Json* asset = findObject(members, "asset", "");
    if (!asset) fail("", "not glTF 2.0: asset is missing");
    const std::string version = text(*asset, "version", "asset");
    if (!version.starts_with("2.")) fail("asset", "version '{}' is not 2.0", printable(version));
    const JsonTable required = document.json.table("extensionsRequired");
    for (size_t i = 0; i < required.size(); ++i) {
        const std::string place = at("extensionsRequired", i);
        const Json value = required[i];
        if (!value.is_string()) fail(place, "is not a string");
        const std::string name = value.get<std::string>();
        if (!featureOf(name).understood) fail(place, "{} is required but not supported", printable(name));
        document.draco_required |= name == "KHR_draco_mesh_compression";
    }
}

// Some writers pad the JSON chunk with zeros instead of spaces, or put a byte order mark before the text.
Bytes trimmed(Bytes text) {
    while (!text.empty() && text.back() == 0) text = text.first(text.size() - 1);
    if (text.size() >= 3 && text[0] == 0xef && text[1] == 0xbb && text[2] == 0xbf) text = text.subspan(3);
    return text;
}

}  // namespace

Document openDocument(ByteSource bytes, std::optional<std::string> directory, const Progress::Report& progress) {
    Document document;
    document.progress = Progress(progress);
    document.bytes = std::move(bytes);
    const Container container = splitContainer(document.bytes);
    const Bytes json = document.bytes.read(container.json);
    document.progress.reach(0, Progress::kRead, 1);
    document.json = JsonText(trimmed(json));
    document.progress.reach(Progress::kRead, Progress::kChecked, 1);
    document.chunk = container.binary;
    document.directory = std::move(directory);
    document.budget.grant(document.bytes.size());
    checkAsset(document);
    readTables(document);
    return document;
}

Document openGltf(const std::string& path, const Progress::Report& progress) {
    ByteSource bytes = ByteSource::open(path, "", kLargestFile + 1);
    if (bytes.size() > kLargestFile) fail("", "is larger than 4 GiB");
    return openDocument(std::move(bytes), std::filesystem::path(path).parent_path().string(), progress);
}

}  // namespace sightline::tools::gltf
