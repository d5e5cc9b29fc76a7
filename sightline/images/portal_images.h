// Portal images: the far side of a doorway as pictures, baked from sample points and shown to other eyes.
// SPDX-License-Identifier: MIT
//
// Daniel Aliaga, Anselmo Lastra. Architectural Walkthroughs Using Portal Textures. 1997.
// Matthew Rafferty, Daniel Aliaga, Anselmo Lastra. 3D Image Warping in Architectural Walkthroughs. 1998.
// Voicu Popescu, Anselmo Lastra, Daniel Aliaga, Manuel de Oliveira Neto. Efficient Warping for Architectural Walkthroughs
// Using Layered Depth Images. 1998.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/result.h"
#include "sightline/images/layered_image.h"
#include "sightline/images/parallax.h"
#include "sightline/images/portal_frame.h"
#include "sightline/images/sample_fan.h"
#include "sightline/studies/hidden/share.h"

namespace sightline::images {

/// What is taken, and from where. A fan without arcs takes nothing.
struct PortalImageSettings {
    uint32_t width = 256, height = 512;  ///< of every image  [texels, 1 to 8192]
    FanSettings images;                  ///< colours alone, for nearest and blended
    /// Of these images each texel is the mean of so many samples along each side: smooth at edges, and as many times
    /// squared as long to bake.  [>= 1; width and height times this: 1 to 8192]
    uint32_t across = 2;
    FanSettings references{
        .nearest = 1, .farthest = 4, .arcs = 3, .angles = 5};  ///< with depth, for warped and layered
    FanSettings layered{.arcs = 1, .angles = 3};               ///< views that layers are gathered in; need references
    LayerSettings layers;
    uint32_t layer_references = 6;  ///< of the nearest references, so many are gathered in a layered image
    /// Layered images reach so far beyond the doorway's rectangle on each side, for what other eyes see through it at a
    /// slant.  [shares of its width and height, 0 to 4]
    double layer_margin = 0.5;
    TakeSettings take;         ///< TakeSettings::shade.colour is asked by index into the items given to the bake
    studies::ShareWork share;  ///< images are taken one by one, or as this shares them out; they are the same
    std::function<void(size_t done, size_t total)> progress;  ///< one call at a time, from any thread; may be empty
};

/// What a bake left and took.
struct PortalBakeReport {
    size_t images = 0, references = 0, layered = 0;                        ///< how many
    size_t image_bytes = 0, reference_bytes = 0, layered_bytes = 0;        ///<
    double image_seconds = 0, reference_seconds = 0, layered_seconds = 0;  ///< wall time
    double triangles = 0;                                                  ///< handed to the renderer an image, mean
};

/// The images of one doorway, seen from one side.
struct PortalImages {
    PortalFrame frame;
    uint32_t width = 0, height = 0;
    SampleFan fan, reference_fan, layered_fan;
    std::vector<std::vector<glm::u8vec3>> images;  ///< of fan.eyes
    std::vector<DepthImage> references;            ///< of reference_fan.eyes
    std::vector<LayeredImage> layered;             ///< of layered_fan.eyes
    BeyondRange beyond;                            ///< of all items that may be seen; infinite if the sky is
    PortalBakeReport report;
};

/// Draws what lies beyond a doorway from all sample points.
/// @param items  the world: what lies before the doorway is left out. Nothing of it is kept
/// Errors (kUsage): fans outside of their limits or with an eye that is not before the doorway; an image without texels.
Result<PortalImages> bakePortalImages(const PortalFrame& frame, std::span<const studies::DrawItem> items,
                                      const PortalImageSettings& settings);

enum class ShowMode : uint8_t {
    kNearest,  ///< the image of the nearest sample point, as it is
    kBlended,  ///< two or three nearest, faded by their weights
    kWarped,   ///< two or three nearest references, carried to the eye, and more for the holes that are left
    kLayered   ///< the nearest layered image, carried to the eye
};
inline constexpr int kShowModes = 4;
inline constexpr const char* kShowModeNames[kShowModes] = {"nearest", "blended", "warped", "layered"};

struct ShowSettings {
    ShowMode mode = ShowMode::kWarped;
    double focal = 500;     ///< focalLength() of the viewer's view  [pixels]
    double most_error = 1;  ///< what may be shown, by prediction  [pixels]
    bool reuse = true;      ///< keep the picture that is there while its prediction stays within most_error
    /// kWarped: while there are holes, so many references at most are carried to the eye, nearest first.  [>= 1]
    uint32_t most_references = 6;
    WarpSettings warp{};
};

/// A picture of a doorway, pixel by pixel as portalView() lays them out; row 0 is the bottom row.
struct PortalPicture {
    uint32_t width = 0, height = 0;
    std::vector<glm::u8vec3> colour;
    std::vector<glm::dvec3> taken_from;  ///< the eyes that it is right for; empty: nothing is shown yet
    double rounding = 0;                 ///< that warping left: half a texel across  [world units on the doorway]
    ShowMode mode = ShowMode::kNearest;
    uint64_t holes = 0;  ///< texels that no reference saw, filled from beside
};

enum class ShowResult : uint8_t {
    kShown,
    kReused,    ///< the picture is the one that was there
    kNotBaked,  ///< there are no images of this kind
    kEye,       ///< Shown::place says why
    kTooFarOff  ///< Shown::error is above ShowSettings::most_error
};

/// What was done, and how far off it is.
struct Shown {
    ShowResult result = ShowResult::kNotBaked;
    EyePlace place = EyePlace::kBefore;
    Displacement error;  ///< of what is, or would be, shown: no point beyond is displaced by more  [pixels]
    double exposed = 0;  ///< no hole between two surfaces that the first reference saw side by side was wider  [pixels]

    bool ok() const { return result == ShowResult::kShown || result == ShowResult::kReused; }
};

/// Makes the picture of a doorway for an eye. Not conservative: what the samples did not see is not shown, and all but
/// kNearest mixes or moves what they saw. Where it answers that it shows nothing, the picture is as it was, and the doorway
/// must be drawn as geometry. Cost: a copy, or the texels (times layers); what lies beyond does not count.
/// @param picture  in/out: of this doorway, or empty
Shown showPortal(const PortalImages& images, const glm::dvec3& eye, const ShowSettings& settings,
                 PortalPicture& picture);

/// How far off a picture is for an eye: the most of the places that it was taken from, and its rounding.
Displacement pictureError(const PortalImages& images, const PortalPicture& picture, const glm::dvec3& eye,
                          double focal);

}  // namespace sightline::images
