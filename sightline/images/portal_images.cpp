// Portal images: the far side of a doorway as pictures, baked from sample points and shown to other eyes.
// SPDX-License-Identifier: MIT
#include "sightline/images/portal_images.h"

#include <algorithm>
#include <cmath>

namespace sightline::images {
namespace {

/// The eyes whose images a mode mixes, or the one that it is made for.
std::vector<glm::dvec3> eyesOf(const PortalImages& images, const SampleWeights& weights, ShowMode mode,
                               const glm::dvec3& eye) {
    if (mode == ShowMode::kWarped || mode == ShowMode::kLayered) return {eye};
    std::vector<glm::dvec3> eyes;
    const uint32_t count = mode == ShowMode::kNearest ? 1 : weights.count;
    for (uint32_t k = 0; k < count; ++k) eyes.push_back(images.fan.eyes[weights.sample[k]]);
    return eyes;
}

double halfTexel(const PortalImages& images) {
    return 0.5 * std::hypot(images.frame.width / images.width, images.frame.height / images.height);
}

void blend(const PortalImages& images, const SampleWeights& weights, std::vector<glm::u8vec3>& out) {
    const std::vector<glm::u8vec3>& first = images.images[weights.sample[0]];
    out = first;
    if (weights.count == 1) return;
    for (size_t i = 0; i < out.size(); ++i) {
        glm::dvec3 sum(0.5);
        for (uint32_t k = 0; k < weights.count; ++k)
            sum += weights.weight[k] * glm::dvec3(images.images[weights.sample[k]][i]);
        out[i] = glm::u8vec3(glm::min(sum, glm::dvec3(255.0)));
    }
}

/// Nearest first: those with weights, and then the others.
std::vector<uint32_t> referencesFor(const PortalImages& images, const SampleWeights& weights, const glm::dvec3& eye,
                                    uint32_t most) {
    const std::vector<glm::dvec3>& eyes = images.reference_fan.eyes;
    std::vector<uint32_t> order(weights.sample, weights.sample + weights.count);
    std::vector<uint32_t> others;
    for (uint32_t i = 0; i < eyes.size(); ++i)
        if (std::find(order.begin(), order.end(), i) == order.end()) others.push_back(i);
    std::stable_sort(others.begin(), others.end(),
                     [&](uint32_t a, uint32_t b) { return glm::length(eyes[a] - eye) < glm::length(eyes[b] - eye); });
    order.insert(order.end(), others.begin(), others.end());
    if (order.size() > most) order.resize(std::max<size_t>(1, most));
    return order;
}

void carry(const PortalImages& images, const SampleWeights& weights, const glm::dvec3& eye,
           const ShowSettings& settings, PortalPicture& picture) {
    const View view = *portalView(images.frame, eye, images.width, images.height);
    WarpedImage image(view);
    if (settings.mode == ShowMode::kLayered) {
        const LayeredImage& from = images.layered[weights.sample[0]];
        warp(from.view, from.lists(), view, image, settings.warp);
    } else {
        const std::vector<uint32_t> order = referencesFor(images, weights, eye, settings.most_references);
        for (uint32_t k = 0; k < order.size() && (k < weights.count || image.holes() > 0); ++k) {
            WarpedImage other(view);
            warp(images.references[order[k]], view, other, settings.warp);
            if (k == 0) image = std::move(other);
            else mergeInto(image, other);
        }
    }
    picture.holes = fillHoles(image);
    picture.colour = std::move(image.colour);
}

bool isBaked(const PortalImages& images, ShowMode mode) {
    switch (mode) {
        case ShowMode::kNearest:
        case ShowMode::kBlended:
            return !images.images.empty();
        case ShowMode::kWarped:
            return !images.references.empty();
        case ShowMode::kLayered:
            return !images.layered.empty();
    }
    return false;
}

const SampleFan& fanOf(const PortalImages& images, ShowMode mode) {
    if (mode == ShowMode::kWarped) return images.reference_fan;
    return mode == ShowMode::kLayered ? images.layered_fan : images.fan;
}

}  // namespace

Displacement pictureError(const PortalImages& images, const PortalPicture& picture, const glm::dvec3& eye,
                          double focal) {
    Displacement most;
    for (const glm::dvec3& from : picture.taken_from) {
        const Displacement one = displacementBound(images.frame, from, eye, images.beyond, focal);
        most.on_plane = std::max(most.on_plane, one.on_plane);
        most.pixels = std::max(most.pixels, one.pixels);
        most.exposed = std::max(most.exposed, one.exposed);
    }
    if (picture.rounding > 0) {
        most.on_plane += picture.rounding;
        most.pixels += picture.rounding * focal / images.frame.toFrame(eye).z;
    }
    return most;
}

Shown showPortal(const PortalImages& images, const glm::dvec3& eye, const ShowSettings& settings,
                 PortalPicture& picture) {
    Shown shown;
    shown.place = eyePlace(images.frame, eye);
    if (shown.place != EyePlace::kBefore) {
        shown.result = ShowResult::kEye;
        return shown;
    }
    if (!isBaked(images, settings.mode)) return shown;
    if (settings.reuse && !picture.taken_from.empty() && picture.mode == settings.mode) {
        shown.error = pictureError(images, picture, eye, settings.focal);
        shown.result = ShowResult::kReused;
        if (shown.error.pixels <= settings.most_error) return shown;
    }
    const SampleFan& fan = fanOf(images, settings.mode);
    const SampleWeights weights = nearestSamples(fan, eye);
    const bool carried = settings.mode == ShowMode::kWarped || settings.mode == ShowMode::kLayered;
    PortalPicture next;
    next.width = images.width;
    next.height = images.height;
    next.mode = settings.mode;
    next.taken_from = eyesOf(images, weights, settings.mode, eye);
    next.rounding = carried ? halfTexel(images) : 0;
    shown.error = pictureError(images, next, eye, settings.focal);
    if (carried)
        shown.exposed =
            displacementBound(images.frame, fan.eyes[weights.sample[0]], eye, images.beyond, settings.focal).exposed;
    shown.result = ShowResult::kTooFarOff;
    if (!(shown.error.pixels <= settings.most_error)) return shown;
    shown.result = ShowResult::kShown;
    if (settings.mode == ShowMode::kNearest) next.colour = images.images[weights.sample[0]];
    else if (settings.mode == ShowMode::kBlended) blend(images, weights, next.colour);
    else carry(images, weights, eye, settings, next);
    picture = std::move(next);
    return shown;
}

}  // namespace sightline::images
