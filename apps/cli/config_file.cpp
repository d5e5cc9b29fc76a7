// Configuration files: sections of keys and values, the part of TOML that options need.
// SPDX-License-Identifier: MIT
#include "apps/cli/config_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace sightline::cli {
namespace {

constexpr size_t kMostBytes = size_t{1} << 20;

bool isBare(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isHex(char c) { return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

void addUtf8(std::string& out, uint32_t code) {
    if (code < 0x80) out += static_cast<char>(code);
    else if (code < 0x800) out += {static_cast<char>(0xc0 | code >> 6), static_cast<char>(0x80 | (code & 0x3f))};
    else if (code < 0x10000)
        out += {static_cast<char>(0xe0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3f)),
                static_cast<char>(0x80 | (code & 0x3f))};
    else
        out += {static_cast<char>(0xf0 | code >> 18), static_cast<char>(0x80 | (code >> 12 & 0x3f)),
                static_cast<char>(0x80 | (code >> 6 & 0x3f)), static_cast<char>(0x80 | (code & 0x3f))};
}

/// A number of TOML, or a sign that it is none: 1_000, -2.5e3, inf, nan.
bool isNumber(std::string_view word) {
    if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
    if (word == "inf" || word == "nan") return true;
    size_t i = 0;
    const auto digits = [&] {
        const size_t begin = i;
        while (i < word.size() && (isDigit(word[i]) || (word[i] == '_' && i > begin && isDigit(word[i - 1])))) ++i;
        return i > begin && word[i - 1] != '_';
    };
    if (!digits()) return false;
    if (i > 1 && word[0] == '0') return false;
    if (i < word.size() && word[i] == '.' && (++i, !digits())) return false;
    if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
        ++i;
        if (i < word.size() && (word[i] == '+' || word[i] == '-')) ++i;
        if (!digits()) return false;
    }
    return i == word.size();
}

class Parser {
public:
    Parser(std::string_view text, std::string name) : text_(text) { file_.name = std::move(name); }

    Result<ConfigFile> parse() {
        if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;
        std::string section;
        while (!fault_ && (skipBlank(true), at_ < text_.size())) {
            if (peek() == '[') readSection(section);
            else readEntry(section);
            if (!fault_) endOfLine();
        }
        if (fault_) return *fault_;
        return std::move(file_);
    }

private:
    char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
    bool isEnd() const { return at_ >= text_.size() || peek() == '\n' || (peek() == '\r' && peek(1) == '\n'); }

    void fail(const std::string& what) {
        if (!fault_) fault_ = file_.fault(line_, what);
    }

    /// Skips spaces and comments, and line ends if told to.
    void skipBlank(bool lines) {
        while (at_ < text_.size()) {
            if (peek() == ' ' || peek() == '\t') ++at_;
            else if (peek() == '#')
                while (!isEnd()) ++at_;
            else if (lines && isEnd()) {
                at_ += peek() == '\r' ? 2 : 1;
                ++line_;
            } else break;
        }
    }

    void endOfLine() {
        skipBlank(false);
        if (!isEnd()) fail("only a comment may follow on this line");
    }

    std::string readKey() {
        if (peek() == '"' || peek() == '\'') return readString();
        const size_t begin = at_;
        while (isBare(peek())) ++at_;
        if (at_ == begin) fail("a key is missing, letters, digits, - and _");
        return std::string(text_.substr(begin, at_ - begin));
    }

    void readSection(std::string& section) {
        ++at_;
        if (peek() == '[') return fail("[[sections]] are not read, only [sections]");
        skipBlank(false);
        section = readKey();
        skipBlank(false);
        if (fault_) return;
        if (peek() == '.') return fail("sections in sections are not read");
        if (peek() != ']') return fail("the ] of the section is missing");
        ++at_;
        if (const auto [other, fresh] = lines_.try_emplace({section, ""}, line_); !fresh)
            return fail(fmt::format("[{}] is there already, in line {}", section, other->second));
        ConfigEntry entry;
        entry.section = section;
        entry.line = line_;
        file_.sections.push_back(std::move(entry));
    }

    void readEntry(const std::string& section) {
        ConfigEntry entry;
        entry.section = section;
        entry.line = line_;
        entry.key = readKey();
        skipBlank(false);
        if (fault_) return;
        if (peek() == '.') return fail("dotted keys are not read: use a [section]");
        if (peek() != '=') return fail(fmt::format("\"{}\" has no =", entry.key));
        ++at_;
        skipBlank(false);
        readValue(entry);
        if (fault_) return;
        if (const auto [other, fresh] = lines_.try_emplace({section, "=" + entry.key}, entry.line); !fresh)
            return fail(fmt::format("\"{}\" is there already, in line {}", entry.key, other->second));
        file_.entries.push_back(std::move(entry));
    }

    void readValue(ConfigEntry& entry) {
        if (peek() != '[') return readWord(entry);
        ++at_;
        entry.kind = ConfigEntry::Kind::kList;
        for (;;) {
            skipBlank(true);
            if (peek() == ']') break;
            ConfigEntry word;
            readWord(word);
            if (fault_) return;
            entry.words.push_back(std::move(word.words[0]));
            skipBlank(true);
            if (peek() == ',') ++at_;
            else if (peek() != ']') return fail(fmt::format("the list of \"{}\" needs a , or its ]", entry.key));
        }
        ++at_;
    }

    void readWord(ConfigEntry& entry) {
        if (peek() == '"' || peek() == '\'') {
            entry.kind = ConfigEntry::Kind::kText;
            entry.words = {readString()};
            return;
        }
        const size_t begin = at_;
        while (isBare(peek()) || peek() == '+' || peek() == '.') ++at_;
        std::string word(text_.substr(begin, at_ - begin));
        if (word == "true" || word == "false") entry.kind = ConfigEntry::Kind::kSwitch;
        else if (isNumber(word)) {
            entry.kind = ConfigEntry::Kind::kNumber;
            word.erase(std::remove(word.begin(), word.end(), '_'), word.end());
        } else if (word.empty()) return fail("a value is missing: \"text\", a number, true, false or [a list]");
        else return fail(fmt::format("{} is neither a number nor true nor false; text stands in quotes", word));
        entry.words = {std::move(word)};
    }

    std::string readString() {
        const char quote = peek();
        if (peek(1) == quote && peek(2) == quote) return fail("strings of several lines are not read"), std::string();
        ++at_;
        std::string out;
        while (peek() != quote || at_ >= text_.size()) {
            if (isEnd()) return fail("a string does not end on its line"), out;
            const char c = text_[at_++];
            if (static_cast<unsigned char>(c) < 0x20 && c != '\t') return fail("a control character in a string"), out;
            if (c == '\\' && quote == '"') readEscape(out);
            else out += c;
            if (fault_) return out;
        }
        ++at_;
        return out;
    }

    void readEscape(std::string& out) {
        constexpr std::string_view kNames = "btnfr\"\\", kMeanings = "\b\t\n\f\r\"\\";
        const char c = peek();
        ++at_;
        if (const size_t known = kNames.find(c); c != '\0' && known != std::string_view::npos) {
            out += kMeanings[known];
            return;
        }
        if (c != 'u' && c != 'U') return fail("an unknown \\ in a string; 'text' in single quotes has none");
        uint32_t code = 0;
        for (int i = c == 'u' ? 4 : 8; i > 0; --i) {
            const char digit = peek();
            if (!isHex(digit)) return fail("too few digits after \\u in a string");
            code = code << 4 | static_cast<uint32_t>(isDigit(digit) ? digit - '0' : (digit | 0x20) - 'a' + 10);
            ++at_;
        }
        if (code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return fail("\\u is no character in a string");
        addUtf8(out, code);
    }

    std::string_view text_;
    size_t at_ = 0;
    uint32_t line_ = 1;
    ConfigFile file_;
    std::map<std::pair<std::string, std::string>, uint32_t> lines_;  // of sections, and of keys with = before them
    std::optional<Error> fault_;
};

}  // namespace

Error ConfigFile::fault(uint32_t line, const std::string& what) const {
    return {Error::Kind::kInput, fmt::format("{}:{}: {}", name, line, what)};
}

Result<ConfigFile> parseConfig(std::string_view text, const std::string& name) { return Parser(text, name).parse(); }

Result<ConfigFile> readConfig(const std::string& file) {
    const auto failure = [&](const std::string& why) {
        return Error{Error::Kind::kInput, fmt::format("{}: cannot be read: {}", file, why)};
    };
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return failure(std::strerror(errno));
    std::string text;
    char bytes[4096];
    ssize_t count = 0;
    while (text.size() <= kMostBytes && (count = ::read(descriptor, bytes, sizeof bytes)) > 0)
        text.append(bytes, static_cast<size_t>(count));
    const int error = errno;
    ::close(descriptor);
    if (count < 0) return failure(std::strerror(error));
    if (text.size() > kMostBytes) return failure("larger than a configuration file may be, 1 MiB");
    return parseConfig(text, file);
}

std::string tomlText(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') out += {'\\', c};
        else if (byte < 0x20 || byte == 0x7f) out += fmt::format("\\u{:04x}", byte);
        else out += c;
    }
    return out + "\"";
}

}  // namespace sightline::cli
