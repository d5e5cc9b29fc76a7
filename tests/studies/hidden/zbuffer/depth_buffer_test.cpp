// Depth tests of every kind against a model that knows no tiles: one sample after the other, in the order of drawing.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_buffer_draw.h"

#include <gtest/gtest.h>

#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"
#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

View viewOf(bool parallel, uint32_t width = 83, uint32_t height = 66) {
    View view = madeView(width, height);
    if (parallel) view.projection = orthographic(4.0, double(width) / height, 0.5, 50.0);
    return view;
}

bool keepsSome(uint32_t surface, int32_t row, int32_t sample) {
    return mixSeed(surface, static_cast<uint64_t>(row) * 4096 + static_cast<uint64_t>(sample)) % 3 != 0;
}

/// Up or down by as much as a tenth.
double otherNearness(uint32_t surface, int32_t row, int32_t sample, double nearness) {
    const uint64_t mixed = mixSeed(surface, static_cast<uint64_t>(row) * 4096 + static_cast<uint64_t>(sample));
    return nearness * (0.9 + 0.2 * static_cast<double>(mixed % 1000) / 1000);
}

/// What a z-buffer is, said as plainly as can be.
class Model {
public:
    Model(const View& view, const DepthCodec& codec, DepthKey clear)
        : image(emptyImage(view)), keys(image.surface.size(), clear), view_(view), codec_(codec) {}

    void draw(const ScreenPolygon& polygon, DepthComparison comparison, const DepthSettings& settings) {
        const double offset = codec_.polygonOffset(polygon.depth, settings.offset_factor, settings.offset_units);
        const DepthShader& shader = settings.shader;
        scanPolygon(polygon.outline(), 0, int32_t(view_.height), int32_t(view_.width),
                    [&](int32_t row, int32_t begin, int32_t end) {
                        for (int32_t i = begin; i < end; ++i) {
                            ++image.counters.generated;
                            DepthKey& there = keys[size_t(row) * view_.width + size_t(i)];
                            const double nearness = polygon.depth.at(row, i);
                            const DepthKey plane = codec_.encode(nearness, offset);
                            DepthKey comes = plane;
                            if (shader.kind == ShaderKind::kDiscards && !shader.keeps(polygon.surface, row, i))
                                continue;
                            if (shader.kind >= ShaderKind::kWritesDepth)
                                comes = codec_.encode(shader.nearness(polygon.surface, row, i, nearness));
                            if (shader.kind == ShaderKind::kWritesFarther)
                                comes = codec_.convention.farther(comes, plane);
                            if (!passes(comparison, comes, there)) continue;
                            ++image.counters.passed;
                            image.at(row, i) = polygon.surface;
                            if (settings.write) there = comes;
                        }
                    });
    }

    HiddenImage image;
    std::vector<DepthKey> keys;

private:
    const View& view_;
    const DepthCodec& codec_;
};

/// Also that the whole pipeline, with and without what it saves, is what the model is.
void expectLikeModel(const MadeList& made, const View& view, RenderSettings settings, const std::string& what) {
    const DrawList list = made.list();
    const DepthCodec codec = depthCodecFor(list, view, settings.depth.format);
    const DepthComparison comparison = settings.depth.comparison.value_or(codec.convention.comparison);
    const DepthKey clear =
        settings.depth.clear_value ? codec.keyOf(*settings.depth.clear_value) : codec.convention.far_value;
    Model model(view, codec, clear);
    Projector projector(view, {view.width, view.height, 0, 1, {}});
    for (const ScreenPolygon& polygon : projectAll(list, projector)) model.draw(polygon, comparison, settings.depth);
    ZBufferMemory memory;
    settings.zbuffer_memory = &memory;
    for (int saves = 0; saves < 8; ++saves) {
        settings.depth.early_test = (saves & 1) != 0;
        settings.depth.hierarchy = (saves & 2) != 0;
        settings.depth.fast_clear = (saves & 2) != 0;
        settings.want_counts = (saves & 4) != 0;
        const HiddenImage image = render(list, view, settings);
        const std::string where = what + ", " + made.name + ", saves " + std::to_string(saves);
        ASSERT_EQ(image.surface, model.image.surface) << where;
        ASSERT_EQ(image.counters.passed, model.image.counters.passed) << where;
        for (uint32_t row = 0; row < view.height; ++row)
            for (uint32_t i = 0; i < view.width; ++i)
                ASSERT_EQ(memory.buffer.at(int32_t(row), int32_t(i)), model.keys[row * view.width + i])
                    << where << ": depth at " << i << " " << row;
        if (!settings.want_counts && settings.depth.hierarchy && settings.depth.early_test) continue;
        EXPECT_EQ(image.counters.generated, model.image.counters.generated) << where;
    }
}

TEST(DepthBuffer, ComparesAsTheModelDoes) {
    Random random(4);
    for (int comparison = 0; comparison < kDepthComparisons; ++comparison)
        for (int trial = 0; trial < 10; ++trial) {
            // Coarse formats, too, so that there are equal depths.
            RenderSettings settings;
            settings.depth.format = static_cast<DepthFormat>(trial % kDepthFormats);
            settings.depth.comparison = static_cast<DepthComparison>(comparison);
            settings.depth.write = trial % 3 != 0;
            const View view = viewOf(trial % 4 == 3);
            const MadeList made = trial % 2 != 0 ? clutter(random.next() % 1000, 250, 0.8) : coplanar(random.next());
            if (trial % 5 != 0) {
                const DrawList list = made.list();
                const DepthCodec codec = depthCodecFor(list, view, settings.depth.format);
                settings.depth.clear_value =
                    codec.pattern(codec.encodeDistance(codec.range.near_plane + random.uniform(0.5, 6)));
            }
            expectLikeModel(made, view, settings,
                            "comparison " + std::to_string(comparison) + " trial " + std::to_string(trial));
        }
}

TEST(DepthBuffer, TestsShadersThatDiscardOrWriteDepth) {
    for (const ShaderKind kind : {ShaderKind::kDiscards, ShaderKind::kWritesDepth, ShaderKind::kWritesFarther})
        for (int comparison = 0; comparison < kDepthComparisons; ++comparison)
            for (const DepthFormat format : {DepthFormat::kReversedFloat, DepthFormat::kUnorm24}) {
                RenderSettings settings;
                settings.depth.format = format;
                settings.depth.comparison = static_cast<DepthComparison>(comparison);
                settings.depth.shader = {kind, keepsSome, otherNearness};
                expectLikeModel(
                    clutter(31, 300, 0.8), viewOf(false), settings,
                    "shader " + std::to_string(static_cast<int>(kind)) + " comparison " + std::to_string(comparison));
            }
}

TEST(DepthBuffer, OffsetsPolygons) {
    for (const DepthFormat format : {DepthFormat::kReversedFloat, DepthFormat::kUnorm16, DepthFormat::kFloat,
                                     DepthFormat::kLinear, DepthFormat::kIntegerInverse}) {
        RenderSettings settings;
        settings.depth.format = format;
        settings.depth.offset_factor = 1.5;
        settings.depth.offset_units = 2;
        expectLikeModel(clutter(41, 300, 0.8), viewOf(false), settings, "offset");
    }
}

TEST(DepthBuffer, ShadesBeforeOrAfterTheTest) {
    const MadeList made = clutter(51, 600, 0.8);
    const DrawList list = made.list();
    const auto shadedAndPassed = [&](ShaderKind kind, bool early) {
        RenderSettings settings;
        settings.want_counts = true;
        settings.depth.early_test = early;
        settings.depth.shader = {kind, keepsSome, otherNearness};
        const HiddenCounters c = render(list, viewOf(false), settings).counters;
        EXPECT_LE(c.passed, c.shaded);
        EXPECT_LE(c.shaded, c.generated);
        return std::pair(c.shaded, c.generated);
    };
    for (const ShaderKind kind :
         {ShaderKind::kPlain, ShaderKind::kDiscards, ShaderKind::kWritesDepth, ShaderKind::kWritesFarther}) {
        const auto [late, all] = shadedAndPassed(kind, false);
        EXPECT_EQ(late, all);
        const auto [early, same] = shadedAndPassed(kind, true);
        EXPECT_EQ(all, same);
        // A shader that writes depth is run for every fragment; all others are spared those that are hidden.
        if (kind == ShaderKind::kWritesDepth) EXPECT_EQ(early, late);
        else EXPECT_LT(5 * early, 4 * late);
    }
}

TEST(DepthBuffer, BoundsHoldWhenTheComparisonChanges) {
    // The direction turns about in the middle of a frame, several times: a hierarchy that trusted one bound from before
    // would reject what passes.
    uint64_t rejected = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        const View view = viewOf(false);
        const DepthCodec codec(static_cast<DepthFormat>(seed % kDepthFormats), {0.1, 100, false});
        HiddenImage image = emptyImage(view);
        const DepthKey clear = codec.encodeDistance(random.uniform(1, 8));
        DepthBuffer buffer(view.width, view.height, clear);
        Model model(view, codec, clear);
        DepthDrawScratch scratch;
        for (int part = 0; part < 8; ++part) {
            const MadeList made = clutter(100 * seed + static_cast<uint64_t>(part), 60, 1.2);
            const DrawList list = made.list();
            DepthSettings settings;
            settings.write = random.below(4) != 0;
            settings.compression = seed % 2 != 0;
            const DepthComparison comparison = static_cast<DepthComparison>(random.below(kDepthComparisons));
            PolygonBatch batch;
            batch.clear(buffer.rows);
            Projector projector(view, {view.width, view.height, 0, 1, {}});
            for (const ScreenPolygon& polygon : projectAll(list, projector)) {
                batch.add(polygon, {view.width, view.height, codec});
                model.draw(polygon, comparison, settings);
            }
            buffer.noteComparison();
            const DepthDraw draw{buffer, codec, settings, comparison, image};
            for (uint32_t row = 0; row < buffer.rows; ++row) drawTileRow(draw, row, {&batch, 1}, scratch);
            ASSERT_EQ(image.surface, model.image.surface) << "seed " << seed << " part " << part;
        }
        rejected += scratch.counters.hierarchy_rejected_tiles + scratch.counters.hierarchy_rejected_polygons;
    }
    EXPECT_GT(rejected, 1000u);
}

/// Polygons that were not projected, into a buffer of one's own.
struct Canvas {
    Canvas(uint32_t width, uint32_t height, const DepthCodec& codec_, bool counting)
        : codec(codec_), buffer(width, height, codec.convention.far_value), image(emptyImage(madeView(width, height))) {
        if (counting)
            for (std::vector<uint16_t>* counts : {&image.generated, &image.tested, &image.passed, &image.shaded})
                counts->assign(image.surface.size(), 0);
    }
    void draw(std::span<const ScreenPolygon> polygons) {
        PolygonBatch batch;
        batch.clear(buffer.rows);
        for (const ScreenPolygon& polygon : polygons) batch.add(polygon, {image.width, image.height, codec});
        const DepthDraw draw{buffer, codec, settings, codec.convention.comparison, image};
        for (uint32_t row = 0; row < buffer.rows; ++row) drawTileRow(draw, row, {&batch, 1}, scratch);
    }

    DepthCodec codec;
    DepthSettings settings;
    DepthBuffer buffer;
    HiddenImage image;
    DepthDrawScratch scratch;
};

ScreenPolygon triangleOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, double nearness) {
    ScreenPolygon polygon;
    polygon.count = 3;
    polygon.points[0] = a;
    polygon.points[1] = b;
    polygon.points[2] = c;
    polygon.depth = {nearness, 0, 0, nearness, nearness};
    return polygon;
}

TEST(DepthBuffer, CoversWhatScanPolygonCoversWhereRoundingDecides) {
    // Corners on samples and far outside: edges pass through samples exactly, at places that doubles cannot name.
    constexpr int32_t kWidth = 700, kHeight = 50;
    Random random(17);
    for (int trial = 0; trial < 40; ++trial) {
        Canvas canvas(kWidth, kHeight, {DepthFormat::kReversedFloat, {0.1, 100, false}}, true);
        std::vector<uint16_t> truth(canvas.image.generated.size(), 0);
        std::vector<ScreenPolygon> polygons;
        for (int i = 0; i < 200; ++i) {
            const auto place = [&] {
                // A sample of the image, and a whole number of whole steps away from it.
                const double x = static_cast<double>(random.below(kWidth)) + 0.5,
                             steps = double(random.below(200)) - 100;
                const double y = static_cast<double>(random.below(kHeight)) + 0.5;
                return glm::dvec2(x + steps * double(random.below(40)), y + steps * double(random.below(7)));
            };
            polygons.push_back(triangleOf(place(), place(), place(), 1.0));
            scanPolygon(polygons.back().outline(), 0, kHeight, kWidth, [&](int32_t row, int32_t begin, int32_t end) {
                for (int32_t k = begin; k < end; ++k) ++truth[size_t(row) * kWidth + size_t(k)];
            });
        }
        canvas.draw(polygons);
        ASSERT_EQ(canvas.image.generated, truth) << "trial " << trial;
    }
}

TEST(DepthBuffer, RejectsNothingThatIsNearerByOneStep) {
    for (int format = 0; format < kDepthFormats; ++format) {
        Canvas canvas(24, 16, {static_cast<DepthFormat>(format), {0.1, 100, false}}, false);
        double nearness = 0.3;
        for (uint32_t layer = 0; layer < 40; ++layer) {
            const DepthKey key = canvas.codec.encode(nearness);
            std::vector<ScreenPolygon> polygons;
            for (int copy = 0; copy < 2; ++copy) {  // the second comes to equal depths, and is hidden
                polygons.push_back(triangleOf({-100, -100}, {100, -90}, {0, 200}, nearness));
                polygons.back().surface = 2 * layer + static_cast<uint32_t>(copy);
            }
            canvas.draw(polygons);
            for (const uint32_t surface : canvas.image.surface)
                ASSERT_EQ(surface, 2 * layer) << kDepthFormatNames[format] << " layer " << layer;
            double same = nearness, next = 1.2 * nearness;  // the next depth that there is
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (same + next);
                (canvas.codec.encode(middle) == key ? same : next) = middle;
            }
            nearness = next;
            ASSERT_EQ(std::abs(int64_t{canvas.codec.encode(nearness)} - key), 1) << kDepthFormatNames[format];
        }
        EXPECT_EQ(canvas.scratch.counters.hierarchy_rejected_polygons, 40u);
    }
}

TEST(DepthBuffer, BoundsRejectAndAcceptOnlyWhatTheyMay) {
    // All pairs of small ranges, all pairs of keys in them.
    for (int c = 0; c < kDepthComparisons; ++c) {
        const DepthComparison comparison = static_cast<DepthComparison>(c);
        for (DepthKey a = 0; a < 5; ++a)
            for (DepthKey b = a; b < 5; ++b)
                for (DepthKey s = 0; s < 5; ++s)
                    for (DepthKey t = s; t < 5; ++t) {
                        bool some = false, all = true;
                        for (DepthKey comes = a; comes <= b; ++comes)
                            for (DepthKey there = s; there <= t; ++there) {
                                some |= passes(comparison, comes, there);
                                all &= passes(comparison, comes, there);
                            }
                        EXPECT_EQ(rejectsAll(comparison, a, b, s, t), !some) << c << " " << a << b << s << t;
                        EXPECT_EQ(acceptsAll(comparison, a, b, s, t), all) << c << " " << a << b << s << t;
                    }
    }
}

TEST(DepthBuffer, RejectsMostOfWhatComesNearToFar) {
    MadeList made;
    for (int layer = 0; layer < 8; ++layer) {
        const float z = -2.0f - static_cast<float>(layer);
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) {
                const glm::vec3 at(-1.5f * z * (i / 3.0f - 1), -z * (j / 3.0f - 1), z);
                const glm::vec3 right(-0.5f * z, 0, -0.1f), up(0, -z / 3, 0.1f);
                made.add(at, at + right, at + right + up);
                made.add(at, at + right + up, at + up);
            }
    }
    const DrawList list = made.list();
    RenderSettings settings;
    const HiddenCounters with = render(list, madeView(320, 240), settings).counters;
    settings.depth.hierarchy = false;
    const HiddenCounters without = render(list, madeView(320, 240), settings).counters;
    EXPECT_GE(without.tested, 7u * 320 * 240);
    EXPECT_LT(4 * with.tested, without.tested);
    EXPECT_GT(with.hierarchy_rejected_polygons, 0u);
}

}  // namespace
}  // namespace sightline::test
