// Writes the seeds of the stream's fuzzer: sightline_stream_corpus DIRECTORY.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "scene_stream_samples.h"

int main(int count, char** words) {
    using namespace sightline;
    using namespace sightline::tools;
    if (count != 2) {
        std::fputs("usage: sightline_stream_corpus DIRECTORY\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = words[1];
    std::filesystem::create_directories(folder);
    const auto write = [&](const char* name, const std::string& bytes) {
        std::ofstream(folder / name, std::ios::binary) << bytes;
    };
    const Scene whole = test::sampleScene();
    write("whole", test::streamOf(whole));
    write("cut", test::streamOf(whole).substr(0, 700));
    Scene still = whole;
    still.meshes.resize(1);
    still.objects = {whole.objects[0]};
    still.cameras.clear();
    write("still", test::streamOf(still));
    Scene moving = still;
    moving.meshes[0] = whole.meshes[1];
    write("moving", test::streamOf(moving));
    Scene empty = whole;
    empty.objects.clear();
    write("empty", test::streamOf(empty));
    std::string fault;
    SceneStreamWriter writer(
        [&](const void* bytes, size_t size) { fault.append(static_cast<const char*>(bytes), size); });
    writer.node({"House", SceneNode::kNone});
    writer.fault("line 7: no such thing");
    write("fault", fault);
    return 0;
}
