// The benchmark cases by name: the tool's verb `bench` and the benchmark binary call the same ones.
// SPDX-License-Identifier: MIT
#include "bench/bench.h"

#include <cstdio>

#include "bench/cases.h"
#include "bench/occlusion_scenes.h"
#include "sightline/tools/report/output_file.h"

namespace sightline::bench {
using namespace tools;
namespace {

struct Case {
    const char* name;
    Table (*measure)(const Options&);
};

constexpr Case kCases[] = {
    {"backface", benchBackface},
    {"bottleneck", benchBottleneck},
    {"bsp", benchBsp},
    {"c", benchC},
    {"clipping", benchClipping},
    {"depth", benchDepth},
    {"eye", benchEye},
    {"frustum", benchFrustum},
#ifdef SIGHTLINE_GL
    {"gl", benchGl},
#endif
    {"hidden", benchHidden},
    {"hierarchy", benchHierarchy},
    {"images", benchImages},
    {"indoor", benchIndoor},
    {"inner", benchInner},
    {"lod", benchLod},
    {"occlusion", benchOcclusion},
    {"order", benchOrder},
    {"peers", benchPeers},
    {"portals", benchPortals},
    {"queries", benchQueries},
    {"rows", benchRows},
    {"shadow", benchShadow},
    {"view-cells", benchViewCells},
#ifdef SIGHTLINE_VIEWER
    {"viewer", benchViewer},
#endif
    {"vis", benchVis},
    {"volumes", benchVolumes},
    {"walks", benchWalks},
    {"ways", benchWays},
};

}  // namespace

std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const Case& c : kCases) names.push_back(c.name);
    return names;
}

std::vector<std::string> sceneNames() { return occlusionSceneNames(); }

Result<bool> run(const Options& options) {
    for (const Case& c : kCases) {
        if (options.name != c.name) continue;
        const Table table = c.measure(options);
        const bool json_to_output = options.json == "-";
        std::fputs(toText(table).c_str(), json_to_output ? stderr : stdout);
        if (json_to_output) std::fputs(toJson(table).c_str(), stdout);
        else if (!options.json.empty())
            if (Status written = writeFileAside(options.json, toJson(table)); !written) return written.error();
        for (const std::string& fault : table.faults) std::fputs((fault + "\n").c_str(), stderr);
        return table.faults.empty();
    }
    return Error{Error::Kind::kUsage, "bench: there is no case \"" + options.name + "\""};
}

}  // namespace sightline::bench
