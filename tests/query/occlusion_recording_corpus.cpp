// Writes seeds for the fuzzer of recordings.
// SPDX-License-Identifier: MIT
#include "tests/query/made_recording.h"
#include "tests/support/files.h"

namespace sightline::test {
namespace {

Array<char> bytesOf(uint64_t seed, int boxes, int sheets, uint32_t side) {
    MadeWorld made = someWorld(seed, boxes, sheets, side);
    QuerySettings settings;
    settings.occlusion_size = 64;
    return recordingBytes(withTiles(std::move(*recordOcclusion(made.world.commit(), someView(seed), settings))));
}

bool writeAll(const std::filesystem::path& folder) {
    const Array<char> boxes = bytesOf(2, 8, 0, 1), parallel = bytesOf(1, 8, 1, 2), sheet = bytesOf(3, 2, 2, 4);
    Array<char> cut = boxes, damaged = boxes, long_section = sheet, no_vertex = parallel;
    cut.resize(cut.size() / 2);
    damaged[damaged.size() / 2] ^= 1;
    long_section[recording_file::kHashedAt + 8 * recording_file::kPolygons + 6] = 1;
    seal(long_section);
    for (char& byte : no_vertex)
        if (&byte >= no_vertex.data() + no_vertex.size() / 2) byte = '\xff';
    seal(no_vertex);
    const auto write = [&](const char* name, const Array<char>& bytes) {
        return writeBytes(folder / name, {bytes.data(), bytes.size()});
    };
    return write("boxes.rec", boxes) && write("parallel.rec", parallel) && write("sheet.rec", sheet) &&
           write("cut.rec", cut) && write("damaged.rec", damaged) && write("long_section.rec", long_section) &&
           write("all_ones.rec", no_vertex);
}

}  // namespace
}  // namespace sightline::test

int main(int argc, char** argv) { return sightline::test::writeInto(argc, argv, sightline::test::writeAll); }
