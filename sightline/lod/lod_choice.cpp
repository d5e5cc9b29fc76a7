// Which level of detail an object needs: by the size of its error in the image, steady under noise, faded from one to the next.
// SPDX-License-Identifier: MIT
#include "sightline/lod/lod_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sightline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The coarsest level whose error is at most so large; an error that is not a number is not.
uint8_t coarsestWithin(std::span<const LodLevel> levels, double pixels_of_unit, double error) {
    for (size_t level = std::min<size_t>(levels.size(), kMostLods); level-- > 1;)
        if (levels[level].error * pixels_of_unit <= error) return static_cast<uint8_t>(level);
    return 0;
}

/// With a fade a finer level comes in before the error is reached, so that the coarser one may be faded out in time.
double leavesAt(const LodRule& rule) { return rule.error * (rule.fade > 0 ? 1.0 - 0.5 * rule.hysteresis : 1.0); }

}  // namespace

LodMeasure makeLodMeasure(const View& view) {
    LodMeasure measure;
    measure.perspective = !isOrthographic(view);
    measure.eye = eyePosition(view);
    measure.toward = -glm::dvec3(view.view[0][2], view.view[1][2], view.view[2][2]);
    measure.viewport = static_cast<double>(view.width) * view.height;
    const glm::dmat4& p = view.projection;
    // What both axes make of a unit: half a viewport for a step of one in normalised coordinates.
    const double x = 0.5 * view.width * std::hypot(p[0][0], p[1][0]),
                 y = 0.5 * view.height * std::hypot(p[0][1], p[1][1]);
    const double w = measure.perspective ? std::abs(p[2][3]) : std::abs(p[3][3]);
    measure.pixels = std::max(x, y) / w;
    return measure;
}

double cornerStretch(const View& view) {
    if (isOrthographic(view)) return 1.0;
    const glm::dmat4 back = glm::inverse(view.projection);
    double most = 1.0;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            const glm::dvec4 at = back * glm::dvec4(x, y, 0.0, 1.0);
            const double across = (at.x * at.x + at.y * at.y) / (at.z * at.z);
            most = std::max(most, 1.0 + across);
        }
    return most;
}

double pixelsOfUnit(const LodMeasure& measure, const Box3d& box) {
    if (!measure.perspective) return measure.pixels;
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double away = std::max({box.min[axis] - measure.eye[axis], measure.eye[axis] - box.max[axis], 0.0});
        square += away * away;
    }
    return square > 0.0 ? measure.pixels / std::sqrt(square) : kInfinity;
}

double pixelsOfBox(const LodMeasure& measure, const Box3d& box) {
    const glm::dvec3 half = 0.5 * (box.max - box.min), centre = box.min + half - measure.eye;
    const double radius = glm::dot(half, half);
    const double disk = std::numbers::pi * measure.pixels * measure.pixels * radius;
    if (!measure.perspective) return std::min(disk, measure.viewport);
    const double beyond = glm::dot(centre, centre) - radius;
    return beyond > 0.0 ? std::min(disk / beyond, measure.viewport) : measure.viewport;
}

LodRange lodRange(std::span<const LodLevel> levels, double pixels_of_unit, const LodRule& rule, bool remembers) {
    LodRange range;
    range.coarsest = coarsestWithin(levels, pixels_of_unit, remembers ? leavesAt(rule) : rule.error);
    range.finest =
        remembers ? coarsestWithin(levels, pixels_of_unit, rule.error * (1.0 - rule.hysteresis)) : range.coarsest;
    return range;
}

LodState nextState(const LodState& last, uint8_t target, std::span<const LodLevel> levels, double pixels_of_unit,
                   const LodRule& rule) {
    const auto errs = [&](uint8_t level) { return level > 0 && !(levels[level].error * pixels_of_unit <= rule.error); };
    LodState state = last;
    if (state.left > 0) --state.left;
    const bool late = target < state.level && errs(state.level);
    if (late || (state.left > 0 && target < state.from && errs(state.from))) return {target, target, 0};
    if (state.left > 0) return state;
    if (target == state.level) return {target, target, 0};
    const auto fade = static_cast<uint8_t>(std::min(rule.fade, kLongestFade));
    return {target, fade > 0 ? state.level : target, fade};
}

VisibleLod visibleLod(const LodState& state, std::span<const LodLevel> levels, double pixels_of_unit,
                      const LodRule& rule) {
    VisibleLod lod;
    lod.level = state.level;
    lod.from = state.left > 0 ? state.from : state.level;
    lod.fade = 1.0f;
    if (state.left > 0)
        lod.fade = 1.0f - static_cast<float>(state.left) / static_cast<float>(std::min(rule.fade, kLongestFade) + 1);
    const size_t next = size_t{state.level} + 1;
    if (next >= levels.size() || next >= kMostLods) return lod;
    // The morph is over where the next level may be drawn. It begins no sooner than where this one has replaced a finer
    // one, and late enough that both errors, in the shares of the morph, stay within the rule's.
    const double error = levels[next].error * pixels_of_unit;
    const double own = levels[state.level].error;
    const double begin = own > 0.0 ? rule.error * std::min(2.0 - own / levels[next].error,
                                                           levels[next].error / own * (1.0 - rule.hysteresis))
                                   : 2.0 * rule.error;
    if (error <= rule.error) lod.morph = 1.0f;
    else if (error < begin) lod.morph = static_cast<float>((begin - error) / (begin - rule.error));
    return lod;
}

}  // namespace sightline
