// What was measured of a machine, as a file: the schema `sightline.calibration/1`.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/tools/profile/facing_costs.h"

namespace sightline::tools {

/// @param machine  in words
std::string calibrationJson(const FacingCosts& costs, const std::string& machine);

/// Fields that are not known are passed over. Errors (kInput) name the file and the field: costs must be numbers above 0.
Result<FacingCosts> parseCalibration(std::string_view text, const std::string& file);

}  // namespace sightline::tools
