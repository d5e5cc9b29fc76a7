// The occlusion buffer of the C interface.
// SPDX-License-Identifier: MIT
#include "sightline/c/buffer.h"

#include <cmath>
#include <limits>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/cull/occlusion_buffer.h"

using namespace sightline;
using c::fail;

struct slBuffer {
    c::SharedHooks hooks;
    uint32_t size;
    OcclusionBuffer buffer{size, hooks->memory()};
    bool perspective = true;
    Array<float> nearness{hooks->memory()};
    Array<uint8_t> covered{hooks->memory()};

    const slLog& log() const { return hooks->log(); }
};

namespace {

slStatus failNull(const slBuffer* buffer, const char* call) {
    return fail(buffer ? buffer->log() : slLog{}, SL_BAD_ARGUMENT, call, "a pointer is null");
}

slSeen seen(Sight sight) {
    switch (sight) {
        case Sight::kOccluded:
            return SL_HIDDEN;
        case Sight::kOutside:
            return SL_OUTSIDE;
        case Sight::kVisible:
            break;
    }
    return SL_SEEN;
}

/// No smaller than the box.
Box3f widened(const Box3d& from) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Box3f to;
    for (int axis = 0; axis < 3; ++axis) {
        to.min[axis] = static_cast<float>(from.min[axis]);
        to.max[axis] = static_cast<float>(from.max[axis]);
        if (static_cast<double>(to.min[axis]) > from.min[axis]) to.min[axis] = std::nextafter(to.min[axis], -kInfinity);
        if (static_cast<double>(to.max[axis]) < from.max[axis]) to.max[axis] = std::nextafter(to.max[axis], kInfinity);
    }
    return to;
}

}  // namespace

slStatus slCreateBuffer(uint32_t size, const slHooks* hooks, slBuffer** buffer_out) {
    const slLog log = hooks ? hooks->log : slLog{};
    if (!buffer_out) return fail(log, SL_BAD_ARGUMENT, __func__, "buffer_out is null");
    if (size < 1 || size > 8192) return fail(log, SL_BAD_ARGUMENT, __func__, "size must be 1 to 8192");
    if (const slStatus status = c::checkHooks(hooks, __func__)) return status;
    *buffer_out = c::makeHandle<slBuffer>(c::shareHooks(hooks), size);
    return SL_OK;
}

void slDestroyBuffer(slBuffer* buffer) { c::destroyHandle(buffer); }

slStatus slBufferBegin(slBuffer* buffer, const slView* view) {
    if (!buffer) return failNull(buffer, __func__);
    View to;
    if (const slStatus status = c::toView(view, buffer->log(), __func__, to)) return status;
    const ViewProblem problem = buffer->buffer.begin(to);
    buffer->perspective = problem != ViewProblem::kNone || !isOrthographic(to);
    return problem == ViewProblem::kNone ? SL_OK : fail(buffer->log(), SL_BAD_ARGUMENT, __func__, wordsOf(problem));
}

slStatus slBufferDraw(slBuffer* buffer, const slOccluder* occluder, const double transform[16],
                      uint32_t* triangles_out) {
    if (!buffer || !occluder) return failNull(buffer, __func__);
    if (transform && c::isProjective(transform)) return fail(buffer->log(), SL_BAD_ARGUMENT, __func__, c::kProjective);
    const uint32_t drawn = buffer->buffer.draw(occluder->occluder, c::matrix(transform));
    if (triangles_out) *triangles_out = drawn;
    return SL_OK;
}

slStatus slBufferAsk(slBuffer* buffer, const slBox* boxes, size_t count, uint8_t* seen_out) {
    if (!buffer || ((!boxes || !seen_out) && count > 0)) return failNull(buffer, __func__);
    constexpr size_t kAtOnce = 64;
    Box3d group[kAtOnce];
    Sight answers[kAtOnce];
    for (size_t first = 0; first < count; first += kAtOnce) {
        const size_t n = std::min(kAtOnce, count - first);
        for (size_t i = 0; i < n; ++i) group[i] = c::box(boxes[first + i]);
        buffer->buffer.ask({group, n}, {answers, n});
        for (size_t i = 0; i < n; ++i) seen_out[first + i] = static_cast<uint8_t>(seen(answers[i]));
    }
    return SL_OK;
}

slStatus slBufferAskOriented(slBuffer* buffer, const slBox* box, const double transform[16], slSeen* seen_out) {
    if (!buffer || !box || !seen_out) return failNull(buffer, __func__);
    if (transform && c::isProjective(transform)) return fail(buffer->log(), SL_BAD_ARGUMENT, __func__, c::kProjective);
    *seen_out = seen(buffer->buffer.ask(widened(c::box(*box)), c::matrix(transform)));
    return SL_OK;
}

slStatus slBufferImage(slBuffer* buffer, slDepthImage* image_out) {
    if (!buffer || !image_out) return failNull(buffer, __func__);
    const size_t pixels = size_t{buffer->buffer.width()} * buffer->buffer.height();
    buffer->nearness.resize(pixels);
    buffer->covered.resize(pixels);
    buffer->buffer.depthImage(buffer->nearness, buffer->covered);
    *image_out = {buffer->buffer.width(), buffer->buffer.height(), buffer->perspective, buffer->nearness.data(),
                  buffer->covered.data()};
    return SL_OK;
}
