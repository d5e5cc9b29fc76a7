// What any engine says that it drew, frame by frame: JSON or CSV from a stranger's file.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/answers.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/run/json_place.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

using nlohmann::json;

constexpr uint64_t kMostAnswered = 1u << 24, kMostAnswerSide = 16384;
constexpr size_t kMostShown = 60;  // of a stranger's text in a message  [bytes]

// JSON

DrawnObject drawnOf(const JsonAt& at, uint64_t place) {
    DrawnObject object;
    object.place = place;
    if (!at.value->is_string()) {
        if (!at.value->is_number()) at.fail("neither a name nor a key");
        object.key = at.whole();
        return object;
    }
    object.name = at.text();
    if (object.name.empty()) at.fail("an empty name");
    return object;
}

/// @param index  of the frame in the list
AnsweredFrame answeredFrameOf(const JsonAt& at, size_t index) {
    AnsweredFrame frame;
    const auto drawn = at.maybe("drawn"), visible = at.maybe("visible"), number = at.maybe("frame");
    if (drawn && visible) at.fail("\"drawn\" and \"visible\" both say what was drawn");
    const JsonAt list = visible ? *visible : at.member("drawn");
    frame.frame = static_cast<uint32_t>(number ? number->whole(0, kMostAnswered) : index);
    frame.place = list.place;
    frame.drawn.reserve(list.size());
    for (size_t i = 0; i < list.size(); ++i) frame.drawn.push_back(drawnOf(list.element(i), i));
    return frame;
}

/// The cameras that the frames bring with them.
CameraPath camerasOf(const JsonAt& frames, const std::vector<AnsweredFrame>& read) {
    json list = json::array();
    for (size_t i = 0; i < frames.size(); ++i) {
        const JsonAt at = frames.element(i);
        const auto camera = at.maybe("camera");
        if (camera) list.push_back(*camera->value);
        if (list.size() != (camera ? i + 1 : 0)) at.fail("has no \"camera\", but other frames have one");
        if (camera && read[i].frame != i)
            at.member("frame").fail("with a \"camera\" in each frame, frames are numbered as they stand");
    }
    if (list.empty()) return {};
    Result<CameraPath> path = parseCameraPath(jsonText(json{{"frames", std::move(list)}}), "cameras");
    if (!path) throw JsonFault{path.error().message};
    return *path;
}

Answers readJson(const json& document) {
    const JsonAt head{&document, ""};
    const JsonAt frames = head.member("frames");
    Answers out;
    if (const auto width = head.maybe("width")) out.width = static_cast<uint32_t>(width->whole(1, kMostAnswerSide));
    if (const auto height = head.maybe("height")) out.height = static_cast<uint32_t>(height->whole(1, kMostAnswerSide));
    if (out.width.has_value() != out.height.has_value()) head.fail("\"width\" without \"height\", or the other way");
    if (const auto stereo = head.maybe("stereo")) out.stereo = stereo->positive();
    if (const auto sections = head.maybe("sections"))
        for (size_t i = 0; i < sections->size(); ++i) sections->element(i).numbers(&out.sections.emplace_back().x, 4);
    for (size_t i = 0; i < frames.size(); ++i) out.frames.push_back(answeredFrameOf(frames.element(i), i));
    out.cameras = camerasOf(frames, out.frames);
    std::map<uint32_t, size_t> first;
    for (size_t i = 0; i < out.frames.size(); ++i)
        if (const auto [at, is_new] = first.try_emplace(out.frames[i].frame, i); !is_new)
            frames.element(i).fail(fmt::format("frame {} is frames[{}] already", at->first, at->second));
    return out;
}

// CSV: RFC 4180, with line ends of any kind.

/// The records of a text: their fields, and the line that each begins on.
class CsvReader {
public:
    explicit CsvReader(std::string_view text) : rest_(text) {}

    /// False at the end. Lines without a character are passed over.
    bool next(std::vector<std::string>& fields, uint64_t& line) {
        while (!rest_.empty() && endsLine(rest_.front())) takeLineEnd();
        if (rest_.empty()) return false;
        line = line_;
        fields.clear();
        do fields.push_back(field());
        while (takeComma());
        if (!rest_.empty()) takeLineEnd();
        return true;
    }

private:
    static bool endsLine(char c) { return c == '\n' || c == '\r'; }
    [[noreturn]] static void fail(uint64_t line, const std::string& what) {
        throw JsonFault{fmt::format("line {}: {}", line, what)};
    }
    void takeLineEnd() {
        rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
        ++line_;
    }
    bool takeComma() {
        if (!rest_.starts_with(',')) return false;
        rest_.remove_prefix(1);
        return true;
    }
    std::string field() {
        if (rest_.starts_with('"')) return quoted();
        const size_t end = std::min(rest_.find_first_of(",\r\n"), rest_.size());
        std::string text(rest_.substr(0, end));
        if (text.find('"') != std::string::npos) fail(line_, "a quote within a field that does not begin with one");
        rest_.remove_prefix(end);
        return text;
    }
    std::string quoted() {
        const uint64_t begin = line_;
        std::string text;
        for (rest_.remove_prefix(1);; rest_.remove_prefix(1)) {
            if (rest_.empty()) fail(begin, "a quote that does not close");
            if (rest_.starts_with("\"\"")) rest_.remove_prefix(1);
            else if (rest_.front() == '"') break;
            line_ += rest_.front() == '\n' || (rest_.front() == '\r' && !rest_.starts_with("\r\n"));
            text += rest_.front();
        }
        rest_.remove_prefix(1);
        if (!rest_.empty() && rest_.front() != ',' && !endsLine(rest_.front()))
            fail(line_, "text behind a closing quote");
        return text;
    }

    std::string_view rest_;
    uint64_t line_ = 1;
};

/// A field without blanks around it.
std::string_view trimmed(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t");
    return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

uint64_t wholeOf(std::string_view text, uint64_t line, const char* column) {
    uint64_t number = 0;
    text = trimmed(text);
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault == std::errc() && end == text.data() + text.size()) return number;
    throw JsonFault{
        fmt::format("line {}: {} \"{}\" is not a whole number", line, column, shortened(oneLine(text), kMostShown))};
}

Answers readCsv(std::string_view text) {
    Answers out;
    CsvReader reader(text);
    std::vector<std::string> fields;
    uint64_t line = 0;
    const bool any = reader.next(fields, line);
    const bool by_key = any && fields.size() == 2 && trimmed(fields[1]) == "key";
    if (!any || fields.size() != 2 || trimmed(fields[0]) != "frame" || (!by_key && trimmed(fields[1]) != "name"))
        throw JsonFault{
            fmt::format("line {}: not JSON, and the header of CSV is `frame,name` or `frame,key`", any ? line : 1)};
    std::map<uint32_t, AnsweredFrame> frames;
    while (reader.next(fields, line)) {
        if (fields.size() != 2)
            throw JsonFault{
                fmt::format("line {}: {} fields, not 2; a name with a comma stands in quotes", line, fields.size())};
        const uint64_t number = wholeOf(fields[0], line, "frame");
        if (number > kMostAnswered)
            throw JsonFault{fmt::format("line {}: frame {} is not between 0 and {}", line, number, kMostAnswered)};
        AnsweredFrame& frame = frames[static_cast<uint32_t>(number)];
        frame.frame = static_cast<uint32_t>(number);
        if (fields[1].empty()) continue;  // the frame was answered: by nothing
        DrawnObject object;
        object.place = line;
        if (by_key) object.key = wholeOf(fields[1], line, "key");
        else object.name = std::move(fields[1]);
        frame.drawn.push_back(std::move(object));
    }
    for (auto& [number, frame] : frames) out.frames.push_back(std::move(frame));
    return out;
}

}  // namespace

std::string Answers::placeOf(const AnsweredFrame& frame, const DrawnObject& object) const {
    if (frame.place.empty()) return fmt::format("{}: line {}", file, object.place);
    return fmt::format("{}: {}[{}]", file, frame.place, object.place);
}

Result<Answers> parseAnswers(std::string_view text, const std::string& file) {
    const auto error = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", file, what)};
    };
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.find('\0') != std::string_view::npos) return error("holds a zero byte: text is UTF-8 here");
    const size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return error("is empty");
    try {
        const bool is_json = text[first] == '{' || text[first] == '[';
        Answers out = is_json ? readJson(parseJson(text)) : readCsv(text);
        if (out.frames.empty()) return error("no frames");
        out.file = file;
        std::sort(out.frames.begin(), out.frames.end(),
                  [](const AnsweredFrame& a, const AnsweredFrame& b) { return a.frame < b.frame; });
        return out;
    } catch (const JsonFault& fault) { return error(fault.what); } catch (const json::exception& fault) {
        return error("not JSON: " + jsonFaultOf(fault.what()));
    }
}

}  // namespace sightline::tools
