// The verb `report`: what runs' files hold, as text and as a page, and two runs beside one another.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/summary.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/cull_page.h"
#include "sightline/tools/report/pictures/film_files.h"
#include "sightline/tools/report/run/compare_runs.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/trace_json.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

constexpr size_t kPictureBudget = size_t{18} << 20;  // of a page [bytes]
constexpr size_t kMostReportLines = 12;              // of objects that differ

struct ReportOptions {
    std::vector<std::string> runs;
    bool compare = false;
    std::string directory;  ///< of the page, or empty
    std::string json;       ///< file, `-`, or empty
    double fail_if_slower = 0;
};

void printComparison(std::FILE* out, const RunComparison& c, const RunFile& a, const RunFile& b) {
    fmt::print(out, "A {}: {}, {}\nB {}: {}, {}\n", oneLine(a.file), oneLine(a.run.scene),
               counted(a.run.frames.size(), "frame"), oneLine(b.file), oneLine(b.run.scene),
               counted(b.run.frames.size(), "frame"));
    fmt::print(out, "paired       {}; without a partner {} of A, {} of B\n", counted(c.pairs.size(), "frame"),
               c.unpaired_a, c.unpaired_b);
    if (c.pairs.empty()) {
        for (const std::string& sentence : c.verdict) fmt::print(out, "{}\n", oneLine(sentence));
        return;
    }
    fmt::print(out, "query        {:.1f} us in A, {:.1f} us in B, medians; B / A {:.3f} ({:.3f} to {:.3f})\n",
               c.median_a, c.median_b, c.ratio, c.ratio_low, c.ratio_high);
    fmt::print(out, "kept         {} in A, {} in B; only A {}, only B {}\n", grouped(c.kept_a), grouped(c.kept_b),
               grouped(c.only_a), grouped(c.only_b));
    if (c.over_estimate_a && c.over_estimate_b)
        fmt::print(out, "over-estimate {:.3f} in A, {:.3f} in B\n", *c.over_estimate_a, *c.over_estimate_b);
    fmt::print(out, "false culls  {} in A, {} in B, {} new\n", grouped(c.false_a), grouped(c.false_b),
               grouped(c.new_false));
    for (size_t i = 0; i < std::min(c.differences.size(), kMostReportLines); ++i) {
        const RunComparison::Difference& row = c.differences[i];
        fmt::print(out, "  object {} \"{}\": {} only in A, {} only in B\n", row.id & ~(uint64_t{1} << 63),
                   oneLine(row.path.empty() ? row.name : row.path, 200), counted(row.only_a, "frame"), row.only_b);
    }
    if (c.differences.size() > kMostReportLines)
        fmt::print(out, "  and {} more\n", c.differences.size() - kMostReportLines);
    for (const std::string& sentence : c.verdict) fmt::print(out, "{}\n", oneLine(sentence));
}

Status writeInto(const std::string& directory, const std::string& page) {
    return writeFileAside(directory + "/index.html", page);
}

Result<int> compare(const ReportOptions& options, const RunFile& a, const RunFile& b) {
    const std::optional<double> limit =
        options.fail_if_slower > 0 ? std::optional(options.fail_if_slower) : std::nullopt;
    const RunComparison comparison = compareRuns(a, b, limit);
    if (!quiet()) printComparison(options.json == "-" ? stderr : stdout, comparison, a, b);
    const std::string json = compareJson(comparison, a, b);
    if (!options.json.empty())
        if (Status written = writeText(options.json, json); !written) return written.error();
    if (!options.directory.empty()) {
        if (Status written = writeFileAside(options.directory + "/compare.json", json); !written)
            return written.error();
        if (Status written = writeInto(options.directory, comparePage(comparison, a, b)); !written)
            return written.error();
        tellPage(options.json == "-" ? stderr : stdout, options.directory);
    }
    return comparison.ok ? kDone : kAnswerIsNo;
}

Result<int> show(const ReportOptions& options, const std::vector<RunFile>& files) {
    bool sound = true;
    for (const RunFile& file : files) {
        if (!quiet()) {
            if (files.size() > 1) fmt::print("{}:\n", oneLine(file.file));
            if (file.run.frames.empty()) fmt::print("{}: no frames\n", oneLine(file.run.scene));
            else printSummary(stdout, file.run);
        }
        const auto sum = sumVerification(file.run);
        sound &= !sum || sum->false_culls == 0;
    }
    if (!options.directory.empty()) {
        const RunFile& file = files.front();
        std::vector<size_t> frames(file.run.frames.size());
        for (size_t i = 0; i < frames.size(); ++i) frames[i] = i;
        const Film film = filmBeside(
            file, {"shaded", "culled", "outside", "buffer", "windows", "plan", "section", "heat-all", "heat-kept"},
            frames, kPictureBudget);
        if (Status written = writeInto(options.directory, runPage(file.run, file.names, film)); !written)
            return written.error();
        tellPage(stdout, options.directory);
    }
    return sound ? kDone : kAnswerIsNo;
}

Status checkReport(const Command& verb, const ReportOptions& options) {
    if (options.compare && options.runs.size() != 2) return usageError("--compare takes two runs, A and B");
    if (!options.compare && verb.count("--fail-if-slower") > 0)
        return usageError("--fail-if-slower goes with --compare");
    if (!options.compare && !options.json.empty()) return usageError("--json goes with --compare");
    if (!options.compare && !options.directory.empty() && options.runs.size() != 1)
        return usageError("-o takes one run, or two with --compare");
    ApartFiles files;
    for (const std::string& name : options.runs) {
        files.read("RUN", name);
        files.read("RUN", std::filesystem::path(name) / "cull.json");
    }
    files.write("--json", options.json);
    if (options.directory.empty()) return files.status();
    const std::filesystem::path directory = options.directory;
    files.write("-o", directory / "index.html");
    if (options.compare) files.writeAgain("-o", directory / "compare.json", options.json);
    return files.status();
}

Result<int> runReport(const Command& verb, const ReportOptions& options) {
    if (Status good = checkReport(verb, options); !good) return good.error();
    std::vector<RunFile> files;
    for (const std::string& name : options.runs) {
        Result<RunFile> file = readRun(name);
        if (!file) return file.error();
        files.push_back(std::move(*file));
    }
    if (Status writable = canWriteFiles({options.json}); !writable) return writable.error();
    if (!options.directory.empty()) {
        if (Status made = makeDirectory(options.directory); !made) return made.error();
        if (Status writable = canWriteFile(options.directory + "/index.html"); !writable) return writable.error();
    }
    return options.compare ? compare(options, files[0], files[1]) : show(options, files);
}

}  // namespace

void addReport(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "report");
    const auto options = std::make_shared<ReportOptions>();
    verb->add_option("RUN", options->runs, "files of cull --json, or directories of cull --report")->required();
    verb->add_flag(
        "--compare", options->compare,
        "two runs, A and B; exit code 1 if B has false culls that A has not, or if no frames have the same camera");
    verb->add_option("-o,--output", options->directory, "write DIR/index.html")->type_name("DIR");
    verb->add_option("--json", options->json, "write the comparison as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--fail-if-slower", options->fail_if_slower,
                     "exit code 1 if B takes more than R times as long as A, by the median")
        ->check(Range{0.01, 1000.0})
        ->type_name("R");
    verb->callback([verb, options, &exit_code] {
        const Result<int> done = runReport(*verb, *options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
