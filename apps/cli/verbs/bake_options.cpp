// The options that `bake` and `vis` share: declared once, checked once.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/bake_options.h"

#include <filesystem>

#include <CLI/CLI.hpp>

#include "sightline/tools/report/output_file.h"

namespace sightline::cli {
using namespace tools;

VisCells BakeOptions::visCells() const {
    if (cells == "leaves") return VisCells::kLeaves;
    return cells == "groups" ? VisCells::kGroups : VisCells::kClusters;
}

void addBakeOptions(CLI::App& verb, BakeOptions& options, const std::string& output) {
    verb.add_option("-o,--output", options.output, output)->type_name("FILE");
    verb.add_option("--cells", options.cells,
                    "what of a .bsp has a row: clusters, as the map's compiler made them; leaves, each its own, which "
                    "is tighter and takes far longer; groups, of leaves that are open to one another (default: "
                    "clusters)")
        ->check(CLI::IsMember({"clusters", "leaves", "groups"}));
    verb.add_flag("--objects", options.objects,
                  "tell also which objects each cell sees, of a .bsp its faces: takes longer than the cells do");
    verb.add_option("--threads", options.threads, "share the portals among so many threads (default: one a core)")
        ->check(CLI::Range(1u, 1024u));
    verb.add_option("--budget", options.budget,
                    "portals that may be clipped for each portal and direction; what is not settled by then is "
                    "visible, and counted (default: no limit)")
        ->type_name("WORK");
    verb.add_option("--time-limit", options.time_limit,
                    "stop after so many seconds; what is not settled by then is visible")
        ->check(CLI::PositiveNumber)
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
    for (const std::string& name : {options.output, options.state, options.json == "-" ? "" : options.json})
        if (!name.empty())
            if (Status writable = canWriteFile(name); !writable) return writable;
    return options.report.empty() ? success() : makeDirectory(options.report);
}

}  // namespace sightline::cli
