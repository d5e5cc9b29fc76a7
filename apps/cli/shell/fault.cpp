// How the tool says that something is wrong: one line, and its exit code.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/fault.h"

#include <cstdio>
#include <string>
#include <utility>

#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;

int report(const Error& error) {
    const std::string line = "sightline: " + oneLine(error.message) + "\n";
    (void)std::fwrite(line.data(), 1, line.size(), stderr);
    switch (error.kind) {
        case Error::Kind::kUsage:
            return kWrongArguments;
        case Error::Kind::kOutput:
            return kOutputUnwritable;
        case Error::Kind::kInput:
            break;
    }
    return kInputUnreadable;
}

Error usageError(std::string message) { return {Error::Kind::kUsage, std::move(message)}; }

}  // namespace sightline::cli
