// What a reader's error looks like, for whom bytes may be anything.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"

namespace sightline::test {

/// Empty, or what is wrong with an error's line.
inline std::string lineFault(const Error& error, const std::string& file) {
    if (error.message.rfind(file + ": ", 0) != 0) return "does not begin with the file: " + error.message;
    for (const char c : error.message)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f')
            return "is not one line that can be printed: " + error.message;
    return error.kind == Error::Kind::kInput ? "" : "is not the input's fault";
}

}  // namespace sightline::test
