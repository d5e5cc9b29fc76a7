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
        const View view = *portalView(out_.frame, eye, settings_.width, settings_.height);
        const Frustum frustum = makeFrustum(view);
        std::vector<DrawItem> chosen;
        std::vector<uint32_t> index;
        BeyondRange range{std::numeric_limits<double>::infinity(), 0};
        double triangles = 0;
        for (uint32_t i = 0; i < items_.size(); ++i) {
            if (!boxes_[i].finite() || isOutside(frustum, boxes_[i])) continue;
            chosen.push_back(items_[i]);
            index.push_back(i);
            triangles += static_cast<double>(items_[i].mesh.triangles());
            const double plane = glm::dot(out_.frame.front, out_.frame.corner);
            range.farthest = std::max(range.farthest, plane + reachOf(boxes_[i], -out_.frame.front));
            range.nearest = std::min(range.nearest, std::max(0.0, plane - reachOf(boxes_[i], out_.frame.front)));
        }
        TakeSettings take = settings_.take;
        if (const auto& colour = settings_.take.shade.colour)
            take.shade.colour = [&](uint32_t item, uint32_t triangle) { return colour(index[item], triangle); };
        else take.shade.colour = {};
        DepthImage image = takeImage(DrawList(chosen), view, take);
        const bool sky = std::any_of(image.samples.begin(), image.samples.end(),
                                     [](const DepthSample& s) { return !(s.nearness > 0); });
        if (sky) range.farthest = std::numeric_limits<double>::infinity();
        const std::lock_guard<std::mutex> lock(mutex_);
        triangles_ += triangles;
        ++done_;
        out_.beyond.nearest = std::min(out_.beyond.nearest, range.nearest);
        out_.beyond.farthest = std::max(out_.beyond.farthest, range.farthest);
        if (settings_.progress) settings_.progress(done_, total_);
        return image;
    }

    void run() {
        total_ = out_.fan.eyes.size() + out_.reference_fan.eyes.size() + out_.layered_fan.eyes.size();
        out_.images.resize(out_.fan.eyes.size());
        out_.references.resize(out_.reference_fan.eyes.size());
        out_.layered.resize(out_.layered_fan.eyes.size());
        PortalBakeReport& report = out_.report;
        auto start = std::chrono::steady_clock::now();
        shareOut(settings_.share, out_.images.size(), [&](size_t i) {
            const DepthImage image = take(out_.fan.eyes[i]);
            out_.images[i].reserve(image.samples.size());
            for (const DepthSample& sample : image.samples) out_.images[i].push_back(sample.colour);
        });
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
    if (settings.width == 0 || settings.height == 0 || settings.width > kMostTexels || settings.height > kMostTexels)
        return Error{Error::Kind::kUsage, "images of a doorway have 1 to 8192 texels on each side"};
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
