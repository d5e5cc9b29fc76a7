// Reads the recording of a frame, and believes nothing of it.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "sightline/base/bytes.h"
#include "sightline/geom/occluder_bytes.h"
#include "sightline/geom/setting_rows.h"
#include "sightline/query/record/frame_recording.h"

namespace sightline {

using namespace recording_file;

namespace {

/// The sections of a file, and the first thing that is wrong with them: after that nothing is taken any more.
class RecordingReader {
public:
    RecordingReader(std::span<const char> bytes, std::string_view file, FrameRecording& out)
        : bytes_(bytes), file_(file), out_(out) {}

    Status read() {
        readHead();
        if (good()) readView();
        if (good()) readSettings();
        if (good()) readForms();
        if (good()) readChains();
        if (good()) readObjects();
        if (good()) readAnswers();
        if (good()) readCertificates();
        if (good()) return success();
        return Error{Error::Kind::kInput,
                     std::string(file_) + ": " + fault_.what + " at byte " + std::to_string(fault_.at)};
    }

private:
    bool good() const { return fault_.none(); }
    bool wrong(std::string what, uint64_t at) { return fault_.wrong(std::move(what), at); }
    uint64_t records(Section section) const { return sections_[section].left() / kRecordBytes[section]; }

    void readHead() {
        ByteCursor head(bytes_);
        if (!isRecording(bytes_)) return (void)wrong("not a recording of a frame", 0);
        for (size_t i = 0; i < sizeof kMagic; ++i) head.take<char>();
        constexpr size_t kSizesEnd = kHashedAt + 8 * kSectionCount;
        if (bytes_.size() < kHashedAt) return (void)wrong("the file ends within its head", bytes_.size());
        if (const uint32_t version = head.take<uint32_t>(); version != kVersion)
            return (void)wrong("a recording of version " + std::to_string(version) + ", where version " +
                                   std::to_string(kVersion) + " is read",
                               16);
        if (head.take<uint32_t>() != kSectionCount) return (void)wrong("not the sections of this version", 20);
        const uint64_t hash = head.take<uint64_t>();
        if (bytes_.size() < kSizesEnd) return (void)wrong("the file ends within its head", bytes_.size());
        uint64_t at = kSizesEnd;
        for (uint32_t section = 0; section < kSectionCount; ++section) {
            const uint64_t where = head.at(), size = head.take<uint64_t>();
            if (size > bytes_.size() - at) return (void)wrong("a section that is longer than the file", where);
            if (size % kRecordBytes[section] != 0) return (void)wrong("a section that ends within a record", where);
            sections_[section] = ByteCursor(bytes_.subspan(at, size), at);
            at += size;
        }
        if (at != bytes_.size()) return (void)wrong("bytes after the last section", at);
        if (contentHash(bytes_.subspan(kHashedAt)) != hash)
            wrong("the content does not have the hash that it says", kHashAt);
    }

    static void takeMatrix(ByteCursor& from, glm::dmat4& matrix) {
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) matrix[column][row] = from.take<double>();
    }

    void readView() {
        ByteCursor& from = sections_[kView];
        const uint64_t at = from.at();
        if (records(kView) != 1) return (void)wrong("not exactly one view", at);
        View& view = out_.view;
        takeMatrix(from, view.view);
        takeMatrix(from, view.projection);
        view.width = from.take<uint32_t>();
        view.height = from.take<uint32_t>();
        view.jitter = from.take<double>();
        view.layers = from.take<uint32_t>();
        view.eye_radius = from.take<double>();
        for (ViewPlanes* planes : {&view.sections, &view.window}) {
            planes->count = from.take<uint32_t>();
            for (glm::dvec4& plane : planes->planes)
                for (int k = 0; k < 4; ++k) plane[k] = from.take<double>();
        }
        view.through.count = from.take<uint32_t>();
        for (glm::dvec3& point : view.through.points)
            for (int axis = 0; axis < 3; ++axis) point[axis] = from.take<double>();
        if (!isUsable(view)) return (void)wrong("a view that cannot be used", at);
        const uint64_t at_flags = from.at();
        const uint32_t flags = from.take<uint32_t>();
        if (flags > 1) return (void)wrong("flags that are not known", at_flags);
        out_.volumes = flags == 1;
    }

    /// What is not in the file is as it is by default, so that settings may be added.
    void readSettings() {
        ByteCursor& from = sections_[kSettings];
        while (good() && from.left() > 0) {
            const uint64_t at = from.at();
            char name[kNameBytes + 1] = {};
            for (size_t i = 0; i < kNameBytes; ++i) name[i] = from.take<char>();
            const double value = from.take<double>();
            bool known = false;
            forEachSetting([&](const auto& row) {
                if (known || std::string_view(name) != row.name) return;
                known = true;
                auto& to = out_.settings.*row.member;
                using Value = std::remove_reference_t<decltype(to)>;
                const bool endless = row.most >= 1e300 && value > row.most;  // a NaN is not
                const bool whole = std::is_same_v<Value, double> || value == std::floor(value);
                if (!endless && !(value >= row.least && value <= row.most && whole))
                    return (void)wrong("a setting beyond its limits", at);
                to = static_cast<Value>(value);
            });
            if (!known) wrong("a setting that is not known", at);
        }
    }

    void readForms() {
        ByteCursor& from = sections_[kForms];
        Memory* const memory = out_.forms.memory();
        out_.forms.reserve(records(kForms));
        while (good() && from.left() > 0) {
            const uint64_t at = from.at(), count = from.take<uint32_t>();
            if (count > records(kInner)) return (void)wrong("more inner occluders than the file has", at);
            FrameRecording::Form& form = out_.forms.emplace_back(memory);
            form.inner.reserve(count);
            occluders_.take(form.occluder);
            for (uint64_t i = 0; i < count && good(); ++i) {
                InnerOccluder& inner = form.inner.emplace_back(memory);
                if (!takeBox(sections_[kInner], inner.outside, fault_) ||
                    !takeFinite(sections_[kInner], inner.error, fault_))
                    return;
                occluders_.take(inner.occluder);
            }
        }
        if (good() && sections_[kInner].left() > 0) wrong("more than the occluders have", sections_[kInner].at());
        if (good()) occluders_.end();
    }

    void readChains() {
        ByteCursor& from = sections_[kChains];
        ByteCursor& levels = sections_[kLevels];
        out_.chains.reserve(records(kChains));
        while (from.left() > 0) {
            const uint64_t at = from.at(), count = from.take<uint32_t>();
            if (count == 0 || count > std::min<uint64_t>(kMostLods, records(kLevels)))
                return (void)wrong("more levels of detail than there are", at);
            Array<LodLevel>& chain = out_.chains.emplace_back();
            for (uint64_t i = 0; i < count; ++i) {
                LodLevel& level = chain.emplace_back();
                level.error = levels.take<double>();
                level.triangles = levels.take<uint32_t>();
                level.vertices = levels.take<uint32_t>();
            }
        }
        if (levels.left() > 0) wrong("more levels of detail than the chains have", levels.at());
    }

    /// Bounds, transforms and limits may be any numbers, as World::add() takes them.
    void readObjects() {
        ByteCursor& from = sections_[kObjects];
        out_.objects.reserve(records(kObjects));
        while (from.left() > 0) {
            const uint64_t at = from.at();
            ObjectDef& object = out_.objects.emplace_back();
            for (glm::dvec3* corner : {&object.bounds.min, &object.bounds.max})
                for (int axis = 0; axis < 3; ++axis) (*corner)[axis] = from.take<double>();
            takeMatrix(from, object.transform);
            object.key = from.take<uint64_t>();
            for (uint32_t* value : {&object.layers, &object.occluder.index, &object.shape.index, &object.lods.index})
                *value = from.take<uint32_t>();
            object.limits.max_distance = from.take<double>();
            object.limits.factor = from.take<double>();
            const uint32_t flags = from.take<uint32_t>();
            object.limits.always = flags & 1;
            object.hides_in_lods = flags & 2;
            if (flags > 3) return (void)wrong("flags that are not known", at);
            if (std::max(object.occluder.index, object.shape.index) > out_.forms.size() ||
                object.lods.index > out_.chains.size())
                return (void)wrong("an object with what there is not", at);
        }
    }

    void readAnswers() {
        const std::pair<Section, Array<uint8_t>*> answers[] = {{kReasons, &out_.reasons}, {kAgain, &out_.again}};
        for (const auto& [section, to] : answers) {
            ByteCursor& from = sections_[section];
            if (records(section) != out_.objects.size()) return (void)wrong("not an answer for each object", from.at());
            to->reserve(out_.objects.size());
            while (from.left() > 0) {
                const uint64_t at = from.at();
                to->push_back(from.take<uint8_t>());
                if (to->back() > kStageCount && to->back() != 255) return (void)wrong("a stage that there is not", at);
            }
        }
    }

    void readCertificates() {
        ByteCursor& from = sections_[kCertificates];
        ByteCursor& named = sections_[kNamed];
        out_.certificates.reserve(records(kCertificates));
        out_.named.reserve(records(kNamed));
        for (uint32_t next = 0; from.left() > 0;) {
            const uint64_t at = from.at();
            FrameRecording::Certificate& certificate = out_.certificates.emplace_back();
            certificate.hidden = from.take<uint32_t>();
            certificate.count = from.take<uint32_t>();
            certificate.first = static_cast<uint32_t>(out_.named.size());
            if (certificate.hidden < next || certificate.hidden >= out_.objects.size() ||
                out_.reasons[certificate.hidden] == 0)
                return (void)wrong("a certificate of no object that was culled", at);
            next = certificate.hidden + 1;
            if (certificate.count > records(kNamed))
                return (void)wrong("a certificate that names more than there are", at);
            for (uint32_t i = 0; i < certificate.count; ++i) {
                const uint64_t at_named = named.at();
                const uint32_t object = named.take<uint32_t>();
                if (object >= out_.objects.size() || (i > 0 && object <= out_.named.back()))
                    return (void)wrong("a certificate that names what there is not, or twice", at_named);
                out_.named.push_back(object);
            }
        }
        if (named.left() > 0) wrong("more names than the certificates have", named.at());
    }

    std::span<const char> bytes_;
    std::string_view file_;
    FrameRecording& out_;
    ByteFault fault_;
    ByteCursor sections_[kSectionCount];
    OccluderReader occluders_{&sections_[kOccluders], fault_};
};

}  // namespace

bool isRecording(std::span<const char> bytes) {
    return bytes.size() >= sizeof kMagic && std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
}

Result<FrameRecording> parseRecording(std::span<const char> bytes, std::string_view file, Memory* memory) {
    FrameRecording out(memory);
    if (Status read = RecordingReader(bytes, file, out).read(); !read) return read.error();
    return out;
}

}  // namespace sightline
