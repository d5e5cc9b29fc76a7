// Layered depth images: several reference images in one, so that what one of them does not see is not a hole.
// SPDX-License-Identifier: MIT
#include "sightline/images/layered_image.h"

#include <algorithm>
#include <cmath>

namespace sightline::images {
namespace {

/// The pixels of the layered image as they fill.
class Layers {
public:
    Layers(const View& view, const LayerSettings& settings)
        : width_(view.width),
          height_(view.height),
          settings_(settings),
          pixels_(size_t{view.width} * view.height),
          seen_by_eye_(pixels_.size(), 0) {}

    void add(const DepthImage& reference, const View& view) {
        const WarpMap map(reference.view, view);
        if (added_++ == 0) same_eye_ = eyePosition(reference.view) == eyePosition(view);
        for (uint32_t row = 0; row < reference.view.height; ++row)
            for (uint32_t i = 0; i < reference.view.width; ++i)
                add(map, i, row, reference.samples[size_t{row} * reference.view.width + i]);
    }

    LayeredImage finish(const View& view) {
        LayeredImage out;
        out.view = view;
        out.first.reserve(pixels_.size() + 1);
        for (std::vector<DepthSample>& pixel : pixels_) {
            out.first.push_back(static_cast<uint32_t>(out.samples.size()));
            std::stable_sort(pixel.begin(), pixel.end(),
                             [](const DepthSample& a, const DepthSample& b) { return a.nearness < b.nearness; });
            out.samples.insert(out.samples.end(), pixel.begin(), pixel.end());
        }
        out.first.push_back(static_cast<uint32_t>(out.samples.size()));
        return out;
    }

private:
    void add(const WarpMap& map, uint32_t i, uint32_t row, const DepthSample& sample) {
        const glm::dvec3 middle = map.at(i, row, sample.nearness);
        if (!(middle.z > 0)) return;
        const glm::dvec3 along = 0.5 * (map.turn[0] + double{sample.per_sample} * map.shift);
        const glm::dvec3 up = 0.5 * (map.turn[1] + double{sample.per_row} * map.shift);
        const glm::dvec2 centre = glm::dvec2(middle) / middle.z, reach(0.5 * settings_.most_stretch);
        glm::dvec2 low = centre, high = centre;
        for (const double a : {-1.0, 1.0})
            for (const double b : {-1.0, 1.0}) {
                const glm::dvec3 corner = middle + a * along + b * up;
                if (!(corner.z > 0.1 * middle.z)) continue;
                low = glm::min(low, glm::dvec2(corner) / corner.z);
                high = glm::max(high, glm::dvec2(corner) / corner.z);
            }
        low = glm::max(glm::ceil(glm::max(low, centre - reach) - 1e-6), glm::dvec2(0.0));
        high = glm::min(glm::floor(glm::min(high, centre + reach) + 1e-6), glm::dvec2(width_ - 1.0, height_ - 1.0));
        const glm::dvec3 here = planeOf(sample, i, row), plane = map.planeThere(here);
        const bool faces = map.sees(sample, i, row);
        const double most = 4 * sample.nearness / middle.z;
        for (double y = low.y; y <= high.y; ++y)
            for (double x = low.x; x <= high.x; ++x) {
                const double nearness = glm::dot(plane, glm::dvec3(x, y, 1));
                if (sample.nearness > 0 && !(nearness > 0 && nearness <= most)) continue;
                DepthSample moved = sample;
                moved.nearness = static_cast<float>(std::max(0.0, nearness));
                moved.per_sample = static_cast<float>(plane.x);
                moved.per_row = static_cast<float>(plane.y);
                moved.from_behind = faces ? 0 : 1;
                place(static_cast<size_t>(y) * width_ + static_cast<size_t>(x), moved, faces);
            }
    }

    void place(size_t at, const DepthSample& sample, bool faces) {
        std::vector<DepthSample>& pixel = pixels_[at];
        const auto tolerance = static_cast<float>(settings_.tolerance);
        // No front stands before what an image of the same eye saw: this is the rim of something beside it.
        if (faces && seen_by_eye_[at] && added_ > 1 && sample.nearness > pixel[0].nearness) return;
        for (const DepthSample& there : pixel)
            if (std::abs(there.nearness - sample.nearness) <= tolerance * std::max(there.nearness, sample.nearness))
                return;
        if (pixel.size() >= settings_.most_layers) return;
        pixel.push_back(sample);
        if (same_eye_ && added_ == 1) seen_by_eye_[at] = 1;
    }

    uint32_t width_, height_;
    LayerSettings settings_;
    uint32_t added_ = 0;     ///< references
    bool same_eye_ = false;  ///< the first one's is the view's
    std::vector<std::vector<DepthSample>> pixels_;
    std::vector<uint8_t> seen_by_eye_;  ///< per pixel: its first sample is of such a reference
};

}  // namespace

uint32_t LayeredImage::mostLayers() const {
    uint32_t most = 0;
    for (size_t i = 1; i < first.size(); ++i) most = std::max(most, first[i] - first[i - 1]);
    return most;
}

LayeredImage layeredImage(std::span<const DepthImage> references, const View& view, const LayerSettings& settings) {
    Layers layers(view, settings);
    for (const DepthImage& reference : references) layers.add(reference, view);
    return layers.finish(view);
}

}  // namespace sightline::images
