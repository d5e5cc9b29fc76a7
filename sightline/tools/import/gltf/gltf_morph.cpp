// Where morph targets may take vertices: each weight moves within its range, whatever the others do.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "sightline/tools/import/gltf/gltf_accessor.h"
#include "sightline/math/finite.h"
#include "sightline/tools/import/gltf/gltf_deform.h"

namespace sightline::tools::gltf {
namespace {

void addTarget(const std::vector<float>& displacements, const VertexRun& run, double rest, const Range& range,
               MorphReach& out) {
    for (size_t i = 0; i < run.source.size(); ++i) {
        const float* xyz = &displacements[size_t(run.source[i]) * 3];
        const glm::dvec3 displacement(xyz[0], xyz[1], xyz[2]);
        const glm::dvec3 a = range.low * displacement, b = range.high * displacement;
        const size_t vertex = run.first + i;
        out.rest[vertex] += rest * displacement;
        out.low[vertex] += glm::min(a, b);
        out.high[vertex] += glm::max(a, b);
    }
}

// Here, vertex by vertex: a box that grows would lose a NaN.
void checkFinite(const MorphReach& reach, const BuiltMesh& built) {
    for (size_t i = 0; i < reach.rest.size(); ++i)
        if (!isFinite(reach.low[i]) || !isFinite(reach.high[i]) || !isFinite(glm::dvec3(glm::vec3(reach.rest[i]))))
            fail(built.runs[0].primitive->place, "its morph targets leave what a float can hold");
}

}  // namespace

MorphReach morphReach(Document& document, const BuiltMesh& built, const std::vector<float>& rest,
                      const std::vector<Range>& ranges) {
    const std::vector<glm::vec3>& positions = built.mesh.positions;
    MorphReach out;
    if (!built.runs.empty())
        document.budget.charge(positions.size(), 3 * sizeof(glm::dvec3), built.runs[0].primitive->place);
    out.rest.assign(positions.begin(), positions.end());
    out.low = out.high = out.rest;
    for (const VertexRun& run : built.runs) {
        const std::vector<std::optional<uint32_t>>& targets = run.primitive->targets;
        for (size_t t = 0; t < targets.size() && !run.source.empty(); ++t) {
            if (!targets[t]) continue;
            const uint64_t count = document.accessors[*targets[t]].count;
            const uint64_t vertices = document.accessors[run.primitive->positions].count;
            if (count != vertices)
                fail(run.primitive->place + at(".targets", t), "moves {} vertices of {}", count, vertices);
            addTarget(decodeFloats(document, *targets[t], 3, "displacement"), run, t < rest.size() ? rest[t] : 0.0,
                      t < ranges.size() ? ranges[t] : Range{0, 1}, out);
        }
    }
    checkFinite(out, built);
    return out;
}

void applyMorph(const MorphReach& reach, Mesh& mesh) {
    mesh.deforms = true;
    mesh.bounds = {};
    for (size_t i = 0; i < reach.rest.size(); ++i) {
        mesh.positions[i] = glm::vec3(reach.rest[i]);
        mesh.bounds.grow(reach.low[i]);
        mesh.bounds.grow(reach.high[i]);
        mesh.bounds.grow(glm::dvec3(mesh.positions[i]));
    }
    // A renderer adds the targets up in single precision.
    const glm::dvec3 slack = 1e-5 * glm::max(glm::abs(mesh.bounds.min), glm::abs(mesh.bounds.max));
    mesh.bounds.min -= slack;
    mesh.bounds.max += slack;
}

}  // namespace sightline::tools::gltf
