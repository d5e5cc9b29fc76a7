// The viewer's panels.
// SPDX-License-Identifier: MIT
#include "apps/viewer/panels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>
#include <imgui.h>

#include "apps/viewer/inks.h"
#include "apps/viewer/settings_panel.h"
#include "apps/viewer/ways_panel.h"
#include "sightline/tools/report/readable.h"

namespace sightline::viewer {
using namespace tools;
namespace {

ImVec4 inkOf(const glm::vec3& colour) { return {colour.r, colour.g, colour.b, 1}; }

constexpr double kFarthest = 1e30;  // [world units]: what a slider bears

double meanOf(std::span<const float> values) {
    double sum = 0;
    size_t count = 0;
    for (const float value : values)
        if (value > 0) {
            sum += static_cast<double>(value);
            ++count;
        }
    return count == 0 ? 0 : sum / static_cast<double>(count);
}

std::string grouped(uint64_t number) { return readable(static_cast<double>(number)); }

/// One frame of them.
class Panels {
public:
    Panels(const PanelFacts& facts, ViewerState& state, Culler& culler, PanelPlaces& places)
        : facts_(facts), state_(state), culler_(culler), places_(places) {}
    PanelWishes draw();

private:
    void answer();
    void stages();
    void clusterCounts();
    void certificates();
    void hidesMost();
    void show();
    void cells() const;
    void legend();
    void paint();
    void clusters();
    void cut();
    void path();
    void doors();
    void door(size_t index, const char* words);
    void chosen();
    void times() const;
    void windows() const;
    void buffer();
    void keys();

    bool check(const char* words, bool& value);
    bool press(const char* words);
    bool slide(const char* words, float& value, float low, float high);
    void note(const char* words);

    const PanelFacts& facts_;
    ViewerState& state_;
    Culler& culler_;
    PanelPlaces& places_;
    PanelWishes wishes_;
};

void Panels::note(const char* words) { notePlace(places_, words); }

bool Panels::check(const char* words, bool& value) {
    const bool changed = ImGui::Checkbox(words, &value);
    note(words);
    return changed;
}

bool Panels::press(const char* words) {
    const bool pressed = ImGui::Button(words);
    note(words);
    return pressed;
}

bool Panels::slide(const char* words, float& value, float low, float high) {
    const bool changed = ImGui::SliderFloat(words, &value, low, high, "%.2f");
    note(words);
    return changed;
}

PanelWishes Panels::draw() {
    const float height = static_cast<float>(facts_.height);
    ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({340, std::max(height - 16, 100.0f)}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Sightline")) {
        answer();
        keys();
        stages();
        hidesMost();
        doors();
        drawSettings(culler_.settings, facts_.begun, places_);
        show();
        legend();
        cut();
        path();
        times();
    }
    ImGui::End();
    if (state_.chosen) chosen();
    if (state_.buffer) buffer();
    const bool doors_shut = std::any_of(culler_.doors().begin(), culler_.doors().end(),
                                        [](const ViewerDoor& door) { return door.open < 1; });
    if (state_.ways) drawWays(facts_.ways, facts_.ways_problem, facts_.times, doors_shut, facts_.height, state_.ways);
    if (state_.windows && !state_.frozen) windows();
    return wishes_;
}

/// What is visible, and how what is not is shown.
void Panels::answer() {
    const QueryStats& stats = culler_.stats();
    ImGui::TextUnformatted(facts_.scene.name.c_str());
    ImGui::Text("%s of %s objects visible", grouped(stats.visible).c_str(), grouped(stats.objects).c_str());
    ImGui::Text("%s triangles drawn", grouped(facts_.triangles).c_str());
    if (facts_.times)
        ImGui::Text("query %.0f us, frame %.1f ms", 1e-3 * static_cast<double>(stats.nanoseconds),
                    meanOf(facts_.frame_milliseconds));
    ImGui::TextUnformatted(state_.said.empty() ? " " : state_.said.c_str());
    if (!state_.said.empty()) showTip(state_.said.c_str());
    check("freeze the culling camera (F)", state_.frozen);
    ImGui::TextUnformatted("culled is shown as (C)");
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(kCulledAsNames[i], static_cast<int>(state_.culled_as) == i))
            state_.culled_as = static_cast<CulledAs>(i);
        note(kCulledAsNames[i]);
    }
    // One line, whatever it says, so that nothing jumps.
    if (!state_.frozen && !state_.x_ray) ImGui::TextUnformatted("once the camera is frozen, or with x-ray");
    else if (state_.culled_as != CulledAs::kNothing && facts_.left_out > 0)
        ImGui::Text("%s more %s would be too many", grouped(facts_.left_out).c_str(),
                    kCulledAsNames[static_cast<int>(state_.culled_as)]);
    else if (state_.culled_as == CulledAs::kGhosts && !state_.x_ray)
        ImGui::TextUnformatted("walls hide them: x-ray (X) sees through");
    else ImGui::TextUnformatted(" ");
}

/// What was culled by which stage, and the stages' switches.
void Panels::stages() {
    const QueryStats& stats = culler_.stats();
    const bool open = ImGui::CollapsingHeader("stages", ImGuiTreeNodeFlags_DefaultOpen);
    note("stages");
    if (!open) return;
    if (!ImGui::BeginTable("stages", 4, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("stage");
    ImGui::TableSetupColumn("tested");
    ImGui::TableSetupColumn("culled");
    ImGui::TableSetupColumn("us");
    ImGui::TableHeadersRow();
    for (int stage = 0; stage < kStageCount; ++stage) {
        const uint32_t bit = 1u << stage;
        if ((bit & kCellStages) != 0 && !culler_.hasCells()) continue;
        if (bit == stageBit(Stage::kClusters) && !culler_.hasClusters()) continue;
        const bool chooses_levels = culler_.settings.lod_error > 0 || culler_.settings.budget > 0;
        if (bit == stageBit(Stage::kLod) && !chooses_levels) continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        bool on = (culler_.settings.stages & bit) != 0;
        ImGui::PushStyleColor(ImGuiCol_Text, inkOf(stageColour(stage)));
        if (!(bit & kAllStages)) ImGui::TextUnformatted(kStageNames[stage]);  // it has no switch
        else if (check(kStageNames[stage], on)) culler_.settings.stages ^= bit;
        ImGui::PopStyleColor();
        const StageStats& row = stats.stages[stage];
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(grouped(row.tested).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(grouped(row.culled).c_str());
        ImGui::TableNextColumn();
        if (facts_.times) ImGui::Text("%.0f", 1e-3 * static_cast<double>(row.nanoseconds));
    }
    ImGui::EndTable();
    float distance = static_cast<float>(std::min(culler_.settings.max_distance, kFarthest)),
          pixels = static_cast<float>(culler_.settings.contribution);
    if ((culler_.settings.stages & stageBit(Stage::kDistance)) != 0 &&
        slide("farthest", distance, 0, static_cast<float>(std::min(facts_.size, kFarthest))))
        culler_.settings.max_distance = static_cast<double>(distance);
    if ((culler_.settings.stages & stageBit(Stage::kContribution)) != 0 && slide("smallest, pixels", pixels, 0, 20))
        culler_.settings.contribution = static_cast<double>(pixels);
    int width = static_cast<int>(culler_.settings.occlusion_size);
    if (ImGui::SliderInt("buffer width", &width, 64, 1280))
        culler_.settings.occlusion_size = static_cast<uint32_t>(width);
    note("buffer width");
    clusterCounts();
    certificates();
}

/// What the stage of clusters left of the objects that were kept.
void Panels::clusterCounts() {
    if (!culler_.hasClusters() || (culler_.settings.stages & stageBit(Stage::kClusters)) == 0) return;
    const QueryStats& stats = culler_.stats();
    ImGui::Text("%s of %s triangles left by clusters", grouped(stats.drawn_triangles).c_str(),
                grouped(stats.cluster_triangles).c_str());
    ImGui::Text("of %s: %s from the back, %s outside, %s hidden", grouped(stats.clusters_tested).c_str(),
                grouped(stats.clusters_back).c_str(), grouped(stats.clusters_outside).c_str(),
                grouped(stats.clusters_hidden).c_str());
}

/// Whether what hid a thing before is held against it first, and how far that goes.
void Panels::certificates() {
    check("certificates", culler_.settings.proofs);
    showTip(
        "Remember who hid a thing, and ask first whether they still do. Where that is known of nearly all, no buffer "
        "is "
        "drawn. Fly to see it at work.");
    if (!culler_.settings.proofs) return;
    const QueryStats& stats = culler_.stats();
    ImGui::SameLine();
    ImGui::TextUnformatted(stats.occluder_triangles > 0 ? "a buffer was drawn" : "no buffer was drawn");
    ImGui::Text("%s culled by whom is known, %s of %s found", grouped(stats.proved).c_str(),
                grouped(stats.proofs_found).c_str(), grouped(stats.proofs_sought).c_str());
}

/// The objects that hide most of the others.
void Panels::hidesMost() {
    const bool open = ImGui::CollapsingHeader("who hides most");
    note("who hides most");
    if (!open) return;
    if (!culler_.knowsHidesMost() && !press("find out")) return;
    const std::span<const HidesMost> most = culler_.hidesMost();
    if (most.empty()) ImGui::TextUnformatted("nobody hides anything");
    for (size_t i = 0; i < std::min<size_t>(most.size(), 12); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const std::string words = fmt::format("{:.1f} by {}", most[i].hidden, culler_.nameOf(most[i].object));
        if (ImGui::Selectable(words.c_str(), state_.chosen == most[i].object)) wishes_.choose = most[i].object;
        if (i == 0) note("the one that hides most");
        showTip(words.c_str());
        ImGui::PopID();
    }
}

void Panels::show() {
    const bool open = ImGui::CollapsingHeader("show", ImGuiTreeNodeFlags_DefaultOpen);
    note("show");
    if (!open) return;
    ImGui::TextUnformatted("colours (V)");
    for (int i = 0; i < kColourings; ++i) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(kColourByNames[i], static_cast<int>(state_.colour_by) == i))
            state_.colour_by = static_cast<ColourBy>(i);
        note(kColourByNames[i]);
    }
    check("frustum of the frozen camera", state_.frustum);
    check("bounds of what is visible", state_.bounds);
    check("x-ray (X)", state_.x_ray);
    check("occlusion buffer", state_.buffer);
    showTip("The depths that occlusion asks: the nearer, the brighter; black is open.");
    check("shadow casters of a sun", state_.casters);
    if (state_.casters) {
        const CasterStats& stats = culler_.casterStats();
        const uint64_t left = stats.in_light - stats.beside - stats.behind - stats.in_shadow;
        ImGui::Text("%s of %s in its light; %.0f us", grouped(left).c_str(), grouped(stats.in_light).c_str(),
                    1e-3 * static_cast<double>(stats.nanoseconds));
    }
    if (culler_.hasCells()) {
        check("portals", state_.portals);
        showTip("Yellow: looked through. Cyan: others. Pink: doors.");
        if (facts_.knows_cells) {
            check("cells", state_.cells);
            showTip("White: the camera's. Green: those that are seen from there, through portals.");
        }
        check("windows of cells", state_.windows);
        cells();
    }
    ImGui::SliderInt("tree level", &state_.tree_level, -1, 12, state_.tree_level < 0 ? "none" : "%d");
    note("tree level");
    showTip("The boxes of a level of the hierarchy that the query descends.");
    check("ways of culling, side by side", state_.ways);
    showTip("What queries to the graphics card and other ways keep of the same view.");
    paint();
}

/// Of what is shown just now.
void Panels::legend() {
    const bool open = ImGui::CollapsingHeader("what colours mean");
    note("what colours mean");
    if (!open) return;
    const auto say = [](const glm::vec3& ink, const char* words) { ImGui::TextColored(inkOf(ink), "%s", words); };
    if (state_.colour_by == ColourBy::kAnswer) say(kVisible, "visible");
    if (state_.colour_by == ColourBy::kLevels)
        for (size_t level = 0; level < std::size(kLevelColours); ++level)
            say(kLevelColours[level], fmt::format("level of detail {}{}", level,
                                                  level == 0                              ? ", the finest"
                                                  : level + 1 == std::size(kLevelColours) ? " and coarser"
                                                                                          : "")
                                          .c_str());
    const bool boxes = (state_.frozen || state_.x_ray) && state_.culled_as != CulledAs::kNothing;
    for (int stage = 0; boxes && stage < kStageCount; ++stage)
        if (culler_.stats().stages[stage].culled > 0)
            say(stageColour(stage), fmt::format("culled by {}", kStageNames[stage]).c_str());
    if (state_.chosen) say(kChosen, "the chosen object");
    if (!state_.hiders.empty()) say(kHider, "hides it, and the shadow that does");
    if (state_.casters) say(kCaster, "may throw a shadow on what is visible");
    if (state_.frozen && state_.frustum) say(kFrustum, "the frozen camera's view");
    if (state_.bounds) say(kBounds, "bounds of what is visible");
    if (state_.tree_level >= 0) say(kTreeBox, "boxes of the hierarchy");
    if (state_.portals && culler_.hasCells()) {
        say(kSeenThrough, "portals that the camera sees through");
        say(kPortal, "other portals");
        say(kDoor, "portals of doors");
    }
    if (state_.cells) {
        say(kEyeCell, "the camera's cell");
        say(kSeenCell, "cells that are seen from there");
    }
    if (state_.clusters && state_.chosen)
        ImGui::TextUnformatted("clusters: each its own; grey: seen from its back; pink: a culling volume");
    if (state_.windows && !state_.frozen) ImGui::TextUnformatted("rectangles: windows that cells are seen through");
    ImGui::TextDisabled("all else: materials, or objects");
}

/// Where the eye is, and how far it sees from there.
void Panels::cells() const {
    const std::span<const SeenWindow> windows = culler_.windows();
    const auto isStart = [](const SeenWindow& window) { return window.from == SeenWindow::kNone; };
    const auto start = std::find_if(windows.begin(), windows.end(), isStart);
    if (start == windows.end()) return ImGui::TextUnformatted("no portals decide here");
    const auto starts = static_cast<size_t>(std::count_if(windows.begin(), windows.end(), isStart));
    const std::string others = starts > 1 ? fmt::format(" or {} more", starts - 1) : "";
    ImGui::Text("in cell %u%s, sees cells in %zu windows", start->cell, others.c_str(), windows.size());
}

/// The picture in the order of a BSP tree.
void Panels::paint() {
    check("paint by a BSP tree", state_.bsp);
    showTip("Without a depth buffer: pieces of the scene one over the other, the farthest first.");
    if (!facts_.bsp_problem.empty()) ImGui::TextWrapped("%s", facts_.bsp_problem.c_str());
    if (!state_.bsp || !facts_.painter) return;
    slide("painted", state_.bsp_part, 0, 1);
    if (press("paint anew")) {
        state_.bsp_part = 0;
        state_.bsp_plays = true;
    }
    ImGui::SameLine();
    ImGui::Text("%s of %s pieces", grouped(facts_.painter->drawn()).c_str(), grouped(facts_.painter->pieces()).c_str());
}

void Panels::cut() {
    if (!ImGui::CollapsingHeader("cut open")) return note("cut open");
    note("cut open");
    check("section", state_.section);
    if (!state_.section) return;
    for (int axis = 0; axis < 4; ++axis) {
        constexpr const char* kNames[] = {"x", "y", "z", "as I look"};
        if (axis > 0) ImGui::SameLine();
        if (ImGui::RadioButton(kNames[axis], state_.section_axis == axis)) {
            state_.section_axis = axis;
            state_.section_ahead = facts_.ahead;
        }
        note(kNames[axis]);
    }
    showTip("Across the direction in which the eye looks now. Click again to take a new one.");
    slide("at", state_.section_at, 0, 1);
    check("keep the upper part", state_.section_keeps_upper);
}

void Panels::path() {
    if (!ImGui::CollapsingHeader("path", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const size_t frames = facts_.path.frames.size();
    if (frames > 0) {
        int frame = static_cast<int>(facts_.path_frame);
        if (ImGui::SliderInt("frame", &frame, 0, static_cast<int>(frames) - 1))
            wishes_.go_to = static_cast<size_t>(frame);
        note("frame");
        check("play (P)", state_.playing);
        ImGui::SameLine();
    }
    check("record (R)", state_.recording);
    if (frames > 0 && press("save path")) wishes_.save_path = true;
    if (frames > 0) ImGui::SameLine();
    if (press("picture (F12)")) state_.wants_picture = true;
    ImGui::SameLine();
    if (press("record this frame")) wishes_.save_frame = true;
}

/// The slider of a door.
void Panels::door(size_t index, const char* words) {
    ViewerDoor& door = culler_.doors()[index];
    const char* const format = door.open <= 0 ? "shut" : door.open >= 1 ? "open" : "%.2f";
    ImGui::SetNextItemWidth(80);
    ImGui::SliderFloat(words, &door.open, 0, 1, format);
    note(words);
    if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return;
    state_.door = index;
    showTip(door.label.c_str());
}

/// The doors, those next to the eye first.
void Panels::doors() {
    std::vector<ViewerDoor>& doors = culler_.doors();
    state_.door.reset();
    if (doors.empty()) return;
    const bool open = ImGui::CollapsingHeader("doors");
    note("doors");
    if (!open) return;
    if (press("open all"))
        for (ViewerDoor& door : doors) door.open = 1;
    ImGui::SameLine();
    if (press("shut all"))
        for (ViewerDoor& door : doors) door.open = 0;
    std::vector<size_t> order(doors.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return glm::distance(doors[a].middle, facts_.eye) < glm::distance(doors[b].middle, facts_.eye);
    });
    for (size_t i = 0; i < std::min<size_t>(doors.size(), 200); ++i) {
        ImGui::PushID(static_cast<int>(order[i]));
        door(order[i], doors[order[i]].label.c_str());
        ImGui::PopID();
    }
}

/// Why an object is, or is not, in the answer.
void Panels::chosen() {
    const uint32_t object = *state_.chosen;
    const float width = static_cast<float>(facts_.width);
    ImGui::SetNextWindowPos({width - 388, 8}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({380, 420}, ImGuiCond_FirstUseEver);
    bool open = true;
    if (ImGui::Begin("chosen object", &open)) {
        const SceneObject& of = facts_.scene.objects[object];
        ImGui::TextWrapped("%s, key %llu, %s triangles", culler_.nameOf(object).c_str(),
                           static_cast<unsigned long long>(of.key),
                           grouped(facts_.scene.meshes[of.mesh].triangles()).c_str());
        ImGui::Separator();
        if (state_.why_is_old) ImGui::TextUnformatted("of an earlier view:");
        ImGui::TextWrapped("%s", state_.why.c_str());
        if (press("explain again")) wishes_.explain = true;
        ImGui::SameLine();
        if (press("look at it (Z)")) wishes_.look_at_chosen = true;
        ImGui::SameLine();
        check("isolate (I)", state_.isolate);
        if (!state_.outlines.empty()) check("the shadows that hide it", state_.shadows);
        clusters();
        for (size_t i = 0; i < culler_.doors().size(); ++i)
            if (culler_.doors()[i].object == object) door(i, "this door");
        if (culler_.knowsHidesMost())
            for (const HidesMost& most : culler_.hidesMost())
                if (most.object == object) ImGui::Text("hides %.1f objects", most.hidden);
        if (!state_.hiders.empty()) ImGui::TextUnformatted("hidden by, in orange:");
        for (size_t i = 0; i < std::min<size_t>(state_.hiders.size(), 12); ++i) {
            ImGui::PushID(static_cast<int>(i));  // several may have one name
            if (ImGui::Selectable(culler_.nameOf(state_.hiders[i]).c_str())) wishes_.choose = state_.hiders[i];
            ImGui::PopID();
        }
    }
    ImGui::End();
    if (!open) wishes_.let_go = true;
}

/// The clusters of its triangles, and the culling volume of one.
void Panels::clusters() {
    check("its clusters", state_.clusters);
    showTip(
        "The runs of triangles that are culled together, each in a colour; grey: the culling camera sees them from "
        "their backs.");
    if (!state_.clusters || !facts_.clusters) return;
    const size_t with_backs = facts_.clusters->withBacks();
    ImGui::Text("%s of %s are seen from their backs", grouped(facts_.clusters_back).c_str(),
                grouped(facts_.clusters->count()).c_str());
    if (with_backs == 0) return;
    ImGui::SliderInt("culling volume", &state_.cluster, -1, static_cast<int>(with_backs) - 1,
                     state_.cluster < 0 ? "none" : "%d");
    note("culling volume");
    showTip(
        "Of one cluster, in pink: an eye in there sees all of it from its back. Freeze the camera and go around to see "
        "it.");
}

void Panels::times() const {
    if (!facts_.times) return;
    if (!ImGui::CollapsingHeader("times")) return;
    const auto plot = [](const char* words, std::span<const float> values, const char* unit) {
        const float most = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
        const std::string over = fmt::format("{}: mean {:.1f}, most {:.1f} {}", words, meanOf(values), most, unit);
        ImGui::PlotLines(("##" + std::string(words)).c_str(), values.data(), static_cast<int>(values.size()), 0,
                         over.c_str(), 0, std::max(most * 1.1f, 0.1f), {-1, 50});
    };
    plot("query", facts_.query_microseconds, "us");
    plot("frame", facts_.frame_milliseconds, "ms");
}

/// What cells are seen through, over the image.
void Panels::windows() const {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const SeenWindow& window : culler_.windows())
        list.AddRect({static_cast<float>(window.rect.left), static_cast<float>(window.rect.top)},
                     {static_cast<float>(window.rect.right), static_cast<float>(window.rect.bottom)},
                     IM_COL32(80, 230, 230, 200), 0, 0, 1.5f);
}

/// The occlusion buffer, the nearer the brighter.
void Panels::buffer() {
    const Query::DepthImage image = culler_.depthImage();
    if (image.width == 0) {
        if (ImGui::Begin("occlusion buffer", &state_.buffer, ImGuiWindowFlags_AlwaysAutoResize))
            ImGui::TextUnformatted("certificates answered: nothing was drawn");
        return ImGui::End();
    }
    constexpr float kWidth = 384;
    const float scale = kWidth / static_cast<float>(image.width);
    ImGui::SetNextWindowPos({static_cast<float>(facts_.width) - kWidth - 24,
                             static_cast<float>(facts_.height) - scale * static_cast<float>(image.height) - 48},
                            ImGuiCond_FirstUseEver);
    if (ImGui::Begin("occlusion buffer", &state_.buffer, ImGuiWindowFlags_AlwaysAutoResize)) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImDrawList& list = *ImGui::GetWindowDrawList();
        double nearest = 0;
        for (size_t i = 0; i < image.nearness.size(); ++i)
            if (image.covered[i]) nearest = std::max(nearest, static_cast<double>(image.nearness[i]));
        // Runs of one brightness, in rows two pixels high: some thousand rectangles at most.
        for (uint32_t y = 0; y < image.height; y += 2) {
            const size_t line = size_t{image.height - 1 - y} * image.width;
            const auto shade = [&](uint32_t x) {
                if (!image.covered[line + x]) return 0;
                const double part = nearest > 0 ? static_cast<double>(image.nearness[line + x]) / nearest : 1;
                return 30 + 15 * static_cast<int>(14.99 * std::sqrt(std::clamp(part, 0.0, 1.0)));
            };
            for (uint32_t x = 0; x < image.width;) {
                const int of = shade(x);
                uint32_t end = x + 1;
                while (end < image.width && shade(end) == of) ++end;
                if (of > 0)
                    list.AddRectFilled(
                        {at.x + scale * static_cast<float>(x), at.y + scale * static_cast<float>(y)},
                        {at.x + scale * static_cast<float>(end), at.y + scale * static_cast<float>(y + 2)},
                        IM_COL32(of, of, of, 255));
                x = end;
            }
        }
        ImGui::Dummy({kWidth, scale * static_cast<float>(image.height)});
    }
    ImGui::End();
}

void Panels::keys() {
    if (!ImGui::CollapsingHeader("keys")) return note("keys");
    note("keys");
    ImGui::TextWrapped(
        "W A S D fly, Q E down and up, Shift faster, wheel: speed. Drag: look. Middle button or Alt and drag: turn "
        "around "
        "the scene or the chosen object. Click: choose. F freeze, C culled, V colours, X x-ray, I isolate, Z look at "
        "it, "
        "P play, R record, H hide the panels, Home: the whole scene, F12 picture, Esc: let go, then quit.");
}

}  // namespace

void notePlace(PanelPlaces& places, const std::string& words) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places[words] = {low.x, low.y, high.x, high.y};
}

void showTip(const char* words) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360);
    ImGui::TextUnformatted(words);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

PanelWishes drawPanels(const PanelFacts& facts, ViewerState& state, Culler& culler, PanelPlaces& places) {
    return Panels(facts, state, culler, places).draw();
}

}  // namespace sightline::viewer
