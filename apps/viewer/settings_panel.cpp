// All settings of the query, each with what it means: made from the table that names them.
// SPDX-License-Identifier: MIT
#include "apps/viewer/settings_panel.h"
#include "sightline/geom/setting_rows.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <imgui.h>

namespace sightline::viewer {
namespace {

/// Those that have a panel of their own, or change nothing that is seen here.
bool isElsewhere(std::string_view name) {
    constexpr std::string_view kElsewhere[] = {"stages", "lod_fade", "bins", "proofs", "time_stages"};
    return std::find(std::begin(kElsewhere), std::end(kElsewhere), name) != std::end(kElsewhere);
}

bool edit(const char* name, bool& value, double, double) { return ImGui::Checkbox(name, &value); }

bool edit(const char* name, PortalWindows& value, double, double) {
    int at = static_cast<int>(value);
    if (!ImGui::Combo(name, &at, kWindowNames, static_cast<int>(std::size(kWindowNames)))) return false;
    value = static_cast<PortalWindows>(at);
    return true;
}

bool edit(const char* name, uint32_t& value, double least, double most) {
    uint32_t asked = value;
    if (!ImGui::InputScalar(name, ImGuiDataType_U32, &asked, nullptr, nullptr, nullptr,
                            ImGuiInputTextFlags_EnterReturnsTrue))
        return false;
    value = static_cast<uint32_t>(std::clamp(static_cast<double>(asked), least, most));
    return true;
}

bool edit(const char* name, double& value, double least, double most) {
    double asked = value;
    if (!ImGui::InputDouble(name, &asked, 0, 0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue)) return false;
    if (!std::isnan(asked)) value = std::clamp(asked, least, most);
    return true;
}

}  // namespace

void drawSettings(QuerySettings& settings, const QuerySettings& begun, PanelPlaces& places) {
    if (!ImGui::CollapsingHeader("settings")) return notePlace(places, "settings");
    notePlace(places, "settings");
    if (ImGui::Button("all as at the start")) settings = begun;
    notePlace(places, "all as at the start");
    ImGui::PushItemWidth(90);
    forEachSetting([&](const auto& row) {
        if (isElsewhere(row.name)) return;
        std::string words = row.name;
        std::replace(words.begin(), words.end(), '_', ' ');
        edit(words.c_str(), settings.*row.member, row.least, row.most);
        notePlace(places, row.name);
        showTip(fmt::format("{}{}", row.help, *row.unit ? fmt::format(" [{}]", row.unit) : "").c_str());
    });
    ImGui::PopItemWidth();
}

}  // namespace sightline::viewer
