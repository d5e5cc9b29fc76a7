// The page of every report: one static file around the JSON of a run.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/page.h"

namespace sightline::tools {

// The files of this folder as they stand before and after the data; written at build by embed.cmake.
extern const unsigned char kPageBegin[], kPageEnd[];
extern const size_t kPageBeginSize, kPageEndSize;

std::string pageWith(std::string_view data) {
    std::string page(reinterpret_cast<const char*>(kPageBegin), kPageBeginSize);
    page.reserve(page.size() + data.size() + data.size() / 16 + kPageEndSize);
    // No text of the data ends the <script> that holds it, or begins a comment that would swallow its end.
    for (const char c : data) page += c == '<' ? std::string_view("\\u003c") : std::string_view(&c, 1);
    return page.append(reinterpret_cast<const char*>(kPageEnd), kPageEndSize);
}

}  // namespace sightline::tools
