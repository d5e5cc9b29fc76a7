// Linear programs in two and three dimensions that ask for any point: found incrementally, denied by certificate.
// SPDX-License-Identifier: MIT
#include "sightline/studies/cells/linear_program.h"

#include <algorithm>
#include <cmath>

namespace sightline::studies {
namespace {

// Of a sum of four products of four factors, the products of which are summed before: more than all that rounds.
constexpr double kProgramRounding = 0x1p-48;
constexpr double kSlack = 0x1p-40;  // of heights and slopes, where rounding may have made them
constexpr size_t kMost = 250;  // half-spaces that are asked; what comes after them is not, which only lets more through

/// Some of the conditions, and how much of each makes a sum that is nowhere positive.
struct Blame {
    size_t index[4];
    double weight[4];
    int count = 0;
    void add(size_t i, double w) { index[count] = i, weight[count++] = w; }
};

double at(const glm::dvec3& line, const glm::dvec2& p) { return line.x * p.x + line.y * p.y + line.z; }

double at(const glm::dvec4& plane, const glm::dvec3& p) {
    return plane.x * p.x + plane.y * p.y + plane.z * p.z + plane.w;
}

/// Half-planes with the sides of a rectangle after them.
struct Lines {
    const glm::dvec3* lines;
    size_t count;
    glm::dvec2 low, high;

    glm::dvec3 operator[](size_t i) const {
        if (i < count) return lines[i];
        switch (i - count) {
            case 0:
                return {1, 0, -low.x};
            case 1:
                return {-1, 0, high.x};
            case 2:
                return {0, 1, -low.y};
            default:
                return {0, -1, high.y};
        }
    }
};

/// Looks on the edge of half-plane `i` for a point of all before it.
/// @returns false if there is none for a reason that `proved` accepts; a reason that it does not accept is let be
template <class Proved>
bool moveToEdge(const Lines& all, size_t i, glm::dvec2& p, Proved proved) {
    const glm::dvec3 edge = all[i];
    const glm::dvec2 normal(edge), along(-edge.y, edge.x);
    const double squared = glm::dot(normal, normal);
    if (!(squared > 0.0)) {
        Blame alone;
        alone.add(i, 1.0);
        return !proved(alone);
    }
    const glm::dvec2 from = p - at(edge, p) / squared * normal;
    constexpr size_t kNone = ~size_t{0};
    double low = -INFINITY, high = INFINITY;
    size_t low_by = kNone, high_by = kNone, beside = kNone;
    const auto narrow = [&](size_t k) {
        const glm::dvec3 line = all[k];
        const double height = at(line, from), slope = line.x * along.x + line.y * along.y;
        const double steepest = std::abs(line.x * along.x) + std::abs(line.y * along.y);
        const double highest = std::abs(line.x * from.x) + std::abs(line.y * from.y) + std::abs(line.z);
        if (std::abs(slope) <= kSlack * steepest && std::abs(height) <= kSlack * highest) return;  // the same line
        if (slope > 0.0) {
            if (const double t = -height / slope; t > low) low = t, low_by = k;
        } else if (slope < 0.0) {
            if (const double t = -height / slope; t < high) high = t, high_by = k;
        } else if (height < 0.0) {
            beside = k;
        }
    };
    for (size_t k = all.count; k < all.count + 4; ++k) narrow(k);
    for (size_t k = 0; k < i; ++k) narrow(k);
    const auto noneBy = [&](size_t a, double weight, size_t b, double other) {
        Blame reason;
        reason.add(a, weight);
        if (b != kNone) reason.add(b, other);
        const glm::dvec2 sum = weight * glm::dvec2(all[a]) + (b != kNone ? other * glm::dvec2(all[b]) : glm::dvec2(0));
        reason.add(i, std::max(-glm::dot(sum, normal) / squared, 0.0));
        return proved(reason);
    };
    if (beside != kNone && noneBy(beside, 1.0, kNone, 0.0)) return false;
    if (low_by == kNone || high_by == kNone) return true;
    const auto slope = [&](size_t k) { return std::abs(all[k].x * along.x + all[k].y * along.y); };
    if (low > high && noneBy(low_by, slope(high_by), high_by, slope(low_by))) return false;
    p = from + 0.5 * (low + high) * along;  // a common point, but for rounding
    return true;
}

template <class Proved>
bool pointInPlane(const Lines& all, glm::dvec2& p, Proved proved) {
    p = glm::clamp(p, all.low, all.high);
    for (size_t i = 0; i < all.count; ++i)
        if (!(at(all[i], p) >= 0.0) && !moveToEdge(all, i, p, proved)) return false;
    return true;
}

}  // namespace

bool commonPoint(std::span<const glm::dvec3> lines, const glm::dvec2& low, const glm::dvec2& high, glm::dvec2& point) {
    const Lines all{lines.data(), lines.size(), low, high};
    return pointInPlane(all, point, [&](const Blame& blame) {
        glm::dvec3 sum(0.0), size(0.0);
        for (int k = 0; k < blame.count; ++k) {
            if (blame.index[k] >= lines.size()) continue;  // the rectangle's own sides: below
            const glm::dvec3 term = blame.weight[k] * lines[blame.index[k]];
            sum += term;
            size += glm::abs(term);
        }
        const glm::dvec2 far = glm::max(glm::abs(low), glm::abs(high));
        const double most = sum.z + std::max(sum.x * low.x, sum.x * high.x) + std::max(sum.y * low.y, sum.y * high.y);
        return most < -kProgramRounding * (size.x * far.x + size.y * far.y + size.z);
    });
}

bool commonPoint(std::span<const glm::dvec4> planes, const glm::dvec3& low, const glm::dvec3& high, glm::dvec3& point) {
    const size_t count = std::min(planes.size(), kMost);
    const auto plane = [&](size_t i) {
        if (i < count) return planes[i];
        const int axis = static_cast<int>(i - count) / 2;
        const bool upper = (i - count) % 2 != 0;
        glm::dvec4 side(0.0);
        side[axis] = upper ? -1.0 : 1.0;
        side.w = upper ? high[axis] : -low[axis];
        return side;
    };
    glm::dvec3 lines[kMost + 6];
    point = glm::clamp(point, low, high);
    for (size_t i = 0; i < count; ++i) {
        const double height = at(planes[i], point);
        if (height >= 0.0) continue;
        const glm::dvec3 normal(planes[i]);
        const double squared = glm::dot(normal, normal);
        if (!(squared > 0.0)) {
            if (normal == glm::dvec3(0.0) && height < 0.0) return false;
            continue;
        }
        const glm::dvec3 from = point - height / squared * normal;
        const glm::dvec3 least = std::abs(normal.x) < std::abs(normal.y) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        glm::dvec3 u = glm::cross(normal, least);
        if (const double length = glm::length(u); length > 0.0) u /= length;
        const glm::dvec3 v = glm::cross(normal, u) / std::sqrt(squared);
        // The box's sides come first; what is in the box is not farther from `from` than its corners are apart.
        const auto index = [&](size_t k) { return k < 6 ? count + k : k - 6; };
        for (size_t k = 0; k < 6 + i; ++k) {
            const glm::dvec4 of = plane(index(k));
            lines[k] = {glm::dot(glm::dvec3(of), u), glm::dot(glm::dvec3(of), v), at(of, from)};
        }
        const double reach = 2.0 * glm::length(high - low);
        glm::dvec2 p(0.0);
        const bool may = pointInPlane(Lines{lines, 6 + i, glm::dvec2(-reach), glm::dvec2(reach)}, p, [&](Blame blame) {
            glm::dvec4 sum(0.0), size(0.0);
            const auto include = [&](size_t of, double weight) {
                const glm::dvec4 term = weight * planes[of];
                sum += term;
                size += glm::abs(term);
            };
            glm::dvec3 gradient(0.0);
            for (int k = 0; k < blame.count; ++k) {
                if (blame.index[k] >= 6 + i) continue;
                const size_t of = index(blame.index[k]);
                gradient += blame.weight[k] * glm::dvec3(plane(of));
                if (of < count) include(of, blame.weight[k]);
            }
            include(i, std::max(-glm::dot(gradient, normal) / squared, 0.0));
            double most = sum.w, far = size.w;
            for (int axis = 0; axis < 3; ++axis) {
                most += std::max(sum[axis] * low[axis], sum[axis] * high[axis]);
                far += size[axis] * std::max(std::abs(low[axis]), std::abs(high[axis]));
            }
            return most < -kProgramRounding * far;
        });
        if (!may) return false;
        point = from + p.x * u + p.y * v;
    }
    return true;
}

}  // namespace sightline::studies
