// Bytes that are spoiled in the ways that files are.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

#include "sightline/base/random.h"

namespace sightline::test {

/// Flips bits, overwrites with telling numbers, removes, repeats: one to eight times.
inline std::string mutated(std::string bytes, Random& random) {
    for (uint64_t left = 1 + random.below(8); left-- > 0 && !bytes.empty();) {
        const size_t at = random.below(bytes.size());
        const size_t length = std::min<size_t>(1 + random.below(16), bytes.size() - at);
        switch (random.below(6)) {
            case 0:
                bytes[at] = char(bytes[at] ^ 1 << random.below(8));
                break;
            case 1:
                bytes[at] = char(random.next());
                break;
            case 2:
                bytes.replace(at, length, length, "\xff\x00\x7f\x80"[random.below(4)]);
                break;
            case 3:
                bytes.erase(at, length);
                break;
            case 4:
                bytes.insert(at, bytes.substr(at, length));
                break;
            default:
                // A digit elsewhere keeps a text whole and changes what it says.
                if (const size_t digit = bytes.find_first_of("0123456789", at); digit != std::string::npos)
                    bytes[digit] = char('0' + random.below(10));
        }
    }
    return bytes;
}

}  // namespace sightline::test
