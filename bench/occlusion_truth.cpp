// What an exact z-buffer shows of an occlusion scene: which boxes have a sample in sight, and the plain box test on it.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_truth.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/project/scan.h"
#include "sightline/studies/hidden/threads.h"

namespace sightline::bench {
using namespace studies;
namespace {

constexpr uint32_t kCorners[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

std::vector<DrawItem> batchItems(const OcclusionScene& scene, std::span<const uint32_t> batches) {
    std::vector<DrawItem> items;
    items.reserve(batches.size());
    for (uint32_t batch : batches) items.emplace_back().mesh = scene.batches[batch].mesh();
    return items;
}

std::vector<glm::vec3> cornersOf(const OcclusionScene& scene, std::span<const uint32_t> boxes) {
    std::vector<glm::vec3> corners;
    corners.reserve(8 * boxes.size());
    for (uint32_t number : boxes) {
        const Box3f& box = scene.boxes[number];
        for (int k = 0; k < 8; ++k)
            corners.emplace_back(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                                 k & 4 ? box.max.z : box.min.z);
    }
    return corners;
}

/// Shifts of the pictures' samples  [pixels].
std::vector<glm::dvec2> shiftsOf(const BoxTruthSettings& settings) {
    const uint32_t side = static_cast<uint32_t>(std::lround(std::sqrt(settings.jitters)));
    const bool square = side * side == settings.jitters;
    Random random(settings.seed);
    std::vector<glm::dvec2> shifts(settings.jitters);
    for (uint32_t i = 0; i < settings.jitters; ++i) {
        glm::dvec2 at;
        at.x = random.uniform();
        at.y = random.uniform();
        if (square) at = (at + glm::dvec2(i % side, i / side)) / double(side);
        shifts[i] = (at - 0.5) / double(settings.supersampling);
    }
    return shifts;
}

/// The samples of a band, with the farthest depth of each square of them: what is farther than that lies behind all.
class DrawnBand {
public:
    DrawnBand(std::span<const DrawItem> items, const View& view, const ZBufferSettings& pass)
        : view_(view), pass_(pass), image_(renderZBuffer(items, view, pass)) {
        columns_ = (image_.width + kSide - 1) / kSide;
        rows_ = (image_.height + kSide - 1) / kSide;
        farthest_.assign(size_t{columns_} * rows_, std::numeric_limits<double>::infinity());
        for (uint32_t row = 0; row < image_.height; ++row)
            for (uint32_t x = 0; x < image_.width; ++x) {
                double& farthest = farthest_[size_t{row / kSide} * columns_ + x / kSide];
                farthest = std::min(farthest, image_.depth[size_t{row} * image_.width + x]);
            }
    }

    SampleGrid grid() const { return {image_.width, image_.height, image_.first_row, pass_.samples, pass_.offset}; }

    /// Whether the samples that a box may meet all lie clearly before its nearest corner. False where it is in doubt.
    bool surelyHides(const glm::vec3* corners) const {
        if (isOrthographic(view_)) return false;
        const glm::dmat4 m = view_.projection * view_.view;
        double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300, nearest = 0;
        for (int k = 0; k < 8; ++k) {
            const glm::dvec4 clip = m * glm::dvec4(glm::dvec3(corners[k]), 1.0);
            if (!(clip.w > 0 && clip.z > -clip.w)) return false;
            const double x = (0.5 + 0.5 * clip.x / clip.w) * image_.width;
            const double y = (0.5 + 0.5 * clip.y / clip.w) * (double(view_.height) * pass_.samples) - image_.first_row;
            x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
            nearest = std::max(nearest, 1.0 / clip.w);
        }
        constexpr double kRim = 2;  // samples: their shift is less than one
        if (x1 < -kRim || y1 < -kRim || x0 > image_.width + kRim || y0 > image_.height + kRim) return true;
        const auto square = [](double at, uint32_t count) {
            return static_cast<uint32_t>(std::clamp(at / kSide, 0.0, count - 1.0));
        };
        const uint32_t last_column = square(x1 + kRim, columns_), last_row = square(y1 + kRim, rows_);
        for (uint32_t row = square(y0 - kRim, rows_); row <= last_row; ++row)
            for (uint32_t column = square(x0 - kRim, columns_); column <= last_column; ++column)
                if (!(farthest_[size_t{row} * columns_ + column] > nearest * (1.0 + 1e-9))) return false;
        return true;
    }

    /// Whether a sample shows the item that the projector has taken up.
    bool shows(const DrawItem& item, Projector& projector, glm::dvec2& pixel) const {
        ScreenPolygon polygon;
        bool seen = false;
        projector.begin(item);
        for (size_t triangle = 0; triangle < item.mesh.triangles() && !seen; ++triangle) {
            if (!projector.project(triangle, polygon)) continue;
            const int32_t first = static_cast<int32_t>(image_.first_row);
            scanPolygon(polygon.outline(), first, first + static_cast<int32_t>(image_.height),
                        static_cast<int32_t>(image_.width), [&](int32_t row, int32_t begin, int32_t end) {
                            const double* depth = image_.depth.data() + static_cast<size_t>(row - first) * image_.width;
                            for (int32_t i = begin; i < end && !seen; ++i) {
                                if (polygon.depth.at(row, i) < depth[i]) continue;
                                seen = true;
                                pixel = (glm::dvec2(i, row) + 0.5) / double(pass_.samples) + pass_.offset;
                            }
                        });
        }
        return seen;
    }

private:
    static constexpr uint32_t kSide = 16;  ///< of a square [samples]

    const View& view_;
    const ZBufferSettings pass_;
    const ZBufferImage image_;
    uint32_t columns_ = 0, rows_ = 0;  ///< [squares]
    std::vector<double> farthest_;     ///< per square
};

}  // namespace

std::vector<BoxSighting> sightBoxes(const OcclusionScene& scene, std::span<const uint32_t> batches,
                                    std::span<const uint32_t> boxes, const View& view,
                                    const BoxTruthSettings& settings) {
    const std::vector<glm::vec3> corners = cornersOf(scene, boxes);
    const std::vector<DrawItem> items = batchItems(scene, batches);
    const std::vector<glm::dvec2> shifts = shiftsOf(settings);
    const uint64_t width = uint64_t{view.width} * settings.supersampling;
    const uint64_t height = uint64_t{view.height} * settings.supersampling;
    const uint64_t band = std::clamp<uint64_t>(settings.band_samples / width, 1, height);
    const size_t bands = static_cast<size_t>((height + band - 1) / band), parts = bands * shifts.size();

    constexpr size_t kNever = ~size_t{0};
    struct First {
        size_t part = kNever;
        glm::dvec2 pixel{0.0};
    };
    std::vector<std::vector<First>> found(settings.threads, std::vector<First>(boxes.size()));
    std::atomic<size_t> next{0};
    FirstFault fault;
    const auto work = [&](uint32_t thread) {
        fault.guard([&] {
            std::vector<First>& mine = found[thread];
            for (size_t part; (part = next++) < parts && !fault.any();) {
                ZBufferSettings pass{.samples = settings.supersampling, .want_generated = false};
                pass.offset = shifts[part / bands];
                pass.first_row = static_cast<uint32_t>(part % bands * band);
                pass.row_count = static_cast<uint32_t>(band);
                const DrawnBand drawn(items, view, pass);
                Projector projector(view, drawn.grid());
                for (size_t i = 0; i < boxes.size(); ++i) {
                    if (mine[i].part != kNever || drawn.surelyHides(&corners[8 * i])) continue;
                    DrawItem item;
                    item.mesh = {std::span(corners).subspan(8 * i, 8), kCorners};
                    if (drawn.shows(item, projector, mine[i].pixel)) mine[i].part = part;
                }
            }
        });
    };
    std::vector<std::thread> others = startThreads(settings.threads, work);
    work(0);
    for (std::thread& other : others) other.join();
    fault.rethrow();

    std::vector<BoxSighting> sightings(boxes.size());
    for (size_t i = 0; i < boxes.size(); ++i) {
        const First* first = &found[0][i];
        for (const std::vector<First>& mine : found)
            if (mine[i].part < first->part) first = &mine[i];
        sightings[i] = {first->part != kNever, first->pixel};
    }
    return sightings;
}

std::vector<uint8_t> boxesInSight(const OcclusionScene& scene, std::span<const uint32_t> batches,
                                  std::span<const uint32_t> boxes, const View& view, const BoxTruthSettings& settings) {
    std::vector<uint8_t> in_sight;
    in_sight.reserve(boxes.size());
    for (const BoxSighting& sighting : sightBoxes(scene, batches, boxes, view, settings))
        in_sight.push_back(sighting.seen);
    return in_sight;
}

ZBufferImage drawBatches(const OcclusionScene& scene, std::span<const uint32_t> batches, const View& view) {
    return renderZBuffer(batchItems(scene, batches), view, {.want_generated = false});
}

bool isBehind(const ZBufferImage& image, const PixelRect& rect) {
    for (int32_t y = rect.y0; y <= rect.y1; ++y)
        for (int32_t x = rect.x0; x <= rect.x1; ++x)
            if (!(image.depth[static_cast<size_t>(y) * image.width + static_cast<size_t>(x)] > rect.nearness))
                return false;
    return true;
}

}  // namespace sightline::bench
