// Links the importer and the witnesses of an installed Sightline.
// SPDX-License-Identifier: MIT
#include <sightline/import/gltf.h>
#include <sightline/truth/verify.h>

int main() {
    const auto scene = sightline::loadGltf("no such file.glb");
    if (scene.ok()) sightline::Witness witness(*scene);
    return scene.ok() ? 1 : 0;
}
