// The words of a scene's stream that its writer and its reader have in common.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace sightline::tools::scene_stream {

inline constexpr char kMagic[16] = {'s', 'i', 'g', 'h', 't', 'l', 'i', 'n', 'e', ' ', 's', 'c', 'e', 'n', 'e', 1};
inline constexpr uint64_t kLongestText = 1 << 16;  // [bytes]

enum Kind : uint32_t { kProgress = 1, kNote, kMaterial, kNode, kMesh, kObject, kCamera, kFault, kEnd };
enum Count : size_t { kMaterials, kNodes, kMeshes, kObjects, kCameras };

/// What goes into a stream as it lies in memory.
template <class T>
constexpr bool kRaw = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

}  // namespace sightline::tools::scene_stream
