// Where a glTF's bytes come from: the GLB container, files beside it, and data URIs.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_container.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <sys/types.h>

#include "sightline/tools/import/gltf/gltf_fault.h"

namespace sightline::tools::gltf {
namespace {

constexpr uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr uint32_t kBinaryChunk = 0x004e4942;  // "BIN"
constexpr uint64_t kBlock = 1 << 16;           // [bytes] read at once

uint32_t readU32(ByteSource& bytes, uint64_t offset) {
    uint32_t value;
    std::memcpy(&value, bytes.read({offset, sizeof value}).data(), sizeof value);
    return value;
}

Container splitGlb(ByteSource& bytes) {
    if (bytes.size() < 12) fail("", "truncated: {} of the 12 bytes of a GLB header", bytes.size());
    const uint32_t version = readU32(bytes, 4), length = readU32(bytes, 8);
    if (version != 2) fail("", "is GLB version {}, not 2", version);
    if (length > bytes.size()) fail("", "truncated: {} of the {} bytes that its header tells of", bytes.size(), length);
    if (length < 12) fail("", "GLB length {} is less than its header", length);

    Container out;
    bool has_json = false;
    uint64_t offset = 12;
    while (offset < length) {
        if (length - offset < 8) fail("", "truncated: a GLB chunk header at byte {}", offset);
        const uint32_t size = readU32(bytes, offset), kind = readU32(bytes, offset + 4);
        offset += 8;
        if (size > length - offset) fail("", "GLB chunk at byte {} is longer than the file: {} bytes", offset, size);
        if (!has_json) {
            if (kind != kJsonChunk) fail("", "the first GLB chunk is not JSON");
            out.json = {offset, size};
            has_json = true;
        } else if (kind == kBinaryChunk && !out.binary) {
            out.binary = ByteRange{offset, size};
        }
        offset += size;
    }
    if (!has_json) fail("", "GLB without a JSON chunk");
    return out;
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::array<int8_t, 256> base64Values() {
    std::array<int8_t, 256> values;
    values.fill(-1);
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int i = 0; i < 64; ++i) values[static_cast<unsigned char>(digits[i])] = static_cast<int8_t>(i);
    values['-'] = 62;  // the URL-safe alphabet
    values['_'] = 63;
    return values;
}

std::vector<unsigned char> base64Decoded(std::string_view text, const std::string& place) {
    static const std::array<int8_t, 256> kValues = base64Values();
    std::vector<unsigned char> out;
    out.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        const int value = kValues[static_cast<unsigned char>(c)];
        if (value < 0) fail(place, "data URI is not base64");
        bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xffffff;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out.push_back(static_cast<unsigned char>(bits >> count & 0xff));
    }
    return out;
}

}  // namespace

std::string percentDecoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0) {
            out += static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2]));
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

Container splitContainer(ByteSource& bytes) {
    if (bytes.size() == 0) fail("", "is empty");
    const size_t head = std::min<uint64_t>(bytes.size(), 4);
    if (std::memcmp(bytes.read({0, head}).data(), "glTF", head) == 0) return splitGlb(bytes);
    return {{0, bytes.size()}, std::nullopt};
}

ByteSource ByteSource::open(const std::string& path, const std::string& place, uint64_t most) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        const bool absent = status.type() == std::filesystem::file_type::not_found;
        fail(place, "{}", absent ? "no such file" : error.message());
    }
    if (std::filesystem::is_directory(status)) fail(place, "is a directory");
    if (!std::filesystem::is_regular_file(status)) fail(place, "is not a regular file");

    ByteSource out;
    errno = 0;
    out.file_.reset(std::fopen(path.c_str(), "rb"));
    if (!out.file_) fail(place, "cannot be opened: {}", std::generic_category().message(errno));
    const uint64_t size = std::filesystem::file_size(path, error);
    if (error) fail(place, "cannot be read: {}", error.message());
    std::setvbuf(out.file_.get(), nullptr, _IONBF, 0);
    out.place_ = place;
    out.size_ = std::min(size, most);
    out.data_ = std::make_unique_for_overwrite<unsigned char[]>(out.size_);
    out.loaded_.resize((out.size_ + kBlock - 1) / kBlock);
    return out;
}

Bytes ByteSource::read(ByteRange range) {
    if (!file_) return memory_.subspan(range.offset, range.length);
    const uint64_t last = (range.offset + range.length + kBlock - 1) / kBlock;
    for (uint64_t block = range.offset / kBlock; range.length > 0 && block < last; ++block) {
        if (loaded_[block]) continue;
        uint64_t end = block + 1;
        while (end < last && !loaded_[end]) ++end;
        load(block, end);
        block = end;
    }
    return Bytes(data_.get(), size_).subspan(range.offset, range.length);
}

void ByteSource::load(uint64_t first, uint64_t end) {
    const uint64_t offset = first * kBlock, length = std::min(size_, end * kBlock) - offset;
    const bool there = ::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) == 0 &&
                       std::fread(data_.get() + offset, 1, length, file_.get()) == length;
    if (!there) fail(place_, "cannot be read: {}", std::ferror(file_.get()) ? "input error" : "it became shorter");
    for (uint64_t block = first; block < end; ++block) loaded_[block] = true;
}

bool isDataUri(const std::string& uri) {
    const std::string_view scheme = "data:";
    return uri.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), uri.begin(), [](char a, char b) {
               return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b);
           });
}

std::vector<unsigned char> decodeDataUri(const std::string& uri, const std::string& place) {
    const size_t comma = uri.find(',');
    if (comma == std::string::npos) fail(place, "data URI without data");
    const std::string_view head = std::string_view(uri).substr(0, comma);
    const std::string_view body = std::string_view(uri).substr(comma + 1);
    if (head.ends_with(";base64") && body.find('%') == std::string_view::npos) return base64Decoded(body, place);
    const std::string data = percentDecoded(body);
    if (head.ends_with(";base64")) return base64Decoded(data, place);
    return {data.begin(), data.end()};
}

std::string uriPath(const std::string& uri, const std::string& directory, const std::string& place) {
    if (uri.find("://") != std::string::npos) fail(place, "URI is not a file: '{}'", printable(uri));
    const std::string name = percentDecoded(uri);
    if (name.empty() || name.find('\0') != std::string::npos) fail(place, "URI is not a file: '{}'", printable(uri));
    return (std::filesystem::path(directory) / name).string();
}

}  // namespace sightline::tools::gltf
