// One view by several ways of culling, as a table.
// SPDX-License-Identifier: MIT
#include "apps/viewer/ways_panel.h"

#include <fmt/core.h>
#include <imgui.h>

#include "sightline/tools/report/readable.h"

namespace sightline::viewer {
namespace {

std::string grouped(size_t number) { return tools::readable(static_cast<double>(number)); }

}  // namespace

void drawWays(const SideBySide* ways, const std::string& problem, bool times, bool doors_shut, uint32_t height,
              bool& open) {
    ImGui::SetNextWindowPos({360, static_cast<float>(height) - 248}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({560, 240}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("ways of culling", &open)) {
        if (!problem.empty()) ImGui::TextWrapped("%s", problem.c_str());
        else if (ways && ImGui::BeginTable("ways", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
            for (const char* head : {"way", "kept", "missed", "ms", "how"}) ImGui::TableSetupColumn(head);
            ImGui::TableHeadersRow();
            for (int i = 0; i < kWays; ++i) {
                const WayAnswer& answer = ways->of(static_cast<Way>(i));
                ImGui::TableNextRow();
                const auto cell = [](const std::string& words) {
                    ImGui::TableNextColumn();
                    ImGui::TextUnformatted(words.c_str());
                };
                cell(kWayNames[i]);
                cell(grouped(answer.kept.size()));
                cell(grouped(answer.missed));
                cell(times ? fmt::format("{:.2f}", answer.milliseconds) : "");
                cell(answer.note);
            }
            ImGui::EndTable();
            ImGui::TextWrapped(
                "The graphics card's image of everything shows %s objects. Queries and pyramid, which are its own, "
                "keep what "
                "its samples show, and know it when all is drawn; the others keep all that is visible, and know it "
                "before.",
                grouped(ways->seen()).c_str());
            if (doors_shut) ImGui::TextWrapped("A shut door hides what the card still shows: that counts as missed.");
        }
    }
    ImGui::End();
}

}  // namespace sightline::viewer
