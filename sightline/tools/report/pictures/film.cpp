// The film of a run: for each frame that is drawn, what the camera sees, what was culled, and where that lies.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/film.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include <fmt/core.h>

#include "sightline/tools/report/pictures/depth_picture.h"
#include "sightline/tools/report/pictures/outside_picture.h"
#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/plan.h"
#include "sightline/tools/report/pictures/plan_section.h"
#include "sightline/tools/report/readable.h"

namespace sightline::tools {

std::vector<size_t> pictureFrames(const CullRun& run, uint32_t most) {
    const size_t count = std::min<size_t>(most, run.frames.size());
    std::set<size_t> chosen;
    for (size_t i = 0; i < run.frames.size() && chosen.size() < count; ++i)
        if (run.frames[i].verification && run.frames[i].verification->false_culls > 0) chosen.insert(i);
    const size_t free = count - chosen.size();
    for (size_t i = 0; i < free; ++i) chosen.insert(free > 1 ? i * (run.frames.size() - 1) / (free - 1) : 0);
    return {chosen.begin(), chosen.end()};
}

namespace {

constexpr uint32_t kPlanWidth = 600, kSectionWidth = 720;  // [pixels]
constexpr uint32_t kHeatWidth = 480;                       // [pixels] at most
constexpr uint32_t kOverviewWidth = 960;                   // [pixels]
constexpr double kOutsidePart = 2.0 / 3;                   // of the sides of the frame's other pictures
constexpr int kJpegQuality = 84;
const glm::u8vec4 kWallColour(20, 24, 31, 255), kCellColour(196, 18, 110, 120), kPortalLine(196, 18, 110, 255);

double mean(const Image<float>& image) {
    double sum = 0;
    for (const float value : image.pixels) sum += value;
    return image.pixels.empty() ? 0 : sum / static_cast<double>(image.pixels.size());
}

View eyeOf(const CullRun& run, const FrameResult& frame) {
    const View view = makeView(frame.camera, run.width, run.height);
    return run.stereo > 0 ? shiftedEye(view, -0.5 * run.stereo) : view;  // a sight between the eyes is neither's
}

View pictureView(const CullRun& run, const FrameResult& frame, const PageSettings& settings, size_t pictures) {
    // Many pictures are drawn smaller, so that the page stays one that can be sent.
    const double wide = pictures > 32 ? std::min(720u, settings.picture_width) : settings.picture_width;
    const double scale = std::min(wide / run.width, double(settings.picture_limit) / run.height);
    View view = eyeOf(run, frame);  // the projection keeps the frame's aspect
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
                       stretch > 1.01 ? fmt::format("; heights drawn {} times as large", readable(stretch, 3)) : "");
}

/// Draws the frames of a film one by one, on any threads, and its heat maps once the scale of all is known.
class FilmMaker {
public:
    FilmMaker(const Scene& scene, const CullRun& run, const PageSettings& settings);
    Film draw();

private:
    void drawOverview();
    void drawShot(size_t i);
    void addOutside(size_t i);
    void addPlans(size_t i);
    void addBuffer(size_t i);
    void addWindows(size_t i, const Image<Rgb>& shaded);
    void drawHeat(size_t i);
    void each(size_t count, const std::function<void(size_t)>& work) const {
        if (settings_.for_each) return settings_.for_each(count, work);
        for (size_t i = 0; i < count; ++i) work(i);
    }
    void save(const char* what, size_t i, const std::string& png) const {
        if (settings_.save) settings_.save(fmt::format("frames/{}-{:04}.png", what, chosen_[i]), png);
    }
    /// A picture of few colours, which is held as it is saved.
    template <class Picture>
    void addDrawing(const char* id, size_t i, const Picture& picture) {
        film_.shots[i].images.push_back({id, encodePalettePng(picture)});
        save(id, i, film_.shots[i].images.back().bytes);
    }
    /// A picture of many colours, which is held in a tenth of the bytes.
    void addPhotograph(const char* id, const char* name, size_t i, const Image<Rgb>& picture) {
        film_.shots[i].images.push_back({id, encodeJpeg(picture, kJpegQuality)});
        if (settings_.save) save(name, i, encodePalettePng(picture));
    }

    const CullRun& run_;
    const PageSettings& settings_;
    const PictureMaker maker_;
    const std::vector<size_t> chosen_;
    std::vector<View> views_;
    std::vector<std::span<const uint8_t>> reasons_;
    PlanArea plan_;
    PlanCells cells_;
    std::vector<Counts> counts_;
    std::atomic<size_t> done_{0};
    Film film_;
};

FilmMaker::FilmMaker(const Scene& scene, const CullRun& run, const PageSettings& settings)
    : run_(run), settings_(settings), maker_(scene), chosen_(pictureFrames(run, settings.most_pictures)) {
    for (const size_t frame : chosen_) {
        views_.push_back(pictureView(run, run.frames[frame], settings, chosen_.size()));
        reasons_.push_back(run.frames[frame].reasons);
    }
    plan_ = planArea(maker_.bounds(), reasons_, views_);
    cells_ = settings.cells ? planCells(*settings.cells) : planCells(scene);
    film_.shots.resize(chosen_.size());
    counts_.resize(chosen_.size());
}

void FilmMaker::drawOverview() {
    std::vector<glm::dvec3> eyes;
    for (const FrameResult& frame : run_.frames) eyes.push_back(eyePosition(eyeOf(run_, frame)));
    Overview overview = overviewPicture(maker_, eyes, kOverviewWidth);
    film_.overview = encodeJpeg(overview.image, kJpegQuality);
    film_.eyes = std::move(overview.eyes);
    if (settings_.save && !film_.overview.empty()) settings_.save("frames/overview.png", encodePng(overview.image));
}

void FilmMaker::drawShot(size_t i) {
    Shot& shot = film_.shots[i];
    shot.frame = chosen_[i];
    const PictureMaker::Frame drawn = maker_.draw(views_[i], reasons_[i]);
    addPhotograph("shaded", "frame", i, drawn.shaded);
    shot.images.push_back({"objects", encodeJpeg(drawn.objects, kJpegQuality)});
    addDrawing("culled", i, drawn.culled);
    addOutside(i);
    addPlans(i);
    if (settings_.buffer) addBuffer(i);
    if (settings_.windows) addWindows(i, drawn.shaded);
    shot.depth_all = mean(drawn.all);
    shot.depth_kept = mean(drawn.kept);
    shot.same = drawn.same;
    shot.variety = varietyOf(drawn.objects);
    const uint32_t step = (drawn.all.width + kHeatWidth - 1) / kHeatWidth;
    counts_[i] = {reducedCounts(drawn.all, step), reducedCounts(drawn.kept, step)};
    if (settings_.progress) settings_.progress(++done_, chosen_.size());
}

void FilmMaker::addOutside(size_t i) {
    View view = views_[i];
    view.width = std::max(1u, static_cast<uint32_t>(std::lround(kOutsidePart * view.width)));
    view.height = std::max(1u, static_cast<uint32_t>(std::lround(kOutsidePart * view.height)));
    addPhotograph("outside", "outside", i, outsidePicture(maker_, view, reasons_[i]));
}

void FilmMaker::addPlans(size_t i) {
    const std::vector<Box3d>& bounds = maker_.bounds();
    const glm::dvec3 eye = eyePosition(views_[i]);
    const PlanArea section = sectionArea(bounds, reasons_[i], views_[i], plan_);
    const PlanBand storey = storeyOf(bounds, eye);
    Image<glm::u8vec4> plan = drawPlan(bounds, reasons_[i], views_[i], plan_, storey, kPlanWidth);
    drawOnPlan(plan, plan_, wallsAt(maker_.scene(), bounds, plan_, eye.y), kWallColour, 0);
    drawOnPlan(plan, plan_, cellsAt(cells_, plan_, eye.y), kCellColour, 0);
    drawOnPlan(plan, plan_, portalsAt(cells_, eye.y), kPortalLine, 1);
    addDrawing("plan", i, plan);
    addDrawing("section", i, drawPlan(bounds, reasons_[i], views_[i], section, sliceOf(section, eye), kSectionWidth));
    Shot& shot = film_.shots[i];
    shot.plan_text = std::string("From above, with walls as they are cut at the height of the eye") +
                     (cells_.portals.empty() ? "" : ", cells and the portals between them") +
                     (storey.whole() ? "." : "; what lies off the eye’s storey is pale.");
    shot.section_text = sectionText(section) + " What lies off the eye’s slice is pale.";
}

void FilmMaker::addBuffer(size_t i) {
    const Image<Rgb> buffer = viewportPart(settings_.buffer(chosen_[i]), glm::dvec2(run_.width, run_.height),
                                           run_.jitter, views_[i].width, views_[i].height);
    addPhotograph("buffer", "buffer", i, buffer);
}

void FilmMaker::addWindows(size_t i, const Image<Rgb>& shaded) {
    const std::vector<CellWindow> exact = settings_.windows(chosen_[i], PortalWindows::kPolygons),
                                  boxes = settings_.windows(chosen_[i], PortalWindows::kBoxes);
    const glm::dvec2 scale(double(views_[i].width) / run_.width, double(views_[i].height) / run_.height);
    addPhotograph("windows", "windows", i, windowPicture(shaded, scale, exact, boxes));
    film_.shots[i].windows_text = windowText(exact, boxes);
}

void FilmMaker::drawHeat(size_t i) {
    addDrawing("heat-all", i, heatMap(counts_[i].all, film_.heat_scale));
    addDrawing("heat-kept", i, heatMap(counts_[i].kept, film_.heat_scale));
}

Film FilmMaker::draw() {
    if (!chosen_.empty()) each(chosen_.size() + 1, [&](size_t i) { i == 0 ? drawOverview() : drawShot(i - 1); });
    std::vector<float> values;
    for (const Counts& c : counts_) values.insert(values.end(), c.all.pixels.begin(), c.all.pixels.end());
    if (!values.empty()) {
        const auto place = values.begin() + static_cast<ptrdiff_t>((values.size() - 1) * 499 / 500);
        std::nth_element(values.begin(), place, values.end());
        film_.heat_scale = heatScaleAbove(*place);
    }
    each(chosen_.size(), [&](size_t i) { drawHeat(i); });
    if (!views_.empty()) {
        film_.width = views_[0].width;
        film_.height = views_[0].height;
    }
    return std::move(film_);
}

}  // namespace

double varietyOf(const Image<Rgb>& objects) {
    std::vector<uint64_t> pixels(4096,
                                 0);  // by colour, in sixteen steps of each channel: light and sky count for little
    for (const Rgb& pixel : objects.pixels) ++pixels[(pixel.x >> 4) << 8 | (pixel.y >> 4) << 4 | pixel.z >> 4];
    double bits = 0;
    for (const uint64_t count : pixels) {
        const double part = double(count) / static_cast<double>(objects.pixels.size());
        if (count > 0) bits -= part * std::log2(part);
    }
    return std::exp2(bits);
}

Film drawFilm(const Scene& scene, const CullRun& run, const PageSettings& settings) {
    return FilmMaker(scene, run, settings).draw();
}

}  // namespace sightline::tools
