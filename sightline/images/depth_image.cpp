// Reference images: colour and depth of each sample, with the slope of its surface, ready to be warped into other views.
// SPDX-License-Identifier: MIT
#include "sightline/images/depth_image.h"

#include <algorithm>
#include <cmath>

namespace sightline::images {
using namespace studies;
namespace {

/// Nearness over the samples of a plane that passes the eye's space at `normal` . p = `offset`: a sample's direction d has
/// w = offset / (normal . d), and d is affine in the sample and the row.
void setPlane(const Unprojection& unprojection, const glm::dvec3& normal, double offset, uint32_t row, uint32_t sample,
              DepthSample& out) {
    const auto nearnessAt = [&](double i, double j) {
        return glm::dot(normal, unprojection.lineOfSight(i, j).direction) / offset;
    };
    const double here = nearnessAt(sample, row);
    out.nearness = static_cast<float>(here);
    out.per_sample = static_cast<float>(nearnessAt(sample + 1.0, row) - here);
    out.per_row = static_cast<float>(nearnessAt(sample, row + 1.0) - here);
}

}  // namespace

DepthImage takeImage(const DrawList& list, const View& view, const TakeSettings& settings) {
    DepthImage out;
    out.view = view;
    const HiddenImage image = render(list, view, settings.render);
    const std::vector<glm::u8vec3> colours = shade(list, view, image, settings.shade);
    const SurfacePoints points(list, view);
    const Unprojection unprojection(view, view.width, view.height);
    const glm::dmat3 to_eye(view.view);
    out.samples.resize(image.surface.size());
    shareOut(settings.shade.share, view.height, [&](size_t row) {
        for (uint32_t i = 0; i < view.width; ++i) {
            const size_t at = row * view.width + i;
            DepthSample& sample = out.samples[at];
            sample.colour = colours[at];
            if (image.surface[at] == HiddenImage::kNone) continue;
            const SurfacePoint point = points.at(static_cast<uint32_t>(row), i, image.surface[at]);
            const glm::dvec3 position = to_eye * point.position, normal = to_eye * point.normal;
            const double offset = glm::dot(normal, position);
            // A triangle that is seen edge-on, or that has no area, has no slope worth keeping.
            if (std::abs(offset) > 1e-9 * glm::length(position))
                setPlane(unprojection, normal, offset, static_cast<uint32_t>(row), i, sample);
            const glm::dvec4 clip = view.projection * glm::dvec4(position, 1.0);
            if (!(sample.nearness > 0)) sample = {static_cast<float>(1 / clip.w), 0, 0, sample.colour, 0};
        }
    });
    return out;
}

ColourImage takeColours(const DrawList& list, const View& view, const TakeSettings& settings, uint32_t across) {
    View fine = view;
    fine.width *= across;
    fine.height *= across;
    const HiddenImage image = render(list, fine, settings.render);
    const std::vector<glm::u8vec3> samples = shade(list, fine, image, settings.shade);
    ColourImage out;
    out.has_sky = std::find(image.surface.begin(), image.surface.end(), HiddenImage::kNone) != image.surface.end();
    out.colours.reserve(size_t{view.width} * view.height);
    for (uint32_t row = 0; row < view.height; ++row)
        for (uint32_t i = 0; i < view.width; ++i) {
            glm::uvec3 sum(across * across / 2);
            for (uint32_t y = 0; y < across; ++y)
                for (uint32_t x = 0; x < across; ++x)
                    sum += glm::uvec3(samples[size_t{row * across + y} * fine.width + i * across + x]);
            out.colours.emplace_back(sum / (across * across));
        }
    return out;
}

}  // namespace sightline::images
