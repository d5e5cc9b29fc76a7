// The seeds of the fuzzers, walked by tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sightline::test {

/// Calls look(name, bytes) for each file of a fuzzer's corpus, of which there are to be `least` or more.
template <class Look>
void forCorpus(const std::string& fuzzer, size_t least, Look look) {
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SIGHTLINE_FUZZ_CORPUS "/" + fuzzer)) {
        look(entry.path().filename().string(), readBytes(entry.path()));
        ++files;
    }
    EXPECT_GE(files, least) << fuzzer;
}

}  // namespace sightline::test
