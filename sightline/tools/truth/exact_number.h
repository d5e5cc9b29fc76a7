// Numbers whose signs are never wrong: a double with a bound on its error, and, where that is not enough, exact binary fractions.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
// Torbjorn Granlund and others. GNU MP: The GNU Multiple Precision Arithmetic Library.
#pragma once

#include <gmp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace sightline::tools {

/// A real number to within an error. Sums and products keep the promise: the exact result is within the new error.
struct Rounded {
    static constexpr int kUnknown = 2;

    double value = 0;
    double error = 0;  ///< infinite or not a number: nothing is known

    Rounded() = default;
    Rounded(double exactly) : value(exactly) {}
    Rounded(double about, double within) : value(about), error(within) {}

    /// -1, 0 or 1; kUnknown if the error leaves it open.
    int sign() const { return value > error ? 1 : value < -error ? -1 : value == 0 && error == 0 ? 0 : kUnknown; }

    Rounded operator-() const { return {-value, error}; }
    friend Rounded operator+(const Rounded& a, const Rounded& b) {
        return inflated(a.value + b.value, a.error + b.error);
    }
    friend Rounded operator-(const Rounded& a, const Rounded& b) { return a + -b; }
    friend Rounded operator*(const Rounded& a, const Rounded& b) {
        if ((a.value == 0 && a.error == 0) || (b.value == 0 && b.error == 0)) return {};
        return inflated(a.value * b.value,
                        std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error);
    }

private:
    /// Adds what this one operation rounded, and what the sum of the errors did. A tiny bit more stands for underflow.
    static Rounded inflated(double value, double error) {
        return {value, error * (1 + 0x1p-50) + std::abs(value) * 0x1p-52 + 0x1p-1000};
    }
};

/// A whole number times a power of two, of any size: sums and products are exact.
class Exact {
public:
    Exact() { mpz_init(whole_); }
    /// @param value  finite
    Exact(double value) {
        int power = 0;
        mpz_init_set_d(whole_, std::ldexp(std::frexp(value, &power), 53));
        power_ = power - 53;
    }
    Exact(const Exact& other) : power_(other.power_) { mpz_init_set(whole_, other.whole_); }
    Exact(Exact&& other) noexcept : Exact() { swap(other); }
    Exact& operator=(Exact other) noexcept {
        swap(other);
        return *this;
    }
    ~Exact() { mpz_clear(whole_); }

    int sign() const { return mpz_sgn(whole_); }

    /// a / b, rounded.  @param b  not 0
    friend double ratio(const Exact& a, const Exact& b) {
        long a_power = 0, b_power = 0;
        const double a_part = mpz_get_d_2exp(&a_power, a.whole_), b_part = mpz_get_d_2exp(&b_power, b.whole_);
        const int64_t power = a.power_ + a_power - b.power_ - b_power;
        return std::ldexp(a_part / b_part, static_cast<int>(std::clamp<int64_t>(power, -4000, 4000)));
    }

    Exact operator-() const {
        Exact result = *this;
        mpz_neg(result.whole_, result.whole_);
        return result;
    }
    friend Exact operator+(const Exact& a, const Exact& b) {
        if (a.sign() == 0) return b;
        if (b.sign() == 0) return a;
        const Exact &low = a.power_ < b.power_ ? a : b, &high = a.power_ < b.power_ ? b : a;
        Exact result;
        mpz_mul_2exp(result.whole_, high.whole_, static_cast<mp_bitcnt_t>(high.power_ - low.power_));
        mpz_add(result.whole_, result.whole_, low.whole_);
        result.power_ = low.power_;
        return result;
    }
    friend Exact operator-(const Exact& a, const Exact& b) { return a + -b; }
    friend Exact operator*(const Exact& a, const Exact& b) {
        Exact result;
        mpz_mul(result.whole_, a.whole_, b.whole_);
        result.power_ = a.power_ + b.power_;
        return result;
    }

private:
    void swap(Exact& other) noexcept {
        mpz_swap(whole_, other.whole_);
        std::swap(power_, other.power_);
    }

    mpz_t whole_;
    int64_t power_ = 0;
};

/// Three numbers: a point, a direction, or the values of a linear function at three points.
template <class Number>
struct Triple {
    Number x, y, z;
};

template <class Number>
Triple<Number> operator-(const Triple<Number>& a, const Triple<Number>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace sightline::tools
