// What glTF extensions do to what a file draws: whether it may hide, and whether it stays where it stands.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "sightline/tools/import/gltf/gltf_json.h"

namespace sightline::tools::gltf {

/// What an extension may do to the material, primitive, mesh or node that carries it. The later, the more.
enum class Effect : uint8_t {
    kNone,     ///< nothing that matters here: colours, lights, names; or the reader takes it as it is meant
    kClears,   ///< light passes the material
    kMoves,    ///< the node, with all below it, may be moved, shown or hidden
    kUnknown,  ///< anything
};

struct Feature {
    Effect effect = Effect::kUnknown;
    bool understood = false;  ///< a file may require it, and keeps it when it is written again
};

Feature featureOf(std::string_view extension);

/// The strongest effect of an object's extensions.
/// @param unknown  counts those that are not known, by name
Effect effectOfExtensions(const Json& object, std::map<std::string, size_t>& unknown);

}  // namespace sightline::tools::gltf
