// A film as its page reads it: the pictures lie in the JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sightline/tools/report/pictures/film.h"

namespace sightline::tools {

nlohmann::ordered_json filmJson(const Film& film);

}  // namespace sightline::tools
