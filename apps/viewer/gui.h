// Dear ImGui in the viewer's own GL: what the user did goes in, panels come out.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/viewer/gl_objects.h"

struct ImGuiContext;

namespace sightline::viewer {

/// Keys that the viewer knows; letters and digits by their own character, in capitals.
enum Key : uint16_t {
    kEscape = 256,
    kEnter,
    kTab,
    kBackspace,
    kDelete,
    kLeft,
    kRight,
    kUp,
    kDown,
    kHome,
    kEnd,
    kF1,
    kF12 = kF1 + 11,
    kKeys
};

/// What the user did since the last frame, and holds now.
struct Input {
    double seconds = 1.0 / 60;         ///< since then
    float mouse_x = -1, mouse_y = -1;  ///< [pixels from the left and the top]
    bool buttons[3] = {};              ///< left, right, middle: held
    float wheel = 0;
    bool keys[kKeys] = {};  ///< held
    bool shift = false, control = false, alt = false;
    std::string text;  ///< typed, UTF-8

    bool holds(uint16_t key) const { return keys[key]; }
};

class Gui {
public:
    Gui() = default;
    static Result<Gui> create();
    Gui(Gui&& other) noexcept;
    Gui& operator=(Gui&& other) noexcept;
    ~Gui();

    void begin(const Input& input, uint32_t width, uint32_t height, float scale);
    /// True if the panels, not the world, get the mouse or the keys.
    bool wantsMouse() const;
    bool wantsKeys() const;
    /// Draws the panels into what is bound.
    void draw();

private:
    ImGuiContext* context_ = nullptr;
    GlName font_, vertices_, indices_, array_, program_;
    GLint to_clip_ = -1;
};

}  // namespace sightline::viewer
