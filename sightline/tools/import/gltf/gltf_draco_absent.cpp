// Stands where Draco's library was not found when this was built.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_draco.h"

namespace sightline::tools::gltf {

bool dracoSupported() { return false; }

DracoMesh decodeDraco(Bytes, const std::vector<DracoAttribute>&, const DracoCounts&, Budget&,
                      const std::string& place) {
    fail(place, "is compressed with Draco, which takes a build of Sightline with libdraco-dev installed");
}

}  // namespace sightline::tools::gltf
