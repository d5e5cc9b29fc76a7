// From the plain values of the C interface to the library's own, checked.
// SPDX-License-Identifier: MIT
#include "sightline/c/impl/convert.h"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>

#include "sightline/geom/clip_space.h"
#include "sightline/math/box.h"

namespace sightline::c {

glm::dmat4 matrix(const double m[16]) {
    glm::dmat4 to(1.0);
    for (int i = 0; m && i < 16; ++i) to[i / 4][i % 4] = m[i];
    return to;
}

bool isProjective(const double m[16]) { return !(m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1); }

const slVisible* visibles(std::span<const Visible> from) {
    static_assert(sizeof(slVisible) == sizeof(Visible) && offsetof(slVisible, key) == offsetof(Visible, key) &&
                  offsetof(slVisible, id) == offsetof(Visible, id) && sizeof(slObjectId) == sizeof(ObjectId) &&
                  offsetof(slObjectId, generation) == offsetof(ObjectId, generation));
    return reinterpret_cast<const slVisible*>(from.data());
}

const slRect* rects(std::span<const ImageRect> from) {
    static_assert(sizeof(slRect) == sizeof(ImageRect) && offsetof(slRect, top) == offsetof(ImageRect, top) &&
                  offsetof(slRect, right) == offsetof(ImageRect, right));
    return from.empty() ? nullptr : reinterpret_cast<const slRect*>(from.data());
}

namespace {

slStatus addPlanes(const double (*from)[4], uint32_t count, ViewPlanes& to) {
    if (count > SL_MOST_PLANES) return SL_BAD_ARGUMENT;
    static_assert(SL_MOST_PLANES == ViewPlanes::kMost);
    for (uint32_t i = 0; i < count; ++i) to.add({from[i][0], from[i][1], from[i][2], from[i][3]});
    return SL_OK;
}

}  // namespace

slStatus toView(const slView* from, const slLog& log, const char* call, View& view) {
    if (!from) return fail(log, SL_BAD_ARGUMENT, call, "the view is null");
    if (from->cookie != kViewCookie)
        return fail(log, SL_NO_DEFAULTS, call, "the view did not begin as slDefaultView()");
    const uint32_t space = numberOf(from->clip_space);
    if (space >= std::size(kClipSpaces)) return fail(log, SL_BAD_ARGUMENT, call, "there is no such clip_space");
    if (addPlanes(from->sections, from->section_count, view.sections) != SL_OK ||
        addPlanes(from->window, from->window_count, view.window) != SL_OK)
        return fail(log, SL_BAD_ARGUMENT, call, "a view has no more than SL_MOST_PLANES sections and window planes");
    view.view = matrix(from->view);
    view.projection = matrix(from->projection);
    if (space != SL_OPENGL) setMatrices(view, view.view, view.projection, kClipSpaces[space].space);
    view.width = from->width;
    view.height = from->height;
    view.jitter = from->jitter;
    view.layers = from->layers;
    view.eye_radius = from->eye_radius;
    return SL_OK;
}

slStatus toSettings(const slQuerySettings* from, const slLog& log, const char* call, QuerySettings& to) {
    if (!from) return SL_OK;
    if (from->cookie != kSettingsCookie)
        return fail(log, SL_NO_DEFAULTS, call, "the settings did not begin as slDefaultQuerySettings()");
    copySettings(*from, to);
    to.windows = static_cast<PortalWindows>(numberOf(from->windows));
    const char* wrong = nullptr;
    forEachSetting([&](const auto& row) {
        const auto value = static_cast<double>(to.*row.member);
        const bool endless = row.most >= 1e300 && std::isinf(value);
        if (!(value >= row.least && (value <= row.most || endless))) wrong = row.name;
    });
    if (!wrong) return SL_OK;
    char sentence[120];
    std::snprintf(sentence, sizeof sentence, "the settings' %s is outside of its limits", wrong);
    return fail(log, SL_BAD_ARGUMENT, call, sentence);
}

namespace {

uint32_t indexAt(const slMesh& mesh, size_t size, size_t i) {
    if (!mesh.indices) return static_cast<uint32_t>(i);
    const char* const at = static_cast<const char*>(mesh.indices) + i * size;
    uint16_t small = 0;
    uint32_t large = 0;
    if (size == 2) return std::memcpy(&small, at, sizeof small), small;
    return std::memcpy(&large, at, sizeof large), large;
}

}  // namespace

slStatus toMesh(const slMesh& from, const slLog& log, const char* call, MeshCopy& mesh) {
    const auto wrong = [&](const char* what) { return fail(log, SL_BAD_ARGUMENT, call, what); };
    const size_t stride = from.stride ? from.stride : 3 * sizeof(float);
    const size_t index_size = from.index_size ? from.index_size : 4;
    const size_t indices = from.indices ? from.index_count : from.vertex_count;
    if (!from.positions && from.vertex_count > 0) return wrong("mesh.positions is null");
    if (stride < 3 * sizeof(float)) return wrong("mesh.stride is less than the 12 bytes of a position");
    if (index_size != 2 && index_size != 4) return wrong("mesh.index_size must be 2 or 4");
    if (indices % 3 != 0) return wrong("the mesh's indices are not three a triangle");
    if (from.vertex_count > UINT32_MAX || indices > UINT32_MAX)
        return wrong("the mesh has more than 2^32 - 1 elements");
    for (size_t i = 0; i < indices; ++i)
        if (indexAt(from, index_size, i) >= from.vertex_count) {
            char sentence[120];
            std::snprintf(sentence, sizeof sentence, "index %zu of the mesh is %u, and there are %zu vertices", i,
                          indexAt(from, index_size, i), from.vertex_count);
            return wrong(sentence);
        }
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    const auto isAligned = [](const void* at) { return reinterpret_cast<uintptr_t>(at) % alignof(uint32_t) == 0; };
    if (stride == sizeof(glm::vec3) && isAligned(from.positions)) {
        mesh.view.positions = {reinterpret_cast<const glm::vec3*>(from.positions), from.vertex_count};
    } else {
        mesh.positions.resize(from.vertex_count);
        for (size_t v = 0; v < from.vertex_count; ++v)
            std::memcpy(&mesh.positions[v], reinterpret_cast<const char*>(from.positions) + v * stride,
                        sizeof(glm::vec3));
        mesh.view.positions = mesh.positions;
    }
    if (from.indices && index_size == 4 && isAligned(from.indices)) {
        mesh.view.indices = {static_cast<const uint32_t*>(from.indices), indices};
    } else {
        mesh.indices.resize(indices);
        for (size_t i = 0; i < indices; ++i) mesh.indices[i] = indexAt(from, index_size, i);
        mesh.view.indices = mesh.indices;
    }
    return SL_OK;
}

}  // namespace sightline::c
