// Sums of doubles kept without rounding, for predicates whose sign has to be right.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include "sightline/math/exact_product.h"

namespace sightline {

/// Components that do not overlap, smallest first. Exact as long as nothing overflows or underflows.
struct Expansion {
    /// Terms that may be added in all: a product of two counts as two, of three as four. 6 products of three sums of two:
    static constexpr int kMaxParts = 192;

    double parts[kMaxParts];
    int count = 0;

    void add(double value) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const double sum = value + parts[i];
            const double virtual_part = sum - value;
            const double error = (value - (sum - virtual_part)) + (parts[i] - virtual_part);
            if (error != 0) parts[kept++] = error;
            value = sum;
        }
        if (value != 0) parts[kept++] = value;  // what cancels at the top must not hide what is left below
        count = kept;
    }

    void addProduct(double a, double b) {
        add(productError(a, b));
        add(a * b);
    }

    void addProduct(double a, double b, double c) {
        addProduct(productError(a, b), c);
        addProduct(a * b, c);
    }

    /// Of the sum; 0 if there is none.
    int sign() const { return count == 0 ? 0 : parts[count - 1] > 0 ? 1 : parts[count - 1] < 0 ? -1 : 0; }
};

}  // namespace sightline
