// What several verbs share: the common options, scenes by name, camera paths, errors.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <string>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/quoted.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/run_options.h"
#include "sightline/base/result.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::cli {
using namespace tools;

constexpr uint32_t kMostThreads = 1024;

/// The scene, its cameras, the size, threads and JSON: what every verb has that looks at a scene.
/// @param shared  what the threads share: "the frames"
void addCameraOptions(Command& verb, RunOptions& options, const std::string& shared);
/// These, and what culling needs.
void addSceneOptions(Command& verb, RunOptions& options);
/// What an answer must hold for, and who judges it: --jitter, --rays and --no-proofs.
void addWitnessOptions(Command& verb, RunOptions& options);
/// --stereo.
void addStereoOption(Command& verb, RunOptions& options);
void addRememberOption(Command& verb, RunOptions& options);
/// And what cull and verify may ask a query for besides: two eyes, strips of the image, a memory.
void addQueryOptions(Command& verb, RunOptions& options);
/// Checks what single options cannot: sizes, stage names. Errors are kUsage.
Status finish(const Command& verb, RunOptions& options);

/// Reads "1920x1080".  [1 to 16384]
/// @param option  what an error, kUsage, calls it
Status readSize(const std::string& option, const std::string& text, uint32_t& width, uint32_t& height);

/// "1.5,0,-2". Error (kUsage): it is no point.
Result<glm::dvec3> readPoint(const char* option, const std::string& text);

/// Which path: --cameras; --eye and --look; --path, --frames and --seed; a city's streets for --frames alone; the scene's own; 16 seeded.
Result<CameraPath> loadPath(const Scene& scene, const RunOptions& options);

/// "frame 3 (0 to 15)", or "the only frame".
std::string frameOf(size_t frame, size_t frames);
/// Error (kUsage): a --frame that the path has not.
Status checkFrame(size_t frame, size_t frames);

/// Whose cameras a path has: "a tour", "the scene's own cameras".
std::string ownerOfPath(const Scene& scene, const RunOptions& options);

/// Writes text to a file aside and renames it, or to standard output for `-`.
Status writeText(const std::string& file, const std::string& text);

/// The files that a verb reads; what it writes is named after them.
ApartFiles filesRead(const RunOptions& options);

/// Finds out before long work whether files can be written, by canWriteFile(). An empty name and `-` are none.
Status canWriteFiles(std::initializer_list<std::string> files);

/// Says where a page was written.
void tellPage(std::FILE* out, const std::string& directory);

/// With small letters for capitals.
std::string lower(std::string text);

/// 1234567 as "1,234,567".
std::string grouped(uint64_t number);

}  // namespace sightline::cli
