// Where a glTF's bytes come from: the GLB container, files beside it, and data URIs.
// SPDX-License-Identifier: MIT
#include "sightline/import/gltf_container.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "sightline/import/gltf_fault.h"

namespace sightline::gltf {
namespace {

constexpr uint32_t kMagic = 0x46546c67;        // "glTF"
constexpr uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr uint32_t kBinaryChunk = 0x004e4942;  // "BIN"

uint32_t readU32(Bytes bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

Container splitGlb(Bytes bytes) {
    if (bytes.size() < 12) fail("", "truncated: {} of the 12 bytes of a GLB header", bytes.size());
    const uint32_t version = readU32(bytes, 4), length = readU32(bytes, 8);
    if (version != 2) fail("", "is GLB version {}, not 2", version);
    if (length > bytes.size()) fail("", "truncated: {} of {} bytes", bytes.size(), length);
    if (length < 12) fail("", "GLB length {} is less than its header", length);

    Container out;
    bool has_json = false;
    size_t offset = 12;
    while (offset < length) {
        if (length - offset < 8) fail("", "truncated: a GLB chunk header at byte {}", offset);
        const uint32_t size = readU32(bytes, offset), kind = readU32(bytes, offset + 4);
        offset += 8;
        if (size > length - offset) fail("", "GLB chunk at byte {} is longer than the file: {} bytes", offset, size);
        if (!has_json) {
            if (kind != kJsonChunk) fail("", "the first GLB chunk is not JSON");
            out.json = bytes.subspan(offset, size);
            has_json = true;
        } else if (kind == kBinaryChunk && !out.binary) {
            out.binary = bytes.subspan(offset, size);
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

Container splitContainer(Bytes bytes) {
    if (bytes.empty()) fail("", "is empty");
    if (bytes.size() >= 4 && readU32(bytes, 0) == kMagic) return splitGlb(bytes);
    if (bytes.size() < 4 && std::memcmp(bytes.data(), "glTF", bytes.size()) == 0) return splitGlb(bytes);
    return {bytes, std::nullopt};
}

std::vector<unsigned char> readFile(const std::string& path, const std::string& place, uint64_t most) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        const bool absent = status.type() == std::filesystem::file_type::not_found;
        fail(place, "{}", absent ? "no such file" : error.message());
    }
    if (std::filesystem::is_directory(status)) fail(place, "is a directory");
    if (!std::filesystem::is_regular_file(status)) fail(place, "is not a regular file");

    errno = 0;
    const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) fail(place, "cannot be opened: {}", std::generic_category().message(errno));
    const uint64_t size = std::filesystem::file_size(path, error);
    if (error) fail(place, "cannot be read: {}", error.message());

    std::vector<unsigned char> out(std::min(size, most));
    const size_t got = std::fread(out.data(), 1, out.size(), file.get());
    if (got < out.size() && std::ferror(file.get())) fail(place, "cannot be read");
    out.resize(got);
    return out;
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
    const std::string data = percentDecoded(std::string_view(uri).substr(comma + 1));
    if (head.ends_with(";base64")) return base64Decoded(data, place);
    return {data.begin(), data.end()};
}

std::string uriPath(const std::string& uri, const std::string& directory, const std::string& place) {
    if (uri.find("://") != std::string::npos) fail(place, "URI is not a file: '{}'", printable(uri));
    const std::string name = percentDecoded(uri);
    if (name.empty() || name.find('\0') != std::string::npos) fail(place, "URI is not a file: '{}'", printable(uri));
    return (std::filesystem::path(directory) / name).string();
}

}  // namespace sightline::gltf
