// What must hold of every bake, whatever the graph.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/bake/flow/flow_portals.h"
#include "sightline/tools/truth/graph_rays.h"
#include "tests/bake/flow/cell_worlds.h"

namespace sightline::test {
using namespace bake;
using namespace tools;

inline std::string nameOf(const char* what, uint64_t number) {
    std::string name(what);
    name += ' ';
    name += std::to_string(number);
    return name;
}

inline uint64_t countOutside(const BitMatrix& inner, const BitMatrix& outer) {
    uint64_t count = 0;
    for (size_t r = 0; r < inner.rows(); ++r)
        for (size_t w = 0; w < inner.wordsPerRow(); ++w)
            count += static_cast<uint64_t>(std::popcount(inner.row(r)[w] & ~outer.row(r)[w]));
    return count;
}

/// Each of `inner` is one of `outer`.
inline ::testing::AssertionResult isWithin(const BitMatrix& inner, const BitMatrix& outer) {
    if (inner.rows() != outer.rows() || inner.columns() != outer.columns())
        return ::testing::AssertionFailure() << "sizes differ";
    for (size_t r = 0; r < inner.rows(); ++r)
        for (size_t c = 0; c < inner.columns(); ++c)
            if (inner.at(r, c) && !outer.at(r, c))
                return ::testing::AssertionFailure()
                       << "(" << r << ", " << c << ") is missing, and " << countOutside(inner, outer) - 1 << " more";
    return ::testing::AssertionSuccess();
}

inline void expectShape(const CellVisibility& answer, uint32_t cells, const std::string& name) {
    ASSERT_EQ(answer.visible.rows(), cells) << name;
    ASSERT_EQ(answer.visible.columns(), cells) << name;
    EXPECT_TRUE(isWithin(answer.witnessed, answer.visible)) << name;
    for (uint32_t a = 0; a < cells; ++a) {
        EXPECT_TRUE(answer.visible.at(a, a)) << name;
        EXPECT_TRUE(answer.witnessed.at(a, a)) << name;
        for (uint32_t b = 0; b < a; ++b) {
            EXPECT_EQ(answer.visible.at(a, b), answer.visible.at(b, a)) << name << ": " << a << ", " << b;
            EXPECT_EQ(answer.witnessed.at(a, b), answer.witnessed.at(b, a)) << name << ": " << a << ", " << b;
        }
    }
}

/// What passes an outline by less than points are known by, twice over, is not promised: portals of trees reach a little
/// beyond their faces, and lines in the plane of one slip through there.
/// @param rays  of which none may pass between cells that do not see one another
inline void expectLaws(const CellGraph& graph, const CellVisibility& answer, uint64_t rays, const std::string& name,
                       BitMatrix* seen = nullptr, Jobs* jobs = nullptr) {
    expectShape(answer, graph.cells, name);
    if (graph.portals.empty()) return;
    const GraphRays judge(graph, 2 * kGraphPrecision * largestCoordinate(graph));
    const RowReport report = checkCellRows(judge, answer.visible, {.segments = rays, .jobs = jobs}, seen);
    EXPECT_EQ(report.misses, 0u) << name << ", the first: " << report.examples[0].row << ", "
                                 << report.examples[0].column;
    EXPECT_GE(report.segments, rays / 4) << name;
}

}  // namespace sightline::test
