// Reads a scene from a stream of bytes, and believes nothing of it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/foreign/scene_stream.h"

#include "sightline/math/finite.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

namespace sightline::tools {

using namespace scene_stream;

namespace {

constexpr size_t kBlock = size_t(1) << 16;  // [bytes]
constexpr double kFarthest = 1e100;         // squares and volumes of what is nearer stay finite

struct Broken {
    std::string what;
};
struct Cut {};
struct Large {};

/// Takes bytes from the source; inside a record no more than the record holds.
class StreamRecords {
public:
    StreamRecords(const ByteSource& source, uint64_t most) : source_(source), most_(most) {}

    void read(void* to, size_t size) {
        auto* out = static_cast<unsigned char*>(to);
        while (size > 0) {
            if (begin_ == end_) refill();
            const size_t part = std::min(size, end_ - begin_);
            std::memcpy(out, block_ + begin_, part);
            begin_ += part;
            out += part;
            size -= part;
        }
    }

    uint32_t next() {
        left_ = 12;
        const auto kind = take<uint32_t>();
        left_ = take<uint64_t>();
        return kind;
    }

    template <class T>
    T take() {
        static_assert(kRaw<T>);
        claim(sizeof(T));
        T value;
        read(&value, sizeof value);
        return value;
    }

    std::string takeText() {
        const auto size = take<uint32_t>();
        if (size > kLongestText) throw Broken{"a text is too long"};
        claim(size);
        std::string text(size, '\0');
        read(text.data(), size);
        return text;
    }

    /// Grows with what arrives, whatever was announced.
    template <class T>
    std::vector<T> takeAll(uint64_t count) {
        static_assert(kRaw<T>);
        if (count > left_ / sizeof(T)) throw Broken{"a table is longer than its record"};
        claim(count * sizeof(T));
        std::vector<T> out;
        for (uint64_t had = 0; had < count;) {
            const uint64_t part = std::min<uint64_t>(count - had, kBlock / sizeof(T));
            if (out.capacity() < had + part) out.reserve(std::min(count, std::max(2 * had, had + part)));
            out.resize(had + part);
            read(out.data() + had, part * sizeof(T));
            had += part;
        }
        return out;
    }

    void finish() const {
        if (left_ != 0) throw Broken{"a record is longer than what it holds"};
    }

private:
    void claim(uint64_t size) {
        if (size > left_) throw Broken{"a record is shorter than what it holds"};
        left_ -= size;
    }

    void refill() {
        begin_ = 0;
        end_ = source_(block_, sizeof block_);
        if (end_ == 0) throw Cut{};
        if (end_ > sizeof block_) throw Broken{"the source gives too much"};
        received_ += end_;
        if (received_ > most_) throw Large{};
    }

    const ByteSource& source_;
    uint64_t most_, received_ = 0, left_ = 0;
    size_t begin_ = 0, end_ = 0;
    unsigned char block_[kBlock];
};

bool affine(const glm::dmat4& matrix) {
    return matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
}

bool within(const Box3d& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] >= -kFarthest && box.max[axis] <= kFarthest && box.min[axis] <= box.max[axis]))
            return false;
    return true;
}

Material takeMaterial(StreamRecords& in) {
    Material out;
    out.base_color = in.take<glm::vec4>();
    out.alpha_cutoff = in.take<float>();
    const auto mode = in.take<uint8_t>(), sides = in.take<uint8_t>(), transmissive = in.take<uint8_t>();
    out.name = in.takeText();
    if (mode > static_cast<uint8_t>(AlphaMode::kBlend) || sides > 1 || transmissive > 1)
        throw Broken{"a material is of no known kind"};
    for (int c = 0; c < 4; ++c)
        if (!std::isfinite(out.base_color[c])) throw Broken{"a colour is not finite"};
    if (!std::isfinite(out.alpha_cutoff)) throw Broken{"a colour is not finite"};
    out.alpha_mode = static_cast<AlphaMode>(mode);
    out.double_sided = sides == 1;
    out.transmissive = transmissive == 1;
    return out;
}

SceneNode takeNode(StreamRecords& in, const Scene& scene) {
    SceneNode out;
    out.parent = in.take<uint32_t>();
    out.name = in.takeText();
    if (out.parent != SceneNode::kNone && out.parent >= scene.nodes.size())
        throw Broken{"a node stands before its parent"};
    return out;
}

void checkPrimitives(const Mesh& mesh, const Scene& scene) {
    uint64_t next = 0;
    for (const Primitive& part : mesh.primitives) {
        if (part.first_triangle != next) throw Broken{"primitives leave a gap"};
        if (part.material >= scene.materials.size()) throw Broken{"a material is out of range"};
        next += part.triangle_count;
    }
    if (next != mesh.triangles()) throw Broken{"primitives do not cover the triangles"};
}

Mesh takeMesh(StreamRecords& in, const Scene& scene) {
    Mesh out;
    const auto positions = in.take<uint64_t>(), triangles = in.take<uint64_t>(), parts = in.take<uint64_t>();
    const auto deforms = in.take<uint8_t>();
    const auto low = in.take<glm::dvec3>(), high = in.take<glm::dvec3>();
    out.name = in.takeText();
    if (triangles == 0) throw Broken{"a mesh has no triangles"};
    if (triangles > ~0u / 3 || positions > ~0u || deforms > 1) throw Broken{"a mesh is too large"};
    out.primitives = in.takeAll<Primitive>(parts);
    out.positions = in.takeAll<glm::vec3>(positions);
    out.indices = in.takeAll<uint32_t>(3 * triangles);
    out.deforms = deforms == 1;
    checkPrimitives(out, scene);
    for (const uint32_t index : out.indices)
        if (index >= positions) throw Broken{"an index is out of range"};
    for (const glm::vec3& position : out.positions) {
        if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
            throw Broken{"a position is not finite"};
        out.bounds.grow(glm::dvec3(position));
    }
    if (!out.deforms) return out;
    if (!within({low, high})) throw Broken{"bounds are not finite"};
    out.bounds.grow(low);
    out.bounds.grow(high);
    return out;
}

SceneObject takeObject(StreamRecords& in, const Scene& scene) {
    SceneObject out;
    out.key = scene.objects.size();
    out.mesh = in.take<uint32_t>();
    out.node = in.take<uint32_t>();
    out.changes = in.take<uint8_t>();
    if (out.changes > SceneObject::kAnimated) throw Broken{"an object changes in a way that is not known"};
    out.transform = in.take<glm::dmat4>();
    out.name = in.takeText();
    if (out.mesh >= scene.meshes.size()) throw Broken{"a mesh is out of range"};
    if (out.node >= scene.nodes.size()) throw Broken{"a node is out of range"};
    if (!isFinite(out.transform) || !affine(out.transform)) throw Broken{"a transform is not affine"};
    if (!within(transformBox(scene.meshes[out.mesh].bounds, out.transform)))
        throw Broken{"an object's bounds in the world are too large"};
    return out;
}

SceneCamera takeCamera(StreamRecords& in) {
    SceneCamera out;
    out.transform = in.take<glm::dmat4>();
    out.fov_y = in.take<double>();
    out.orthographic_height = in.take<double>();
    out.z_near = in.take<double>();
    const auto z_far = in.take<double>();
    out.name = in.takeText();
    const bool angle = out.fov_y > 0 && out.fov_y < 3.14159 && out.orthographic_height == 0;
    const bool height = out.orthographic_height > 0 && out.orthographic_height < kFarthest && out.fov_y == 0;
    if (!angle && !height) throw Broken{"a camera is of neither kind"};
    if (!isFinite(out.transform) || !affine(out.transform) ||
        !(glm::length(glm::cross(glm::dvec3(out.transform[1]), glm::dvec3(out.transform[2]))) > 0))
        throw Broken{"a camera looks nowhere"};
    if (!(out.z_near >= (angle ? 1e-30 : 0.0) && out.z_near < kFarthest)) throw Broken{"a camera has no near plane"};
    if (z_far > out.z_near && z_far < kFarthest) out.z_far = z_far;
    return out;
}

SceneRoom takeRoom(StreamRecords& in, const Scene& scene) {
    SceneRoom out;
    out.node = in.take<uint32_t>();
    out.bounds.min = in.take<glm::dvec3>();
    out.bounds.max = in.take<glm::dvec3>();
    if (out.node >= scene.nodes.size()) throw Broken{"a node is out of range"};
    if (out.bounds.empty()) out.bounds = {};
    else if (!within(out.bounds)) throw Broken{"bounds are not finite"};
    return out;
}

void takeEnd(StreamRecords& in, const Scene& scene) {
    const uint64_t counts[kCounts] = {scene.materials.size(), scene.nodes.size(),   scene.meshes.size(),
                                      scene.objects.size(),   scene.cameras.size(), scene.rooms.size()};
    for (const uint64_t count : counts)
        if (in.take<uint64_t>() != count) throw Broken{"records are missing"};
    in.finish();
    if (scene.objects.empty()) throw Broken{"no object"};
}

/// Reads records until one of them is the last.
void readAll(StreamRecords& in, const std::function<void(size_t, size_t)>& progress, SceneStream& out) {
    char magic[sizeof kMagic];
    in.read(magic, sizeof magic);
    if (std::memcmp(magic, kMagic, sizeof kMagic) != 0) throw Broken{"it does not begin as one of this version"};
    Scene& scene = out.scene;
    constexpr size_t kMostNotes = 100;
    for (;;) {
        switch (in.next()) {
            case kProgress: {
                const auto done = in.take<uint64_t>(), total = in.take<uint64_t>();
                if (progress && total > 0) progress(std::min(done, total), total);
                break;
            }
            case kNote:
                if (std::string text = in.takeText(); out.notes.size() < kMostNotes)
                    out.notes.push_back(std::move(text));
                break;
            case kMaterial:
                scene.materials.push_back(takeMaterial(in));
                break;
            case kNode:
                scene.nodes.push_back(takeNode(in, scene));
                break;
            case kMesh:
                scene.meshes.push_back(takeMesh(in, scene));
                break;
            case kObject:
                scene.objects.push_back(takeObject(in, scene));
                break;
            case kCamera:
                scene.cameras.push_back(takeCamera(in));
                break;
            case kRoom:
                scene.rooms.push_back(takeRoom(in, scene));
                break;
            case kPart:
                out.part = in.takeText();
                break;
            case kFault:
                out.what = in.takeText();
                in.finish();
                out.end = SceneStream::End::kFault;
                return;
            case kEnd:
                takeEnd(in, scene);
                out.end = SceneStream::End::kWhole;
                return;
            default:
                throw Broken{"a record is of no known kind"};
        }
        in.finish();
    }
}

}  // namespace

SceneStream readSceneStream(const ByteSource& source, uint64_t most,
                            const std::function<void(size_t done, size_t total)>& progress) {
    SceneStream out;
    try {
        StreamRecords records(source, most);
        readAll(records, progress, out);
        if (out.end == SceneStream::End::kWhole) return out;
    } catch (const Cut&) { out.end = SceneStream::End::kCut; } catch (const Large&) {
        out.end = SceneStream::End::kLarge;
    } catch (const Broken& broken) {
        out.end = SceneStream::End::kBroken;
        out.what = broken.what;
    } catch (const std::bad_alloc&) { out.end = SceneStream::End::kLarge; }
    out.scene = {};
    return out;
}

SceneStream parseSceneStream(std::span<const unsigned char> bytes) {
    const ByteSource source = [&](unsigned char* to, size_t size) {
        const size_t part = std::min(size, bytes.size());
        std::copy_n(bytes.begin(), part, to);
        bytes = bytes.subspan(part);
        return part;
    };
    return readSceneStream(source, ~uint64_t(0), {});
}

}  // namespace sightline::tools
