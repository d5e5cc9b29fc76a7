// Tells plain JSON at a glance, so that a large text is not taken apart twice.
// SPDX-License-Identifier: MIT
//
// Tim Bray. RFC 8259: The JavaScript Object Notation (JSON) Data Interchange Format. 2017.
#include "sightline/tools/import/gltf/gltf_text.h"

#include <bitset>
#include <cstring>
#include <string_view>

namespace sightline::tools::gltf {
namespace {

constexpr size_t kDeepest = 256;
constexpr ptrdiff_t kLongestNumber = 100;  // with two digits of exponent still far from infinity

bool isDigit(unsigned char c) { return c >= '0' && c <= '9'; }
bool isHex(unsigned char c) { return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

class Scanner {
public:
    explicit Scanner(std::span<const unsigned char> text) : at_(text.data()), end_(at_ + text.size()) {}

    bool document() {
        for (;;) {
            space();
            bool opened = false;
            if (!value(opened)) return false;
            if (opened) continue;
            // Closes what ends here; goes on to the next value of what does not.
            for (;;) {
                space();
                if (depth_ == 0) return at_ == end_;
                const bool object = in_object_[depth_ - 1];
                if (take(object ? '}' : ']')) {
                    --depth_;
                    continue;
                }
                if (!take(',')) return false;
                if (object && !key()) return false;
                break;
            }
        }
    }

private:
    unsigned char now() const { return at_ < end_ ? *at_ : 0; }
    bool take(char c) { return now() == static_cast<unsigned char>(c) && (++at_, true); }
    void space() {
        while (at_ < end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
    }

    // `opened`: a container began whose first value is next.
    bool value(bool& opened) {
        switch (now()) {
            case '{':
            case '[':
                return open(opened);
            case '"':
                return string();
            case 't':
                return literal("true");
            case 'f':
                return literal("false");
            case 'n':
                return literal("null");
            default:
                return number();
        }
    }

    bool open(bool& opened) {
        const bool object = *at_++ == '{';
        space();
        if (take(object ? '}' : ']')) return depth_ < kDeepest;
        if (depth_ == kDeepest) return false;
        in_object_[depth_++] = object;
        opened = true;
        return !object || key();
    }

    bool key() {
        space();
        if (now() != '"' || !string()) return false;
        space();
        return take(':');
    }

    bool literal(std::string_view word) {
        if (static_cast<size_t>(end_ - at_) < word.size() || std::memcmp(at_, word.data(), word.size()) != 0)
            return false;
        at_ += word.size();
        return true;
    }

    size_t digits() {
        size_t count = 0;
        while (isDigit(now())) ++at_, ++count;
        return count;
    }

    bool number() {
        const unsigned char* begin = at_;
        take('-');
        if (!take('0') && digits() == 0) return false;
        if (isDigit(now())) return false;
        if (take('.') && digits() == 0) return false;
        if (now() == 'e' || now() == 'E') {
            ++at_;
            if (!take('+')) take('-');
            const size_t count = digits();
            if (count == 0 || count > 2) return false;
        }
        return at_ - begin <= kLongestNumber;
    }

    bool string() {
        for (++at_; at_ < end_;) {
            const unsigned char c = *at_;
            if (c == '"') return ++at_, true;
            if (c < 0x20) return false;
            if (c >= 0x80 ? !sequence() : c == '\\' ? !escape() : (++at_, false)) return false;
        }
        return false;
    }

    bool escape() {
        ++at_;
        if (!take('u')) return at_ < end_ && std::strchr("\"\\/bfnrt", *at_) && *at_++ != 0;
        if (end_ - at_ < 4) return false;
        for (int i = 0; i < 4; ++i)
            if (!isHex(at_[i])) return false;
        const bool surrogate = (at_[0] == 'd' || at_[0] == 'D') && at_[1] >= '8';
        at_ += 4;
        return !surrogate;
    }

    // Table 3-7 of the Unicode Standard: neither overlong, nor a surrogate, nor beyond U+10FFFF.
    bool sequence() {
        const unsigned char c = *at_++;
        unsigned char low = 0x80, high = 0xbf;
        int more = 0;
        if (c >= 0xc2 && c <= 0xdf) more = 1;
        else if (c >= 0xe0 && c <= 0xef) more = 2;
        else if (c >= 0xf0 && c <= 0xf4) more = 3;
        else return false;
        if (c == 0xe0) low = 0xa0;
        if (c == 0xed) high = 0x9f;
        if (c == 0xf0) low = 0x90;
        if (c == 0xf4) high = 0x8f;
        for (; more > 0; --more, low = 0x80, high = 0xbf, ++at_)
            if (now() < low || now() > high) return false;
        return true;
    }

    const unsigned char* at_;
    const unsigned char* end_;
    size_t depth_ = 0;
    std::bitset<kDeepest> in_object_;
};

}  // namespace

bool plainJson(std::span<const unsigned char> text) { return Scanner(text).document(); }

}  // namespace sightline::tools::gltf
