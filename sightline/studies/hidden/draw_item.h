// What is drawn: meshes of somebody else, placed and numbered.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"

namespace sightline::studies {

/// One mesh to draw. Single-sided back faces are not drawn.
struct DrawItem {
    MeshView mesh;
    std::span<const uint8_t> double_sided;  ///< per triangle [size: triangles, or empty for none]
    std::span<const uint8_t> writes_depth;  ///< per triangle: 0 is seen but hides nothing, as blended ones
                                            ///< [size: triangles, or empty for all]
    glm::dmat4 transform{1.0};              ///< object to world
    uint32_t id = 0;
};

/// Items whose triangles are numbered through: the surfaces. Surface numbers are the order in which things are drawn.
class DrawList {
public:
    explicit DrawList(std::span<const DrawItem> items) : items_(items) {
        first_.reserve(items.size() + 1);
        first_.push_back(0);
        for (const DrawItem& item : items)
            first_.push_back(first_.back() + static_cast<uint32_t>(item.mesh.triangles()));
    }

    std::span<const DrawItem> items() const { return items_; }
    uint32_t surfaces() const { return first_.back(); }
    uint32_t firstSurface(size_t item) const { return first_[item]; }

    struct Place {
        uint32_t item = 0, triangle = 0;
    };
    Place placeOf(uint32_t surface) const {
        const auto next = std::upper_bound(first_.begin(), first_.end(), surface);
        const uint32_t item = static_cast<uint32_t>(next - first_.begin()) - 1;
        return {item, surface - first_[item]};
    }
    /// DrawItem::id of a surface's item.
    uint32_t idOf(uint32_t surface) const { return items_[placeOf(surface).item].id; }

private:
    std::span<const DrawItem> items_;
    std::vector<uint32_t> first_;  ///< [size: items + 1]
};

}  // namespace sightline::studies
