// Writes the seeds of the stream's fuzzer: sightline_stream_corpus DIRECTORY.
// SPDX-License-Identifier: MIT
#include "scene_stream_samples.h"
#include "tests/support/files.h"

int main(int argc, char** argv) {
    using namespace sightline::test;
    return writeSeeds(argc, argv, [](auto seed) {
        const Scene whole = sampleScene();
        seed("whole", streamOf(whole));
        seed("cut", streamOf(whole).substr(0, 700));
        Scene still = whole;
        still.meshes.resize(1);
        still.objects = {whole.objects[0]};
        still.cameras.clear();
        seed("still", streamOf(still));
        Scene moving = still;
        moving.meshes[0] = whole.meshes[1];
        seed("moving", streamOf(moving));
        Scene empty = whole;
        empty.objects.clear();
        seed("empty", streamOf(empty));
        std::string fault;
        SceneStreamWriter writer(
            [&](const void* bytes, size_t size) { fault.append(static_cast<const char*>(bytes), size); });
        writer.node({"House", SceneNode::kNone});
        writer.fault("line 7: no such thing");
        seed("fault", fault);
    });
}
