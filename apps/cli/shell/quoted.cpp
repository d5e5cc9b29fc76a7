// A word as a shell takes it.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/quoted.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace sightline::cli {

std::string quoted(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) || std::string_view("@%+=:,./_-").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace sightline::cli
