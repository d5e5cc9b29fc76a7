// Regions that a user names: boxes, marked cells and nodes of a scene; and which objects may be seen from any of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/cli/shell/options.h"
#include "apps/cli/verbs/explain_object.h"
#include "sightline/base/result.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::cli {
using namespace tools;

/// --from-box, --from-node and --inset.
struct RegionChoice {
    std::string box, node;  ///< empty: not given
    double inset = 0;       ///< so far from the sides of these boxes eyes stay  [world units]

    bool any() const { return !box.empty() || !node.empty(); }
};
void addRegionOptions(Command& verb, RegionChoice& choice);

struct NamedRegion {
    std::string name;
    Box3d box;
};

/// The regions that are meant: of a name or a pattern with * and ?, in any case of letters, all marked cells whose names it
/// is; if there are none, all nodes whose names or paths it is, each with the box around all that hangs below it.
/// Errors are kUsage: no box; nothing has such a name.
Result<std::vector<NamedRegion>> regionsOf(const Scene& scene, const RegionChoice& choice);

/// Which objects may be seen from somewhere in some region: conservative, as SightQuery::seenFrom().
struct SeenFromRegions {
    std::vector<uint8_t> seen;         ///< per object of the scene
    std::vector<std::string> unknown;  ///< regions from which all may be seen, for nothing is known
};
SeenFromRegions seenFrom(const AskedScene& asked, const std::vector<NamedRegion>& regions);

}  // namespace sightline::cli
