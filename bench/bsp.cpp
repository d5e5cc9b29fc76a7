// BSP trees: building, walking, and drawing by them front to back beside back to front.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/studies/hidden/bsp/bsp_frame.h"
#include "sightline/studies/hidden/bsp/bsp_render.h"
#include "sightline/studies/hidden/methods/dynamic_screen.h"
#include "sightline/studies/hidden/methods/fill.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr double kDepthComplexity = 8;

/// What is drawn, with its memory, and from where.
struct Stage {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    std::vector<uint8_t> double_sided;
    std::vector<DrawItem> items;
    View view;
};

View viewOf(const glm::dmat4& camera, double fov_y, double z_near) {
    View view;
    view.view = camera;
    view.projection = perspective(fov_y, double(view.width) / view.height, z_near);
    return view;
}

HiddenImage emptyImage(const View& view) {
    HiddenImage image;
    image.width = view.width;
    image.height = view.height;
    image.surface.assign(size_t{view.width} * view.height, HiddenImage::kNone);
    return image;
}

/// Fragments a sample.
double depthComplexity(const DrawList& list, const View& view) {
    Projector projector(view, {view.width, view.height, 0, 1, {}});
    double fragments = 0;
    for (const ScreenPolygon& polygon : projectAll(list, projector))
        scanPolygon(polygon.outline(), 0, int32_t(view.height), int32_t(view.width),
                    [&](int32_t, int32_t begin, int32_t end) { fragments += end - begin; });
    return fragments / (double(view.width) * view.height);
}

/// Triangles turned any way before the eye, as large as the depth complexity asks for.
Stage randomStage(size_t count) {
    Stage stage;
    stage.name = std::to_string(count) + " random triangles";
    stage.view = viewOf(lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0}), 1.0, 0.1);
    stage.double_sided.assign(count, 1);
    double size = 0.5;
    for (int round = 0; round < 5; ++round) {
        Random random(1);
        stage.positions.clear();
        stage.indices.clear();
        for (size_t i = 0; i < 3 * count; ++i) stage.indices.push_back(static_cast<uint32_t>(i));
        for (size_t i = 0; i < count; ++i) {
            // Spread evenly over the screen and its depth.
            const double depth = random.uniform(3, 9), up = depth * std::tan(0.5), right = up * 16 / 9;
            const glm::dvec3 center(random.uniform(-right, right), random.uniform(-up, up), -depth);
            for (int corner = 0; corner < 3; ++corner)
                stage.positions.emplace_back(center + glm::dvec3(random.uniform(-size, size),
                                                                 random.uniform(-size, size),
                                                                 random.uniform(-size, size)));
        }
        DrawItem item;
        item.mesh = {stage.positions, stage.indices};
        item.double_sided = stage.double_sided;
        stage.items = {item};
        size *= std::sqrt(kDepthComplexity / depthComplexity(DrawList(stage.items), stage.view));
    }
    return stage;
}

/// A scene, from that of some cameras whose depth complexity is nearest to what is wanted.
/// @param both_faces  as if all materials were double-sided: twice as deep
Stage sceneStage(const Scene& scene, const std::vector<View>& views, bool both_faces) {
    Stage stage;
    stage.name = scene.name + (both_faces ? ", both faces" : "");
    size_t most = 0;
    for (const Mesh& mesh : scene.meshes) most = std::max(most, mesh.triangles());
    if (both_faces) stage.double_sided.assign(most, 1);
    for (const SceneObject& object : scene.objects) {
        DrawItem item;
        item.mesh = {scene.meshes[object.mesh].positions, scene.meshes[object.mesh].indices};
        if (both_faces) item.double_sided = std::span(stage.double_sided).first(item.mesh.triangles());
        item.transform = object.transform;
        item.id = static_cast<uint32_t>(stage.items.size());
        stage.items.push_back(item);
    }
    const DrawList list(stage.items);
    double nearest = std::numeric_limits<double>::infinity();
    for (const View& view : views) {
        const double off = std::abs(std::log(std::max(depthComplexity(list, view), 1e-3) / kDepthComplexity));
        if (off >= nearest) continue;
        nearest = off;
        stage.view = view;
    }
    return stage;
}

std::vector<View> viewsOf(const CameraPath& path) {
    std::vector<View> views;
    for (const CameraFrame& frame : path.frames) views.push_back(makeView(frame, 1280, 720));
    return views;
}

/// The same walk at the height of windows and of roofs: more lies behind what is in front.
CameraPath withRaised(CameraPath path) {
    const size_t count = path.frames.size();
    for (const double height : {6.0, 15.0, 30.0})
        for (size_t i = 0; i < count; ++i) {
            CameraFrame frame = path.frames[i];
            frame.eye.y += height;
            frame.target.y += height;
            path.frames.push_back(frame);
        }
    return path;
}

void addTrees(const Stage& stage, int repeat, Table& table) {
    const DrawList list(stage.items);
    BspSettings one, chosen, axes;
    one.candidates = 1;
    one.axis_planes = chosen.axis_planes = false;
    BspScene by_one, by_choice, by_axes;
    const std::vector<double> times = timeInterleaved(
        {[&] { by_one = buildBspScene(list, {}, one); }, [&] { by_choice = buildBspScene(list, {}, chosen); },
         [&] { by_axes = buildBspScene(list, {}, axes); }},
        std::max(1, repeat / 4));
    const BspStatistics of_one = statisticsOf(by_one.tree), of_choice = statisticsOf(by_choice.tree),
                        of_axes = statisticsOf(by_axes.tree);
    const auto row = [&](const char* what, double value, const char* unit, double base) {
        table.rows.push_back({stage.name, what, value, unit, "a random splitter each time", base});
    };
    row("build, best of 16 splitters", times[1] * 1e-3, "ms", times[0] * 1e-3);
    row("build, and of 3 axis planes", times[2] * 1e-3, "ms", times[0] * 1e-3);
    row("splits, best of 16 splitters", double(of_choice.splits), "splits", double(of_one.splits));
    row("splits, and of 3 axis planes", double(of_axes.splits), "splits", double(of_one.splits));
    row("pieces a polygon", of_axes.pieces_per_polygon, "", of_one.pieces_per_polygon);
    row("depth", of_axes.depth, "nodes", of_one.depth);
    BspStack stack;
    uint64_t pieces = 0;
    // Another eye each time: nobody foretells the sides.
    const Box3d box = by_axes.tree.nodes.empty() ? Box3d{} : by_axes.tree.bounds[by_axes.tree.root];
    Random random(1);
    const std::vector<double> walks = timeInterleaved(
        {[&] {
             for (const BspNode& node : by_axes.tree.nodes) pieces += node.count;
         },
         [&] {
             const glm::dvec3 part(random.uniform(), random.uniform(), random.uniform());
             walkFrontToBack(
                 BspStatic{by_axes.tree}, bspEye(box.min + part * box.size()), stack, [](uint32_t) { return true; },
                 [&](uint32_t node) { pieces += by_axes.tree.nodes[node].count; });
         }},
        4 * repeat);
    const double per_node = 1e3 / double(std::max<uint64_t>(of_axes.nodes, 1));
    table.rows.push_back({stage.name, "walk front to back" + std::string(pieces == 0 ? " (of nothing)" : ""),
                          walks[1] * per_node, "ns/node", "reading all nodes in a row", walks[0] * per_node});
}

void addDrawing(const Stage& stage, int repeat, Table& table) {
    const DrawList list(stage.items);
    const BspScene scene = buildBspScene(list);
    HiddenImage images[4];
    std::vector<std::function<void()>> jobs;
    for (int i = 0; i < 4; ++i)
        jobs.push_back([&, i] {
            RenderSettings settings;
            settings.free_samples = static_cast<FreeSamples>(std::max(i - 1, 0));
            images[i] = emptyImage(stage.view);
            const HiddenInput input{list, stage.view, settings};
            if (i == 0) drawBspBackToFront(scene, input, images[i]);
            else drawBspFrontToBack(scene, input, images[i]);
        });
    const std::vector<double> times = timeInterleaved(jobs, repeat);
    const double samples = double(images[0].surface.size());
    constexpr const char* kNames[4] = {"back to front", "front to back, a look a sample", "front to back, segments",
                                       "front to back, bits"};
    for (int i = 1; i < 4; ++i)
        table.rows.push_back({stage.name, kNames[i], times[i] * 1e-3, "ms", kNames[0], times[0] * 1e-3});
    table.rows.push_back({stage.name, kNames[3], times[3] * 1e-3, "ms", kNames[2], times[2] * 1e-3});
    for (int i = 1; i < 4; ++i)
        table.rows.push_back({stage.name, std::string("generated, ") + kNames[i],
                              double(images[i].counters.generated) / samples, "fragments/sample", kNames[0],
                              double(images[0].counters.generated) / samples});
}

/// One span of a stream.
struct Span {
    int32_t row, begin, end;
    uint32_t surface;
};

std::vector<Span> spansOf(const Stage& stage) {
    const DrawList list(stage.items);
    const BspScene scene = buildBspScene(list);
    const RenderSettings settings;
    HiddenImage image = emptyImage(stage.view);
    BspFrame frame(scene, {list, stage.view, settings}, image);
    std::vector<Span> spans;
    BspFragment fragment;
    BspStack stack;
    walkFrontToBack(
        BspStatic{scene.tree}, frame.eye(), stack, [](uint32_t) { return true; },
        [&](uint32_t node) {
            frame.forPieces(node, false, [&](const BspPiece& piece, const BspArrays& arrays) {
                if (!frame.makeFragment(piece, arrays, fragment)) return;
                scanFragment(fragment, 0, int32_t(image.height), int32_t(image.width),
                             [&](int32_t row, int32_t begin, int32_t end) {
                                 spans.push_back({row, begin, end, piece.number});
                             });
            });
        });
    return spans;
}

template <class Screen, class Draw>
void takeAll(Screen screen, const std::vector<Span>& spans, Draw&& draw) {
    for (const Span& span : spans) {
        if (screen.full()) break;
        screen.take(span.row, span.begin, span.end, [&](int32_t begin, int32_t end) { draw(span, begin, end); });
    }
}

/// The screens alone: the spans of all pieces are known already and only taken, and filled where they are free.
void addScreens(const Stage& stage, int repeat, Table& table) {
    const std::vector<Span> spans = spansOf(stage);
    const int32_t width = int32_t(stage.view.width), height = int32_t(stage.view.height);
    HiddenImage image = emptyImage(stage.view);
    uint64_t taken = 0;
    const auto fill = [&](const Span& span, int32_t begin, int32_t end) {
        uint32_t* line = image.surface.data() + size_t(span.row) * size_t(width);
        std::fill(line + begin, line + end, span.surface);
    };
    const auto count = [&](const Span&, int32_t begin, int32_t end) { taken += uint64_t(end - begin); };
    const auto clear = [&] { std::fill(image.surface.begin(), image.surface.end(), HiddenImage::kNone); };
    const std::vector<double> times =
        timeInterleaved({[&] {
                             for (auto span = spans.rbegin(); span != spans.rend(); ++span)
                                 fill(*span, span->begin, span->end);
                         },
                         [&] {
                             clear();
                             takeAll(CheckedScreen(image), spans, fill);
                         },
                         clear, [&] { takeAll(SegmentScreen(width, height), spans, fill); },
                         [&] { takeAll(BitScreen(width, height), spans, fill); },
                         [&] { takeAll(SegmentScreen(width, height), spans, count); },
                         [&] { takeAll(BitScreen(width, height), spans, count); }},
                        repeat);
    const double per_span = 1e3 / double(std::max<size_t>(spans.size(), 1));
    const Rows row{table, stage.name, "ns/span", per_span};
    row("spans alone, a look a sample", times[1] - times[2], "spans alone, painted", times[0]);
    row("spans alone, segments", times[3], "spans alone, painted", times[0]);
    row("spans alone, bits", times[4], "spans alone, painted", times[0]);
    row("spans alone, bits", times[4], "spans alone, segments", times[3]);
    row(taken > 0 ? "spans alone, bits, not filled" : "no spans", times[6], "segments, not filled", times[5]);
}

}  // namespace

Table benchBsp(const Options& options) {
    Table table{"bsp", {}};
    const int repeat = options.repeat ? options.repeat : 9;
    const auto measure = [&](const Stage& stage) {
        table.rows.push_back({stage.name, "depth complexity", depthComplexity(DrawList(stage.items), stage.view),
                              "fragments/sample", "wanted", kDepthComplexity});
        addTrees(stage, repeat, table);
        addDrawing(stage, repeat, table);
        addScreens(stage, repeat, table);
    };
    if (options.scene) {
        measure(sceneStage(*options.scene, viewsOf(seededCameras(*options.scene, 16, 1)), false));
        return table;
    }
    for (const size_t count : {size_t{1000}, size_t{10000}, size_t{100000}}) measure(randomStage(count));
    const Scene city = makeCity(1, 3000);
    measure(sceneStage(city, viewsOf(withRaised(cityStreetPath(1, 16))), true));
    return table;
}

}  // namespace sightline::bench
