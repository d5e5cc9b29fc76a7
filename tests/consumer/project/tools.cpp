// Links the importer and the witnesses of an installed Sightline.
// SPDX-License-Identifier: MIT
#include <sightline/tools/import/scene_file.h>
#include <sightline/tools/truth/verify.h>

int main() {
    const auto scene = sightline::tools::loadSceneFile("no such file.glb");
    if (scene.ok()) sightline::tools::Witness witness(*scene);
    return scene.ok() ? 1 : 0;
}
