// Where a glTF's bytes come from: the GLB container, files beside it, and data URIs.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sightline::tools::gltf {

using Bytes = std::span<const unsigned char>;

struct ByteRange {
    uint64_t offset = 0, length = 0;  ///< [bytes]
};

/// The bytes of a file, of which each block is read when it is first asked for, and once; or bytes in memory.
class ByteSource {
public:
    ByteSource() = default;
    explicit ByteSource(Bytes bytes) : memory_(bytes), size_(bytes.size()) {}

    /// A regular file.
    /// @param place  named in the Fault if it cannot be opened or read
    /// @param most   takes no more than this [bytes]; a larger file is cut without a word
    static ByteSource open(const std::string& path, const std::string& place, uint64_t most);

    uint64_t size() const { return size_; }

    /// Bytes that lie within the size; they stay where they are as long as this lives.
    Bytes read(ByteRange range);

private:
    struct Close {
        void operator()(FILE* file) const { std::fclose(file); }
    };

    void load(uint64_t first, uint64_t end);

    Bytes memory_;
    uint64_t size_ = 0;
    std::unique_ptr<FILE, Close> file_;
    std::string place_;
    std::unique_ptr<unsigned char[]> data_;  // [size: size_]; memory that is never written takes none
    std::vector<bool> loaded_;               // block by block
};

struct Container {
    ByteRange json;
    std::optional<ByteRange> binary;  ///< the BIN chunk
};

/// Splits a GLB into its chunks; other bytes are taken for JSON as a whole.
Container splitContainer(ByteSource& bytes);

/// True for `data:...`, whatever its case.
bool isDataUri(const std::string& uri);

/// A URI's text with each %XX as its byte; a % without two digits stays.
std::string percentDecoded(std::string_view text);

/// The bytes of a data URI, base64 or percent-encoded.
std::vector<unsigned char> decodeDataUri(const std::string& uri, const std::string& place);

/// The file that a relative or absolute URI means, for a glTF in `directory`.
std::string uriPath(const std::string& uri, const std::string& directory, const std::string& place);

}  // namespace sightline::tools::gltf
