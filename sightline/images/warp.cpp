// Carries reference images into another view, far samples before near ones, so that no depth need be compared.
// SPDX-License-Identifier: MIT
#include "sightline/images/warp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::images {
namespace {

/// Of a view: (i, j, 1) samples to a direction in the world, for which w is 1, and back to (i, j, 1) times w.
struct Pinhole {
    glm::dmat3 to_world{1.0}, to_samples{1.0};
    glm::dvec3 eye{0.0};

    explicit Pinhole(const View& view) {
        const glm::dmat4& p = view.projection;
        glm::dmat3 rows;
        for (int column = 0; column < 3; ++column) rows[column] = glm::dvec3(p[column][0], p[column][1], p[column][3]);
        // Clip x / w is 2 (i + 0.5) / width - 1.
        const double x = 0.5 * view.width, y = 0.5 * view.height;
        const glm::dmat3 of_clip(glm::dvec3(x, 0, 0), glm::dvec3(0, y, 0), glm::dvec3(x - 0.5, y - 0.5, 1));
        to_samples = of_clip * rows * glm::dmat3(view.view);
        to_world = glm::inverse(to_samples);
        eye = eyePosition(view);
    }
};

/// All of [0, count), towards a place or away from it: what lies before it rising, what lies behind it falling.
std::vector<uint32_t> towards(double place, uint32_t count, bool away) {
    std::vector<uint32_t> order;
    order.reserve(count);
    const auto split = static_cast<uint32_t>(std::clamp(std::ceil(place), 0.0, static_cast<double>(count)));
    for (uint32_t i = 0; i < split; ++i) order.push_back(i);
    for (uint32_t i = count; i > split; --i) order.push_back(i - 1);
    if (away) std::reverse(order.begin(), order.end());
    return order;
}

/// Where one sample comes to lie: a rectangle of the new image.
struct Splat {
    float low[2], high[2];
    float nearness = WarpedImage::kHole;  ///< kHole: not to be drawn
};

/// Closes the gap between the splats of two neighbours, if it is small and they may be of one surface: they meet in its
/// middle. Where one stands before the other, the gap is what was hidden.
void closeGap(Splat& a, Splat& b, float most) {
    constexpr float kOneSurface = 1.1f;
    if (a.nearness > kOneSurface * b.nearness || b.nearness > kOneSurface * a.nearness) return;
    for (int axis = 0; axis < 2; ++axis) {
        const float after = b.low[axis] - a.high[axis], before = a.low[axis] - b.high[axis];
        if (after > 0 && after <= most) a.high[axis] = b.low[axis] = a.high[axis] + 0.5f * after;
        if (before > 0 && before <= most) a.low[axis] = b.high[axis] = b.high[axis] + 0.5f * before;
    }
}

class Warper {
public:
    Warper(const View& from, const SampleLists& lists, const View& to, WarpedImage& image, const WarpSettings& settings)
        : map_(from, to),
          lists_(lists),
          width_(from.width),
          height_(from.height),
          image_(image),
          settings_(settings),
          splats_(lists.samples.size()) {}

    void run(const WarpOrder& order) {
        for (uint32_t row = 0; row < height_; ++row)
            for (uint32_t i = 0; i < width_; ++i)
                for (uint32_t k = begin(row, i); k < end(row, i); ++k) splats_[k] = splatOf(i, row, lists_.samples[k]);
        for (uint32_t row = 0; row < height_; ++row)
            for (uint32_t i = 0; i < width_; ++i) {
                if (i + 1 < width_) meet(row, i, row, i + 1);
                if (row + 1 < height_) meet(row, i, row + 1, i);
            }
        for (const uint32_t row : order.rows)
            for (const uint32_t i : order.columns)
                for (uint32_t k = begin(row, i); k < end(row, i); ++k)
                    if (splats_[k].nearness >= 0) draw(splats_[k], lists_.samples[k].colour);
    }

private:
    uint32_t begin(uint32_t row, uint32_t i) const {
        const size_t at = size_t{row} * width_ + i;
        return lists_.first.empty() ? static_cast<uint32_t>(at) : lists_.first[at];
    }
    uint32_t end(uint32_t row, uint32_t i) const {
        const size_t at = size_t{row} * width_ + i;
        return lists_.first.empty() ? static_cast<uint32_t>(at) + 1 : lists_.first[at + 1];
    }

    Splat splatOf(uint32_t i, uint32_t row, const DepthSample& sample) const {
        Splat out{};
        const glm::dvec3 middle = map_.at(i, row, sample.nearness);
        if (!(middle.z > 0) || !map_.sees(sample, i, row)) return out;
        // The derivatives of x / z and y / z along a row and a column, over the sample's plane.
        const double scale = 1 / middle.z;
        const glm::dvec2 centre = scale * glm::dvec2(middle);
        const glm::dvec3 along = map_.turn[0] + double{sample.per_sample} * map_.shift;
        const glm::dvec3 up = map_.turn[1] + double{sample.per_row} * map_.shift;
        const glm::dvec2 by_sample = glm::dvec2(along) - along.z * centre, by_row = glm::dvec2(up) - up.z * centre;
        const glm::dvec2 half =
            glm::min(0.5 * scale * (glm::abs(by_sample) + glm::abs(by_row)), glm::dvec2(0.5 * settings_.most_stretch));
        out.nearness = static_cast<float>(sample.nearness * scale);
        for (int axis = 0; axis < 2; ++axis) {
            out.low[axis] = static_cast<float>(centre[axis] - half[axis]);
            out.high[axis] = static_cast<float>(centre[axis] + half[axis]);
        }
        return out;
    }

    void meet(uint32_t row, uint32_t i, uint32_t other_row, uint32_t other_i) {
        const auto most = static_cast<float>(settings_.most_gap);
        const uint32_t last = end(other_row, other_i);
        for (uint32_t k = begin(row, i); k < end(row, i); ++k)
            for (uint32_t n = begin(other_row, other_i); n < last; ++n)
                if (splats_[k].nearness >= 0 && splats_[n].nearness >= 0) closeGap(splats_[k], splats_[n], most);
    }

    void draw(const Splat& splat, const glm::u8vec3& colour) {
        // Neighbours on a plane meet in a line that each computes for itself.
        constexpr float kSlack = 1e-3f;
        const auto first = [](float low) { return std::max(0.0f, std::ceil(low - kSlack)); };
        const auto last = [](float high, uint32_t size) {
            return std::min(static_cast<float>(size) - 1, std::floor(high + kSlack));
        };
        const float left = first(splat.low[0]), right = last(splat.high[0], image_.width);
        const float bottom = first(splat.low[1]), top = last(splat.high[1], image_.height);
        if (!(left <= right && bottom <= top)) return;
        for (auto row = static_cast<uint32_t>(bottom); row <= static_cast<uint32_t>(top); ++row)
            for (auto i = static_cast<uint32_t>(left); i <= static_cast<uint32_t>(right); ++i) {
                const size_t at = size_t{row} * image_.width + i;
                if (settings_.hidden_by == HiddenBy::kZBuffer && !(splat.nearness > image_.nearness[at])) continue;
                image_.nearness[at] = splat.nearness;
                image_.colour[at] = colour;
            }
    }

    WarpMap map_;
    SampleLists lists_;
    uint32_t width_, height_;
    WarpedImage& image_;
    WarpSettings settings_;
    std::vector<Splat> splats_;
};

}  // namespace

WarpMap::WarpMap(const View& from, const View& to) {
    const Pinhole old_eye(from), new_eye(to);
    turn = new_eye.to_samples * old_eye.to_world;
    turn_back = old_eye.to_samples * new_eye.to_world;
    shift = new_eye.to_samples * (old_eye.eye - new_eye.eye);
    shift_back = turn_back * shift;
}

WarpOrder warpOrder(const View& from, const View& to) {
    const Pinhole old_eye(from);
    const glm::dvec3 epipole = old_eye.to_samples * (eyePosition(to) - old_eye.eye);
    // At no distance along the axis the epipole lies beyond the image, on the side that the new eye has moved to.
    constexpr double kFar = 1e9;
    const auto place = [&](double x) {
        if (std::abs(x) >= kFar * std::abs(epipole.z)) return x > 0 ? kFar : x < 0 ? -kFar : 0.0;
        return x / epipole.z;
    };
    const bool away = epipole.z < 0;
    const auto along = [&](double x, uint32_t count) {
        const double at = place(x);
        return towards(at, count, away && std::abs(at) < kFar);
    };
    return {along(epipole.y, from.height), along(epipole.x, from.width)};
}

uint64_t WarpedImage::holes() const {
    return static_cast<uint64_t>(std::count_if(nearness.begin(), nearness.end(), [](float n) { return n < 0; }));
}

void warp(const View& from, const SampleLists& lists, const View& to, WarpedImage& image,
          const WarpSettings& settings) {
    Warper(from, lists, to, image, settings).run(warpOrder(from, to));
}

void warp(const DepthImage& reference, const View& to, WarpedImage& image, const WarpSettings& settings) {
    warp(reference.view, {reference.samples, {}}, to, image, settings);
}

void mergeInto(WarpedImage& image, const WarpedImage& other, double tolerance) {
    const auto nearer = static_cast<float>(1 + tolerance);
    for (size_t at = 0; at < image.colour.size(); ++at) {
        if (other.nearness[at] < 0) continue;
        if (image.nearness[at] >= 0 && !(other.nearness[at] > nearer * image.nearness[at])) continue;
        image.nearness[at] = other.nearness[at];
        image.colour[at] = other.colour[at];
    }
}

uint64_t fillHoles(WarpedImage& image) {
    const uint64_t holes = image.holes();
    if (holes == 0 || holes == image.nearness.size()) return holes;
    const auto fill = [&](size_t start, size_t step, uint32_t count) {
        for (uint32_t i = 0; i < count;) {
            if (image.nearness[start + i * step] >= 0) {
                ++i;
                continue;
            }
            uint32_t end = i;
            while (end < count && image.nearness[start + end * step] < 0) ++end;
            const bool before = i > 0, behind = end < count;
            if (!before && !behind) return;
            size_t of = start + (before ? i - 1 : end) * step;
            if (before && behind && image.nearness[start + end * step] < image.nearness[of]) of = start + end * step;
            for (; i < end; ++i) {
                image.nearness[start + i * step] = image.nearness[of];
                image.colour[start + i * step] = image.colour[of];
            }
        }
    };
    for (uint32_t row = 0; row < image.height; ++row) fill(size_t{row} * image.width, 1, image.width);
    for (uint32_t i = 0; i < image.width; ++i) fill(i, image.width, image.height);
    return holes;
}

}  // namespace sightline::images
