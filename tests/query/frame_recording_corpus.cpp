// Writes seeds for the fuzzer of recordings.
// SPDX-License-Identifier: MIT
#include "tests/query/made_recording.h"
#include "tests/support/files.h"

namespace sightline::test {
namespace {

Array<char> bytesOf(uint64_t seed, int boxes, int sheets, uint32_t side) {
    MadeWorld made = someWorld(seed, boxes, sheets, side);
    FrameRecording recording = std::move(*recordFrame(made.world.commit(), someView(seed), {.occlusion_size = 64}));
    // Few frames of so little have a certificate.
    for (uint32_t i = 1; i < recording.objects.size() && recording.certificates.empty(); ++i) {
        if (recording.reasons[i] == 0) continue;
        recording.certificates.push_back({i, 0, 2});
        recording.named = {0, i};
    }
    return recordingBytes(recording);
}

template <class Seed>
void makeAll(Seed seed) {
    const Array<char> boxes = bytesOf(2, 8, 0, 1), parallel = bytesOf(1, 1, 1, 1), sheet = bytesOf(3, 1, 1, 2);
    Array<char> cut = boxes, damaged = boxes, long_section = sheet, all_ones = parallel;
    cut.resize(cut.size() / 2);
    damaged[damaged.size() / 2] ^= 1;
    long_section[recording_file::kHashedAt + 8 * recording_file::kPolygons + 6] = 1;
    sealRecording(long_section);
    for (char& byte : all_ones)
        if (&byte >= all_ones.data() + all_ones.size() / 2) byte = '\xff';
    sealRecording(all_ones);
    seed("boxes.rec", boxes);
    seed("parallel.rec", parallel);
    seed("sheet.rec", sheet);
    seed("cut.rec", cut);
    seed("damaged.rec", damaged);
    seed("long_section.rec", long_section);
    seed("all_ones.rec", all_ones);
}

}  // namespace
}  // namespace sightline::test

int main(int argc, char** argv) {
    return sightline::test::writeSeeds(argc, argv, [](auto seed) { sightline::test::makeAll(seed); });
}
