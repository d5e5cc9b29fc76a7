// How files become scenes: axes, sides, limits of foreign readers, and who is told.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace sightline::tools {

/// The axis of a file that points up. Sightline's is y, with z towards the viewer.
enum class UpAxis : uint8_t { kAsFileSays, kX, kY, kZ };

/// Which sides of surfaces are drawn.
enum class Sides : uint8_t {
    kAsFileSays,  ///< by the file's materials; both, where its format does not tell
    kOne,         ///< the front alone, whatever the file says: for renderers that leave out back faces
    kBoth,        ///< both, whatever the file says
};

struct ImportSettings {
    UpAxis up = UpAxis::kAsFileSays;  ///< a scene is turned so that this axis becomes y
    double scale = 1;                 ///< positions are multiplied with it  [> 0]
    Sides sides = Sides::kAsFileSays;
    uint64_t memory_limit = uint64_t(8) << 30;  ///< for readers that are not ours  [bytes]
    double time_limit = 300;                    ///< for readers that are not ours  [seconds]
    std::string worker;                         ///< the program sightline-import; empty: beside the running program,
                                                ///< or where it was installed
    std::function<void(size_t done, size_t total)> progress;  ///< may be empty; any unit
    std::function<void(const std::string& text)>
        note;  ///< what the user should know of a scene that was read; may be empty
};

}  // namespace sightline::tools
