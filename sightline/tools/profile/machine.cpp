// What machine this is, as figures name it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/machine.h"

#include <cstdint>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <hwy/targets.h>

namespace sightline::tools {

std::string machineName() {
    std::string model = "unknown processor";
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
            model = line.substr(line.find(": ") + 2);
            break;
        }
    const int64_t targets = hwy::SupportedTargets();
    return fmt::format("{}, {}, {} cores", model, hwy::TargetName(targets & -targets),
                       std::thread::hardware_concurrency());
}

}  // namespace sightline::tools
