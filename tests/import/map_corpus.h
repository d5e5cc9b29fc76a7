// Spoiled bytes, and the fuzzers' corpora, for the tests of readers.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "map_check.h"
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
                if (const size_t digit = bytes.find_first_of("0123456789", at); digit != std::string::npos)
                    bytes[digit] = char('0' + random.below(10));
        }
    }
    return bytes;
}

/// Calls look(name, bytes) for each file of a fuzzer's corpus, of which there are to be `least` or more.
inline void forCorpus(const char* fuzzer, size_t least,
                      const std::function<void(const std::string&, const std::string&)>& look) {
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(SIGHTLINE_FUZZ_CORPUS "/") + fuzzer)) {
        std::ifstream in(entry.path(), std::ios::binary);
        look(entry.path().filename().string(), {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
        ++files;
    }
    EXPECT_GE(files, least) << fuzzer;
}

}  // namespace sightline::test
