// How the tool says that something is wrong: one line, and its exit code.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"

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

}  // namespace sightline::cli
