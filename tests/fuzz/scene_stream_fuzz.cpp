// Whatever the bytes are, the reader of streams answers with a sound scene or with none.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "tests/tools/import/gltf_check.h"
#include "sightline/tools/import/foreign/scene_stream.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    using namespace sightline::tools;
    const SceneStream read = parseSceneStream(std::span(data, size));
    const bool whole = read.end == SceneStream::End::kWhole;
    const std::string fault = whole                        ? test::sceneFault(read.scene)
                              : read.scene.objects.empty() ? ""
                                                           : "a scene is left";
    if (fault.empty()) return 0;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
}
