// Whatever the bytes are, the reader of calibrations answers with costs above 0, or with one line.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "sightline/tools/report/run/calibration_json.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    using namespace sightline::tools;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const Result<std::optional<DrawCost>> drawing = parseDrawCost(text, "c.json");
    if (drawing.ok() && *drawing)
        for (const double cost : {(*drawing)->object, (*drawing)->triangle, (*drawing)->vertex, (*drawing)->pixel})
            if (!(cost >= 0.0) || !std::isfinite(cost)) std::abort();
    const Result<FacingCosts> read = parseCalibration(text, "c.json");
    if (read.ok()) {
        for (const double cost : {read->test, read->dropped, read->drawn})
            if (!(cost > 0.0) || !std::isfinite(cost)) std::abort();
        return 0;
    }
    const std::string& line = read.error().message;
    if (line.rfind("c.json: ", 0) == 0 && line.find('\n') == std::string::npos) return 0;
    std::fprintf(stderr, "not one line that begins with the file: %s\n", line.c_str());
    std::abort();
}
