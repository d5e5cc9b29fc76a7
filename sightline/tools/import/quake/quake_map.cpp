// Sources of maps: words, braces and parentheses, read in one pass.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_map.h"

#include <charconv>
#include <cmath>
#include <unordered_map>

#include <fmt/core.h>

#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

constexpr double kFarthestPlane = 1e9;  // [world units]
constexpr size_t kLongestWord = 65535;
constexpr size_t kMostSides = 4096;

bool isBlankOrControl(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// The signs that stand for themselves wherever they are, outside of quotes.
bool isSign(char c) { return c == '{' || c == '}' || c == '(' || c == ')' || c == '[' || c == ']'; }

/// A number that may begin with a plus; false if the text is none, or too large.
bool readNumber(std::string_view text, double& value) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && next == text.data() + text.size() && std::abs(value) <= kFarthestPlane;
}

class Reader {
public:
    Reader(std::string_view text, QuakeMap& map) : at_(text.data()), end_(at_ + text.size()), map_(map) {}

    /// The fault, or nothing.
    std::string run() {
        if (end_ - at_ >= 3 && std::string_view(at_, 3) == "\xEF\xBB\xBF") at_ += 3;
        next();
        while (ok() && !word_.empty()) readEntity();
        return fault_;
    }

private:
    bool ok() const { return fault_.empty(); }

    void fail(std::string what) {
        if (!ok()) return;
        fault_ = fmt::format("line {}: {}", word_line_, what);
        word_ = {};
        at_ = end_;
    }
    void failHere(const char* wanted) {
        fail(word_.empty() ? fmt::format("the file ends where {} was expected", wanted)
                           : fmt::format("\"{}\" where {} was expected", shortened(oneLine(word_), 40), wanted));
    }

    void skipBlanks() {
        for (; at_ < end_; ++at_) {
            if (*at_ == '/' && end_ - at_ > 1 && at_[1] == '/') skipComment();
            else if (!isBlankOrControl(*at_)) return;
            line_ += *at_ == '\n';
        }
    }

    /// To before the line's end.
    void skipComment() {
        constexpr std::string_view kGame = "// Game: ";
        const char* first = at_;
        while (at_ + 1 < end_ && at_[1] != '\n') ++at_;
        const std::string_view text(first, static_cast<size_t>(at_ + 1 - first));
        if (begun_ || !map_.game.empty() || !text.starts_with(kGame)) return;
        map_.game = text.substr(kGame.size(), 80);
        while (!map_.game.empty() && isBlankOrControl(map_.game.back())) map_.game.pop_back();
    }

    /// Takes the next word, sign or text in quotes; empty and not quoted at the end.
    void next() {
        skipBlanks();
        begun_ = true;
        word_line_ = line_;
        quoted_ = at_ < end_ && *at_ == '"';
        if (quoted_) return readQuoted();
        const char* first = at_;
        if (at_ < end_ && isSign(*at_)) ++at_;
        else
            while (at_ < end_ && !isBlankOrControl(*at_) && !isSign(*at_) && *at_ != '"') ++at_;
        setWord(first);
    }
    void setWord(const char* first) {
        word_ = {first, static_cast<size_t>(at_ - first)};
        if (word_.size() > kLongestWord) fail(fmt::format("a word of {} bytes", word_.size()));
    }

    /// The name of a texture, of which the word just taken is the beginning: signs are part of it, as in "{grate".
    std::string_view texture() {
        if (quoted_) return word_;
        const char* first = word_.data();
        if (word_.empty()) failHere("a texture");
        while (at_ < end_ && !isBlankOrControl(*at_)) ++at_;
        if (ok()) setWord(first);
        return word_;
    }

    /// To the closing quote, which a backslash before it makes part of the text, unless it is the line's last: paths
    /// end so.
    void readQuoted() {
        const char* first = ++at_;
        for (; at_ < end_ && *at_ != '"' && *at_ != '\n'; ++at_)
            if (*at_ == '\\' && end_ - at_ > 1 && at_[1] == '"' && closesLater(at_ + 2)) ++at_;
        if (at_ == end_ || *at_ == '\n') return fail("a quote is not closed on its line");
        word_ = {first, static_cast<size_t>(at_ - first)};
        ++at_;
        if (word_.size() > kLongestWord) fail(fmt::format("a text of {} bytes", word_.size()));
    }
    bool closesLater(const char* from) const {
        while (from < end_ && *from != '\n' && *from != '"') ++from;
        return from < end_ && *from == '"';
    }

    bool isNext(char sign) const { return !quoted_ && word_.size() == 1 && word_[0] == sign; }
    void take(char sign) {
        if (isNext(sign)) return next();
        const char wanted[] = {'\'', sign, '\'', 0};
        failHere(wanted);
    }
    double number() {
        double value = 0;
        if (quoted_ || !readNumber(word_, value)) {
            failHere("a number");
            return 0;
        }
        next();
        return value;
    }
    /// Flags, which some files write as real numbers or with a sign.
    uint32_t flags() {
        const double value = number();
        if (!(value >= -2147483648.0 && value < 4294967296.0)) {
            fail("flags of more than 32 bits");
            return 0;
        }
        return static_cast<uint32_t>(static_cast<int64_t>(value));
    }
    bool isNumber() const {
        double value = 0;
        return !quoted_ && readNumber(word_, value);
    }
    glm::dvec3 point() {
        take('(');
        const double x = number(), y = number(), z = number();
        take(')');
        return {x, z, -y};
    }

    void readEntity() {
        QuakeMapEntity entity;
        entity.line = word_line_;
        entity.first_pair = static_cast<uint32_t>(map_.pairs.size());
        entity.first_brush = static_cast<uint32_t>(map_.brushes.size());
        take('{');
        while (ok() && !isNext('}')) {
            if (quoted_) {
                QuakeMapPair pair;
                pair.key = word_;
                next();
                if (ok() && !quoted_) failHere("a value in quotes");
                pair.value = word_;
                if (!ok()) return;
                next();
                map_.pairs.push_back(std::move(pair));
            } else if (isNext('{')) {
                readBrush();
            } else {
                failHere("a key, a brush or '}'");
            }
        }
        take('}');
        entity.pair_count = static_cast<uint32_t>(map_.pairs.size()) - entity.first_pair;
        entity.brush_count = static_cast<uint32_t>(map_.brushes.size()) - entity.first_brush;
        if (ok()) map_.entities.push_back(entity);
    }

    void readBrush() {
        QuakeMapBrush brush;
        brush.line = word_line_;
        brush.first_side = static_cast<uint32_t>(map_.sides.size());
        next();
        if (!quoted_ && word_.substr(0, 5) == "patch") return skipPatch();
        const bool primitive = !quoted_ && word_ == "brushDef";
        if (!quoted_ && word_ == "brushDef3") return fail("a brush of Doom 3, which is not read");
        if (primitive) {
            map_.primitives = true;
            next();
            take('{');
        }
        while (ok() && !isNext('}')) {
            if (map_.sides.size() - brush.first_side >= kMostSides)
                return fail(fmt::format("a brush of more than {} sides", kMostSides));
            readSide(primitive);
        }
        take('}');
        if (primitive) take('}');
        brush.side_count = static_cast<uint32_t>(map_.sides.size()) - brush.first_side;
        if (ok()) map_.brushes.push_back(brush);
    }

    void readSide(bool primitive) {
        QuakeMapSide side;
        for (glm::dvec3& point : side.points) point = this->point();
        if (primitive) {
            take('(');
            for (int row = 0; row < 2; ++row) point();
            take(')');
        }
        const std::string_view name = texture();
        if (ok()) side.texture = textureOf(name);
        if (!ok()) return;
        next();
        if (isNext('[')) {  // two axes, their lengths free
            for (int axis = 0; axis < 2; ++axis) {
                take('[');
                for (int i = 0; i < 4; ++i) number();
                take(']');
            }
            for (int i = 0; i < 3; ++i) number();  // turn, and two scales
        } else if (!primitive) {
            for (int i = 0; i < 5; ++i) number();
        }
        // Contents, surface and value, as far as they are there.
        side.has_flags = isNumber();
        if (isNumber()) side.contents = flags();
        if (isNumber()) side.surface = flags();
        while (isNumber()) next();
        if (ok()) map_.sides.push_back(side);
    }

    void skipPatch() {
        uint64_t depth = 1;
        for (next(); ok(); next()) {
            if (word_.empty() && !quoted_) return failHere("'}'");
            if (isNext('{')) ++depth;
            if (isNext('}') && --depth == 0) break;
        }
        take('}');
        map_.patches += ok();
    }

    uint32_t textureOf(std::string_view name) {
        const auto [at, fresh] =
            texture_numbers_.try_emplace(std::string(name), static_cast<uint32_t>(map_.textures.size()));
        if (fresh) map_.textures.emplace_back(name);
        return at->second;
    }

    const char *at_, *end_;
    uint32_t line_ = 1, word_line_ = 1;
    std::string_view word_;
    bool quoted_ = false, begun_ = false;
    std::string fault_;
    QuakeMap& map_;
    std::unordered_map<std::string, uint32_t> texture_numbers_;
};

}  // namespace

Result<QuakeMap> parseQuakeMap(std::span<const unsigned char> bytes, const std::string& name) {
    QuakeMap map;
    Reader reader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, map);
    const std::string fault = reader.run();
    if (!fault.empty()) return Error{Error::Kind::kInput, fmt::format("{}: {}", name, fault)};
    if (map.entities.empty()) return Error{Error::Kind::kInput, fmt::format("{}: no entity", name)};
    return map;
}

std::optional<glm::dvec3> quakeVector(std::string_view value) {
    double numbers[3];
    size_t count = 0, at = 0;
    while (at < value.size()) {
        if (isBlankOrControl(value[at])) {
            ++at;
            continue;
        }
        size_t end = at;
        while (end < value.size() && !isBlankOrControl(value[end])) ++end;
        if (count == 3 || !readNumber(value.substr(at, end - at), numbers[count])) return std::nullopt;
        ++count;
        at = end;
    }
    if (count != 3) return std::nullopt;
    return glm::dvec3(numbers[0], numbers[2], -numbers[1]);
}

}  // namespace sightline::tools
