// What was measured of a machine, as a file: the schema `sightline.calibration/1`.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/geom/lod.h"
#include "sightline/tools/profile/facing_costs.h"

namespace sightline::tools {

/// @param machine  in words
std::string calibrationJson(const FacingCosts& costs, const std::string& machine);

/// A calibration, or the costs of a profile. Fields that are not known are passed over. Errors (kInput) name the file and
/// the field: costs must be numbers above 0.
Result<FacingCosts> parseCalibration(std::string_view text, const std::string& file);

/// What drawing costs, for budgets: of a profile alone; a calibration does not say. Errors (kInput) name the file and the
/// field: costs must be numbers that are not negative.
Result<std::optional<DrawCost>> parseDrawCost(std::string_view text, const std::string& file);

}  // namespace sightline::tools
