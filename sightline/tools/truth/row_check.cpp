// Rows against segments: each miss once, in an order that no thread changes.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/row_check.h"

namespace sightline::tools {

void RowJudge::addMiss(const RowMiss& miss) {
    if (rows_.at(miss.row, miss.column)) return;  // only the other way is missing
    if (missed_.rows() == 0) missed_ = BitMatrix(rows_.rows(), rows_.columns());
    if (missed_.at(miss.row, miss.column)) return;
    missed_.set(miss.row, miss.column);
    report_.examples.push_back(miss);
}

void RowJudge::addTo(RowReport& report, BitMatrix& missed, size_t most_examples, BitMatrix* seen) const {
    report.segments += report_.segments;
    report.stretches += report_.stretches;
    report.pairs += report_.pairs;
    report.doubtful += report_.doubtful;
    report.unmapped += report_.unmapped;
    for (const RowMiss& miss : report_.examples) {
        if (missed.at(miss.row, miss.column)) continue;
        missed.set(miss.row, miss.column);
        ++report.misses;
        if (report.examples.size() < most_examples) report.examples.push_back(miss);
    }
    if (!seen) return;
    for (size_t r = 0; r < seen_.rows(); ++r)
        for (size_t w = 0; w < seen_.wordsPerRow(); ++w) seen->row(r)[w] |= seen_.row(r)[w];
}

}  // namespace sightline::tools
