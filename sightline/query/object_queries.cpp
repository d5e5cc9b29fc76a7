// A world drawn by a graphics interface's own occlusion queries, where it has some and a frame may wait for them.
// SPDX-License-Identifier: MIT
#include "sightline/query/object_queries.h"

#include "sightline/base/assert.h"
#include "sightline/world/world_state.h"

namespace sightline {
namespace {

/// Says of rows which objects they are.
class RowDevice : public QueryDevice {
public:
    RowDevice(const detail::SnapshotState& state, uint32_t layers, ObjectDevice& device, Array<Visible>& drawn)
        : state_(state), layers_(layers), device_(device), drawn_(drawn) {}

    void draw(std::span<const uint32_t> rows) override {
        const size_t before = drawn_.size();
        for (const uint32_t row : rows) {
            SIGHTLINE_DEBUG_ASSERT(row < state_.objects.size());
            const detail::ObjectRecord& object = state_.objects[row];
            if ((object.layers & layers_) != 0) drawn_.push_back({object.key, object.id});
        }
        if (drawn_.size() > before) device_.draw(std::span<const Visible>(drawn_).subspan(before));
    }
    void ask(uint32_t question, std::span<const Box3d> boxes) override { device_.ask(question, boxes); }
    bool hasAnswer(uint32_t question) override { return device_.hasAnswer(question); }
    uint64_t answer(uint32_t question) override { return device_.answer(question); }

private:
    const detail::SnapshotState& state_;
    uint32_t layers_;
    ObjectDevice& device_;
    Array<Visible>& drawn_;
};

}  // namespace

ObjectQueries::ObjectQueries(Memory* memory) : queries_(memory), drawn_(memory) {}

std::span<const Visible> ObjectQueries::draw(const Snapshot& now, const View& view, ObjectDevice& device,
                                             const OcclusionQuerySettings& settings) {
    drawn_.clear();
    if (!now) return drawn_;
    const detail::SnapshotState& state = now.state();
    RowDevice rows(state, view.layers, device, drawn_);
    if (!state.unbounded.empty()) rows.draw(state.unbounded);
    queries_.draw(state.bvh, view, rows, settings);
    return drawn_;
}

}  // namespace sightline
