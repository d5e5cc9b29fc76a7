// Reads tables of materials and pieces: what the procedural scenes are furnished with, as text that a person can edit.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/pieces.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

struct Statement {
    int line = 0;
    std::string_view verb, name;          ///< name: all that follows the verb
    std::vector<std::string_view> words;  ///< what follows it and is no number
    std::vector<double> numbers;
};

/// What a kind of shape has to have.
struct ShapeRule {
    std::string_view verb;
    size_t words, least, step;  ///< numbers: `least` and any multiple of `step` more
};

constexpr ShapeRule kShapes[] = {{"box", 1, 6, 0},      {"prism", 2, 8, 2},  {"turned", 1, 8, 2}, {"quad", 1, 12, 0},
                                 {"triangle", 1, 9, 0}, {"copies", 1, 1, 1}, {"fifths", 0, 0, 0}};

bool fits(const Statement& statement, const ShapeRule& rule) {
    const size_t count = statement.numbers.size();
    if (statement.words.size() != rule.words || count < rule.least) return false;
    return rule.step == 0 ? count == rule.least : (count - rule.least) % rule.step == 0;
}

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
        const size_t begin = line.find_first_not_of(" \t\r");
        if (begin == line.npos || line[begin] == '#') return words;
        const size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        line.remove_prefix(end);
    }
}

bool readNumber(std::string_view word, double& number) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

std::vector<Statement> statementsOf(std::string_view table) {
    std::vector<Statement> statements;
    for (int line = 1; !table.empty(); ++line) {
        const size_t end = std::min(table.find('\n'), table.size());
        const std::vector<std::string_view> words = wordsOf(table.substr(0, end));
        table.remove_prefix(std::min(end + 1, table.size()));
        if (words.empty()) continue;
        double number = 0;
        const bool goes_on = !statements.empty() && readNumber(words[0], number);
        if (!goes_on) statements.push_back({line, words[0], {}, {}, {}});
        Statement& statement = statements.back();
        for (size_t i = goes_on ? 0 : 1; i < words.size(); ++i) {
            if (readNumber(words[i], number)) statement.numbers.push_back(number);
            else statement.words.push_back(words[i]);
        }
        if (!goes_on && words.size() > 1)
            statement.name = {words[1].data(), static_cast<size_t>(words.back().end() - words[1].begin())};
    }
    return statements;
}

/// Draws statements into a mesh, one after the other, within copies that lie within each other.
class PieceReader {
public:
    explicit PieceReader(std::string_view table) : statements_(statementsOf(table)) {}

    Result<Pieces> read() {
        size_t i = 0;
        while (i < statements_.size() && fault_.empty()) {
            const Statement& statement = statements_[i++];
            if (statement.verb == "material") {
                addMaterial(statement);
            } else if (statement.verb == "piece" && !statement.name.empty()) {
                city::MeshBuilder mesh;
                i = drawAll(i, city::kSideways, mesh, 0);
                pieces_.meshes.push_back(mesh.finish(std::string(statement.name)));
            } else {
                fail(statement, "is neither a material nor a piece with a name");
            }
        }
        if (!fault_.empty()) return Error{Error::Kind::kInput, fault_};
        return std::move(pieces_);
    }

private:
    void fail(const Statement& statement, const char* what) {
        if (fault_.empty()) fault_ = fmt::format("line {}: {} {}", statement.line, statement.verb, what);
    }

    void addMaterial(const Statement& statement) {
        const std::vector<double>& numbers = statement.numbers;
        if (statement.words.empty() || numbers.size() < 3 || numbers.size() > 4)
            return fail(statement, "wants a name, three numbers for the colour and one for opacity if it is not 1");
        Material material;
        material.name = statement.words[0];
        std::replace(material.name.begin(), material.name.end(), '_', ' ');
        for (size_t c = 0; c < numbers.size(); ++c)
            material.base_color[static_cast<int>(c)] = static_cast<float>(numbers[c]);
        for (size_t i = 1; i < statement.words.size(); ++i) {
            if (statement.words[i] == "mask") material.alpha_mode = AlphaMode::kMask;
            else if (statement.words[i] == "blend") material.alpha_mode = AlphaMode::kBlend;
            else if (statement.words[i] == "two_sided") material.double_sided = true;
            else return fail(statement, "knows mask, blend and two_sided alone");
        }
        pieces_.materials.push_back(std::move(material));
    }

    /// The statements from `i` on, up to the end of a block or the next piece; the index of what ended them.
    /// @param at  the frame that they are drawn in
    size_t drawAll(size_t i, const city::Frame& at, city::MeshBuilder& mesh, int depth) {
        while (i < statements_.size() && fault_.empty()) {
            const Statement& statement = statements_[i];
            if (statement.verb == "piece" || statement.verb == "material") return i;
            if (statement.verb == "end" && depth > 0) return i;
            const auto rule = std::find_if(std::begin(kShapes), std::end(kShapes),
                                           [&](const ShapeRule& shape) { return shape.verb == statement.verb; });
            if (rule == std::end(kShapes)) fail(statement, "is no shape");
            else if (!fits(statement, *rule)) fail(statement, "has too few or too many words or numbers");
            else if (statement.verb == "copies" || statement.verb == "fifths") i = drawBlock(i, at, mesh, depth);
            else drawShape(statement, at, mesh);
            ++i;
        }
        return i;
    }

    /// The index of the block's end.
    size_t drawBlock(size_t i, const city::Frame& at, city::MeshBuilder& mesh, int depth) {
        const Statement& statement = statements_[i];
        size_t end = i;
        if (statement.verb == "fifths") {
            for (int fifth = 0; fifth < 5; ++fifth) {
                city::Frame turned = city::fifthFrame(fifth);
                turned.origin = at.origin;
                end = drawAll(i + 1, turned, mesh, depth + 1);
            }
        } else {
            const std::string_view axis = statement.words[0];
            if (axis != "x" && axis != "y" && axis != "z") fail(statement, "wants x, y or z");
            for (const double length : statement.numbers) {
                city::Frame moved = at;
                moved.origin += (axis == "x" ? at.u : axis == "y" ? at.v : at.w) * length;
                end = drawAll(i + 1, moved, mesh, depth + 1);
            }
        }
        if (end >= statements_.size() || statements_[end].verb != "end") fail(statement, "has no end");
        return end;
    }

    void drawShape(const Statement& statement, const city::Frame& at, city::MeshBuilder& mesh) {
        const std::vector<double>& n = statement.numbers;
        const std::string_view name = statement.words[0];
        const auto same = [](char a, char b) { return a == b || (a == ' ' && b == '_'); };
        const auto found = std::find_if(pieces_.materials.begin(), pieces_.materials.end(), [&](const Material& m) {
            return std::equal(m.name.begin(), m.name.end(), name.begin(), name.end(), same);
        });
        if (found == pieces_.materials.end()) return fail(statement, "is of no material of the table");
        const auto material = static_cast<uint32_t>(found - pieces_.materials.begin());
        const auto turn = [&](const glm::dvec3& v) { return at.u * v.x + at.v * v.y + at.w * v.z; };
        const auto point = [&](size_t i) { return at.origin + turn({n[i], n[i + 1], n[i + 2]}); };
        const auto inPlace = [&](const city::Frame& frame) {
            return city::Frame{at.origin, turn(frame.u), turn(frame.v), turn(frame.w)};
        };
        if (statement.verb == "box") {
            addPrism(mesh, material, inPlace(city::kUpright), {{n[2], n[0]}, {n[5], n[0]}, {n[5], n[3]}, {n[2], n[3]}},
                     n[1], n[4]);
        } else if (statement.verb == "prism") {
            std::vector<glm::dvec2> outline;
            for (size_t i = 2; i < n.size(); i += 2) outline.push_back({n[i], n[i + 1]});
            const std::string_view way = statement.words[1];
            if (way != "up" && way != "across" && way != "along") return fail(statement, "wants up, across or along");
            const city::Frame& frame = way == "up" ? city::kUpright : way == "across" ? city::kAcross : city::kSideways;
            addPrism(mesh, material, inPlace(frame), outline, n[0], n[1]);
        } else if (statement.verb == "turned") {
            std::vector<city::Ring> rings;
            for (size_t i = 4; i < n.size(); i += 2) rings.push_back({n[i], n[i + 1]});
            constexpr double kSides[] = {3, 4, 6, 8, 12, 16};
            if (std::find(std::begin(kSides), std::end(kSides), n[0]) == std::end(kSides))
                return fail(statement, "wants 3, 4, 6, 8, 12 or 16 sides");
            addTurned(mesh, material, point(1), static_cast<int>(n[0]), rings);
        } else if (statement.verb == "quad") {
            mesh.quad(material, point(0), point(3), point(6), point(9));
        } else {
            mesh.triangle(material, point(0), point(3), point(6));
        }
    }

    std::vector<Statement> statements_;
    Pieces pieces_;
    std::string fault_;  ///< the first one
};

}  // namespace

Result<Pieces> readPieces(std::string_view table) { return PieceReader(table).read(); }

Pieces builtInPieces(std::string_view table) {
    return readPieces(table).value();  // stops the program where the table is at fault
}

void putShape(Mesh& piece, const city::MeshBuilder& shape) { piece = shape.finish(piece.name); }

}  // namespace sightline::tools
