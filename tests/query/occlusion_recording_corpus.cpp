// Writes seeds for the fuzzer of recordings.
// SPDX-License-Identifier: MIT
#include "tests/query/made_recording.h"
#include "tests/support/files.h"

namespace sightline::test {
namespace {

Array<char> bytesOf(uint64_t seed, int boxes, int sheets, uint32_t side) {
    MadeWorld made = someWorld(seed, boxes, sheets, side);
    return recordingBytes(
        withTiles(std::move(*recordOcclusion(made.world.commit(), someView(seed), {.occlusion_size = 64}))));
}

template <class Seed>
void makeAll(Seed seed) {
    const Array<char> boxes = bytesOf(2, 8, 0, 1), parallel = bytesOf(1, 6, 1, 2), sheet = bytesOf(3, 2, 2, 4);
    Array<char> cut = boxes, damaged = boxes, long_section = sheet, no_vertex = parallel;
    cut.resize(cut.size() / 2);
    damaged[damaged.size() / 2] ^= 1;
    long_section[recording_file::kHashedAt + 8 * recording_file::kPolygons + 6] = 1;
    seal(long_section);
    for (char& byte : no_vertex)
        if (&byte >= no_vertex.data() + no_vertex.size() / 2) byte = '\xff';
    seal(no_vertex);
    seed("boxes.rec", boxes);
    seed("parallel.rec", parallel);
    seed("sheet.rec", sheet);
    seed("cut.rec", cut);
    seed("damaged.rec", damaged);
    seed("long_section.rec", long_section);
    seed("all_ones.rec", no_vertex);
}

}  // namespace
}  // namespace sightline::test

int main(int argc, char** argv) {
    return sightline::test::writeSeeds(argc, argv, [](auto seed) { sightline::test::makeAll(seed); });
}
