// Whatever the bytes are, the reader of engines' answers has frames for them, or one line.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "sightline/tools/report/run/answers.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    using namespace sightline::tools;
    const Result<Answers> read = parseAnswers({reinterpret_cast<const char*>(data), size}, "answers");
    if (!read.ok()) {
        const std::string& line = read.error().message;
        if (line.rfind("answers: ", 0) == 0 && line.find('\n') == std::string::npos) return 0;
        std::fprintf(stderr, "not one line that begins with the file: %s\n", line.c_str());
        std::abort();
    }
    if (read->frames.empty()) std::abort();
    for (const AnsweredFrame& frame : read->frames)
        for (const DrawnObject& object : frame.drawn)
            if (read->placeOf(frame, object).empty()) std::abort();
    return 0;
}
