// What must hold of any bytes that are opened as a visibility file: for the tests and the fuzzer.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sightline/visfile/visibility_file.h"

namespace sightline::test {

/// Empty, or what is wrong with the answers: a pair that is not as its rows say, a leaf of no cell that there is.
inline std::string faultOfAnswers(const VisibilityFile& file) {
    const VisibleRows& rows = file.rows();
    const uint32_t cells = rows.cells(), step = 1 + cells / 200;
    std::vector<uint64_t> row((cells + 63) / 64);
    for (uint32_t a = 0; a < cells; a += step) {
        rows.row(a, row);
        if (!rows.sees(a, a)) return "a cell that does not see itself";
        for (uint32_t b = 0; b < cells; b += step) {
            const bool in_row = row[b / 64] >> b % 64 & 1;
            if (rows.sees(a, b) != in_row || rows.sees(b, a) != in_row) return "a pair that is not as its row says";
        }
    }
    for (uint32_t i = 0; i < file.leaves(); ++i)
        if (file.cellOfLeaf(i) >= cells && file.cellOfLeaf(i) != CellGraph::kNoCell) return "a leaf of no cell";
    return {};
}

/// Empty, or what is wrong with how the bytes are read: they are opened, and then all answers fit each other, or are refused
/// with one line.
/// @param opened  set to whether they are
inline std::string faultOfReading(std::span<const char> bytes, bool& opened) {
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "a/map.see");
    opened = file.ok();
    if (opened) return faultOfAnswers(*file);
    const std::string& line = file.error().message;
    if (line.rfind("a/map.see: ", 0) == 0 && line.find('\n') == std::string::npos) return {};
    return "not one line that begins with the file: " + line;
}

}  // namespace sightline::test
