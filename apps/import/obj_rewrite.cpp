// Reads line by line; a backslash at the end of a line makes the next one part of it.
// SPDX-License-Identifier: MIT
#include "apps/import/obj_rewrite.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace sightline::import {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t'; }

/// The positions' indices of a face, and what stands between them. A remark is left out: Assimp takes it for indices.
void addFace(std::string_view line, std::string& out) {
    bool dropping = false;
    for (const char c : line) {
        if (c == '#') return;
        if (isBlank(c) || c == '\\') dropping = false;
        else if (c == '/') dropping = true;
        if (!dropping) out += c;
    }
}

}  // namespace

std::string rewriteObj(std::string text) {
    std::string out;
    out.reserve(text.size());
    bool face = false, goes_on = false;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = std::string_view(text).substr(begin, end - begin);
        begin = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (!goes_on) {
            while (!line.empty() && isBlank(line[0])) line.remove_prefix(1);  // Assimp reads no indented face
            face = line.size() > 1 && (line[0] == 'f' || line[0] == 'F') && isBlank(line[1]);
        }
        if (face) addFace(line, out);
        else out += line;
        out += '\n';
        goes_on = line.ends_with('\\');
    }
    return out;
}

}  // namespace sightline::import
