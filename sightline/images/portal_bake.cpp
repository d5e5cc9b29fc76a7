// Takes the images of a doorway from all sample points.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

#include "sightline/geom/frustum.h"
#include "sightline/images/portal_images.h"
#include "sightline/math/box.h"

namespace sightline::images {
using namespace studies;
namespace {

double secondsSince(const std::chrono::steady_clock::time_point& start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Box3d> boxesOf(std::span<const DrawItem> items) {
    std::map<const glm::vec3*, Box3d> meshes;  // items share meshes
    std::vector<Box3d> boxes;
    boxes.reserve(items.size());
    for (const DrawItem& item : items) {
        const auto [found, added] = meshes.try_emplace(item.mesh.positions.data());
        if (added)
            for (const glm::vec3& p : item.mesh.positions) found->second.grow(glm::dvec3(p));
        boxes.push_back(transformBox(found->second, item.transform));
    }
    return boxes;
}

/// The farthest that a box reaches along a direction.
double reachOf(const Box3d& box, const glm::dvec3& direction) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += std::max(direction[axis] * box.min[axis], direction[axis] * box.max[axis]);
    return reach;
}

bool isOutside(const Frustum& frustum, const Box3d& box) {
    for (uint32_t i = 0; i < frustum.count; ++i) {
        const glm::dvec3 normal(frustum.planes[i]);
        const double reach = reachOf(box, normal) - glm::dot(normal, frustum.eye) + frustum.planes[i].w;
        if (reach < -1e-9 * (1 + glm::length(box.size()))) return true;
    }
    return false;
}

/// Draws one image after the other.
class Baker {
public:
    Baker(const PortalFrame& frame, std::span<const DrawItem> items, const PortalImageSettings& settings,
          PortalImages& out)
        : items_(items), settings_(settings), boxes_(boxesOf(items)), out_(out) {
        out_.beyond = {std::numeric_limits<double>::infinity(), 0};
        out_.frame = frame;
        out_.width = settings.width;
        out_.height = settings.height;
    }

    DepthImage take(const glm::dvec3& eye) {
        const Seen seen = seenFrom(eye);
        DepthImage image = takeImage(DrawList(seen.items), seen.view, settingsFor(seen));
        note(seen, std::any_of(image.samples.begin(), image.samples.end(),
                               [](const DepthSample& s) { return !(s.nearness > 0); }));
        return image;
    }

    std::vector<glm::u8vec3> takeColoursFrom(const glm::dvec3& eye) {
        const Seen seen = seenFrom(eye);
        ColourImage image = takeColours(DrawList(seen.items), seen.view, settingsFor(seen), settings_.across);
        note(seen, image.has_sky);
        return std::move(image.colours);
    }

    void run() {
        total_ = out_.fan.eyes.size() + out_.reference_fan.eyes.size() + out_.layered_fan.eyes.size();
        out_.images.resize(out_.fan.eyes.size());
        out_.references.resize(out_.reference_fan.eyes.size());
        out_.layered.resize(out_.layered_fan.eyes.size());
        PortalBakeReport& report = out_.report;
        auto start = std::chrono::steady_clock::now();
        shareOut(settings_.share, out_.images.size(),
                 [&](size_t i) { out_.images[i] = takeColoursFrom(out_.fan.eyes[i]); });
        report.image_seconds = secondsSince(start);
        start = std::chrono::steady_clock::now();
        shareOut(settings_.share, out_.references.size(),
                 [&](size_t i) { out_.references[i] = take(out_.reference_fan.eyes[i]); });
        report.reference_seconds = secondsSince(start);
        start = std::chrono::steady_clock::now();
        shareOut(settings_.share, out_.layered.size(), [&](size_t i) { out_.layered[i] = gather(i); });
        report.layered_seconds = secondsSince(start);
        finish();
    }

private:
    /// What an eye may see through the doorway.
    struct Seen {
        View view;
        std::vector<DrawItem> items;
        std::vector<uint32_t> index;  ///< of each among all items
        BeyondRange range{std::numeric_limits<double>::infinity(), 0};
        double triangles = 0;
    };

    Seen seenFrom(const glm::dvec3& eye) const {
        Seen seen;
        seen.view = *portalView(out_.frame, eye, settings_.width, settings_.height);
        const Frustum frustum = makeFrustum(seen.view);
        const double plane = glm::dot(out_.frame.front, out_.frame.corner);
        for (uint32_t i = 0; i < items_.size(); ++i) {
            if (!boxes_[i].finite() || isOutside(frustum, boxes_[i])) continue;
            seen.items.push_back(items_[i]);
            seen.index.push_back(i);
            seen.triangles += static_cast<double>(items_[i].mesh.triangles());
            BeyondRange& range = seen.range;
            range.farthest = std::max(range.farthest, plane + reachOf(boxes_[i], -out_.frame.front));
            range.nearest = std::min(range.nearest, std::max(0.0, plane - reachOf(boxes_[i], out_.frame.front)));
        }
        return seen;
    }

    /// @param seen  outlives the answer
    TakeSettings settingsFor(const Seen& seen) const {
        TakeSettings take = settings_.take;
        if (const auto& colour = settings_.take.shade.colour)
            take.shade.colour = [&](uint32_t item, uint32_t triangle) { return colour(seen.index[item], triangle); };
        return take;
    }

    /// Takes down an image that was drawn.
    void note(const Seen& seen, bool has_sky) {
        const std::lock_guard<std::mutex> lock(mutex_);
        triangles_ += seen.triangles;
        ++done_;
        const double farthest = has_sky ? std::numeric_limits<double>::infinity() : seen.range.farthest;
        out_.beyond.nearest = std::min(out_.beyond.nearest, seen.range.nearest);
        out_.beyond.farthest = std::max(out_.beyond.farthest, farthest);
        if (settings_.progress) settings_.progress(done_, total_);
    }

    /// The view's own image comes first, then the references, nearest first.
    LayeredImage gather(size_t i) {
        const glm::dvec3& eye = out_.layered_fan.eyes[i];
        std::vector<size_t> order(out_.references.size());
        std::iota(order.begin(), order.end(), size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
            return glm::length(out_.reference_fan.eyes[a] - eye) < glm::length(out_.reference_fan.eyes[b] - eye);
        });
        if (order.size() > settings_.layer_references) order.resize(settings_.layer_references);
        std::vector<DepthImage> references = {take(eye)};
        for (const size_t reference : order) references.push_back(out_.references[reference]);
        // The larger rectangle has the same texels and more.
        const auto columns = static_cast<uint32_t>(std::lround(settings_.layer_margin * settings_.width));
        const auto rows = static_cast<uint32_t>(std::lround(settings_.layer_margin * settings_.height));
        const PortalFrame wide = widened(
            out_.frame, {columns * out_.frame.width / settings_.width, rows * out_.frame.height / settings_.height});
        const View view = *portalView(wide, eye, settings_.width + 2 * columns, settings_.height + 2 * rows);
        return layeredImage(references, view, settings_.layers);
    }

    void finish() {
        PortalBakeReport& report = out_.report;
        report.images = out_.images.size();
        report.references = out_.references.size();
        report.layered = out_.layered.size();
        for (const auto& image : out_.images) report.image_bytes += image.size() * sizeof(glm::u8vec3);
        for (const DepthImage& image : out_.references) report.reference_bytes += image.bytes();
        for (const LayeredImage& image : out_.layered) report.layered_bytes += image.bytes();
        report.triangles = done_ > 0 ? triangles_ / static_cast<double>(done_) : 0;
        if (out_.beyond.nearest > out_.beyond.farthest) out_.beyond.nearest = out_.beyond.farthest;
    }

    std::span<const DrawItem> items_;
    const PortalImageSettings& settings_;
    std::vector<Box3d> boxes_;
    PortalImages& out_;
    std::mutex mutex_;
    size_t done_ = 0, total_ = 0;
    double triangles_ = 0;
};

Status makeFan(const PortalFrame& frame, const FanSettings& settings, SampleFan& out) {
    if (settings.arcs == 0) return success();
    Result<SampleFan> fan = sampleFan(frame, settings);
    if (!fan) return fan.error();
    for (const glm::dvec3& eye : fan->eyes)
        if (const EyePlace place = eyePlace(frame, eye); place != EyePlace::kBefore)
            return Error{Error::Kind::kUsage, std::string("a sample point: ") + wordsOf(place)};
    out = std::move(*fan);
    return success();
}

}  // namespace

Result<PortalImages> bakePortalImages(const PortalFrame& frame, std::span<const DrawItem> items,
                                      const PortalImageSettings& settings) {
    constexpr uint32_t kMostTexels = 8192;
    const uint64_t across = settings.across;
    if (settings.width == 0 || settings.height == 0 || across == 0 || across * settings.width > kMostTexels ||
        across * settings.height > kMostTexels)
        return Error{Error::Kind::kUsage, "images of a doorway have 1 to 8192 samples on each side"};
    if (!(settings.layer_margin >= 0 && settings.layer_margin <= 4))
        return Error{Error::Kind::kUsage, "the margin of layered images is from 0 to 4"};
    PortalImages out;
    const std::pair<const FanSettings*, SampleFan*> fans[] = {{&settings.images, &out.fan},
                                                              {&settings.references, &out.reference_fan},
                                                              {&settings.layered, &out.layered_fan}};
    for (const auto& [wish, fan] : fans)
        if (Status made = makeFan(frame, *wish, *fan); !made) return made.error();
    Baker(frame, items, settings, out).run();
    return out;
}

}  // namespace sightline::images
