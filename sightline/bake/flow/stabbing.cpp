// Seeks the proof by least squares: the point of the cone of all forms nearest to one that only a proof reaches.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/stabbing.h"

#include <algorithm>
#include <cmath>

namespace sightline::bake {
namespace {

constexpr int kSize = 6;
constexpr int kMostSteps = 64;
constexpr double kPivot = 1e-11;  // of forms of length 1

/// Solves the normal equations of a few columns by Cholesky's method. False: they are not independent.
bool solve(const double (*columns)[kSize], int count, const double* goal, double* out) {
    double lower[kSize][kSize], right[kSize];
    for (int i = 0; i < count; ++i) {
        right[i] = 0;
        for (int k = 0; k < kSize; ++k) right[i] += columns[i][k] * goal[k];
        for (int j = 0; j <= i; ++j) {
            double sum = 0;
            for (int k = 0; k < kSize; ++k) sum += columns[i][k] * columns[j][k];
            for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
            if (i != j) {
                lower[i][j] = sum / lower[j][j];
                continue;
            }
            if (!(sum > kPivot)) return false;
            lower[i][i] = std::sqrt(sum);
        }
    }
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < i; ++k) right[i] -= lower[i][k] * right[k];
        right[i] /= lower[i][i];
    }
    for (int i = count; i-- > 0;) {
        out[i] = right[i];
        for (int k = i + 1; k < count; ++k) out[i] -= lower[k][i] * out[k];
        out[i] /= lower[i][i];
    }
    return true;
}

}  // namespace

void StabbingChain::begin(const glm::dvec3& normal, double extent, double precision) {
    forms_.clear();
    normal_ = normal;
    scale_ = 1 / std::max(extent, 1e-300);
    precision_ = precision;
}

void StabbingChain::add(std::span<const glm::dvec3> outline) {
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 a = scale_ * outline[i], edge = scale_ * outline[i + 1 == outline.size() ? 0 : i + 1] - a;
        const double length = glm::length(edge);
        if (!(length > 64 * precision_ * scale_))
            continue;  // without this form there are fewer proofs, never wrong ones
        const glm::dvec3 along = edge / length, moment = glm::cross(a, along);
        forms_.push_back({{moment.x, moment.y, moment.z, along.x, along.y, along.z}});
    }
}

// A line (d, m) that is inside of all edges has f . (d, m) >= 0 for each form f, as edges are of length 1 the
// distance from it times the sine between them. Sought are weights w >= 0 with sum w f = -(n, 0): then 0 <= sum w f .
// (d, m) = -n . d, but lines go along n. The weights are found by Lawson's and Hanson's active sets, up to a rest r.
// With |d| = 1, |m| <= sqrt(3) in the scale, so |r . (d, m)| <= 2 |r|; lines closer to an edge than the precision p
// miss by at most p, in all by p sum w. So if n . d, which is at least rise / distance, is more than 2 |r| + p sum w,
// there is no line.
bool StabbingChain::isProvedEmpty(double rise, double distance) {
    const double goal[kSize] = {-normal_.x, -normal_.y, -normal_.z, 0, 0, 0};
    double columns[kSize][kSize], weights[kSize] = {}, next[kSize];
    size_t member[kSize];
    int count = 0;
    const double least = rise / distance;
    for (int step = 0; step < kMostSteps; ++step) {
        double rest[kSize];
        std::copy_n(goal, kSize, rest);
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            sum += weights[i];
            for (int k = 0; k < kSize; ++k) rest[k] -= weights[i] * columns[i][k];
        }
        double squared = 0;
        for (const double r : rest) squared += r * r;
        // Rounding is far below the square root of that of the numbers.
        if (least > 2 * (std::sqrt(squared) + 1e-12 * (1 + sum)) + precision_ * scale_ * sum) return true;
        if (count == kSize) return false;
        // The form that lies most along the rest joins.
        double most = 1e-9 * std::sqrt(squared);
        size_t best = forms_.size();
        for (size_t f = 0; f < forms_.size(); ++f) {
            double along = 0;
            for (int k = 0; k < kSize; ++k) along += forms_[f].value[k] * rest[k];
            if (along > most && std::find(member, member + count, f) == member + count) {
                most = along;
                best = f;
            }
        }
        if (best == forms_.size())
            return false;  // the nearest point is found: a point lies on the inner side of all forms
        std::copy_n(forms_[best].value, kSize, columns[count]);
        member[count] = best;
        weights[count++] = 0;
        for (;;) {
            if (!solve(columns, count, goal, next)) return false;
            // Goes towards the solution until a weight would become negative; forms whose weight is zero leave.
            double share = 1;
            for (int i = 0; i < count; ++i)
                if (next[i] <= 0) share = std::min(share, weights[i] / (weights[i] - next[i]));
            bool left = false;
            int kept = 0;
            for (int i = 0; i < count; ++i) {
                const double weight = weights[i] + share * (next[i] - weights[i]);
                if (next[i] <= 0 && weight <= 1e-14) {
                    left = true;
                    continue;
                }
                if (kept != i) {
                    std::copy_n(columns[i], kSize, columns[kept]);
                    member[kept] = member[i];
                }
                weights[kept++] = std::max(weight, 0.0);
            }
            count = kept;
            if (!left) break;
            if (count == 0) return false;
        }
    }
    return false;
}

}  // namespace sightline::bake
