// What can be seen in a snapshot from a view: one front-to-back walk, frustum and occlusion.
// SPDX-License-Identifier: MIT
#include "sightline/run/query.h"

#include <algorithm>
#include <chrono>

#include "sightline/raster/depth_image.h"
#include "sightline/run/explain.h"
#include "sightline/run/walk.h"

namespace sightline {

struct Query::Impl {
    explicit Impl(Memory* from) : memory(from) {}

    Memory* const memory;
    Snapshot snapshot;  ///< of the last answer
    detail::Walk walk{memory};
    Array<Visible> before{memory};  ///< the answer before the last
    Array<float> depth_image{memory};
    Array<uint8_t> depth_covered{memory};
    Array<Visible> appeared{memory}, disappeared{memory};
    Array<uint32_t> mark{memory};  ///< per ObjectId::index: 1 + place in `before`, while changes() runs; else 0
};

Query::Query(Memory* memory) : impl_(makeOwned<Impl>(memory, memory)) {}
Query::~Query() = default;
Query::Query(Query&&) noexcept = default;
Query& Query::operator=(Query&&) noexcept = default;

VisibleSet Query::visible(const Snapshot& now, const View& view) {
    const auto start = std::chrono::steady_clock::now();
    Impl& impl = *impl_;
    detail::Walk& walk = impl.walk;
    std::swap(walk.visible, impl.before);
    impl.snapshot = now;
    walk.run(now ? &now.state() : nullptr, view);
    walk.stats.nanoseconds = static_cast<uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count());
    if (view.time_stages && walk.uses(Stage::kOcclusion))
        walk.of(Stage::kOcclusion).nanoseconds =
            walk.stats.nanoseconds - walk.of(Stage::kFrustum).nanoseconds - walk.of(Stage::kVolumes).nanoseconds;
    return {walk.visible, walk.stats};
}

VisibleChanges Query::changes() {
    Impl& impl = *impl_;
    impl.appeared.clear();
    impl.disappeared.clear();
    uint32_t last = 0;
    for (const auto* set : {&impl.before, &impl.walk.visible})
        for (const Visible& v : *set) last = std::max(last, v.id.index);
    if (impl.mark.size() <= last) impl.mark.resize(last + 1, 0);
    for (size_t i = 0; i < impl.before.size(); ++i) impl.mark[impl.before[i].id.index] = static_cast<uint32_t>(i + 1);
    for (const Visible& v : impl.walk.visible) {
        uint32_t& mark = impl.mark[v.id.index];
        if (mark > 0 && impl.before[mark - 1].id == v.id) mark = 0;
        else impl.appeared.push_back(v);
    }
    for (const Visible& v : impl.before) {
        uint32_t& mark = impl.mark[v.id.index];
        if (mark > 0) impl.disappeared.push_back(v);
        mark = 0;
    }
    return {impl.appeared, impl.disappeared};
}

void Query::reasons(std::span<uint8_t> reasons) const { impl_->walk.reasons(reasons); }

Explanation Query::explain(const Snapshot& now, const View& view, ObjectId id) const {
    return Explainer(now, view, impl_->memory).explain(id);
}

Query::DepthImage Query::depthImage(bool resolve_seams) {
    Impl& impl = *impl_;
    DepthTiles& tiles = impl.walk.tiles;
    const size_t pixels = size_t{tiles.width} * tiles.height;
    impl.depth_image.resize(pixels);
    impl.depth_covered.resize(pixels);
    readDepthImage(tiles, resolve_seams ? Seams::kResolve : Seams::kLeave, impl.depth_image, impl.depth_covered, 0.0f);
    return {tiles.width, tiles.height, impl.walk.screen.perspective, impl.depth_image, impl.depth_covered};
}

}  // namespace sightline
