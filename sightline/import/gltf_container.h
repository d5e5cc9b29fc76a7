// Where a glTF's bytes come from: the GLB container, files beside it, and data URIs.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sightline::gltf {

using Bytes = std::span<const unsigned char>;

struct Container {
    Bytes json;
    std::optional<Bytes> binary;  ///< the BIN chunk
};

/// Splits a GLB into its chunks; other bytes are taken for JSON as a whole. The spans point into `bytes`.
Container splitContainer(Bytes bytes);

/// Reads a regular file.
/// @param place  named in the Fault if it cannot be read
/// @param most   reads no more than this [bytes]; a larger file is cut without a word
std::vector<unsigned char> readFile(const std::string& path, const std::string& place, uint64_t most);

/// True for `data:...`, whatever its case.
bool isDataUri(const std::string& uri);

/// A URI's text with each %XX as its byte; a % without two digits stays.
std::string percentDecoded(std::string_view text);

/// The bytes of a data URI, base64 or percent-encoded.
std::vector<unsigned char> decodeDataUri(const std::string& uri, const std::string& place);

/// The file that a relative or absolute URI means, for a glTF in `directory`.
std::string uriPath(const std::string& uri, const std::string& directory, const std::string& place);

}  // namespace sightline::gltf
