// Products of doubles without rounding.
// SPDX-License-Identifier: MIT
//
// T. J. Dekker. A Floating-Point Technique for Extending the Available Precision. 1971.
#pragma once

#include <cmath>

namespace sightline {

/// What a product lacks: a * b is exactly (a * b rounded) + productError(a, b), unless something underflows. Factors are
/// below 2^996.
inline double productError(double a, double b) {
#ifdef FP_FAST_FMA
    return std::fma(a, b, -(a * b));
#else
    // Where the machine has no such instruction, std::fma is the C library's: MinGW's is wrong for one in eighteen
    // products of whole numbers of 53 bits.
    constexpr double kSplit = 0x1p27 + 1;  // halves of 26 bits, whose products are doubles
    const double a_high = a * kSplit - (a * kSplit - a), a_low = a - a_high;
    const double b_high = b * kSplit - (b * kSplit - b), b_low = b - b_high;
    return ((a_high * b_high - a * b) + a_high * b_low + a_low * b_high) + a_low * b_low;
#endif
}

/// Whether a * b is c * d, without rounding.
inline bool equalProducts(double a, double b, double c, double d) {
    return a * b == c * d && productError(a, b) == productError(c, d);
}

/// a * b - c * d, right to within two units in the last place even where the products cancel.
inline double differenceOfProducts(double a, double b, double c, double d) {
    const auto difference = [](double x, double y, double& error) {
        const double result = x - y, from_y = x - result;
        error = (x - (result + from_y)) + (from_y - y);
        return result;
    };
    double error, error_of_errors;
    const double rough = difference(a * b, c * d, error);
    const double rest = difference(productError(a, b), productError(c, d), error_of_errors);
    return (rough + rest) + (error + error_of_errors);
}

}  // namespace sightline
