// Warnock's algorithm: divide the screen until each window is simple.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/warnock.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/studies/hidden/methods/fill.h"
#include "sightline/studies/hidden/project/scan.h"

namespace sightline::studies {
namespace {

/// How far beyond an edge a sample must lie so that rounding cannot have put it there  [samples]
constexpr double kDoubt = 1e-5;
constexpr double kShortEdge = 1e-2;  ///< [samples]

/// A polygon as windows ask about it.
struct Candidate {
    const ScreenPolygon* polygon = nullptr;
    glm::dvec2 low{0.0}, high{0.0};               ///< extents, over samples
    glm::dvec3 edges[ScreenPolygon::kMaxPoints];  ///< dot(edge, (sample, row, 1)): distance, inside positive
    int count = 0;
    bool may_surround = false;
};

/// Samples [left, right) of rows [bottom, top).
struct Window {
    int32_t left = 0, right = 0, bottom = 0, top = 0;

    glm::dvec2 first() const { return {left, bottom}; }
    glm::dvec2 last() const { return {right - 1, top - 1}; }
    bool oneSample() const { return right - left == 1 && top - bottom == 1; }
};

enum class Place : uint8_t { kDisjoint, kContainedOrIntersecting, kSurrounding };

Candidate candidateOf(const ScreenPolygon& polygon) {
    Candidate candidate;
    candidate.polygon = &polygon;
    candidate.low = candidate.high = polygon.points[0] - 0.5;
    double area = 0;
    for (int i = 0; i < polygon.count; ++i) {
        const glm::dvec2 &a = polygon.points[i], &b = polygon.points[i + 1 < polygon.count ? i + 1 : 0];
        candidate.low = glm::min(candidate.low, a - 0.5);
        candidate.high = glm::max(candidate.high, a - 0.5);
        const glm::dvec2 from = a - polygon.points[0], to = b - polygon.points[0];
        area += from.x * to.y - from.y * to.x;
    }
    // A sliver of no width has no inside to speak of.
    if (!(std::abs(area) > kDoubt)) return candidate;
    candidate.may_surround = true;
    for (int i = 0; i < polygon.count; ++i) {
        const glm::dvec2 &a = polygon.points[i], &b = polygon.points[i + 1 < polygon.count ? i + 1 : 0];
        const double length = glm::length(b - a);
        // The direction of an edge that clipping left that short is the direction of its rounding.
        if (polygon.count > 3 && !(length > kShortEdge)) {
            candidate.may_surround = false;
            continue;
        }
        const glm::dvec2 inward = glm::dvec2(a.y - b.y, b.x - a.x) / (area < 0 ? -length : length);
        candidate.edges[candidate.count++] = {inward.x, inward.y, glm::dot(inward, 0.5 - a)};
    }
    return candidate;
}

/// Says disjoint or surrounding only where there is no doubt.
Place classify(const Candidate& candidate, const Window& window) {
    const glm::dvec2 first = window.first(), last = window.last();
    if (candidate.low.x > last.x + kDoubt || candidate.high.x < first.x - kDoubt || candidate.low.y > last.y + kDoubt ||
        candidate.high.y < first.y - kDoubt)
        return Place::kDisjoint;
    const glm::dvec2 middle = 0.5 * (first + last), half = 0.5 * (last - first);
    bool inside = candidate.may_surround;
    for (int i = 0; i < candidate.count; ++i) {
        const glm::dvec3& edge = candidate.edges[i];
        const double distance = edge.x * middle.x + edge.y * middle.y + edge.z;
        const double reach = std::abs(edge.x) * half.x + std::abs(edge.y) * half.y;
        if (distance + reach < -kDoubt) return Place::kDisjoint;
        inside &= distance - reach > kDoubt;
    }
    return inside ? Place::kSurrounding : Place::kContainedOrIntersecting;
}

class Subdivision {
public:
    Subdivision(const std::vector<ScreenPolygon>& polygons, HiddenImage& image) : image_(image) {
        candidates_.reserve(polygons.size());
        for (const ScreenPolygon& polygon : polygons) candidates_.push_back(candidateOf(polygon));
    }

    void draw() {
        for (uint32_t i = 0; i < candidates_.size(); ++i) listed_.push_back({i, false});
        stack_.push_back(
            {{0, static_cast<int32_t>(image_.width), 0, static_cast<int32_t>(image_.height)}, 0, listed_.size()});
        while (!stack_.empty()) {
            const Pending next = stack_.back();
            stack_.pop_back();
            // What lies beyond belongs to windows that are done.
            listed_.resize(next.end);
            look(next);
        }
    }

private:
    struct Listed {
        uint32_t candidate = 0;
        bool surrounding = false;
    };
    /// A window with its parent's list.
    struct Pending {
        Window window;
        size_t begin = 0, end = 0;  ///< of listed_
    };

    const ScreenPolygon& polygonOf(const Listed& listed) const { return *candidates_[listed.candidate].polygon; }

    void look(const Pending& pending) {
        const Window& window = pending.window;
        ++image_.counters.windows;
        const size_t begin = listed_.size();
        for (size_t i = pending.begin; i < pending.end; ++i) {
            Listed listed = listed_[i];
            if (!listed.surrounding) {
                ++image_.counters.comparisons;
                const Place place = classify(candidates_[listed.candidate], window);
                if (place == Place::kDisjoint) continue;
                listed.surrounding = place == Place::kSurrounding;
            }
            listed_.push_back(listed);
        }
        dropHidden(window, begin);
        const size_t count = listed_.size() - begin;
        if (count == 0) return;
        if (count == 1) drawAlone(window, listed_[begin]);
        else if (window.oneSample()) drawNearest(window, begin);
        else quarter(window, begin);
    }

    /// Nearness of a surface's plane at the window's four corner samples.
    static glm::dvec4 cornersOf(const ScreenPolygon& polygon, const Window& window) {
        const DepthPlane& depth = polygon.depth;
        const double bottom = depth.origin + depth.per_row * window.bottom,
                     top = depth.origin + depth.per_row * (window.top - 1);
        const double left = depth.per_sample * window.left, right = depth.per_sample * (window.right - 1);
        return {bottom + left, bottom + right, top + left, top + right};
    }

    /// Drops what lies behind the surrounding polygon that is nearest at the window's farthest corner.
    void dropHidden(const Window& window, size_t begin) {
        size_t chosen = listed_.size();
        double most = -std::numeric_limits<double>::infinity();
        glm::dvec4 front(0.0);
        for (size_t i = begin; i < listed_.size(); ++i) {
            if (!listed_[i].surrounding) continue;
            const glm::dvec4 corners = cornersOf(polygonOf(listed_[i]), window);
            const double least = std::min({corners.x, corners.y, corners.z, corners.w});
            if (least <= most) continue;
            most = least;
            chosen = i;
            front = corners;
        }
        if (chosen == listed_.size()) return;
        const Listed surrounder = listed_[chosen];
        size_t kept = begin;
        for (size_t i = begin; i < listed_.size(); ++i) {
            const ScreenPolygon& other = polygonOf(listed_[i]);
            ++image_.counters.comparisons;
            const auto behind = [&](const glm::dvec4& back) {
                return isBehind(back, other.surface, front, polygonOf(surrounder).surface);
            };
            // By its plane, or, since a plane goes on where its polygon ends, by its nearest point.
            const bool hidden =
                i != chosen && (behind(cornersOf(other, window)) || behind(glm::dvec4(other.depth.high)));
            if (!hidden) listed_[kept++] = listed_[i];
        }
        listed_.resize(kept);
    }

    /// At all four corners, equals going to the lower number.
    static bool isBehind(const glm::dvec4& back, uint32_t back_surface, const glm::dvec4& front,
                         uint32_t front_surface) {
        for (int i = 0; i < 4; ++i)
            if (!(back[i] < front[i] || (back[i] == front[i] && front_surface < back_surface))) return false;
        return true;
    }

    void drawAlone(const Window& window, const Listed& listed) {
        const uint32_t surface = polygonOf(listed).surface;
        if (listed.surrounding) {
            for (int32_t row = window.bottom; row < window.top; ++row)
                fillSpan(image_, row, window.left, window.right, surface);
            return;
        }
        scanWindow(window, listed,
                   [&](int32_t row, int32_t begin, int32_t end) { fillSpan(image_, row, begin, end, surface); });
    }

    template <class Fill>
    void scanWindow(const Window& window, const Listed& listed, Fill&& fill) {
        scanPolygon(polygonOf(listed).outline(), window.bottom, window.top, static_cast<int32_t>(image_.width),
                    [&](int32_t row, int32_t begin, int32_t end) {
                        begin = std::max(begin, window.left);
                        end = std::min(end, window.right);
                        if (begin < end) fill(row, begin, end);
                    });
    }

    void drawNearest(const Window& window, size_t begin) {
        const ScreenPolygon* nearest = nullptr;
        double most = -std::numeric_limits<double>::infinity();
        for (size_t i = begin; i < listed_.size(); ++i) {
            bool there = listed_[i].surrounding;
            if (!there) scanWindow(window, listed_[i], [&](int32_t, int32_t, int32_t) { there = true; });
            if (!there) continue;
            ++image_.counters.tested;
            countSpan(image_, image_.tested, window.bottom, window.left, window.right);
            const double nearness = polygonOf(listed_[i]).depth.at(window.bottom, window.left);
            if (nearness <= most) continue;
            most = nearness;
            nearest = &polygonOf(listed_[i]);
        }
        if (nearest) fillSpan(image_, window.bottom, window.left, window.right, nearest->surface);
    }

    void quarter(const Window& window, size_t begin) {
        const int32_t x = window.left + (window.right - window.left + 1) / 2,
                      y = window.bottom + (window.top - window.bottom + 1) / 2;
        const Window quarters[4] = {{window.left, x, window.bottom, y},
                                    {x, window.right, window.bottom, y},
                                    {window.left, x, y, window.top},
                                    {x, window.right, y, window.top}};
        for (const Window& part : quarters)
            if (part.left < part.right && part.bottom < part.top) stack_.push_back({part, begin, listed_.size()});
    }

    std::vector<Candidate> candidates_;
    std::vector<Listed> listed_;  ///< lists of windows, each behind its parent's
    std::vector<Pending> stack_;
    HiddenImage& image_;
};

}  // namespace

void drawWarnock(const HiddenInput& input, HiddenImage& image) {
    Projector projector = input.projector();
    const std::vector<ScreenPolygon> polygons = projectAll(input.list, projector);
    image.counters.geometry = projector.counters();
    Subdivision(polygons, image).draw();
}

}  // namespace sightline::studies
