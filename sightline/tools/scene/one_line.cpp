// Text of unknown origin, made fit for a line that a terminal shows.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/one_line.h"

#include <cstdint>

namespace sightline::tools {
namespace {

bool follows(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// The length in bytes of the character that begins a text, and its code; 0: it is no UTF-8.
size_t takeCharacter(std::string_view text, uint32_t& code) {
    const auto first = static_cast<unsigned char>(text[0]);
    const size_t length = first < 0x80   ? 1
                          : first < 0xc2 ? 0
                          : first < 0xe0 ? 2
                          : first < 0xf0 ? 3
                          : first < 0xf5 ? 4
                                         : 0;
    if (length == 0 || length > text.size()) return 0;
    code = length == 1 ? first : first & (0x7f >> length);
    for (size_t i = 1; i < length; ++i) {
        if (!follows(text[i])) return 0;
        code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3f);
    }
    const bool twice = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    return twice || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff ? 0 : length;
}

/// What moves the cursor, begins a command, ends the line or turns the direction of writing.
bool isObeyed(uint32_t code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x061c || code == 0x200e || code == 0x200f ||
           (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string oneLine(std::string_view text, size_t most) {
    std::string out;
    if (text.size() > most) {
        text.remove_prefix(text.size() - (most - 3));
        while (!text.empty() && follows(text[0])) text.remove_prefix(1);
        out = "...";
    }
    while (!text.empty()) {
        uint32_t code = 0;
        const size_t length = takeCharacter(text, code);
        if (length == 0) out += '?';
        else if (isObeyed(code)) out += ' ';
        else out += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out;
}

std::string withoutMiddle(std::string_view text, size_t most) {
    if (text.size() <= most) return oneLine(text);
    size_t begin = (most - 3) / 3;
    while (begin > 0 && follows(text[begin])) --begin;
    return oneLine(text.substr(0, begin)) + oneLine(text.substr(begin), most - begin);
}

std::string shortened(std::string_view text, size_t most) {
    if (text.size() <= most) return std::string(text);
    size_t end = most - 3;
    while (end > 0 && follows(text[end])) --end;
    return std::string(text.substr(0, end)) + "...";
}

std::string joined(const std::vector<std::string>& texts, std::string_view between) {
    std::string all;
    for (size_t i = 0; i < texts.size(); ++i) all.append(i == 0 ? "" : between).append(texts[i]);
    return all;
}

std::string joinedFew(const std::vector<std::string>& names) {
    const size_t shown = names.size() > 4 ? 3 : names.size();
    std::string text;
    for (size_t i = 0; i < shown; ++i) text += (i ? " + " : "") + names[i];
    if (shown < names.size()) text += " + " + std::to_string(names.size() - shown) + " more";
    return text;
}

}  // namespace sightline::tools
