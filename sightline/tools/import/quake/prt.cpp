// Portal files of the Quake family: numbers and parentheses, read in one pass.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/prt.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

constexpr double kFarthest = 1e9;  // [world units]

bool isBlank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// Takes words of a text one by one. After a fault it takes nothing more: all numbers are then 0.
class Words {
public:
    explicit Words(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

    bool ok() const { return fault_.empty(); }
    const std::string& fault() const { return fault_; }
    uint32_t line() const { return number_; }

    void fail(std::string what) {
        if (!ok()) return;
        fault_ = fmt::format("line {}: {}", number_, what);
        at_ = end_;
    }

    void skipBlanks() {
        for (; at_ < end_ && isBlank(*at_); ++at_) number_ += *at_ == '\n';
    }
    bool atEnd() {
        skipBlanks();
        return at_ == end_;
    }

    std::string_view word() {
        skipBlanks();
        const char* first = at_;
        while (at_ < end_ && !isBlank(*at_)) ++at_;
        return {first, static_cast<size_t>(at_ - first)};
    }
    void sign(char wanted) {
        skipBlanks();
        if (at_ < end_ && *at_ == wanted) {
            ++at_;
            return;
        }
        fail(fmt::format("{} where '{}' was expected", here(), wanted));
    }
    /// A whole number in [low, high].
    int64_t whole(const char* what, int64_t low, int64_t high) {
        skipBlanks();
        int64_t value = 0;
        const auto [next, error] = std::from_chars(at_, end_, value);
        if (error != std::errc() || !ends(next)) {
            fail(fmt::format("{} is no {}", here(), what));
            return 0;
        }
        at_ = next;
        if (value < low || value > high) {
            fail(fmt::format("{} {} is not in {} to {}", what, value, low, high));
            return 0;
        }
        return value;
    }
    double real() {
        skipBlanks();
        double value = 0;
        const auto [next, error] = std::from_chars(at_, end_, value);
        if (error != std::errc() || !ends(next)) fail(fmt::format("{} is no coordinate", here()));
        else if (!(std::abs(value) <= kFarthest)) fail(fmt::format("{} is too large for a coordinate", here()));
        if (!ok()) return 0;
        at_ = next;
        return value;
    }

private:
    /// A number ends at a blank, a parenthesis or the file's end.
    bool ends(const char* next) const { return next == end_ || isBlank(*next) || *next == '(' || *next == ')'; }

    /// What stands here, for an error's line.
    std::string here() const {
        if (at_ == end_) return "the file's end";
        constexpr std::ptrdiff_t kMost = 20;
        std::string out = "'";
        for (const char* c = at_; c < end_ && c - at_ < kMost && !isBlank(*c); ++c)
            out += *c > ' ' && *c < '\x7f' ? *c : '?';
        return out + "'";
    }

    const char* at_;
    const char* end_;
    uint32_t number_ = 1;
    std::string fault_;
};

struct Counts {
    int64_t leaves = 0, cells = 0, portals = 0;
};

/// The orders of the three differ, and PRT1 has no word on leaves.
Counts readCounts(Words& words, std::string_view kind, int64_t most) {
    const auto count = [&](const char* what) { return words.whole(what, 0, most); };
    Counts out;
    if (kind == "PRT2") out.leaves = count("count of leaves");
    out.cells = count("count of clusters");
    out.portals = count("count of portals");
    if (kind == "PRT1-AM") out.leaves = count("count of leaves");
    if (kind == "PRT1") out.leaves = out.cells;
    return out;
}

/// The file's outlines run clockwise as seen from their first cell; ours the other way round.
void readPortal(Words& words, CellGraph& graph, std::vector<glm::dvec3>& outline, PrtNotes& notes) {
    const int64_t most = static_cast<int64_t>(graph.cells) - 1;
    const int64_t count = words.whole("count of points", 3, INT32_MAX);
    const uint32_t line = words.line();
    const auto a = static_cast<uint32_t>(words.whole("cluster", 0, most));
    const auto b = static_cast<uint32_t>(words.whole("cluster", 0, most));
    if (words.ok() && a == b) words.fail(fmt::format("a portal from cluster {} into itself", a));
    outline.clear();
    for (int64_t i = 0; i < count && words.ok(); ++i) {
        words.sign('(');
        const double x = words.real(), y = words.real(), z = words.real();
        words.sign(')');
        outline.emplace_back(x, z, 0 - y);
    }
    if (!words.ok()) return;
    std::reverse(outline.begin(), outline.end());
    if (!graph.addPortal(a, b, outline)) notes.flat_lines.push_back(line);
}

/// A list of leaves for each cell, each ended by -1.
void readLists(Words& words, CellGraph& graph) {
    const auto leaves = static_cast<int64_t>(graph.cell_of_leaf.size()) - 1;
    for (uint32_t cell = 0; cell < graph.cells && words.ok(); ++cell)
        for (;;) {
            const int64_t leaf = words.whole("leaf", -1, leaves - 1);
            if (!words.ok() || leaf < 0) break;
            uint32_t& owner = graph.cell_of_leaf[static_cast<size_t>(leaf) + 1];
            if (owner != CellGraph::kNoCell) words.fail(fmt::format("leaf {} is in two clusters", leaf));
            owner = cell;
        }
}

void readLeaves(Words& words, std::string_view kind, CellGraph& graph) {
    if (kind == "PRT2") return readLists(words, graph);
    for (size_t leaf = 1; leaf < graph.cell_of_leaf.size() && words.ok(); ++leaf)
        graph.cell_of_leaf[leaf] =
            kind == "PRT1" ? static_cast<uint32_t>(leaf - 1)
                           : static_cast<uint32_t>(words.whole("cluster", 0, static_cast<int64_t>(graph.cells) - 1));
}

}  // namespace

Result<CellGraph> parsePrt(std::span<const unsigned char> bytes, const std::string& name, PrtNotes* notes) {
    const auto error = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", name, what)};
    };
    Words words({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const std::string_view word = words.word();
    constexpr const char* kKinds[] = {"PRT1", "PRT2", "PRT1-AM"};
    const auto* const kind = std::find(std::begin(kKinds), std::end(kKinds), word);
    if (kind == std::end(kKinds)) return error("line 1: not a portal file: it begins with none of PRT1, PRT2, PRT1-AM");

    // No file has more of anything than bytes: a count that lies asks for no more memory than the file has taken.
    const auto most = static_cast<int64_t>(std::min<size_t>(bytes.size(), size_t(1) << 30));
    const Counts counts = readCounts(words, *kind, most);
    PrtNotes found{*kind, static_cast<uint32_t>(counts.leaves), {}};
    CellGraph graph;
    graph.cells = static_cast<uint32_t>(counts.cells);
    if (words.ok()) graph.cell_of_leaf.assign(static_cast<size_t>(counts.leaves) + 1, CellGraph::kNoCell);
    std::vector<glm::dvec3> outline;
    for (int64_t i = 0; i < counts.portals && words.ok(); ++i) readPortal(words, graph, outline, found);
    if (words.ok()) readLeaves(words, *kind, graph);
    if (words.ok() && !words.atEnd()) words.fail("more follows where the file should end");
    if (!words.ok()) return error(words.fault());
    if (notes) *notes = std::move(found);
    return graph;
}

Result<CellGraph> readPrt(const std::string& file, PrtNotes* notes) {
    const Result<std::string> text = readTextFile(file);
    if (!text) return text.error();
    return parsePrt({reinterpret_cast<const unsigned char*>(text->data()), text->size()}, file, notes);
}

}  // namespace sightline::tools
