// The visibility file that a run asks for: opened, held to its scene, and attached to the world.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/verbs/run_options.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/visfile/visibility_file.h"
#include "sightline/world/world.h"

namespace sightline::cli {
using namespace tools;

/// A file and what it says; worlds and their snapshots look into it.
struct OpenedVisibility {
    OpenedVisibility(std::unique_ptr<std::string> from, VisibilityFile opened)
        : bytes(std::move(from)), file(std::move(opened)) {}

    std::unique_ptr<const std::string> bytes;
    VisibilityFile file;
    PreparedMeshes prepared;                   ///< what the file holds of the scene's meshes
    std::vector<const PreparedMesh*> of_mesh;  ///< per mesh of the scene; null: nothing; empty: it holds none of any
};

/// Opens RunOptions::visibility, if there is one, into RunOptions::opened. Errors: the file cannot be read or is none,
/// holds no cells, or was baked of another scene; a door is not in it (kUsage).
Status openVisibility(const Scene& scene, RunOptions& options);

/// loadSettings() of the query, with what was opened of prepared meshes, as far as the file has what is asked for.
LoadSettings loadSettingsOf(const RunOptions& options);

/// Attaches what was opened, if anything was, and sets the doors. The next commit has it.
/// @param world  of the scene that it was opened for
void attachVisibility(const RunOptions& options, World& world);

}  // namespace sightline::cli
