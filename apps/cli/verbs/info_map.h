// What `info` tells of maps: a compiled map beside its scene, and files of portals, which are no scenes.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "sightline/base/result.h"

namespace sightline::cli {

/// Rows of two columns, as printed and as JSON.
struct MapReport {
    nlohmann::ordered_json json;
    std::string text;
};

/// What a compiled map holds that a scene does not: leaves, clusters, how much is visible. None if the file is none, or
/// spoiled: loading it as a scene tells why.
std::optional<MapReport> reportMap(const std::string& name);

/// Whether a file's first letters are those of a `.prt`.
bool isPortalFile(const std::string& name);
/// What a `.prt` holds. Errors as readPrt's.
Result<MapReport> reportPortals(const std::string& name);

}  // namespace sightline::cli
