// Walls, panes and clutter that come, move and go, drawn by a simulated GPU: for the laws of occlusion queries.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/cull/queries/occlusion_queries.h"
#include "sightline/studies/gpu/simulated_gpu.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace studies;

class QueriedWorld {
public:
    QueriedWorld(uint64_t seed, uint32_t count) : random_(seed) {
        pane_.add({{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}});
        both_.assign(2, 1);
        std::vector<Box3d> boxes;
        std::vector<uint32_t> numbers;
        for (uint32_t i = 0; i < count; ++i) {
            items_.push_back(itemAt(i));
            boxes.push_back(boxOf(i));
            numbers.push_back(i);
        }
        here_.assign(count, 1);
        tree_.build(boxes, numbers);
    }

    const PlacedBvh& tree() const { return tree_.now(); }
    std::span<const DrawItem> items() const { return items_; }
    std::vector<uint32_t> here() const {
        std::vector<uint32_t> all;
        for (uint32_t i = 0; i < items_.size(); ++i)
            if (here_[i]) all.push_back(i);
        return all;
    }

    /// Some move a little, two jump: doors and walls among them.
    /// @returns them
    std::vector<uint32_t> moveSome() {
        std::vector<uint32_t> moved;
        for (int i = 0; i < 12; ++i) {
            const uint32_t item = any();
            const glm::dvec3 by = randomVector(random_, i < 10 ? 0.5 : 20.0);
            if (here_[item] == 0) continue;
            place(item, by);
            moved.push_back(item);
        }
        return moved;
    }
    /// These move, one goes and one comes.
    void change() {
        moveSome();
        const uint32_t gone = any(), come = any();
        if (here_[gone]) tree_.remove(gone);
        here_[gone] = 0;
        if (!here_[come]) insert(come);
        here_[come] = 1;
    }
    /// New numbers for all nodes.
    void rebuild() {
        std::vector<Box3d> boxes;
        const std::vector<uint32_t> numbers = here();
        for (const uint32_t item : numbers) boxes.push_back(boxOf(item));
        tree_.build(boxes, numbers);
    }

private:
    uint32_t any() { return static_cast<uint32_t>(random_.below(items_.size())); }

    DrawItem itemAt(uint32_t i) {
        glm::dvec3 size(random_.uniform(0.1, 1.5), random_.uniform(0.1, 1.5), random_.uniform(0.1, 1.5));
        if (i % 4 == 0) size = {random_.uniform(3, 15), random_.uniform(2, 8), 0.2};
        if (i % 8 == 0) std::swap(size.x, size.z);
        DrawItem item;
        item.mesh = i % 3 == 1 ? pane_.view() : cube_.view();
        if (i % 3 == 1) item.double_sided = both_;
        for (int axis = 0; axis < 3; ++axis) item.transform[axis][axis] = size[axis];
        if (i % 5 == 0) item.transform[0][1] = random_.uniform(-0.5, 0.5);
        item.transform[3] = glm::dvec4(randomVector(random_, {20, 5, 20}), 1.0);
        return item;
    }
    Box3d boxOf(uint32_t item) const {
        const glm::dvec3 low(0, 0, item % 3 == 1 ? 0.5 : 0), high(1, 1, item % 3 == 1 ? 0.5 : 1);
        return transformBox({low, high}, items_[item].transform);
    }
    void insert(uint32_t item) {
        const Box3d box = boxOf(item);
        if (tree_.insert(item, box) == WorldBvh::kNone) tree_.append({&box, 1}, {&item, 1});
    }
    void place(uint32_t item, const glm::dvec3& by) {
        items_[item].transform[3] += glm::dvec4(by, 0.0);
        if (tree_.move(item, boxOf(item))) return;
        tree_.remove(item);
        insert(item);
    }

    Random random_;
    TestMesh cube_ = boxMesh(), pane_;
    std::vector<uint8_t> both_, here_;
    std::vector<DrawItem> items_;
    WorldBvh tree_;
};

/// A frame by queries beside the same frame with all that is there: the image must be the same, sample for sample.
class HeldToAll {
public:
    HeldToAll(const QueriedWorld& world, const SimulatedGpuSettings& settings)
        : world_(world), gpu_(world.items(), settings), all_(world.items(), settings) {}

    /// @returns the items that the image of all shows and that were not drawn
    std::vector<uint32_t> missed(OcclusionQueries& queries, const View& view, const OcclusionQuerySettings& settings,
                                 const std::string& what) {
        gpu_.beginFrame(view);
        const std::span<const uint32_t> drawn = queries.draw(world_.tree(), view, gpu_, settings);
        gpu_.endFrame();
        all_.beginFrame(view);
        all_.draw(world_.here());
        std::vector<uint8_t> kept(world_.items().size(), 0);
        for (const uint32_t item : drawn) {
            EXPECT_EQ(kept[item], 0) << what << ": item " << item << " is drawn twice";
            kept[item] = 1;
        }
        drawn_ += drawn.size();
        std::vector<uint32_t> missed;
        for (const uint32_t item : all_.shown()) {
            if (item == SimulatedGpu::kNone) continue;
            shown_ += kept[item] == 1;
            if (kept[item] == 0) missed.push_back(item);
            kept[item] |= 2;
        }
        if (missed.empty()) {
            for (size_t i = 0; i < all_.depths().size(); ++i)
                if (gpu_.depths()[i] != all_.depths()[i]) {
                    ADD_FAILURE() << what << ": another depth at sample " << i;
                    break;
                }
        }
        return missed;
    }

    SimulatedGpu& gpu() { return gpu_; }
    size_t drawn() const { return drawn_; }  ///< in all frames
    size_t shown() const { return shown_; }  ///< items in all frames

private:
    const QueriedWorld& world_;
    SimulatedGpu gpu_, all_;
    size_t drawn_ = 0, shown_ = 0;
};

}  // namespace sightline::test
