// What holds for a whole run of the tool: how much it says, in which colours, how it fails, and whether it is to stop.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "sightline/base/result.h"

namespace CLI {
class App;
}

namespace sightline::cli {

/// Exit codes; others rely on them.
enum ExitCode : int {
    kDone = 0,
    kAnswerIsNo = 1,  ///< verification failed
    kWrongArguments = 2,
    kInputUnreadable = 3,
    kOutputUnwritable = 4,
    kInterrupted = 130,  ///< by Ctrl-C, or by a request to end; as a shell reports it
};

/// Prints one line on standard error.
/// @return the exit code of the error's kind
int report(const Error& error);

/// What is wrong with the arguments.
Error usageError(std::string message);

/// What every verb takes, and the tool itself before the verb.
struct SessionOptions {
    bool quiet = false;
    std::string config;  ///< file, or empty
    bool no_config = false;
};

/// Adds them to the tool or to a verb: they may stand before the verb or after it.
void addSessionOptions(CLI::App& app, SessionOptions& options);

/// Makes sure that standard input, output and error are open, that a reader who has left, or a file that may not
/// grow, is an error and not the end, and that Ctrl-C and a request to end are heard. Before anything else, once.
void openSession();
/// What standard output did not take makes an error of what would have been well.
/// @return the exit code of the process
int endSession(int exit_code);

/// From here on Ctrl-C, or a request to end, makes interrupted() true. If nobody asks within a second, the process ends and
/// names the step that was at work. Before stopGently() it ends at once, and a second signal ends it at once in any
/// case, each with exit code 130.
void stopGently();
/// True once Ctrl-C was pressed, or the process was asked to end. A caller that gets true stops its loop and keeps what
/// is finished.
bool interrupted();
/// Names the step at work, for the line that the process writes if it is ended during it. Empty: no step.
void nameStep(std::string_view what);
/// Says on standard error how far it came.
/// @param done  "3 of 16 frames"
/// @return the exit code for it, kInterrupted
int reportInterruption(const std::string& done, bool written);

/// With --quiet there is no progress and there are no summaries; errors, and what was asked for on standard output,
/// remain.
void setQuiet(bool quiet);
bool quiet();

/// Gives a summary to a reader, unless quiet. Whether it could be written is endSession()'s concern.
void tell(std::FILE* out, std::string_view text);
/// "note: ..." on standard error, unless quiet: something that is no error but of use to know.
void note(const std::string& text);

enum class Tone : uint8_t { kGood, kBad };
/// The text, green or red on a terminal, unless NO_COLOR is set or the terminal is dumb.
std::string paint(std::FILE* out, Tone tone, std::string_view text);

}  // namespace sightline::cli
