// The vertices of quantised occluders in 16 bits a coordinate, for files and for the wire.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/packed_vertices.h"

namespace sightline {
namespace {

/// False if a coordinate is not a whole number of steps, 0 to 65,535, from the origin.
bool pack(const Array<float>& from, float origin, float step, std::vector<uint16_t>& to) {
    to.clear();
    to.reserve(from.size());
    for (const float at : from) {
        const float place = (at - origin) / step;
        if (!(place >= 0.0f && place <= 65535.0f)) return false;
        to.push_back(static_cast<uint16_t>(place));
        if (origin + step * static_cast<float>(to.back()) != at) return false;
    }
    return true;
}

void unpack(const std::vector<uint16_t>& from, float origin, float step, Array<float>& to) {
    to.resize(from.size());
    for (size_t i = 0; i < from.size(); ++i) to[i] = origin + step * static_cast<float>(from[i]);
}

}  // namespace

std::optional<PackedVertices> packVertices(const InnerOccluder& inner) {
    if (!(inner.step > 0)) return std::nullopt;
    PackedVertices out;
    out.origin = inner.origin;
    out.step = inner.step;
    const Occluder& from = inner.occluder;
    if (!pack(from.x, out.origin.x, out.step, out.x) || !pack(from.y, out.origin.y, out.step, out.y) ||
        !pack(from.z, out.origin.z, out.step, out.z))
        return std::nullopt;
    return out;
}

void unpackVertices(const PackedVertices& packed, Occluder& occluder) {
    unpack(packed.x, packed.origin.x, packed.step, occluder.x);
    unpack(packed.y, packed.origin.y, packed.step, occluder.y);
    unpack(packed.z, packed.origin.z, packed.step, occluder.z);
}

}  // namespace sightline
