// What the user of the viewer has chosen.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::viewer {

enum class ColourBy : uint8_t { kMaterials, kObjects, kAnswer, kLevels };
inline constexpr int kColourings = 4;
inline constexpr const char* kColourByNames[kColourings] = {"materials", "objects", "answer", "levels"};

/// How what was culled looks while the culling camera is left alone.
enum class CulledAs : uint8_t { kNothing, kBoxes, kGhosts };
inline constexpr const char* kCulledAsNames[] = {"nothing", "boxes", "ghosts"};

/// What the user has chosen.
struct ViewerState {
    bool panels = true;
    bool frozen = false;  ///< the culling camera stays where it is, and the eye leaves it
    ColourBy colour_by = ColourBy::kMaterials;
    CulledAs culled_as = CulledAs::kBoxes;
    bool frustum = true;   ///< of the frozen camera
    bool portals = false;  ///< of the attached cells
    bool cells = false;    ///< the culling camera's, and those that are seen from there
    bool windows = false;  ///< that cells are seen through, in the image of the culling camera
    bool bounds = false;   ///< of what is visible
    bool casters = false;  ///< what may darken what is visible, under a sun
    int tree_level = -1;   ///< boxes of the hierarchy's nodes of a level; below 0: none
    bool buffer = false;   ///< the occlusion buffer as a picture
    bool ways = false;     ///< of culling, side by side
    bool x_ray = false;    ///< all that is solid is see-through
    bool isolate = false;  ///< the chosen object alone, and what hides it
    bool bsp = false;      ///< the picture is painted in the order of a BSP tree
    float bsp_part = 1;    ///< of its pieces, the farthest first  [0 to 1]
    bool bsp_plays = false;
    bool section = false;
    int section_axis = 1;                ///< 3: along `section_ahead`
    glm::dvec3 section_ahead{0, 0, -1};  ///< where the eye looked when it was chosen
    float section_at = 0.5f;             ///< between the ends of the scene  [0 to 1]
    bool section_keeps_upper = false;
    bool recording = false, playing = false;
    float speed = 1;                                ///< of flight, times what suits the scene
    std::optional<uint32_t> chosen;                 ///< object
    std::string why;                                ///< of it
    bool why_is_old = false;                        ///< of an earlier view
    std::vector<uint32_t> hiders;                   ///< of it
    bool shadows = true;                            ///< of the parts that hide it
    std::vector<std::vector<glm::dvec3>> outlines;  ///< these parts
    bool clusters = false;                          ///< of its triangles
    int cluster = -1;                               ///< whose culling volume is shown; below 0: none
    std::optional<size_t> door;                     ///< that the mouse is at in the list
    std::string said;                               ///< the last message
    bool wants_picture = false;                     ///< of the next frame, into a file of the user's
    bool wants_to_close = false;
};

}  // namespace sightline::viewer
