// A z-buffer that clips nothing: triangles are scanned by their edges in homogeneous space.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/clipless.h"

#include <limits>

#include "sightline/hidden/fill.h"
#include "sightline/hidden/homogeneous.h"

namespace sightline {
namespace {

class Drawing {
public:
    explicit Drawing(HiddenImage& image)
        : image_(image), nearest_(image.surface.size(), -std::numeric_limits<double>::infinity()) {}

    void drawSpan(const HomogeneousTriangle& triangle, int32_t row, int32_t begin, int32_t end) {
        HiddenCounters& counters = image_.counters;
        const uint64_t count = static_cast<uint64_t>(end - begin);
        counters.generated += count;
        counters.tested += count;
        countSpan(image_, image_.generated, row, begin, end);
        countSpan(image_, image_.tested, row, begin, end);
        for (int32_t i = begin; i < end; ++i) {
            const double nearness = triangle.depth.at(row, i);
            double& nearest = nearest_[static_cast<size_t>(row) * image_.width + static_cast<size_t>(i)];
            if (!(nearness > nearest)) continue;
            nearest = nearness;
            image_.at(row, i) = triangle.surface;
            ++counters.passed;
            ++counters.shaded;
            countSpan(image_, image_.passed, row, i, i + 1);
            countSpan(image_, image_.shaded, row, i, i + 1);
        }
    }

private:
    HiddenImage& image_;
    std::vector<double> nearest_;
};

}  // namespace

void drawClipless(const HiddenInput& input, HiddenImage& image) {
    Projector projector = input.projector();
    Drawing drawing(image);
    const int32_t width = static_cast<int32_t>(image.width), height = static_cast<int32_t>(image.height);
    HomogeneousTriangle triangle;
    for (size_t i = 0; i < input.list.items().size(); ++i) {
        const DrawItem& item = input.list.items()[i];
        projector.begin(item);
        for (size_t t = 0; t < item.mesh.triangles(); ++t) {
            if (!item.writes_depth.empty() && item.writes_depth[t] == 0) continue;
            if (!projector.projectHomogeneous(t, triangle)) continue;
            triangle.surface = input.list.firstSurface(i) + static_cast<uint32_t>(t);
            scanHomogeneous(triangle, 0, height, width, [&](int32_t row, int32_t begin, int32_t end) {
                drawing.drawSpan(triangle, row, begin, end);
            });
        }
    }
    image.counters.geometry = projector.counters();
}

}  // namespace sightline
