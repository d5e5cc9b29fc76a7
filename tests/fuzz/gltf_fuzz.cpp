// Whatever the bytes are, the glTF reader answers with a sound scene or with one line; what it takes, the writer cuts.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "tests/tools/import/gltf_check.h"
#include "sightline/tools/export/gltf_cut.h"
#include "sightline/tools/import/gltf/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    using namespace sightline::tools;
    const Result<Scene> scene = parseGltf(std::span(data, size), "fuzz.glb");
    std::string fault = scene.ok() ? test::sceneFault(*scene) : test::messageFault(scene.error(), "fuzz.glb");
    if (fault.empty() && scene.ok()) {
        const CutScene cut = cutScene(*scene, {Split::Along::kGrid, 2});
        const Result<WrittenGltf> written = cutGltf(std::span(data, size), "fuzz.glb", cut);
        if (!written) fault = test::messageFault(written.error(), "fuzz.glb");
        else if (const Result<Scene> again = parseGltf(
                     std::span(reinterpret_cast<const uint8_t*>(written->bytes.data()), written->bytes.size()),
                     "cut.glb");
                 !again)
            fault = again.error().message;
        else if (drawnTriangles(*again) != drawnTriangles(*scene)) fault = "the cut file draws other triangles";
    }
    if (fault.empty()) return 0;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
}
