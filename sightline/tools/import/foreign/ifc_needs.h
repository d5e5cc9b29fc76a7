// What IFC is read with: Node.js, and web-ifc beside sightline-import.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sightline::tools {

struct IfcNeeds {
    std::string node;    ///< the program Node.js
    std::string script;  ///< what it runs
    std::string lacks;   ///< empty, or one line: what is not there, and how it is got
};

/// Looks for them.
/// @param worker  the program sightline-import
IfcNeeds findIfcNeeds(const std::string& worker);

}  // namespace sightline::tools
