// The fuzzers' corpora and spoiled bytes, for the tests of readers of maps.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "map_check.h"
#include "mutated.h"

namespace sightline::test {

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
