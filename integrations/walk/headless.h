// What programs share that draw a path both ways: a context without a display, and what it means if two images differ.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::integrations {

inline constexpr int kWidth = 1280, kHeight = 720;

/// From now on, contexts are Mesa's software driver's, with one thread that fills unless LP_NUM_THREADS says otherwise.
void useSoftwareDriver();

/// Makes a context of Mesa's software driver current on this thread, with an image of kWidth x kHeight of its own.
bool makeContext();

/// A scene by its file or its specification, and a path through it.
struct Walked {
    tools::Scene scene;
    std::vector<tools::CameraFrame> path;
    bool queries = false;  ///< also by the engine's own occlusion queries
};
/// Reads the arguments of a program: SCENE [FRAMES [SEED [walk|scatter [queries]]]].
Result<Walked> readArguments(int argc, char** argv);

/// What of a path was found so far.
struct Tally {
    explicit Tally(const tools::Scene& scene);
    ~Tally();
    Tally(const Tally&) = delete;
    Tally& operator=(const Tally&) = delete;

    /// Compares two images of a view, four bytes a pixel from the bottom. Where a pixel differs, the line of sight through its
    /// centre is followed by Embree, which shares nothing with either: unless it ends on what was drawn, it was culled wrongly.
    /// @param drawn  the objects of the scene that were drawn
    void add(const View& view, const std::vector<unsigned char>& own, const std::vector<unsigned char>& ours,
             const std::set<uint32_t>& drawn);
    bool good() const { return wrong == 0 && blank < frames; }

    uint64_t frames = 0, blank = 0;   ///< those of one colour
    uint64_t differ = 0, pixels = 0;  ///< images, and their pixels
    uint64_t wrong = 0;               ///< pixels

private:
    struct Rays;
    Rays* const rays_;
};

/// Milliseconds of the frames but the first two, which compile and load.
double median(const std::vector<double>& times);

}  // namespace sightline::integrations
