// Measures portal images on a scene: pictures shown for doorways beside the geometry that they stand for.
// SPDX-License-Identifier: MIT
#include "bench/image_study.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/stopwatch.h"
#include "sightline/images/portal_screen.h"
#include "sightline/tools/report/pictures/scene_look.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::bench {
using namespace images;
namespace {

constexpr uint32_t kImageWidth = 640, kImageHeight = 360, kSub = 4;  // pixels, and samples across a pixel
constexpr double kTexelsAPixel = 2, kMostTexels = 1500;              // where the eye is nearest
constexpr size_t kEyes = 4;

/// Sees the whole of a scene, so that a list's items are all of them.
View viewOfAll(const Scene& scene) {
    const Box3d box = coreOf(scene).bounds;
    const double size = 4 * diagonalOf(box);
    View view;
    const glm::dvec3 middle = box.empty() ? glm::dvec3(0.0) : box.center();
    view.view = lookAt(middle + glm::dvec3(0, 0, size), middle, {0, 1, 0});
    view.projection = orthographic(size, 1, 1e-3 * size, 4 * size);
    view.width = view.height = 16;
    return view;
}

/// The camera of an eye: 90 degrees across, level, towards the doorway's middle.
View cameraOf(const StudiedDoorway& doorway, const glm::dvec3& eye) {
    View view;
    view.width = kSub * kImageWidth;
    view.height = kSub * kImageHeight;
    glm::dvec3 target = doorway.frame.centre();
    target += glm::dot(eye - target, doorway.frame.up) * doorway.frame.up;
    view.view = lookAt(eye, target, doorway.frame.up);
    view.projection = perspective(glm::radians(58.7155), 16.0 / 9.0, 0.02 * doorway.nearest);
    return view;
}

/// Of the image that is shown, not of its samples.
double focalOf(const View& camera) { return focalLength(camera) / kSub; }

std::vector<glm::u8vec3> coloursOf(const DepthImage& image) {
    std::vector<glm::u8vec3> out;
    out.reserve(image.samples.size());
    for (const DepthSample& sample : image.samples) out.push_back(sample.colour);
    return out;
}

std::vector<float> nearnessOf(const DepthImage& image) {
    std::vector<float> out;
    out.reserve(image.samples.size());
    for (const DepthSample& sample : image.samples) out.push_back(sample.nearness);
    return out;
}

/// The mean of a pixel's samples.
glm::u8vec3 pixelOf(std::span<const glm::u8vec3> samples, uint32_t row, uint32_t column) {
    glm::uvec3 sum(kSub * kSub / 2);
    for (uint32_t y = 0; y < kSub; ++y)
        for (uint32_t x = 0; x < kSub; ++x)
            sum += glm::uvec3(samples[size_t{row * kSub + y} * kImageWidth * kSub + column * kSub + x]);
    return glm::u8vec3(sum / (kSub * kSub));
}

/// Compares the pixels that look through the doorway, in part or wholly.
PictureError compare(std::span<const glm::u8vec3> a, std::span<const glm::u8vec3> b,
                     const std::vector<uint32_t>& through) {
    std::vector<uint8_t> done(size_t{kImageWidth} * kImageHeight, 0);
    PictureError error;
    for (const uint32_t sample : through) {
        const uint32_t row = sample / (kImageWidth * kSub) / kSub, column = sample % (kImageWidth * kSub) / kSub;
        uint8_t& is_done = done[size_t{row} * kImageWidth + column];
        if (is_done) continue;
        is_done = 1;
        error.add(pixelOf(a, row, column), pixelOf(b, row, column));
    }
    return error;
}

/// What the doorway's pictures are held against for one eye.
struct Truth {
    View camera;
    std::vector<glm::u8vec3> screen, raster;
    std::vector<glm::u8vec3> smooth;  ///< the raster as images without depth have it
    DepthImage beyond;                ///< as the raster shows it
    std::vector<uint32_t> through;
    std::vector<glm::u8vec3> near;
    std::vector<float> nearness;
};

class DoorwayStudy {
public:
    DoorwayStudy(const DrawnScene& scene, const StudiedDoorway& doorway, uint64_t seed, StudyFigures& figures)
        : scene_(scene), doorway_(doorway), random_(seed), figures_(figures), images_(bake()) {}

    void run() {
        if (!images_) return;
        ++figures_.doorways;
        addBake();
        const std::vector<glm::dvec3>& arc = images_->fan.eyes;
        for (size_t tries = 0, k = 0; k < kEyes && tries < 100 * kEyes; ++tries) {
            const size_t at = random_.below(arc.size() - 1);
            const glm::dvec3 between = 0.5 * (arc[at] + arc[at + 1]);
            if (!isIn(arc[at]) || !isIn(between)) continue;
            ++k;
            measure(arc[at], figures_.at_samples, false);
            measure(between, figures_.on_arc, true);
        }
        for (size_t k = 0; k < kEyes; ++k) measure(anyEye(), figures_.anywhere, true);
        walk();
    }

private:
    Result<PortalImages> bake() {
        PortalImageSettings settings;
        const PortalFrame& frame = doorway_.frame;
        const View camera = cameraOf(doorway_, frame.toWorld({0.5 * frame.width, doorway_.height, doorway_.nearest}));
        const double density = std::min(kTexelsAPixel * focalOf(camera) / doorway_.nearest,
                                        kMostTexels / std::max(frame.width, frame.height));
        settings.width = static_cast<uint32_t>(std::lround(density * frame.width));
        settings.height = static_cast<uint32_t>(std::lround(density * frame.height));
        const double middle = std::sqrt(doorway_.nearest * doorway_.farthest);
        settings.images = {doorway_.height, middle, middle, 1, 120, kHalfAngle};
        settings.references = {doorway_.height, doorway_.nearest, doorway_.farthest, 3, 7, kHalfAngle};
        settings.layered = {doorway_.height, doorway_.nearest, doorway_.farthest, 2, 5, kHalfAngle};
        settings.take = scene_.take();
        return bakePortalImages(frame, scene_.items(), settings);
    }

    void addBake() {
        const PortalBakeReport& one = images_->report;
        PortalBakeReport& all = figures_.bake;
        all.images += one.images, all.references += one.references, all.layered += one.layered;
        all.image_bytes += one.image_bytes, all.reference_bytes += one.reference_bytes;
        all.layered_bytes += one.layered_bytes;
        all.image_seconds += one.image_seconds, all.reference_seconds += one.reference_seconds;
        all.layered_seconds += one.layered_seconds;
        all.triangles += one.triangles;
    }

    bool isIn(const glm::dvec3& eye) const {
        const Box3d& box = doorway_.place;
        return glm::all(glm::greaterThan(eye, box.min)) && glm::all(glm::lessThan(eye, box.max));
    }

    glm::dvec3 anyEye() {
        const SampleFan& fan = images_->fan;
        for (int tries = 0;; ++tries) {
            const double angle = random_.uniform(-kHalfAngle, kHalfAngle);
            const double radius = random_.uniform(doorway_.nearest, doorway_.farthest);
            const glm::dvec3 eye = fan.centre + radius * (std::sin(angle) * fan.right + std::cos(angle) * fan.front);
            if (isIn(eye) || tries > 1000) return eye;
        }
    }

    /// What is drawn as geometry if the doorway is an image.
    std::vector<uint32_t> nearOf(const std::vector<uint32_t>& items, const glm::dvec3& eye) const {
        std::vector<uint32_t> near;
        for (const uint32_t item : items) {
            const Box3d& box = scene_.boxOf(item);
            bool is_near = true;
            for (int axis = 0; doorway_.in_cell && axis < 3; ++axis)
                is_near &= box.max[axis] >= doorway_.place.min[axis] && box.min[axis] <= doorway_.place.max[axis];
            if (!doorway_.in_cell) is_near = !isReplaced(box, eye);
            if (is_near) near.push_back(item);
        }
        return near;
    }

    /// True if all of a box lies beyond the doorway and is seen through it.
    bool isReplaced(const Box3d& box, const glm::dvec3& eye) const {
        const PortalFrame& frame = doorway_.frame;
        const glm::dvec3 own_eye = frame.toFrame(eye);
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 corner((k & 1) != 0 ? box.max.x : box.min.x, (k & 2) != 0 ? box.max.y : box.min.y,
                                    (k & 4) != 0 ? box.max.z : box.min.z);
            const glm::dvec3 own = frame.toFrame(corner);
            if (!(own.z < 0)) return false;
            const glm::dvec2 met = glm::dvec2(own_eye) + glm::dvec2(own - own_eye) * (own_eye.z / (own_eye.z - own.z));
            if (met.x < 0 || met.y < 0 || met.x > frame.width || met.y > frame.height) return false;
        }
        return true;
    }

    Truth truthOf(const glm::dvec3& eye, bool count) {
        Truth truth;
        truth.camera = cameraOf(doorway_, eye);
        const std::vector<uint32_t> in_view = scene_.inView(truth.camera), near = nearOf(in_view, eye);
        truth.screen = coloursOf(scene_.draw(in_view, truth.camera));
        const DepthImage before = scene_.draw(near, truth.camera);
        truth.near = coloursOf(before);
        truth.nearness = nearnessOf(before);
        truth.through = uncovered(truth);
        const View raster = *portalView(doorway_.frame, eye, images_->width, images_->height);
        const std::vector<uint32_t> beyond = scene_.inView(raster);
        const double start = threadTime();
        truth.beyond = scene_.draw(beyond, raster);
        figures_.geometry_times.push_back(threadTime() - start);
        truth.raster = coloursOf(truth.beyond);
        truth.smooth = scene_.drawSmooth(beyond, raster);
        if (count) {
            ++figures_.eyes;
            figures_.in_frustum += static_cast<double>(scene_.triangles(in_view));
            figures_.with_image += static_cast<double>(scene_.triangles(near)) + 2;
        }
        return truth;
    }

    /// The samples that look through the doorway and past what stands before it.
    std::vector<uint32_t> uncovered(const Truth& truth) const {
        PortalPicture mark;
        mark.width = mark.height = 1;
        mark.colour = {glm::u8vec3(1)};
        std::vector<glm::u8vec3> marks(truth.near.size(), glm::u8vec3(0));
        drawOnScreen(doorway_.frame, mark, truth.camera, truth.nearness, marks);
        std::vector<uint32_t> found;
        for (uint32_t at = 0; at < marks.size(); ++at)
            if (marks[at].x != 0) found.push_back(at);
        return found;
    }

    void measure(const glm::dvec3& eye, ModeFigures* modes, bool count) {
        const Truth truth = truthOf(eye, count);
        for (int mode = 0; mode < kShowModes; ++mode) {
            ShowSettings settings;
            settings.mode = static_cast<ShowMode>(mode);
            settings.most_error = std::numeric_limits<double>::infinity();
            settings.focal = focalOf(truth.camera);
            settings.reuse = false;
            PortalPicture picture;
            const double start = threadTime();
            const Shown shown = showPortal(*images_, eye, settings, picture);
            modes[mode].times.push_back(threadTime() - start);
            if (!shown.ok() || truth.through.empty()) continue;
            const bool has_depth = settings.mode == ShowMode::kWarped || settings.mode == ShowMode::kLayered;
            modes[mode].on_raster.add(has_depth ? truth.raster : truth.smooth, picture.colour);
            modes[mode].holes += picture.holes;
            modes[mode].texels += picture.colour.size();
            const PictureError error = compareOnScreen(truth, picture);
            modes[mode].on_screen.squares += error.squares;
            modes[mode].on_screen.bytes += error.bytes;
            modes[mode].worst = std::min(modes[mode].worst, error.psnr());
            if (mode == 0 && count) addPoint(truth, eye, picture, shown.error.pixels, settings.focal);
        }
    }

    PictureError compareOnScreen(const Truth& truth, const PortalPicture& picture) const {
        // Elsewhere the pictures are the same by construction.
        std::vector<glm::u8vec3> screen = truth.screen;
        drawOnScreen(doorway_.frame, picture, truth.camera, truth.nearness, screen);
        return compare(truth.screen, screen, truth.through);
    }

    /// How far off points beyond truly are in the nearest image.
    void addPoint(const Truth& truth, const glm::dvec3& eye, const PortalPicture& picture, double predicted,
                  double focal) {
        const glm::dvec3& from = picture.taken_from[0];
        const View sample_view = *portalView(doorway_.frame, from, images_->width, images_->height);
        const WarpMap map(truth.beyond.view, sample_view);
        const glm::dvec2 texel(doorway_.frame.width / images_->width, doorway_.frame.height / images_->height);
        const glm::dvec2 high(images_->width - 0.5, images_->height - 0.5);
        double most = 0;
        for (uint32_t row = 0; row < images_->height; ++row)
            for (uint32_t i = 0; i < images_->width; ++i) {
                const glm::dvec3 there =
                    map.at(i, row, truth.beyond.samples[size_t{row} * images_->width + i].nearness);
                if (!(there.z > 0)) continue;
                const glm::dvec2 place = glm::dvec2(there) / there.z;
                if (place.x < -0.5 || place.y < -0.5 || place.x > high.x || place.y > high.y) continue;
                most = std::max(most, glm::length((place - glm::dvec2(i, row)) * texel));
            }
        PictureError error;
        error.add(truth.smooth, picture.colour);
        figures_.points.push_back({predicted, most * focal / doorway_.frame.toFrame(eye).z, error.psnr()});
    }

    /// Sixty steps aside of a thousandth of a unit: most pictures may be kept.
    void walk() {
        ShowSettings settings;
        settings.mode = ShowMode::kWarped;
        settings.focal = focalOf(cameraOf(doorway_, images_->fan.centre + doorway_.farthest * images_->fan.front));
        settings.most_error = 2;
        PortalPicture picture;
        for (int frame = 0; frame < 60; ++frame) {
            const glm::dvec3 eye =
                images_->fan.centre + doorway_.farthest * images_->fan.front + 0.001 * frame * images_->fan.right;
            const Shown shown = showPortal(*images_, eye, settings, picture);
            ++figures_.frames;
            figures_.reused += shown.result == ShowResult::kReused;
            if (shown.ok()) figures_.reuse_error = std::max(figures_.reuse_error, shown.error.pixels);
        }
    }

    static constexpr double kHalfAngle = 1.0;

    const DrawnScene& scene_;
    const StudiedDoorway& doorway_;
    Random random_;
    StudyFigures& figures_;
    Result<PortalImages> images_;
};

}  // namespace

DrawnScene::DrawnScene(const Scene& scene) : scene_(scene), all_(scene, viewOfAll(scene)) {
    for (const DrawItem& item : items()) {
        const SceneObject& object = scene.objects[item.id];
        boxes_.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    }
}

TakeSettings DrawnScene::take() const {
    TakeSettings settings;
    settings.shade.colour = [this](uint32_t item, uint32_t triangle) { return all_.colourOf(item, triangle); };
    return settings;
}

std::vector<uint32_t> DrawnScene::inView(const View& view) const {
    const glm::dmat4 clip = view.projection * view.view;
    std::vector<uint32_t> chosen;
    for (uint32_t i = 0; i < boxes_.size(); ++i)
        if (mayBeInView(clip, boxes_[i])) chosen.push_back(i);
    return chosen;
}

uint64_t DrawnScene::triangles(const std::vector<uint32_t>& chosen) const {
    uint64_t sum = 0;
    for (const uint32_t item : chosen) sum += items()[item].mesh.triangles();
    return sum;
}

std::vector<DrawItem> DrawnScene::itemsOf(const std::vector<uint32_t>& chosen) const {
    std::vector<DrawItem> some;
    some.reserve(chosen.size());
    for (const uint32_t item : chosen) some.push_back(items()[item]);
    return some;
}

TakeSettings DrawnScene::takeOf(const std::vector<uint32_t>& chosen) const {
    TakeSettings settings;
    settings.shade.colour = [&](uint32_t item, uint32_t triangle) { return all_.colourOf(chosen[item], triangle); };
    return settings;
}

DepthImage DrawnScene::draw(const std::vector<uint32_t>& chosen, const View& view) const {
    return takeImage(DrawList(itemsOf(chosen)), view, takeOf(chosen));
}

std::vector<glm::u8vec3> DrawnScene::drawSmooth(const std::vector<uint32_t>& chosen, const View& view) const {
    return takeColours(DrawList(itemsOf(chosen)), view, takeOf(chosen), PortalImageSettings{}.across).colours;
}

void studyDoorway(const DrawnScene& scene, const StudiedDoorway& doorway, uint64_t seed, StudyFigures& figures) {
    DoorwayStudy(scene, doorway, seed, figures).run();
}

}  // namespace sightline::bench
