// A plain z-buffer renderer: the slow, obvious reference for images, ids and depth complexity.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/zbuffer.h"

#include <algorithm>

#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/project/scan.h"

namespace sightline::studies {
namespace {

/// So many are drawn between two questions whether to stop: each may fill the image.
constexpr size_t kTrianglesAtOnce = 32;

class Renderer {
public:
    Renderer(const View& view, const ZBufferSettings& settings, ZBufferImage& image)
        : settings_(settings),
          image_(image),
          projector_(view, {image.width, image.height, image.first_row, settings.samples, settings.offset}) {
        for (const glm::dvec4& plane : view.sections.all()) sections_.push_back(projector_.overSamples(plane));
    }

    void draw(const DrawItem& item, bool writing) {
        projector_.begin(item);
        const int32_t first_row = static_cast<int32_t>(image_.first_row);
        const int32_t end_row = first_row + static_cast<int32_t>(image_.height);
        ScreenPolygon polygon;
        for (size_t triangle = 0; triangle < item.mesh.triangles(); ++triangle) {
            if (triangle % kTrianglesAtOnce == 0 && settings_.stop && settings_.stop()) return;
            const bool writes = item.writes_depth.empty() || item.writes_depth[triangle] != 0;
            if (writes != writing || !projector_.project(triangle, polygon)) continue;
            scanPolygon(polygon.outline(), first_row, end_row, static_cast<int32_t>(image_.width),
                        [&](int32_t row, int32_t begin, int32_t end) {
                            cutSpan(polygon.depth, row, begin, end);
                            if (writing) writeSpan(polygon.depth, item.id, row, begin, end);
                            else showSpan(polygon.depth, item.id, row, begin, end);
                        });
        }
    }

    /// The opaque surfaces that the finished image shows.
    void noteOpaque() {
        longest_.assign(image_.seen.size(), 0);
        for (uint32_t row = 0; row < image_.height; ++row) {
            const size_t line = size_t(row) * image_.width;
            for (size_t at = line; at < line + image_.width;) {
                const uint32_t id = image_.id[at];
                size_t end = at + 1;
                while (end < line + image_.width && image_.id[end] == id) ++end;
                if (id != ZBufferImage::kNone) noteSeen(id, at, end);
                at = end;
            }
        }
    }

private:
    /// A run of samples [begin, end) that show an id.
    void noteSeen(uint32_t id, size_t begin, size_t end) {
        image_.seen[id] = 1;
        if (end - begin <= longest_[id]) return;
        longest_[id] = static_cast<uint32_t>(end - begin);
        image_.seen_at[id] = begin + (end - begin) / 2;
    }

    /// Where a row of the whole image begins in this band.
    size_t lineOf(int32_t row) const { return (size_t(row) - image_.first_row) * image_.width; }

    /// Leaves of a span what lies inside of all sections. Along it the nearness is affine, and so is the side of a plane:
    /// what is cut off are ends.
    void cutSpan(const DepthPlane& plane, int32_t row, int32_t& begin, int32_t& end) const {
        for (const glm::dvec4& section : sections_) {
            const auto inside = [&](int32_t i) {
                const double nearness = plane.origin + plane.per_row * row + plane.per_sample * i;
                return glm::dot(section, glm::dvec4(i, row, nearness, 1.0)) >= 0.0;
            };
            while (begin < end && !inside(begin)) ++begin;
            while (begin < end && !inside(end - 1)) --end;
        }
    }

    void countFragment(size_t at) {
        if (image_.generated[at] != UINT16_MAX) ++image_.generated[at];
    }

    void writeSpan(const DepthPlane& plane, uint32_t id, int32_t row, int32_t begin, int32_t end) {
        const size_t line = lineOf(row);
        double* depth = image_.depth.data() + line;
        uint32_t* ids = image_.id.data() + line;
        const double start = plane.origin + plane.per_row * row;
        for (int32_t i = begin; i < end; ++i) {
            double nearness = start + plane.per_sample * i;
            nearness = nearness > plane.low ? nearness : plane.low;
            nearness = nearness < plane.high ? nearness : plane.high;
            const bool nearer = nearness > depth[i];
            depth[i] = nearer ? nearness : depth[i];
            ids[i] = nearer ? id : ids[i];
        }
        if (settings_.want_generated)
            for (int32_t i = begin; i < end; ++i) countFragment(line + i);
    }

    void showSpan(const DepthPlane& plane, uint32_t id, int32_t row, int32_t begin, int32_t end) {
        const size_t line = lineOf(row);
        const double start = plane.origin + plane.per_row * row;
        int32_t run = begin;
        for (int32_t i = begin; i <= end; ++i) {
            if (i < end) {
                const double nearness = std::clamp(start + plane.per_sample * i, plane.low, plane.high);
                if (nearness >= image_.depth[line + i]) continue;
            }
            if (i > run) noteSeen(id, line + run, line + i);
            run = i + 1;
        }
        if (settings_.want_generated)
            for (int32_t i = begin; i < end; ++i) countFragment(line + i);
    }

    const ZBufferSettings& settings_;
    ZBufferImage& image_;
    Projector projector_;
    std::vector<glm::dvec4> sections_;  ///< Projector::overSamples()
    std::vector<uint32_t> longest_;     ///< per id: its longest run so far
};

bool hasUnwritten(const DrawItem& item) {
    return std::find(item.writes_depth.begin(), item.writes_depth.end(), 0) != item.writes_depth.end();
}

/// As assign(), by code of this file alone, which is compiled without a sanitizer where the others are not.
template <class T>
void refill(std::vector<T>& values, size_t size, T with) {
    values.resize(size);
    std::fill(values.begin(), values.end(), with);
}

}  // namespace

ZBufferImage renderZBuffer(std::span<const DrawItem> items, const View& view, const ZBufferSettings& settings) {
    ZBufferImage image;
    renderZBuffer(items, view, settings, image);
    return image;
}

void renderZBuffer(std::span<const DrawItem> items, const View& view, const ZBufferSettings& settings,
                   ZBufferImage& image) {
    image.width = view.width * settings.samples;
    const uint32_t rows = view.height * settings.samples;
    image.first_row = std::min(settings.first_row, rows);
    image.height = std::min(settings.row_count, rows - image.first_row);
    const size_t samples = size_t(image.width) * image.height;
    refill(image.id, samples, ZBufferImage::kNone);
    refill(image.depth, samples, -std::numeric_limits<double>::infinity());
    refill(image.generated, settings.want_generated ? samples : 0, uint16_t{0});
    size_t ids = 0;
    for (const DrawItem& item : items) ids = std::max<size_t>(ids, size_t(item.id) + 1);
    image.seen.assign(ids, 0);
    image.seen_at.assign(ids, ZBufferImage::kNowhere);

    Renderer renderer(view, settings, image);
    for (const DrawItem& item : items) renderer.draw(item, true);
    renderer.noteOpaque();
    for (const DrawItem& item : items)
        if (hasUnwritten(item)) renderer.draw(item, false);
}

}  // namespace sightline::studies
