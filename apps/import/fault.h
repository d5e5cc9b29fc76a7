// How the reader of foreign formats gives up: one line, caught in main.
// SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace sightline::import {

struct Fault {
    std::string message;  ///< without the file's name
};

/// What the importer's own words say, with the place that they name, and what helps.
inline Fault importerFault(std::string words) {
    while (!words.empty() && (words.back() == '.' || words.back() == '\n' || words.back() == ' ')) words.pop_back();
    std::string place;
    for (const std::string_view name : {"line ", "Line ", "offset 0x"}) {
        const size_t at = words.find(name), end = at + name.size();
        const bool hex = name.back() == 'x';
        size_t last = end;
        const auto isDigit = [&](char c) { return hex ? std::isxdigit(c) != 0 : c >= '0' && c <= '9'; };
        while (at != std::string::npos && last < words.size() && isDigit(words[last])) ++last;
        if (at == std::string::npos || last == end) continue;
        place = (hex ? "offset 0x" : "line ") + words.substr(end, last - end);
        break;
    }
    return {"damaged, or not as its format wants it" + (place.empty() ? "" : ", at " + place) +
            ": the importer says \"" + words + "\"; save it anew with the program that made it, or as glTF"};
}

}  // namespace sightline::import
