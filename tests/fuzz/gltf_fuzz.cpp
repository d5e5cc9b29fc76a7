// Whatever the bytes are, the glTF reader answers with a sound scene or with one line.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "tests/tools/import/gltf_check.h"
#include "sightline/tools/import/gltf/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    using namespace sightline::tools;
    const Result<Scene> scene = parseGltf(std::span(data, size), "fuzz.glb");
    const std::string fault = scene.ok() ? test::sceneFault(*scene) : test::messageFault(scene.error(), "fuzz.glb");
    if (fault.empty()) return 0;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
}
