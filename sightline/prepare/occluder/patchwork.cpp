// The hiding triangles of one or several meshes on common vertices, and the sides by which they hang together.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/patchwork.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/finite.h"
#include "sightline/prepare/occluder/exact.h"
#include "sightline/prepare/welder.h"

namespace sightline {

Patchwork weld(std::span<const OccluderSource> sources) {
    constexpr uint32_t kUnknown = ~uint32_t{0};
    Patchwork out;
    Welder welder(out.positions);
    std::vector<uint32_t> number;
    for (uint32_t m = 0; m < sources.size(); ++m) {
        const OccluderSource& source = sources[m];
        const MeshView& mesh = source.mesh;
        number.assign(mesh.positions.size(), kUnknown);
        for (size_t t = 0; t < mesh.triangles(); ++t) {
            if (!source.hides.empty() && !source.hides[t]) continue;
            const uint32_t* index = mesh.indices.data() + 3 * t;
            const auto usable = [&](uint32_t i) { return i < mesh.positions.size() && isFinite(mesh.positions[i]); };
            if (!usable(index[0]) || !usable(index[1]) || !usable(index[2])) continue;
            PatchPolygon polygon{{}, m, 3, !source.double_sided.empty() && source.double_sided[t]};
            for (int k = 0; k < 3; ++k) {
                if (number[index[k]] == kUnknown) number[index[k]] = welder.number(mesh.positions[index[k]]);
                polygon.vertex[k] = number[index[k]];
            }
            const auto at = [&](int k) { return out.positions[polygon.vertex[k]]; };
            if (!areCollinear(at(0), at(1), at(2))) out.polygons.push_back(polygon);
        }
    }
    return out;
}

std::vector<PatchSide> sortedSides(const Patchwork& patchwork) {
    const auto forSides = [&](auto each) {
        for (uint32_t i = 0; i < patchwork.polygons.size(); ++i) {
            const PatchPolygon& polygon = patchwork.polygons[i];
            for (uint8_t k = 0; k < polygon.corners; ++k) {
                uint32_t from = polygon.vertex[k];
                const auto go = [&](uint32_t to) {
                    each(PatchSide{std::min(from, to), std::max(from, to), i, k, from < to});
                    from = to;
                };
                for (uint32_t vertex : patchwork.chain(i, k)) go(vertex);
                go(polygon.vertex[k + 1 == polygon.corners ? 0 : k + 1]);
            }
        }
    };
    // Counted by the lower vertex, then sorted among the few that share it.
    std::vector<uint32_t> first(patchwork.positions.size() + 1, 0);
    forSides([&](const PatchSide& side) { ++first[side.low + 1]; });
    for (size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<PatchSide> sides(first.back());
    std::vector<uint32_t> next(first.begin(), first.end() - 1);
    forSides([&](const PatchSide& side) { sides[next[side.low]++] = side; });
    for (size_t v = 0; v + 1 < first.size(); ++v)
        std::sort(sides.begin() + first[v], sides.begin() + first[v + 1], [](const PatchSide& a, const PatchSide& b) {
            return a.high != b.high         ? a.high < b.high
                   : a.polygon != b.polygon ? a.polygon < b.polygon
                                            : a.corner < b.corner;
        });
    return sides;
}

}  // namespace sightline
