// Whether a texture lets light through: what may hide must be certain.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <assimp/scene.h>

namespace sightline::import {

/// Looks at each texture once.
class TextureAlpha {
public:
    /// @param folder  that textures' names are relative to
    TextureAlpha(const aiScene& scene, std::string folder);

    /// False only if every texel is certainly opaque: the picture has no alpha channel, or it is full everywhere. A
    /// picture that is missing or of a kind that is not known is judged by its name: JPEG and BMP have no alpha.
    bool mayBeTransparent(const std::string& name);

private:
    bool look(const std::string& name) const;

    const aiScene& scene_;
    std::string folder_;
    std::map<std::string, bool> known_;
};

}  // namespace sightline::import
