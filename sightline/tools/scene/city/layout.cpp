// The city's plan: where its blocks lie, from the middle outward.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/city/layout.h"

#include <algorithm>
#include <tuple>

#include "sightline/tools/scene/city/library.h"

namespace sightline::tools::city {
namespace {

constexpr int64_t kBandWidth = 512;  // [metres]

void addBlock(std::vector<Block>& blocks, int64_t x, int64_t z, bool small, int64_t inner, int64_t outer) {
    const int64_t distance2 = x * x + z * z;
    if (distance2 < inner || distance2 >= outer) return;
    blocks.push_back({distance2, static_cast<int32_t>(x), static_cast<int32_t>(z), small});
}

}  // namespace

int Block::size() const { return small ? kSmallBlock : kLargeBlock; }

uint64_t Block::place() const {
    return (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(z);
}

std::vector<Block> blocksBetween(int64_t inner, int64_t outer) {
    // Large blocks stand at i (a, b) + j (-b, a); each has a small one at its lower right.
    constexpr int64_t a = kLargeBlock, b = kSmallBlock;
    int64_t reach = 1;
    while (reach * reach * (a * a + b * b) < 2 * outer) reach *= 2;
    reach += 2;
    std::vector<Block> blocks;
    for (int64_t i = -reach; i <= reach; ++i) {
        for (int64_t j = -reach; j <= reach; ++j) {
            const int64_t x = i * a - j * b, z = i * b + j * a;
            addBlock(blocks, x, z, false, inner, outer);
            addBlock(blocks, x + (a + b) / 2, z - (a - b) / 2, true, inner, outer);
        }
    }
    std::sort(blocks.begin(), blocks.end(), [](const Block& p, const Block& q) {
        return std::tie(p.distance2, p.x, p.z) < std::tie(q.distance2, q.x, q.z);
    });
    return blocks;
}

Block BlockSequence::next() {
    while (used_ == band_.size()) {
        const int64_t inner = bands_ * kBandWidth, outer = inner + kBandWidth;
        band_ = blocksBetween(inner * inner, outer * outer);
        used_ = 0;
        ++bands_;
    }
    return band_[used_++];
}

glm::dvec2 outwardOf(int quarter) {
    constexpr int kX[] = {0, 1, 0, -1}, kZ[] = {1, 0, -1, 0};
    return {kX[quarter & 3], kZ[quarter & 3]};
}

glm::dvec2 alongSide(int quarter) { return outwardOf(quarter + 1); }

glm::dvec2 Side::at(double s, double t) const {
    const glm::dvec2 along = alongSide(quarter), outward = outwardOf(quarter);
    return {start.x + along.x * s + outward.x * t, start.y + along.y * s + outward.y * t};
}

Side sideOf(const Rectangle& r, int quarter) {
    const double width = r.max.x - r.min.x, depth = r.max.y - r.min.y;
    switch (quarter & 3) {
        case 0:
            return {0, {r.min.x, r.max.y}, width};
        case 1:
            return {1, {r.max.x, r.max.y}, depth};
        case 2:
            return {2, {r.max.x, r.min.y}, width};
        default:
            return {3, {r.min.x, r.min.y}, depth};
    }
}

}  // namespace sightline::tools::city
