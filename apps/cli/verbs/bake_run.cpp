// A bake as the tool runs it: its options, on threads, with progress, and with a state on disk that it goes on from.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/bake_run.h"

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "sightline/bake/flow/bake_state.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

constexpr size_t kProgressParts = 100;

/// What an earlier run left.
struct Left {
    RowJournal journal;
    std::string rows;  // a state of rows, or empty
};

/// Errors: the file holds something else.
Result<Left> readLeft(const std::string& file) {
    Left out;
    std::error_code error;
    if (file.empty() || !std::filesystem::is_regular_file(file, error)) return out;
    const Result<std::string> bytes = readTextFile(file, size_t(1) << 36);
    if (!bytes) {
        note(bytes.error().message + ": the bake begins anew");
        return out;
    }
    if (!isBakeState(*bytes) && !RowJournal::begins(*bytes))
        return Error{Error::Kind::kOutput, file + ": holds something else than the state of a bake"};
    std::span<const char> rest = *bytes;
    Result<RowJournal> journal = RowJournal::takenOff(rest, file);
    if (!journal) {
        note(journal.error().message + ": the bake begins anew");
        return out;
    }
    out.journal = std::move(*journal);
    out.rows.assign(rest.begin(), rest.end());
    return out;
}

}  // namespace

VisCells visCellsOf(const std::string& word) {
    if (word == "leaves") return VisCells::kLeaves;
    return word == "groups" ? VisCells::kGroups : VisCells::kClusters;
}

void addBakeOptions(Command& verb, BakeOptions& options, const std::string& output, bool of_scenes) {
    std::vector<std::string> cells = {"clusters", "leaves", "groups"};
    if (of_scenes) cells.insert(cells.end(), {"walls", "none"});
    verb.add_option("-o,--output", options.output, output)->type_name("FILE");
    verb.add_option(
            "--cells", options.cells,
            "what of a .bsp has a row: clusters, as the map's compiler made them; leaves, each its own, which "
            "is tighter and takes far longer; groups, of leaves that are open to one another (default: "
            "clusters)" +
                std::string(
                    of_scenes ? "; of a scene: walls, its own, although cells are marked; none, view cells alone" : ""))
        ->check(OneOf(cells));
    verb.add_flag("--objects", options.objects,
                  "tell also which objects each cell sees, of a .bsp its faces: takes longer than the cells do");
    verb.add_option("--threads", options.threads, "share the portals among so many threads (default: one a core)")
        ->check(Range{1u, 1024u});
    verb.add_option(
            "--budget", options.budget,
            "portals that may be clipped for each portal and direction, 0: no limit; what is not settled by then "
            "is visible, and counted (default: work of some minutes, shared out among all portals)")
        ->type_name("WORK");
    verb.add_option("--time-limit", options.time_limit,
                    "stop after so many seconds; what is not settled by then is visible")
        ->check(Validator{[](const std::string& text) -> std::string {
                              double seconds = 0;
                              const bool good = readNumber(text, seconds) && seconds > 0;
                              return good ? "" : text + " is no number of seconds above 0";
                          },
                          "seconds"})
        ->type_name("S");
    verb.add_option("--state", options.state,
                    "where a long bake writes down how far it is, to go on after its end (default: the output's name "
                    "and .state)")
        ->type_name("FILE");
    verb.add_flag("--in-place", options.in_place,
                  "of a visibility file the larger form, which answers without being unpacked");
    verb.add_option("--json", options.json, "write the figures as JSON (-: standard output)")->type_name("FILE");
    verb.add_option("--report", options.report, "write pictures and a page")->type_name("DIR");
}

Status finishBakeOptions(BakeOptions& options, ApartFiles& files) {
    if (options.in_place && options.output.empty())
        return Error{Error::Kind::kUsage, "--in-place goes with -o: it says how that is written"};
    if (options.state.empty() && !options.output.empty()) options.state = options.output + ".state";
    files.write("-o", options.output);
    files.write("--json", options.json);
    files.write("--state", options.state);
    if (!options.report.empty()) files.write("--report", std::filesystem::path(options.report) / "index.html");
    if (!files.status()) return files.status();
    if (Status writable = canWriteFiles({options.output, options.state, options.json}); !writable) return writable;
    return options.report.empty() ? success() : makeDirectory(options.report);
}

BakeRun::BakeRun(const BakeOptions& options)
    : options_(options),
      threads_(options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency())),
      pool_(threads_) {}

Result<RowJournal*> BakeRun::beginViewCells() {
    Result<Left> left = readLeft(options_.state);
    if (!left) return left.error();
    if (left->journal.size() > 0) note("goes on from " + options_.state);
    journal_ = std::move(left->journal);
    if (!options_.state.empty())
        journal_->writeTo([this](const std::string& bytes) { return writeFileAside(options_.state, bytes); });
    stopGently();
    return &*journal_;
}

Result<BakeSettings> BakeRun::begin(const CellGraph& rows) {
    stopGently();
    BakeSettings settings;
    settings.budget = options_.budget.value_or(0);
    settings.work = options_.budget ? 0 : kUsualWork;
    const Result<Left> left = readLeft(options_.state);
    if (!left) return left.error();
    if (!left->rows.empty()) {
        Result<CellVisibilityState> state =
            readBakeState(left->rows, options_.state, rows, settings.budget, options_.farthest, settings.work);
        if (state) left_ = std::move(*state);
        note(state ? "goes on from " + options_.state : state.error().message + ": the bake begins anew");
    }
    settings.jobs = &pool_;
    settings.time_limit = options_.time_limit;
    settings.farthest = options_.farthest;
    settings.object_rows = options_.objects;
    settings.form = options_.in_place ? VisibilityForm::kInPlace : VisibilityForm::kPacked;
    settings.stop = [] { return interrupted(); };
    settings.progress = [this](const BakeProgress& now) { show(now); };
    settings.resume = left_ ? &*left_ : nullptr;
    settings.journal = journal_ ? &*journal_ : nullptr;
    if (!options_.state.empty())
        settings.checkpoint = [this](const std::string& bytes) { return writeFileAside(options_.state, bytes); };
    return settings;
}

void BakeRun::show(const BakeProgress& now) {
    if (!progress_ || step_ != now.step) {
        step_ = now.step;
        progress_.reset();
        progress_ = std::make_unique<Progress>("visibility, " + step_, "percent", kProgressParts);
    }
    progress_->set(static_cast<size_t>(now.done * static_cast<double>(kProgressParts)), kProgressParts);
    if (now.done >= 1) progress_.reset();
}

int BakeRun::reportInterrupted() {
    progress_.reset();
    return reportInterruption(
        options_.state.empty() ? "a part of the bake" : "a part of the bake, which goes on from " + options_.state,
        false);
}

void BakeRun::end() {
    progress_.reset();
    std::error_code ignored;
    if (!options_.state.empty()) std::filesystem::remove(options_.state, ignored);
}

Status checkSize(const CellGraph& rows, const std::string& title, bool of_bsp) {
    Status fits = checkBakeSize(rows, title);
    if (fits || !of_bsp) return fits;
    return Error{fits.error().kind, fits.error().message + ": --cells groups makes fewer"};
}

}  // namespace sightline::cli
