// Whatever the bytes are, the reader of runs answers with a run that can be shown and compared, or with one line.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "sightline/tools/report/page/cull_page.h"
#include "sightline/tools/report/pictures/film.h"
#include "sightline/tools/report/run/compare_runs.h"
#include "sightline/tools/report/run/run_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    using namespace sightline::tools;
    const Result<RunFile> read = parseRun({reinterpret_cast<const char*>(data), size}, "run.json");
    if (!read.ok()) {
        const std::string& line = read.error().message;
        if (line.rfind("run.json: ", 0) == 0 && line.find('\n') == std::string::npos) return 0;
        std::fprintf(stderr, "not one line that begins with the file: %s\n", line.c_str());
        std::abort();
    }
    if (runPage(read->run, read->names, Film()).empty() || !compareRuns(*read, *read).ok) std::abort();
    return 0;
}
