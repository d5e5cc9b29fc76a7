// Assimp's materials as Sightline's: what may hide, and from which sides.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>

#include "sightline/tools/import/foreign/scene_stream.h"
#include "sightline/tools/import/scene_kind.h"

namespace sightline::import {
using namespace tools;

/// Looks at each texture once.
class TextureAlpha {
public:
    /// @param folder  that textures' names are relative to
    TextureAlpha(const aiScene& scene, std::string folder);

    /// False only if every texel is certainly opaque: the picture has no alpha channel, or it is full everywhere. A
    /// picture that is missing or of a kind that is not known is judged by its name: JPEG and BMP have no alpha.
    bool mayBeTransparent(const std::string& name);

    /// Pictures that could not be looked at, and so let nothing hide that shows them; each once, in order.
    const std::vector<std::string>& unread() const { return unread_; }

private:
    bool look(const std::string& name);

    const aiScene& scene_;
    std::string folder_;
    std::map<std::string, bool> known_;
    std::vector<std::string> unread_;
};

/// Sends each material when it is first used.
class Materials {
public:
    /// @param suffix  of the format
    /// @param folder  of the file, for its textures
    Materials(const aiScene& scene, std::string suffix, std::string folder, SceneStreamWriter& out);

    /// The index, in the stream, of a mesh's material. A mesh with vertex colours that are not opaque has a material of its own.
    uint32_t of(const aiMesh& mesh);

    /// A note of the textures that could not be read, if that takes from what hides.
    void tellUnread() const;

private:
    Material convert(const aiMaterial& material);

    const aiScene& scene_;
    std::string suffix_;
    SidesRule sides_ = SidesRule::kNothing;
    TextureAlpha textures_;
    SceneStreamWriter& out_;
    std::map<std::pair<unsigned, bool>, uint32_t> sent_;
};

}  // namespace sightline::import
