// IFC4's faces by index, written as the faces of IFC2x3, which Assimp reads.
// SPDX-License-Identifier: MIT
#include "apps/import/ifc_rewrite.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "apps/import/fault.h"

namespace sightline::import {
namespace {

constexpr std::array<std::string_view, 7> kNotRead = {"IFCTRIANGULATEDIRREGULARNETWORK", "IFCADVANCEDBREP",
                                                      "IFCADVANCEDBREPWITHVOIDS",        "IFCADVANCEDFACE",
                                                      "IFCFIXEDREFERENCESWEPTAREASOLID", "IFCEXTRUDEDAREASOLIDTAPERED",
                                                      "IFCREVOLVEDAREASOLIDTAPERED"};

/// A statement `#id = TYPE(arguments);` and where it stands.
struct Statement {
    uint64_t id = 0;
    std::string type;
    std::string_view arguments;  ///< between the outermost brackets
    size_t begin = 0, end = 0;   ///< in the text, with the semicolon
};

/// The end of what begins at `at` and ends before one of `stops` outside of texts and brackets.
size_t skipTo(std::string_view text, size_t at, std::string_view stops) {
    int depth = 0;
    for (bool quoted = false; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '\'') quoted = !quoted;
        if (quoted) continue;
        if (depth == 0 && stops.find(c) != std::string_view::npos) return at;
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    }
    return at;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

/// The elements of "a,(b,c),d".
std::vector<std::string_view> split(std::string_view list) {
    std::vector<std::string_view> out;
    for (size_t at = 0; at < list.size();) {
        const size_t end = skipTo(list, at, ",");
        out.push_back(trimmed(list.substr(at, end - at)));
        at = end + 1;
    }
    return out;
}

std::string_view inBrackets(std::string_view text) {
    text = trimmed(text);
    if (text.size() < 2 || text.front() != '(' || text.back() != ')') return {};
    return text.substr(1, text.size() - 2);
}

uint64_t number(std::string_view text) {
    uint64_t out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size() ? out : 0;
}

uint64_t reference(std::string_view text) {
    text = trimmed(text);
    return text.starts_with('#') ? number(text.substr(1)) : 0;
}

/// All statements of some types; the largest number of any.
struct Statements {
    std::unordered_map<uint64_t, Statement> by_id;
    std::vector<uint64_t> to_replace;
    uint64_t largest = 0;
};

bool isReplaced(const std::string& type) {
    return type == "IFCTRIANGULATEDFACESET" || type == "IFCPOLYGONALFACESET" || type == "IFCINDEXEDPOLYCURVE";
}

bool isKept(const std::string& type) {
    return isReplaced(type) || type.starts_with("IFCCARTESIANPOINTLIST") || type.starts_with("IFCINDEXEDPOLYGONALFACE");
}

Statements readStatements(std::string_view text) {
    Statements out;
    for (size_t at = 0; at < text.size();) {
        const size_t end = skipTo(text, at, ";");
        const std::string_view words = trimmed(text.substr(at, end - at));
        const size_t equals = words.starts_with('#') ? words.find('=') : std::string_view::npos;
        const size_t open = equals == std::string_view::npos ? equals : words.find('(', equals);
        if (open != std::string_view::npos) {
            Statement statement;
            statement.id = reference(words.substr(0, equals));
            for (const char c : trimmed(words.substr(equals + 1, open - equals - 1)))
                statement.type += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
            out.largest = std::max(out.largest, statement.id);
            if (std::find(kNotRead.begin(), kNotRead.end(), statement.type) != kNotRead.end())
                throw Fault{fmt::format("holds IFC4 geometry that is not read ({}): export it as IFC2x3 or glTF",
                                        statement.type)};
            if (isKept(statement.type)) {
                statement.arguments = inBrackets(words.substr(open));
                statement.begin = static_cast<size_t>(words.data() - text.data());
                statement.end = end + 1;
                if (isReplaced(statement.type)) out.to_replace.push_back(statement.id);
                out.by_id[statement.id] = std::move(statement);
            }
        }
        at = end + 1;
    }
    return out;
}

/// Writes what replaces statements.
class Writer {
public:
    explicit Writer(const Statements& statements) : statements_(statements), next_(statements.largest + 1) {}

    std::string replacement(const Statement& from) {
        out_.clear();
        const std::vector<std::string_view> arguments = split(from.arguments);
        if (from.type == "IFCINDEXEDPOLYCURVE") return curve(from, arguments);
        const bool polygons = from.type == "IFCPOLYGONALFACESET";
        const size_t list = polygons ? 2 : 3;
        if (arguments.size() <= list) throw broken(from, "lacks arguments");
        const std::vector<uint64_t>& points = pointsOf(from, arguments[0]);
        std::string faces;
        for (const std::string_view face : split(inBrackets(arguments[list]))) {
            const std::string bounds = polygons ? polygon(from, points, face) : bound(from, points, face, true);
            const uint64_t id = add(fmt::format("IFCFACE(({}))", bounds));
            faces += fmt::format("{}#{}", faces.empty() ? "" : ",", id);
        }
        if (faces.empty()) throw broken(from, "has no faces");
        const uint64_t set = add(fmt::format("IFCCONNECTEDFACESET(({}))", faces));
        return out_ + fmt::format("#{}=IFCFACEBASEDSURFACEMODEL((#{}));", from.id, set);
    }

private:
    static Fault broken(const Statement& at, const std::string& what) {
        return {fmt::format("#{} ({}) {}", at.id, at.type, what)};
    }

    uint64_t add(const std::string& entity) {
        out_ += fmt::format("#{}={};\n", next_, entity);
        return next_++;
    }

    const Statement& find(const Statement& from, std::string_view text) const {
        const auto found = statements_.by_id.find(reference(text));
        if (found == statements_.by_id.end()) throw broken(from, "refers to what is not there");
        return found->second;
    }

    /// Points of a list, written when first asked for.
    const std::vector<uint64_t>& pointsOf(const Statement& from, std::string_view list) {
        const Statement& source = find(from, list);
        const auto [place, fresh] = points_.try_emplace(source.id);
        if (!fresh) return place->second;
        const std::vector<std::string_view> arguments = split(source.arguments);
        if (arguments.empty()) throw broken(source, "has no points");
        for (const std::string_view point : split(inBrackets(arguments[0])))
            place->second.push_back(add(fmt::format("IFCCARTESIANPOINT({})", point)));
        return place->second;
    }

    /// References to the points of "(1,2,3)".
    std::string corners(const Statement& from, const std::vector<uint64_t>& points, std::string_view indices) const {
        std::string out;
        for (const std::string_view word : split(inBrackets(indices))) {
            const uint64_t index = number(word);
            if (index == 0 || index > points.size()) throw broken(from, fmt::format("has no point {}", word));
            out += fmt::format("{}#{}", out.empty() ? "" : ",", points[index - 1]);
        }
        return out;
    }

    std::string bound(const Statement& from, const std::vector<uint64_t>& points, std::string_view indices,
                      bool outer) {
        const uint64_t loop = add(fmt::format("IFCPOLYLOOP(({}))", corners(from, points, indices)));
        return fmt::format("#{}", add(fmt::format("{}(#{},.T.)", outer ? "IFCFACEOUTERBOUND" : "IFCFACEBOUND", loop)));
    }

    std::string polygon(const Statement& from, const std::vector<uint64_t>& points, std::string_view face) {
        const std::vector<std::string_view> arguments = split(find(from, face).arguments);
        if (arguments.empty()) throw broken(from, "has a face without corners");
        std::string out = bound(from, points, arguments[0], true);
        if (arguments.size() > 1)
            for (const std::string_view hole : split(inBrackets(arguments[1])))
                out.append(",").append(bound(from, points, hole, false));
        return out;
    }

    std::string curve(const Statement& from, const std::vector<std::string_view>& arguments) {
        if (arguments.empty()) throw broken(from, "lacks arguments");
        const std::vector<uint64_t>& points = pointsOf(from, arguments[0]);
        std::string line;
        const std::vector<std::string_view> segments =
            arguments.size() > 1 ? split(inBrackets(arguments[1])) : std::vector<std::string_view>{};
        for (size_t i = 0; i < segments.size(); ++i) {
            const size_t open = segments[i].find('(');
            std::string kind(segments[i].substr(0, open));
            for (char& c : kind) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
            if (open == std::string_view::npos || trimmed(kind) != "IFCLINEINDEX")
                throw Fault{
                    "holds IFC4 geometry that is not read (IFCINDEXEDPOLYCURVE with arcs): export it as IFC2x3 or "
                    "glTF"};
            std::string part = corners(from, points, inBrackets(segments[i].substr(open)));
            if (i > 0) part.erase(0, std::min(part.size(), part.find(',') + 1));  // it begins where the last one ended
            line.append(line.empty() || part.empty() ? "" : ",").append(part);
        }
        if (segments.empty())
            for (const uint64_t point : points) line += fmt::format("{}#{}", line.empty() ? "" : ",", point);
        return out_ + fmt::format("#{}=IFCPOLYLINE(({}));", from.id, line);
    }

    const Statements& statements_;
    std::unordered_map<uint64_t, std::vector<uint64_t>> points_;
    uint64_t next_;
    std::string out_;
};

}  // namespace

std::string rewriteIfc(std::string text) {
    const Statements statements = readStatements(text);
    if (statements.to_replace.empty()) return text;
    Writer writer(statements);
    std::string out;
    out.reserve(text.size() * 2);
    size_t done = 0;
    for (const uint64_t id : statements.to_replace) {
        const Statement& statement = statements.by_id.at(id);
        if (statement.begin < done) continue;  // a number that is given twice
        out.append(text, done, statement.begin - done);
        out += writer.replacement(statement);
        done = statement.end;
    }
    return out.append(text, std::min(done, text.size()));
}

}  // namespace sightline::import
