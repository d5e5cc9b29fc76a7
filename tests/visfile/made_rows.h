// Matrices of visibility made for tests: at random, in blocks, and of rooms in a grid.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/random.h"

namespace sightline::test {

inline void setBoth(BitMatrix& matrix, size_t a, size_t b) {
    matrix.set(a, b);
    matrix.set(b, a);
}

inline BitMatrix onlyThemselves(size_t cells) {
    BitMatrix matrix(cells, cells);
    for (size_t i = 0; i < cells; ++i) matrix.set(i, i);
    return matrix;
}

/// Each pair sees each other with the same chance.
inline BitMatrix randomRows(size_t cells, double chance, uint64_t seed) {
    Random random(seed);
    BitMatrix matrix = onlyThemselves(cells);
    for (size_t a = 0; a < cells; ++a)
        for (size_t b = 0; b < a; ++b)
            if (random.uniform() < chance) setBoth(matrix, a, b);
    return matrix;
}

/// Cells that see all of some groups and nothing of others, with a few exceptions; their numbers are shuffled. Some rows are equal.
inline BitMatrix groupedRows(size_t cells, size_t groups, double exceptions, uint64_t seed) {
    Random random(seed);
    const BitMatrix seen = randomRows(groups, 0.3, seed + 1);
    std::vector<size_t> group;
    for (size_t i = 0; i < cells; ++i) group.push_back(random.below(groups));
    BitMatrix matrix = onlyThemselves(cells);
    for (size_t a = 0; a < cells; ++a)
        for (size_t b = 0; b < a; ++b)
            if (seen.at(group[a], group[b]) != (random.uniform() < exceptions)) setBoth(matrix, a, b);
    return matrix;
}

/// Every shape that a row may have to be stored in, each with a name for messages.
struct MadeRows {
    std::string name;
    BitMatrix matrix;
};

inline std::vector<MadeRows> manyRows() {
    std::vector<MadeRows> made;
    for (const size_t cells : {0, 1, 2, 7, 8, 9, 16, 63, 64, 65, 130, 257}) {
        const std::string n = std::to_string(cells);
        made.push_back({n + " apart", onlyThemselves(cells)});
        made.push_back({n + " all", randomRows(cells, 1, 1)});
        made.push_back({n + " sparse", randomRows(cells, 0.05, 2)});
        made.push_back({n + " half", randomRows(cells, 0.5, 3)});
        made.push_back({n + " dense", randomRows(cells, 0.97, 4)});
        made.push_back({n + " grouped", groupedRows(cells, 1 + cells / 6, 0, 5)});
        made.push_back({n + " nearly grouped", groupedRows(cells, 1 + cells / 9, 0.01, 6)});
    }
    return made;
}

}  // namespace sightline::test
