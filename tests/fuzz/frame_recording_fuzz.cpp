// Whatever the bytes are, the reader of recordings answers with one that can be asked and written again, or with a line.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "sightline/base/bytes.h"
#include "sightline/query/record/frame_replay.h"

namespace {

void look(const sightline::Array<char>& bytes) {
    using namespace sightline;
    Result<FrameRecording> read = parseRecording(bytes, "frame.rec");
    if (!read.ok()) {
        const std::string& line = read.error().message;
        if (line.rfind("frame.rec: ", 0) == 0 && line.find('\n') == std::string::npos) return;
        std::fprintf(stderr, "not one line that begins with the file: %s\n", line.c_str());
        std::abort();
    }
    const Array<char> again = recordingBytes(*read);
    const Result<FrameRecording> second = parseRecording(again, "frame.rec");
    if (!second.ok() || recordingBytes(*second) != again) std::abort();
    if (read->settings.occlusion_size > 512) read->settings.occlusion_size = 512;  // sound, and slow
    FrameReplay replay(*read);
    const FrameReplay::Answer answer = replay.run();
    if (answer.differences > read->objects.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sightline;
    Array<char> bytes(data, data + size);
    look(bytes);
    if (size < recording_file::kHashedAt) return 0;
    const uint64_t hash = contentHash(std::span<const char>(bytes).subspan(recording_file::kHashedAt));
    for (size_t i = 0; i < 8; ++i) bytes[recording_file::kHashAt + i] = static_cast<char>(hash >> 8 * i);
    look(bytes);
    return 0;
}
