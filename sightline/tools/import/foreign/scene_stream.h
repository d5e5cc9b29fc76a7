// A scene as a stream of bytes: what sightline-import writes into a pipe, and what is believed of it.
// SPDX-License-Identifier: MIT
//
// The stream is 16 bytes of magic and then records: a kind (u32), a size (u64) and so many bytes, in the order of the
// machine that both ends run on. It is no file format: both ends are of one version.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

namespace scene_stream {

inline constexpr char kMagic[16] = {'s', 'i', 'g', 'h', 't', 'l', 'i', 'n', 'e', ' ', 's', 'c', 'e', 'n', 'e', 2};
inline constexpr uint64_t kLongestText = 1 << 16;  // [bytes]

enum Kind : uint32_t { kProgress = 1, kNote, kMaterial, kNode, kMesh, kObject, kCamera, kFault, kEnd, kRoom, kPart };
enum Count : size_t { kMaterials, kNodes, kMeshes, kObjects, kCameras, kRooms, kCounts };

/// What goes into a stream as it lies in memory.
template <class T>
constexpr bool kRaw = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

}  // namespace scene_stream

/// With this exit code sightline-import says that its memory did not suffice.
constexpr int kImportOutOfMemory = 12;

/// Writes records to a sink, which takes every byte that it is given; a call with none asks it to let go of all that it
/// holds back, so that progress is seen in time. Allocates nothing.
class SceneStreamWriter {
public:
    using Sink = std::function<void(const void* bytes, size_t size)>;

    /// Writes the magic.
    explicit SceneStreamWriter(Sink sink);

    void progress(uint64_t done, uint64_t total);
    /// Something that the user should know, one line; the scene is good nevertheless.
    void note(const std::string& text);
    void material(const Material& material);
    /// Its parent must have been written before it.
    void node(const SceneNode& node);
    /// Its materials must have been written before it. Bounds count only if the mesh deforms.
    void mesh(const Mesh& mesh);
    /// Its mesh and node must have been written before it. The key is not written: it is the object's place.
    void object(const SceneObject& object);
    void camera(const SceneCamera& camera);
    /// Its node must have been written before it.
    void room(const SceneRoom& room);
    /// What is being read from here on, one line: it is told if the writer ends without a word.
    void part(const std::string& text);
    /// Instead of the rest: why there is no scene, one line.
    void fault(const std::string& text);
    /// Without it the scene does not count.
    void end();

private:
    void head(uint32_t kind, uint64_t size);
    template <class T>
    void put(const T& value);
    void put(const std::string& text);
    template <class T>
    void putAll(const std::vector<T>& values);

    Sink sink_;
    uint64_t counts_[scene_stream::kCounts] = {};
};

/// Gives the next bytes, at least one and at most `size`; 0 at the end.
using ByteSource = std::function<size_t(unsigned char* to, size_t size)>;

struct SceneStream {
    enum class End : uint8_t {
        kWhole,   ///< the scene is good
        kFault,   ///< the writer says why there is none, in `what`
        kCut,     ///< the stream ended too early
        kBroken,  ///< the stream is not one; `what` says where
        kLarge    ///< it is longer than allowed, or needs more memory than there is
    };
    End end = End::kCut;
    std::string what;
    std::string part;  ///< what was being read; empty: not told
    std::vector<std::string> notes;
    Scene scene;  ///< without name and files
};

/// Reads and checks a stream of unknown origin. A whole scene holds what an importer promises: indices in range,
/// positions and transforms finite, static bounds its own, nodes without cycles, at least one object and triangle.
/// Memory is bounded by 64 KiB and 8 times the bytes received; nothing is believed before it has arrived.
/// @param most      longest stream that is taken  [bytes]
/// @param progress  may be empty
SceneStream readSceneStream(const ByteSource& source, uint64_t most,
                            const std::function<void(size_t done, size_t total)>& progress);

/// The same from memory, as a fuzzer needs it.
SceneStream parseSceneStream(std::span<const unsigned char> bytes);

}  // namespace sightline::tools
