// --watch: runs a verb again whenever a file changes that it reads.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sightline::cli {

struct SessionOptions;

void addWatchOption(CLI::App& verb, SessionOptions& options);

/// Forks a process for each run of the verb that was parsed, and waits for changes between them. A run that fails has
/// printed its line; a run that is ended by a signal is told of; both leave the watch as it is. Changes while a run
/// goes on begin another when it is over. Ctrl-C between runs ends the watch with exit code 0; within one it
/// interrupts that run, and its exit code is the watch's.
///
/// Watched are the files that SCENE names, those they lead to (filesOfScene), the camera path, and the configuration,
/// whether it is there yet or not. Directories are watched, as programs replace files by renaming; what counts is
/// whether a file's size, time or identity differs, once it has been still for a moment. A change of a file that
/// tells nobody, as on some network drives, is found within two seconds.
/// @return nothing in a run's process, which is to do its work; in the first one, the exit code at the end of the watch.
///         It is that of a usage error if there is no file to be watched.
std::optional<int> watchRuns(CLI::App& verb, const SessionOptions& options);

/// What tells one state of some files from another: their size, time and identity, or that they are not there.
std::vector<uint64_t> stateOf(const std::vector<std::string>& files);

}  // namespace sightline::cli
