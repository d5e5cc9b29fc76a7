// The options of the verb `render`, and the settings that they stand for.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/cli/shell/options.h"
#include "apps/cli/verbs/common.h"
#include "sightline/tools/report/run/render_run.h"

namespace sightline::cli {
using namespace studies;
using namespace tools;

/// Words are those that OneOf has let through.
struct RenderOptions : RunOptions {
    uint32_t frame = 0;
    std::string method = "zbuffer", image, ids, heat_map;
    std::string heat = "generated", shading = "flat", shadows = "on";
    std::string painter_key = "farthest", free_samples = "bits", ray_tracer = "bvh";
    std::string clipping = "guard-band", front = "ccw", back_faces = "drop";
    std::string depth_format = "reversed-float", depth_comparison = "nearer", depth_write = "on";
    std::vector<double> polygon_offset = {0, 0};  ///< factor and units
    std::string early_z = "on", hierarchical_z = "on", fast_clear = "on", depth_compression = "off";

    bool all() const { return method == "all"; }
};

/// True if the z-buffer is among the methods asked for.
bool drawsZBuffer(const RenderOptions& options);

void addRenderOptions(Command& verb, RenderOptions& options);

/// Checks what single options cannot, and that all outputs have names. Errors are kUsage.
Status finishRender(const Command& verb, RenderOptions& options);

/// Whether all outputs are likely to be written; makes the report's directory. Errors are kOutput.
Status checkOutputs(const RenderOptions& options);

/// Fills what the options say of a run.
void applyOptions(const RenderOptions& options, RenderRun& run);

/// The method asked for; nothing of `all`.
HiddenMethod methodOf(const RenderOptions& options);

/// The command that repeats a run, without its outputs.
std::string commandOf(const Command& verb, const RenderOptions& options);

}  // namespace sightline::cli
