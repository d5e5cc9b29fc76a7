// Worlds drawn by occlusion queries: what an exact z-buffer shows is drawn, while objects move, go and change layers.
// SPDX-License-Identifier: MIT
#include "sightline/query/object_queries.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "sightline/studies/gpu/simulated_gpu.h"
#include "tests/support/made_world.h"

namespace sightline::test {
namespace {

/// A simulated GPU that is told objects by their keys.
class KeyDevice : public ObjectDevice {
public:
    explicit KeyDevice(SimulatedGpu& gpu) : gpu_(gpu) {}

    void draw(std::span<const Visible> objects) override {
        for (const Visible& object : objects) {
            const uint32_t item = static_cast<uint32_t>(object.key);
            gpu_.draw({&item, 1});
        }
    }
    void ask(uint32_t question, std::span<const Box3d> boxes) override { gpu_.ask(question, boxes); }
    bool hasAnswer(uint32_t question) override { return gpu_.hasAnswer(question); }
    uint64_t answer(uint32_t question) override { return gpu_.answer(question); }

private:
    SimulatedGpu& gpu_;
};

std::vector<DrawItem> itemsOf(const MadeWorld& made) {
    std::vector<DrawItem> items;
    for (const glm::dmat4& transform : made.transforms) {
        DrawItem item;
        item.mesh = made.mesh.view();
        item.transform = transform;
        items.push_back(item);
    }
    return items;
}

TEST(ObjectQueries, DrawWhatAnExactZBufferShows) {
    MadeWorld made(31, 500);
    std::vector<DrawItem> items = itemsOf(made);
    SimulatedGpu gpu(items), all(items);
    KeyDevice device(gpu);
    ObjectQueries queries;
    Random random(32);
    size_t drawn_count = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (int i = 0; i < 10; ++i) {
            const size_t which = random.below(made.transforms.size());
            items[which].transform[3] += glm::dvec4(randomVector(random, 1.0), 0);
            made.world.move(made.ids[which], items[which].transform);
        }
        const View view = randomView(random);
        gpu.beginFrame(view);
        const std::span<const Visible> drawn = queries.draw(made.world.commit(), view, device);
        std::vector<uint8_t> kept(items.size(), 0);
        for (const Visible& object : drawn) {
            EXPECT_EQ(object.id, made.ids[object.key]);
            kept[object.key] = 1;
        }
        drawn_count += drawn.size();
        all.beginFrame(view);
        for (uint32_t i = 0; i < items.size(); ++i) all.draw({&i, 1});
        for (const uint32_t item : all.shown()) {
            if (item == SimulatedGpu::kNone) continue;
            EXPECT_EQ(kept[item], 1) << "frame " << frame << ": object " << item;
            kept[item] = 1;
        }
    }
    EXPECT_LT(drawn_count, 60u * 500 / 2);
}

TEST(ObjectQueries, KeepToLayersAndDrawFirstWhatHasNoBounds) {
    MadeWorld made;
    made.add({-5, -5, -10}, {5, 5, -9}, true, 1);
    made.add({-1, -1, -6}, {1, 1, -5}, true, 2);
    made.add({-1, -1, -20}, {1, 1, -19}, true, 1);
    glm::dmat4 nowhere(1.0);
    nowhere[3][0] = std::numeric_limits<double>::quiet_NaN();
    made.add(nowhere, false, 1);
    const std::vector<DrawItem> items = itemsOf(made);
    SimulatedGpu gpu(items);
    KeyDevice device(gpu);
    ObjectQueries queries;
    View view = viewFrom({0, 0, 0}, {0, 0, -1});
    const auto keysIn = [&](uint32_t layers) {
        view.layers = layers;
        std::vector<uint64_t> keys;
        for (int frame = 0; frame < 12; ++frame) {  // what was seen before anything was drawn is asked again
            gpu.beginFrame(view);
            keys.clear();
            for (const Visible& object : queries.draw(made.world.commit(), view, device)) keys.push_back(object.key);
        }
        return keys;
    };
    EXPECT_EQ(keysIn(1), (std::vector<uint64_t>{3, 0}));  // the wall hides what is behind it
    EXPECT_EQ(keysIn(2), (std::vector<uint64_t>{1}));
    EXPECT_EQ(keysIn(3), (std::vector<uint64_t>{3, 1, 0}));
    EXPECT_TRUE(keysIn(4).empty());
}

TEST(ObjectQueries, DrawNothingOfNoSnapshot) {
    SimulatedGpu gpu({});
    KeyDevice device(gpu);
    EXPECT_TRUE(ObjectQueries().draw(Snapshot(), viewFrom({0, 0, 0}, {0, 0, -1}), device).empty());
}

}  // namespace
}  // namespace sightline::test
