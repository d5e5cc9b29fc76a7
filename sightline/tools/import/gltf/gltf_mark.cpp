// What a node says of itself: that it is a cell or a portal.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_mark.h"

#include <string_view>

namespace sightline::tools::gltf {
namespace {

/// The rest of a name behind `cell.` and the like; empty: it is none of these.
std::string_view behind(std::string_view name, std::string_view word) {
    if (!name.starts_with(word) || name.size() < word.size() + 2) return {};
    if (name[word.size()] != '.' && name[word.size()] != ':') return {};
    name.remove_prefix(word.size() + 1);
    return name.find_first_not_of("0123456789") == name.npos ? std::string_view() : name;
}

void readBox(const Json& json, NodeMark& mark, const std::string& place) {
    const Json* ends = find(json, "box");
    if (!ends) return;
    if (!ends->is_array() || ends->size() != 2) fail(place, "box is not two corners");
    double corners[2][3];
    for (size_t i = 0; i < 2; ++i) {
        const Json corner = {{"box", (*ends)[i]}};
        numbers(corner, "box", corners[i], place);
    }
    mark.box.emplace();
    for (const auto& corner : corners) mark.box->grow({corner[0], corner[1], corner[2]});
}

void readPortal(const Json& json, size_t nodes, NodeMark& mark, const std::string& place) {
    if (const Json* cells = find(json, "cells")) {
        if (!cells->is_array() || cells->size() != 2) fail(place, "cells are not two names");
        for (size_t i = 0; i < 2; ++i) {
            if (!(*cells)[i].is_string()) fail(place, "cells are not two names");
            mark.cells[i] = (*cells)[i].get<std::string>();
        }
    }
    if (const Json* door = find(json, "door")) {
        if (door->is_string()) mark.door = door->get<std::string>();
        else mark.door_node = index(json, "door", nodes, place);
    }
    double slide[3] = {0, 0, 0};
    numbers(json, "slide", slide, place);
    mark.slide = {slide[0], slide[1], slide[2]};
}

}  // namespace

std::optional<NodeMark> readMark(const Json& node, const std::string& name, size_t nodes, const std::string& place) {
    NodeMark mark;
    const Json* extras = find(node, "extras");
    const Json* json = extras && extras->is_object() ? find(*extras, "sightline") : nullptr;
    if (json) {
        const std::string inner = place + ".extras.sightline";
        if (!json->is_object()) fail(inner, "is not an object");
        const bool cell = json->contains("cell"), portal = json->contains("portal");
        if (cell == portal) fail(inner, "is neither a cell nor a portal, or both");
        mark.kind = cell ? NodeMark::Kind::kCell : NodeMark::Kind::kPortal;
        mark.name = text(*json, cell ? "cell" : "portal", inner);
        readBox(*json, mark, inner);
        if (portal) readPortal(*json, nodes, mark, inner);
        return mark;
    }
    const std::string_view cell = behind(name, "cell"), portal = behind(name, "portal");
    if (cell.empty() && portal.empty()) return std::nullopt;
    mark.kind = portal.empty() ? NodeMark::Kind::kCell : NodeMark::Kind::kPortal;
    mark.name = portal.empty() ? cell : portal;
    return mark;
}

}  // namespace sightline::tools::gltf
