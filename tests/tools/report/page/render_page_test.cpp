// Runs of hidden-surface methods as data, pictures and a page.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/render_page.h"

#include <gtest/gtest.h>

#include "tests/tools/report/page/page_data.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

/// The made scene drawn by the plain z-buffer, which stands for whatever methods a test needs.
struct Made {
    Made() : scene(madeScene()), view(makeView(madeRun(scene).frames[0].camera, 64, 36)), list(scene, view) {
        image = plainZBuffer(list.list(), view, {});
        for (std::vector<uint16_t>* counts : {&image.generated, &image.tested, &image.passed, &image.shaded})
            counts->assign(image.surface.size(), 1);
        run.scene = "a <made> \"scene\".glb";
        run.width = view.width;
        run.height = view.height;
        run.frames = 1;
        run.objects_in_view = list.list().items().size();
        run.triangles_in_view = list.list().surfaces();
        run.polygons_in_view = image.counters.geometry.produced;
    }
    MethodResult& add(HiddenMethod method) {
        MethodResult result;
        result.method = method;
        result.image = image;
        result.milliseconds = 1.5 + static_cast<int>(method);
        judge(list, view, image, run.settings, result);
        run.methods.push_back(result);
        return run.methods.back();
    }
    nlohmann::json page() const { return dataOf(renderPage(list, view, run, settings)); }
    size_t centre() const { return size_t{view.height / 2} * view.width + view.width / 2; }

    Scene scene;
    View view;
    RenderList list;
    HiddenImage image;
    RenderRun run;
    PictureSettings settings;
};

TEST(RenderList, HoldsWhatMayBeInViewAndAllThatCasts) {
    const Made made;
    EXPECT_EQ(made.list.list().items().size(), 3u);  // one object lies beside the view
    EXPECT_EQ(made.list.casters().size(), 4u);
    EXPECT_EQ(made.list.keyOf(made.image.surface[made.centre()]), 7u);
}

TEST(RenderList, LeavesOutWhatIsNotSolid) {
    Scene scene = madeScene();
    scene.materials[0].alpha_mode = AlphaMode::kBlend;
    const Made made;
    const RenderList list(scene, made.view);
    const HiddenImage image = plainZBuffer(list.list(), made.view, {});
    EXPECT_EQ(image.surface[made.centre()], HiddenImage::kNone);
    scene.materials[0].alpha_mode = AlphaMode::kMask;
    const RenderList masked(scene, made.view);
    EXPECT_EQ(plainZBuffer(masked.list(), made.view, {}).surface, made.image.surface);
}

TEST(RenderList, ColoursByMaterialOrKey) {
    Scene scene = madeScene();
    scene.materials.resize(2);
    scene.materials[1].base_color = {0.5f, 0.25f, 0, 1};
    scene.meshes[0].primitives = {{0, 0, 0}, {0, 1, 1}, {1, 1, 0}};  // the first is empty
    const Made made;
    const RenderList list(scene, made.view);
    EXPECT_EQ(list.colourOf(0, 0), glm::dvec3(0.5, 0.25, 0));
    EXPECT_EQ(list.colourOf(0, 1), hashedColour(7));
}

TEST(RenderPictures, IdsAreKeysPlusOne) {
    const Made made;
    const Result<Image<Rgb>> ids = idPicture(made.list, made.image);
    ASSERT_TRUE(ids.ok());
    EXPECT_EQ(ids->at(32, 18), Rgb(0, 0, 8));  // key 7
    EXPECT_EQ(ids->at(0, 0), Rgb(0));
    for (uint32_t y = 0; y < 36; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            const uint32_t surface = made.image.surface[size_t{35 - y} * 64 + x];
            EXPECT_EQ(ids->at(x, y).z, surface == HiddenImage::kNone ? 0 : made.list.keyOf(surface) + 1);
        }
}

TEST(RenderPictures, KeysBeyond24BitsAreAnError) {
    Scene scene = madeScene();
    const Made made;
    scene.objects[0].key = 0xfffffe;
    EXPECT_EQ(idPicture(RenderList(scene, made.view), made.image)->at(32, 18), Rgb(255, 255, 255));
    scene.objects[0].key = 0xffffff;
    EXPECT_FALSE(idPicture(RenderList(scene, made.view), made.image).ok());
}

TEST(RenderPictures, ReducedPicturesAreMeans) {
    Image<Rgb> image(5, 3, Rgb(10));
    image.at(0, 0) = Rgb(50);
    EXPECT_EQ(reduced(image, 5).pixels, image.pixels);
    const Image<Rgb> half = reduced(image, 3);
    EXPECT_EQ(half.width, 3u);
    EXPECT_EQ(half.height, 2u);
    EXPECT_EQ(half.at(0, 0), Rgb(20));
    EXPECT_EQ(half.at(2, 1), Rgb(10));
}

TEST(RenderPictures, DifferencesAreRed) {
    const Made made;
    HiddenImage other = made.image;
    other.surface[made.centre()] = HiddenImage::kNone;
    const Image<Rgb> picture = differencePicture(Image<Rgb>(64, 36), made.image, other);
    size_t red = 0;
    for (const Rgb& pixel : picture.pixels) red += pixel.x > 2 * pixel.y;
    EXPECT_EQ(red, 1u);
    EXPECT_GT(picture.at(32, 35 - 18).x, 2 * picture.at(32, 35 - 18).y);
}

TEST(RenderPictures, AreTheSameForAnySharingOfTheWork) {
    const Made made;
    EXPECT_EQ(shadedPicture(made.list, made.view, made.image, {}).pixels,
              shadedPicture(made.list, made.view, made.image,
                            {.share =
                                 [](size_t count, const std::function<void(size_t)>& work) {
                                     for (size_t i = count; i-- > 0;) work(i);
                                 }})
                  .pixels);
}

TEST(RenderPictures, HeatScalesHaveWholeTicks) {
    EXPECT_EQ(heatScale({}), 8);
    for (const auto& [most, scale] :
         {std::pair{2, 8}, {8, 8}, {9, 16}, {17, 40}, {41, 80}, {81, 160}, {60000, 80000}}) {
        EXPECT_EQ(heatScale(std::vector<uint16_t>(100, static_cast<uint16_t>(most))), scale) << most;
        EXPECT_EQ(scale % 8, 0);
    }
}

TEST(RenderRun, StatisticsCountSamples) {
    const std::vector<uint16_t> counts = {0, 0, 1, 3, 100};
    const CountStatistics statistics = statisticsOf(counts);
    EXPECT_DOUBLE_EQ(statistics.mean, 104 / 5.0);
    EXPECT_EQ(statistics.maximum, 100u);
    ASSERT_EQ(statistics.histogram.size(), CountStatistics::kMostBars);
    EXPECT_EQ(statistics.histogram[0], 2u);
    EXPECT_EQ(statistics.histogram[3], 1u);
    EXPECT_EQ(statistics.histogram.back(), 1u);
    EXPECT_EQ(statisticsOf({}).mean, 0);
}

TEST(RenderRun, MethodsAreLeftOutOnlyWhereTheyAreImpractical) {
    RenderRun run;
    run.polygons_in_view = 250'000;
    run.triangles_in_view = 1'000'000;
    for (int i = 0; i < kHiddenMethods; ++i) EXPECT_EQ(whyImpractical(run, static_cast<HiddenMethod>(i)), "") << i;
    run.polygons_in_view = run.triangles_in_view = 1'234'567;
    EXPECT_EQ(whyImpractical(run, HiddenMethod::kNewell), "1,234,567 polygons in view; practical up to 250,000");
    EXPECT_NE(whyImpractical(run, HiddenMethod::kBspFrontToBack), "");
    EXPECT_EQ(whyImpractical(run, HiddenMethod::kZBuffer), "");
    EXPECT_EQ(whyImpractical(run, HiddenMethod::kRaycast), "");
}

TEST(RenderRun, JsonHasEveryMethodAndCounter) {
    Made made;
    made.add(HiddenMethod::kPainter);
    made.add(HiddenMethod::kZBuffer);
    made.run.left_out.push_back({HiddenMethod::kNewell, "too many"});
    const auto json = nlohmann::json::parse(renderJson(made.run));
    EXPECT_EQ(json["schema"], "sightline.render/1");
    EXPECT_EQ(json["width"], 64);
    EXPECT_EQ(json["scene"]["polygons_in_view"], made.run.polygons_in_view);
    ASSERT_EQ(json["methods"].size(), 2u);
    EXPECT_EQ(json["methods"][1]["name"], "zbuffer");
    EXPECT_EQ(json["methods"][1]["milliseconds"], 6.5);
    EXPECT_EQ(json["methods"][1]["agreement"]["wrong"], 0);
    for (const CounterName& counter : counterNames())
        EXPECT_TRUE(json["methods"][0]["counters"].contains(std::string(counter.name))) << counter.name;
    for (const std::string_view heat : kHeatNames)
        EXPECT_EQ(json["methods"][0]["per_sample"][std::string(heat)]["mean"], 1.0) << heat;
    EXPECT_EQ(json["left_out"][0]["name"], "newell");
}

TEST(RenderPage, HoldsEveryMethodThatRanAndNamesThoseThatDidNot) {
    Made made;
    for (int i = 0; i < kHiddenMethods; ++i)
        if (static_cast<HiddenMethod>(i) != HiddenMethod::kNewell) made.add(static_cast<HiddenMethod>(i));
    made.run.left_out.push_back({HiddenMethod::kNewell, "21,000 polygons in view"});
    const auto data = made.page();
    ASSERT_EQ(data["methods"].size(), made.run.methods.size());
    for (size_t i = 0; i < made.run.methods.size(); ++i) {
        EXPECT_EQ(data["methods"][i].contains("picture"), i == 0) << "the same picture is held once";
        EXPECT_TRUE(data["methods"][i].contains("heat")) << i;
        EXPECT_FALSE(data["methods"][i].contains("wrong")) << i;
        EXPECT_EQ(data["methods"][i]["exact"], i != 0) << "all but the painter's algorithm";
    }
    EXPECT_EQ(data["run"]["left_out"][0]["why"], "21,000 polygons in view");
    EXPECT_EQ(data["run"]["scene"]["file"], "a <made> \"scene\".glb");
    EXPECT_EQ(data["depth"]["method"], "painter");
    for (const CounterName& counter : counterNames())
        EXPECT_EQ(data["titles"][std::string(counter.name)], counter.title) << counter.name;
}

TEST(RenderPage, ShowsWhereAMethodIsWrong) {
    Made made;
    MethodResult& result = made.add(HiddenMethod::kWarnock);
    const HiddenImage truth = result.image;
    // The quad behind the wall in place of the wall.
    const uint32_t behind = made.list.list().firstSurface(1);
    result.image.surface[made.centre() + 5] = behind;
    judge(made.list, made.view, truth, made.run.settings, result);
    EXPECT_EQ(result.agreement.wrong, 1u);
    EXPECT_TRUE(made.page()["methods"][0].contains("wrong"));
}

TEST(RenderPage, BlamesACoarseFormatAndNotTheMethod) {
    Made made;
    made.add(HiddenMethod::kWarnock);
    MethodResult& result = made.add(HiddenMethod::kZBuffer);
    result.agreement.wrong = 12;
    EXPECT_TRUE(made.page()["methods"][1]["exact"]);
    made.run.settings.depth.format = DepthFormat::kUnorm16;
    const auto data = made.page();
    EXPECT_FALSE(data["methods"][1]["exact"]);
    EXPECT_EQ(data["methods"][1]["why"], "unorm16 is too coarse for them");
    made.run.methods[0].agreement.wrong = 3;  // no format excuses another method
    EXPECT_TRUE(made.page()["methods"][0]["exact"]);
}

TEST(RenderPage, ShowsWhatTheHierarchySpared) {
    Made made;
    MethodResult& result = made.add(HiddenMethod::kZBuffer);
    EXPECT_TRUE(made.page()["hierarchy"].is_null());
    result.image.counters.hierarchy_rejected_tiles = 1;
    EXPECT_TRUE(made.page()["hierarchy"].contains("tested"));
}

TEST(RenderPage, LinksPicturesThatAreTaken) {
    Made made;
    made.add(HiddenMethod::kPainter);
    made.add(HiddenMethod::kZBuffer);
    EXPECT_FALSE(made.page()["linked"]);
    std::string taken;
    const std::string page =
        renderPage(made.list, made.view, made.run, made.settings, [&](const MethodResult& r, const Image<Rgb>& p) {
            taken += std::string(r.name()) + " ";
            EXPECT_EQ(p.width, made.view.width);
        });
    EXPECT_EQ(taken, "painter zbuffer ");
    EXPECT_TRUE(dataOf(page)["linked"]);
}

TEST(RenderPage, MapsFightsOfDepths) {
    Made made;
    made.add(HiddenMethod::kZBuffer);
    EXPECT_TRUE(made.page()["fights"].is_null());
    findFights(made.list, made.view, {}, made.run);
    ASSERT_EQ(made.run.fights.size(), size_t{kDepthFormats});
    EXPECT_EQ(made.run.fight_map.fights.size(), made.image.surface.size());
    for (const FormatFights& fights : made.run.fights) {
        EXPECT_GT(fights.overlaid, 0u);  // something stands behind the wall
        EXPECT_EQ(fights.fighting, 0u);  // far behind
    }
    made.run.fight_map.fights[made.centre()] = Fight::kFormat;
    const Image<Rgb> picture = fightPicture(Image<Rgb>(64, 36), made.run.fight_map);
    EXPECT_GT(picture.at(32, 35 - 18).x, 2 * picture.at(32, 35 - 18).y);
    EXPECT_EQ(made.page()["run"]["z_fighting"].size(), size_t{kDepthFormats});
    EXPECT_TRUE(made.page()["fights"].is_string());
}

}  // namespace
}  // namespace sightline
