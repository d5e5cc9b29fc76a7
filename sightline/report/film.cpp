// The film of a run: for each frame that is drawn, what the camera sees, what was culled, and where that lies.
// SPDX-License-Identifier: MIT
#include "sightline/report/film.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/core.h>

#include "sightline/report/depth_picture.h"
#include "sightline/report/picture.h"
#include "sightline/report/plan.h"

namespace sightline {
namespace {

constexpr uint32_t kPlanWidth = 600, kSectionWidth = 720;  // [pixels]
constexpr uint32_t kHeatWidth = 480;                       // [pixels] at most
constexpr int kJpegQuality = 84;

double mean(const Image<float>& image) {
    double sum = 0;
    for (const float value : image.pixels) sum += value;
    return image.pixels.empty() ? 0 : sum / static_cast<double>(image.pixels.size());
}

View pictureView(const CullRun& run, const FrameResult& frame, const PageSettings& settings, size_t pictures) {
    // Many pictures are drawn smaller, so that the page stays one that can be sent.
    const double wide = pictures > 32 ? std::min(720u, settings.picture_width) : settings.picture_width;
    const double scale = std::min(wide / run.width, double(settings.picture_limit) / run.height);
    View view = makeView(frame.camera, run.width, run.height);       // the projection keeps the frame's aspect
    if (run.stereo > 0) view = shiftedEye(view, -0.5 * run.stereo);  // a sight between the eyes is neither's
    view.width = std::max(1u, static_cast<uint32_t>(std::lround(run.width * scale)));
    view.height = std::max(1u, static_cast<uint32_t>(std::lround(run.height * scale)));
    return view;
}

/// What the heat maps need until the scale of all is known.
struct Counts {
    Image<float> all, kept;
};

std::string sectionText(const PlanArea& section) {
    const double stretch = sectionStretch(section);
    return fmt::format("From the side, along {}{}.", section.across == 0 ? "x" : "z",
                       stretch > 1.01 ? fmt::format("; heights drawn {:.3g} times as large", stretch) : "");
}

std::string fileOf(const char* what, size_t frame) { return fmt::format("frames/{}-{:04}.png", what, frame); }

}  // namespace

Film drawFilm(const Scene& scene, const CullRun& run, const PageSettings& settings) {
    const std::vector<size_t> chosen = pictureFrames(run, settings.most_pictures);
    const PictureMaker maker(scene);
    std::vector<View> views;
    std::vector<std::span<const uint8_t>> reasons;
    for (const size_t frame : chosen) {
        views.push_back(pictureView(run, run.frames[frame], settings, chosen.size()));
        reasons.push_back(run.frames[frame].reasons);
    }
    const PlanArea plan = planArea(maker.bounds(), reasons, views);
    Film film;
    film.shots.resize(chosen.size());
    std::vector<Counts> counts(chosen.size());
    std::atomic<size_t> done{0};
    const auto save = [&](const char* what, size_t frame, const auto& image) {
        if (settings.save) settings.save(fileOf(what, frame), encodePalettePng(image));
    };
    const auto draw = [&](size_t i) {
        Shot& shot = film.shots[i];
        shot.frame = chosen[i];
        PictureMaker::Frame drawn = maker.draw(views[i], reasons[i]);
        const glm::dvec3 eye = eyePosition(views[i]);
        const PlanArea section = sectionArea(maker.bounds(), reasons[i], views[i], plan);
        const PlanBand storey = storeyOf(maker.bounds(), eye);
        const auto above = drawPlan(maker.bounds(), reasons[i], views[i], plan, storey, kPlanWidth);
        const auto side = drawPlan(maker.bounds(), reasons[i], views[i], section, sliceOf(section, eye), kSectionWidth);
        shot.images = {{"shaded", encodeJpeg(drawn.shaded, kJpegQuality)},
                       {"objects", encodeJpeg(drawn.objects, kJpegQuality)},
                       {"culled", encodePalettePng(drawn.culled)},
                       {"plan", encodePalettePng(above)},
                       {"section", encodePalettePng(side)}};
        if (settings.buffer) {
            const Image<Rgb> buffer = viewportPart(settings.buffer(chosen[i]), glm::dvec2(run.width, run.height),
                                                   run.jitter, views[i].width, views[i].height);
            shot.images.push_back({"buffer", encodeJpeg(buffer, kJpegQuality)});
            save("buffer", chosen[i], buffer);
        }
        if (settings.windows) {
            const std::vector<CellWindow> exact = settings.windows(chosen[i], PortalWindows::kPolygons),
                                          boxes = settings.windows(chosen[i], PortalWindows::kBoxes);
            const glm::dvec2 scale(double(views[i].width) / run.width, double(views[i].height) / run.height);
            const Image<Rgb> windows = windowPicture(drawn.shaded, scale, exact, boxes);
            shot.images.push_back({"windows", encodeJpeg(windows, kJpegQuality)});
            shot.windows_text = windowText(exact, boxes);
            save("windows", chosen[i], windows);
        }
        shot.plan_text = storey.whole() ? "From above." : "From above; what lies off the eye’s storey is pale.";
        shot.section_text = sectionText(section) + " What lies off the eye’s slice is pale.";
        shot.depth_all = mean(drawn.all);
        shot.depth_kept = mean(drawn.kept);
        shot.same = drawn.same;
        save("frame", chosen[i], drawn.shaded);
        save("culled", chosen[i], drawn.culled);
        save("plan", chosen[i], above);
        save("section", chosen[i], side);
        const uint32_t step = (drawn.all.width + kHeatWidth - 1) / kHeatWidth;
        counts[i] = {reducedCounts(drawn.all, step), reducedCounts(drawn.kept, step)};
        if (settings.progress) settings.progress(++done, chosen.size());
    };
    const auto each = [&](const std::function<void(size_t)>& work) {
        if (settings.for_each) settings.for_each(chosen.size(), work);
        else
            for (size_t i = 0; i < chosen.size(); ++i) work(i);
    };
    each(draw);
    std::vector<float> values;
    for (const Counts& c : counts) values.insert(values.end(), c.all.pixels.begin(), c.all.pixels.end());
    if (!values.empty()) {
        const auto place = values.begin() + static_cast<ptrdiff_t>((values.size() - 1) * 499 / 500);
        std::nth_element(values.begin(), place, values.end());
        film.heat_scale = heatScaleAbove(*place);
    }
    each([&](size_t i) {
        const Image<Rgb> all = heatMap(counts[i].all, film.heat_scale), kept = heatMap(counts[i].kept, film.heat_scale);
        film.shots[i].images.push_back({"heat-all", encodePalettePng(all)});
        film.shots[i].images.push_back({"heat-kept", encodePalettePng(kept)});
        save("heat-all", chosen[i], all);
        save("heat-kept", chosen[i], kept);
    });
    if (!views.empty()) {
        film.width = views[0].width;
        film.height = views[0].height;
    }
    return film;
}

}  // namespace sightline
