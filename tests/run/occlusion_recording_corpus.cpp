// Writes seeds for the fuzzer of recordings: sightline_recording_corpus tests/fuzz/corpus/occlusion_recording
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/run/made_recording.h"

namespace sightline::test {
namespace {

Array<char> bytesOf(uint64_t seed, int boxes, int sheets, uint32_t side) {
    MadeWorld made = someWorld(seed, boxes, sheets, side);
    View view = someView(seed);
    view.occlusion_size = 64;
    return recordingBytes(withTiles(std::move(*recordOcclusion(made.world.commit(), view))));
}

bool write(const std::filesystem::path& file, const Array<char>& bytes) {
    std::ofstream out(file, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    if (!out) std::fprintf(stderr, "%s: cannot be written\n", file.c_str());
    return bool(out);
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
    return write(folder / "boxes.rec", boxes) && write(folder / "parallel.rec", parallel) &&
           write(folder / "sheet.rec", sheet) && write(folder / "cut.rec", cut) &&
           write(folder / "damaged.rec", damaged) && write(folder / "long_section.rec", long_section) &&
           write(folder / "all_ones.rec", no_vertex);
}

}  // namespace
}  // namespace sightline::test

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: sightline_recording_corpus FOLDER\n");
        return 2;
    }
    return sightline::test::writeAll(argv[1]) ? 0 : 4;
}
