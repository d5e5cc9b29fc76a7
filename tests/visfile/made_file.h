// Visibility files of made rows and leaves.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/visfile/visibility_file.h"
#include "tests/visfile/made_rows.h"

namespace sightline::test {

struct MadeFile {
    BitMatrix visible;
    std::vector<uint32_t> cell_of_leaf;

    explicit MadeFile(uint64_t seed, size_t cells = 70) : visible(groupedRows(cells, 9, 0.02, seed)) {
        Random random(seed);
        for (size_t i = 0; i < 3 * cells; ++i)
            cell_of_leaf.push_back(i % 11 == 0 ? CellGraph::kNoCell : static_cast<uint32_t>(random.below(cells)));
    }
    Array<char> bytes(VisibilityForm form) const {
        return *visibilityFile({visible, cell_of_leaf, "e1m5.bsp", 77}, form);
    }
};

}  // namespace sightline::test
