// The style and the script of the report page.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline {

extern const char* const kPageStyle;
extern const char* const kPageScript;

}  // namespace sightline
