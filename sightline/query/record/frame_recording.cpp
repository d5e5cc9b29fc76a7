// Writes the recording of a frame as bytes.
// SPDX-License-Identifier: MIT
#include <string_view>

#include "sightline/base/bytes.h"
#include "sightline/geom/occluder_bytes.h"
#include "sightline/geom/setting_rows.h"
#include "sightline/query/record/frame_recording.h"

namespace sightline {

using namespace recording_file;

namespace {

void putMatrix(ByteWriter& out, const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) out.put(matrix[column][row]);
}

/// The sections of a file while they are filled.
class RecordingWriter {
public:
    explicit RecordingWriter(Memory* memory) : memory_(memory), sections_(memory) { sections_.resize(kSectionCount); }

    void put(const FrameRecording& recording) {
        putView(recording.view, recording.volumes);
        putSettings(recording.settings);
        for (const FrameRecording::Form& form : recording.forms) {
            to(kForms).put(static_cast<uint32_t>(form.inner.size()));
            putOccluder(form.occluder, occluders());
            for (const InnerOccluder& inner : form.inner) {
                ByteWriter out = to(kInner);
                putBox(out, inner.outside);
                out.put(inner.error);
                putOccluder(inner.occluder, occluders());
            }
        }
        for (const Array<LodLevel>& chain : recording.chains) {
            to(kChains).put(static_cast<uint32_t>(chain.size()));
            for (const LodLevel& level : chain) {
                ByteWriter out = to(kLevels);
                out.put(level.error);
                out.put(level.triangles);
                out.put(level.vertices);
            }
        }
        for (const ObjectDef& object : recording.objects) putObject(object);
        for (const uint8_t reason : recording.reasons) to(kReasons).put(reason);
        for (const uint8_t reason : recording.again) to(kAgain).put(reason);
        for (const FrameRecording::Certificate& certificate : recording.certificates) {
            to(kCertificates).put(certificate.hidden);
            to(kCertificates).put(certificate.count);
            for (const uint32_t named : recording.namedBy(certificate)) to(kNamed).put(named);
        }
    }

    Array<char> file() const {
        Array<char> hashed(memory_), file(memory_);
        ByteWriter sizes(hashed), head(file);
        for (const Array<char>& section : sections_) sizes.put(uint64_t{section.size()});
        for (const Array<char>& section : sections_) hashed.insert(hashed.end(), section.begin(), section.end());
        for (const char letter : kMagic) head.put(letter);
        head.put(kVersion);
        head.put(uint32_t{kSectionCount});
        head.put(contentHash(hashed));
        file.insert(file.end(), hashed.begin(), hashed.end());
        return file;
    }

private:
    ByteWriter to(Section section) { return ByteWriter(sections_[section]); }
    std::span<Array<char>, occluder_bytes::kRuns> occluders() {
        return std::span<Array<char>, occluder_bytes::kRuns>(sections_.data() + kOccluders, occluder_bytes::kRuns);
    }

    void putView(const View& view, bool volumes) {
        ByteWriter out = to(kView);
        putMatrix(out, view.view);
        putMatrix(out, view.projection);
        out.put(view.width);
        out.put(view.height);
        out.put(view.jitter);
        out.put(view.layers);
        out.put(view.eye_radius);
        for (const ViewPlanes* planes : {&view.sections, &view.window}) {
            out.put(planes->count);
            for (const glm::dvec4& plane : planes->planes)
                for (int k = 0; k < 4; ++k) out.put(plane[k]);
        }
        out.put(view.through.count);
        for (const glm::dvec3& point : view.through.points)
            for (int axis = 0; axis < 3; ++axis) out.put(point[axis]);
        out.put(uint32_t{volumes});
    }

    void putSettings(const QuerySettings& settings) {
        forEachSetting([&](const auto& row) {
            ByteWriter out = to(kSettings);
            const std::string_view name = row.name;
            for (size_t i = 0; i < kNameBytes; ++i) out.put(i < name.size() ? name[i] : '\0');
            out.put(static_cast<double>(settings.*row.member));
        });
    }

    void putObject(const ObjectDef& object) {
        ByteWriter out = to(kObjects);
        putBox(out, object.bounds);
        putMatrix(out, object.transform);
        out.put(object.key);
        for (const uint32_t value : {object.layers, object.occluder.index, object.shape.index, object.lods.index})
            out.put(value);
        out.put(object.limits.max_distance);
        out.put(object.limits.factor);
        out.put(uint32_t{object.limits.always} | uint32_t{object.hides_in_lods} << 1);
    }

    Memory* const memory_;
    Array<Array<char>> sections_;
};

}  // namespace

Array<char> recordingBytes(const FrameRecording& recording, Memory* memory) {
    RecordingWriter writer(memory);
    writer.put(recording);
    return writer.file();
}

}  // namespace sightline
