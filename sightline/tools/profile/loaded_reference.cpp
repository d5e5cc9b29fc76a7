// The reference z-buffer as a subject: more pixels, more vertices, more bytes or more queries, and no more of the rest.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/loaded_reference.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sightline/studies/hidden/render.h"

namespace sightline::tools {
using namespace studies;
namespace {

constexpr double kHardlyAny = 1.0 / 256;  // of the pixels
constexpr double kLargestSide = 16384;    // [pixels]

uint32_t wholeTimes(double factor) { return static_cast<uint32_t>(std::max(1.0, std::round(factor))); }

uint32_t scaledSide(uint32_t side, double by) {
    return static_cast<uint32_t>(std::clamp(std::round(side * by), 1.0, kLargestSide));
}

uint64_t bytesOf(const DrawItem& item, bool stream) {
    uint64_t bytes = sizeof(glm::mat4);
    if (stream) bytes += item.mesh.positions.size_bytes() + item.mesh.indices.size_bytes();
    return bytes;
}

}  // namespace

uint64_t carriedBytes(std::span<const DrawItem> items, bool stream) {
    uint64_t bytes = 0;
    for (const DrawItem& item : items) bytes += bytesOf(item, stream);
    return bytes;
}

View withPixels(View view, double times) {
    const double by = std::sqrt(times);
    view.width = scaledSide(view.width, by);
    view.height = scaledSide(view.height, by);
    return view;
}

uint64_t countFragments(std::span<const DrawItem> items, const View& view, uint32_t threads) {
    RenderSettings settings;
    settings.threads = threads;
    settings.want_counts = true;
    return render(DrawList(items), view, settings).counters.generated;
}

void LoadedReference::carry(std::span<const DrawItem> items, double times) {
    const uint64_t wanted = static_cast<uint64_t>(times * static_cast<double>(carriedBytes(items, settings_.stream)));
    if (staging_.size() < wanted) staging_.resize(wanted);
    bytes_ = 0;
    const auto put = [&](const void* from, uint64_t count) {
        count = std::min(count, wanted - bytes_);
        std::memcpy(staging_.data() + bytes_, from, count);
        bytes_ += count;
    };
    while (bytes_ < wanted)
        for (const DrawItem& item : items) {
            const glm::mat4 transform(item.transform);
            put(&transform, sizeof transform);
            if (!settings_.stream) continue;
            put(item.mesh.positions.data(), item.mesh.positions.size_bytes());
            put(item.mesh.indices.data(), item.mesh.indices.size_bytes());
        }
}

FrameTimes LoadedReference::draw(const View& view, const SubmitFrame& submit, const StageLoads& loads) {
    const FrameClock clock;
    std::span<const DrawItem> items;
    for (uint32_t i = 0; i < wholeTimes(loads.cpu); ++i) items = submit();
    carry(items, std::max(loads.bus, 0.0));
    const DrawList list(items);
    RenderSettings settings;
    settings.threads = settings_.threads;
    settings.zbuffer_memory = &memory_;
    counters_ = render(list, loads.fill == 1 ? view : withPixels(view, loads.fill), settings).counters;
    settings.zbuffer_memory = &small_memory_;
    for (uint32_t i = 1; i < wholeTimes(loads.transform); ++i) render(list, withPixels(view, kHardlyAny), settings);
    FrameTimes times = clock.times();
    times.gpu = 0.0;
    return times;
}

}  // namespace sightline::tools
