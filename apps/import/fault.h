// How the reader of foreign formats gives up: one line, caught in main.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sightline::import {

struct Fault {
    std::string message;  ///< without the file's name
};

}  // namespace sightline::import
