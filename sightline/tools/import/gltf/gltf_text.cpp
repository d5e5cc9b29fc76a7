// A glTF's JSON, kept as text: only one element of a table at a time becomes values.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_text.h"
#include "sightline/tools/scene/json_text.h"

#include <utility>

namespace sightline::tools::gltf {
namespace {

using Text = JsonTable::Text;

constexpr int kDeepestText = 256;

// Before the parser sees the text: what it builds of an element is walked by others, some of them recursive.
void checkDepth(Text text) {
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const unsigned char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kDeepestText) fail("", "JSON is nested deeper than {} at byte {}", kDeepestText, i);
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

/// Reads the grammar and keeps nothing.
struct Grammar final : nlohmann::json_sax<Json> {
    size_t size = 0;
    int depth = 0;

    explicit Grammar(size_t bytes) : size(bytes) {}
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return ++depth, true; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return --depth, true; }
    bool start_array(std::size_t) override { return ++depth, true; }
    bool end_array() override { return --depth, true; }
    bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& error) override {
        constexpr int kOutOfRange = 406;
        if (error.id == kOutOfRange) fail("", "not JSON: a number is out of range");
        if (byte > size && depth > 0) fail("", "truncated: the JSON ends at byte {}, before it is complete", size);
        fail("", "not JSON: syntax error at byte {}", byte);
    }
};

// The rest is for text whose grammar is known to be right.

bool isSpace(unsigned char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

size_t skipSpace(Text text, size_t at) {
    while (at < text.size() && isSpace(text[at])) ++at;
    return at;
}

// The end of the string that begins here.
size_t stringEnd(Text text, size_t at) {
    for (++at; text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return at + 1;
}

// The end of the value that begins here.
size_t valueEnd(Text text, size_t at) {
    if (text[at] == '"') return stringEnd(text, at);
    if (text[at] != '[' && text[at] != '{') {
        while (at < text.size() && !isSpace(text[at]) && text[at] != ',' && text[at] != ']' && text[at] != '}') ++at;
        return at;
    }
    for (int depth = 0;;) {
        const unsigned char c = text[at];
        if (c == '"') {
            at = stringEnd(text, at);
            continue;
        }
        ++at;
        if (c == '[' || c == '{') ++depth;
        if ((c == ']' || c == '}') && --depth == 0) return at;
    }
}

Json parse(Text text) { return parseJson({reinterpret_cast<const char*>(text.data()), text.size()}); }

}  // namespace

Json JsonTable::operator[](size_t index) const {
    const size_t begin = starts_[index];
    size_t end = starts_[index + 1];
    while (isSpace(text_[end - 1]) || text_[end - 1] == ',') --end;
    return parse(text_.subspan(begin, end - begin));
}

Json JsonTable::object(size_t index, const std::string& place) const {
    Json value = (*this)[index];
    if (!value.is_object()) fail(place, "is not an object");
    return value;
}

JsonText::JsonText(Text text) : text_(text) {
    if (!plainJson(text)) {
        checkDepth(text);
        Grammar grammar(text.size());
        Json::sax_parse(text.data(), text.data() + text.size(), &grammar);
    }
    if (text[skipSpace(text, 0)] != '{') fail("", "not glTF: the JSON is not an object");
    index();
}

void JsonText::index() {
    size_t at = skipSpace(text_, 0) + 1;
    for (at = skipSpace(text_, at); text_[at] != '}'; at = skipSpace(text_, at)) {
        if (text_[at] == ',') ++at;
        else at = addMember(at);
    }
}

size_t JsonText::addMember(size_t at) {
    const size_t key_end = stringEnd(text_, at);
    const std::string key = parse(text_.subspan(at, key_end - at)).get<std::string>();
    at = skipSpace(text_, skipSpace(text_, key_end) + 1);
    Member member;
    member.begin = at;
    member.array = text_[at] == '[';
    if (member.array) {
        for (at = skipSpace(text_, at + 1); text_[at] != ']'; at = skipSpace(text_, at)) {
            if (text_[at] == ',') {
                ++at;
                continue;
            }
            member.starts.push_back(at);
            at = valueEnd(text_, at);
        }
        member.starts.push_back(at++);
    } else {
        at = valueEnd(text_, at);
    }
    member.end = at;
    members_[key] = std::move(member);
    return at;
}

JsonTable JsonText::table(const char* key) const {
    const auto found = members_.find(key);
    if (found == members_.end()) return {};
    if (!found->second.array) fail("", "{} is not an array", key);
    return {text_, found->second.starts};
}

Json JsonText::members(std::initializer_list<const char*> keys) const {
    Json out = Json::object();
    for (const char* key : keys) {
        const auto found = members_.find(key);
        if (found == members_.end()) continue;
        const Member& member = found->second;
        out[key] = member.array ? Json::array() : parse(text_.subspan(member.begin, member.end - member.begin));
    }
    return out;
}

Json JsonText::all() const { return parse(text_); }

}  // namespace sightline::tools::gltf
