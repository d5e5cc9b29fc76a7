// Seeded random numbers that are the same on every machine and with every standard library.
// SPDX-License-Identifier: MIT
//
// Guy Steele, Doug Lea, Christine Flood. Fast Splittable Pseudorandom Number Generators. 2014.
#pragma once

#include <cstdint>

namespace sightline {

/// SplitMix64. Copy it to replay a stream; seed with different numbers for independent streams.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}

    uint64_t next() {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }

    /// Uniform in [0, 1), on the grid of 2^-53.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Uniform in [0, count); count > 0.
    uint64_t below(uint64_t count) { return next() % count; }

private:
    uint64_t state_;
};

/// One well-mixed number from two, for a stream per (seed, place).
inline uint64_t mixSeed(uint64_t seed, uint64_t place) { return Random(seed ^ (place * 0xd6e8feb86659fd93ull)).next(); }

}  // namespace sightline
