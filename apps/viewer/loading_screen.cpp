// What the window shows while a scene is read and prepared: what is being done, and how far it is.
// SPDX-License-Identifier: MIT
#include "apps/viewer/loading_screen.h"

#include <algorithm>
#include <utility>

#include <imgui.h>

#include "apps/viewer/inks.h"

namespace sightline::viewer {

Result<LoadingScreen> LoadingScreen::create() {
    LoadingScreen made;
    Result<Gui> gui = Gui::create();
    if (!gui) return gui.error();
    made.gui_ = std::move(*gui);
    return made;
}

Status LoadingScreen::frame(const Input& input, uint32_t width, uint32_t height, float scale, const std::string& title,
                            const LoadingPart& now) {
    if (Status ready = image_.resize(width, height, false); !ready) return ready;
    gui_.begin(input, width, height, scale);
    const float across = std::min(420 * scale, static_cast<float>(width));
    ImGui::SetNextWindowPos({0.5f * (static_cast<float>(width) - across), 0.4f * static_cast<float>(height)});
    ImGui::SetNextWindowSize({across, 0});
    ImGui::Begin("loading", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize);
    ImGui::TextUnformatted(title.c_str());
    ImGui::TextUnformatted(now.what.empty() ? "loading" : now.what.c_str());
    ImGui::ProgressBar(static_cast<float>(std::clamp(now.part, 0.0, 1.0)), {-1, 0});
    ImGui::End();
    image_.begin();
    glClearColor(kBackground.r, kBackground.g, kBackground.b, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    image_.resolve();
    gui_.draw();
    return checkGl("drawing the progress");
}

}  // namespace sightline::viewer
