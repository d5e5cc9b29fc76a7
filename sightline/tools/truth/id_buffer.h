// The id-buffer witness: the frame drawn by the reference renderer, supersampled and shifted by a seeded jitter.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {
using namespace studies;

/// Objects as the reference renderer draws them; DrawItem::id is the place in the list. The facts must outlive them.
std::vector<DrawItem> drawItems(const SceneFacts& facts, const std::vector<uint32_t>& objects);

struct IdBufferSettings {
    uint32_t supersampling = 4;        ///< samples per pixel and axis  [>= 1]
    uint64_t seed = 1;                 ///< of the shift, within one sample
    uint64_t band_samples = 1u << 24;  ///< drawn at once: 12 bytes each
    std::function<bool()> stop = {};   ///< asked now and then; true: end, without the rest of the bands. May be empty
};

/// Draws the objects whose boxes meet the frustum and calls seen(object, place) for each one that the image
/// shows: at least once, at most once per band. The place is in clip x, y over w.
/// @return samples drawn; of one that was stopped, of the bands that were finished
uint64_t drawIdBuffer(const SceneFacts& facts, const View& view, const SightLines& sight,
                      const IdBufferSettings& settings, const std::function<void(uint32_t, const glm::dvec2&)>& seen);

}  // namespace sightline::tools
