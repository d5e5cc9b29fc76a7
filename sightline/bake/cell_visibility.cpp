// SPDX-License-Identifier: MIT
#include "sightline/bake/cell_visibility.h"

namespace sightline {

}  // namespace sightline
