// The occlusion buffer by itself on scenes made for it: drawing, asking boxes, how tight and sound the answers are.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"

#include <algorithm>
#include <bit>

#include <fmt/core.h>

#include "bench/occlusion_frame.h"
#include "bench/occlusion_truth.h"
#include "bench/stopwatch.h"

namespace sightline::bench {
using namespace studies;
namespace {

struct Size {
    uint32_t width, height;
    size_t truths;  ///< views that are held against the truth: the larger the picture, the dearer
};
constexpr Size kSizes[] = {{1280, 720, ~size_t{0}}, {1920, 1080, 1}};
constexpr int kBaselineEvery = 8;  ///< rounds for one of the baseline, which is slow

/// Of one view, or sums over several.
struct Figures {
    double draw = 0, draw_all = 0, draw_plain = 0, draw_masked = 0;  ///< [microseconds]
    double flat = 0, grouped = 0, plain = 0, masked = 0;             ///< all boxes [microseconds]
    double triangles = 0, offered = 0, boxes = 0, resolved = 0, aside = 0;
    double kept = 0, kept_exactly = 0, kept_masked = 0;
    double truths = 0, kept_of_truths = 0, seen = 0, false_culls = 0, false_culls_exactly = 0;

    void add(const Figures& f) {
        for (auto member : {&Figures::draw,         &Figures::draw_all,    &Figures::draw_plain,
                            &Figures::draw_masked,  &Figures::masked,      &Figures::kept_masked,
                            &Figures::flat,         &Figures::grouped,     &Figures::plain,
                            &Figures::triangles,    &Figures::offered,     &Figures::boxes,
                            &Figures::resolved,     &Figures::aside,       &Figures::kept,
                            &Figures::kept_exactly, &Figures::truths,      &Figures::kept_of_truths,
                            &Figures::seen,         &Figures::false_culls, &Figures::false_culls_exactly})
            this->*member += f.*member;
    }
};

template <class Job>
void clockJob(std::vector<double>& times, Job job) {
    const double start = threadTime();
    job();
    times.push_back(threadTime() - start);
}

/// Seam pixels that are open until something asks for them.
double openSeams(const DepthTiles& tiles) {
    double count = 0;
    for (uint32_t tile = 0; tile < tiles.seams.size(); ++tile)
        count += std::popcount(tiles.seamBits(tile) & ~tiles.coveredBits(tile));
    return count;
}

class ViewMeasurement {
public:
    ViewMeasurement(const OcclusionScene& scene, OcclusionFrame& frame, const View& view, uint32_t occlusion_size)
        : scene_(scene), frame_(frame), view_(view) {
        frame.begin(view, occlusion_size);
        figures_.boxes = static_cast<double>(frame.boxes().size());
        figures_.triangles = static_cast<double>(frame.trianglesInView());
        flat_.resize(frame.boxes().size());
        grouped_.resize(frame.boxes().size());
        masked_.resize(frame.boxes().size());
        exact_.resize(frame.boxes().size());
    }

    /// Each round draws anew before it asks, so that seams are resolved in each of them.
    void time(int repeat) {
        std::vector<double> draw, draw_all, draw_plain, draw_masked, flat, grouped, plain, masked;
        for (int round = -1; round < repeat; ++round) {
            if (round == 0)
                for (auto* times : {&draw, &draw_all, &draw_masked, &flat, &grouped, &masked})
                    times->clear();  // the first was to warm up
            clockJob(draw_all, [&] { frame_.rasterize(tiles_, OcclusionFrame::SelfTest::kNo); });
            clockJob(draw, [&] { frame_.rasterize(tiles_); });
            clockJob(flat, [&] { frame_.testFlat(tiles_, flat_); });
            figures_.offered = static_cast<double>(frame_.rasterize(tiles_));
            figures_.aside = openSeams(tiles_);
            clockJob(grouped, [&] { frame_.testGrouped(tiles_, grouped_); });
            figures_.resolved = static_cast<double>(tiles_.seam_pixels);
            clockJob(draw_masked,
                     [&] { frame_.rasterize(tiles_, OcclusionFrame::SelfTest::kYes, OcclusionDetail::kMasked); });
            clockJob(masked, [&] { frame_.testGrouped(tiles_, masked_); });
            if (round < 0 || round % kBaselineEvery) continue;
            ZBufferImage image;
            clockJob(draw_plain, [&] { image = drawBatches(scene_, frame_.batches(), view_); });
            clockJob(plain, [&] { testPlainly(image); });
        }
        figures_.draw = medianOf(draw);
        figures_.draw_all = medianOf(draw_all);
        figures_.draw_plain = medianOf(draw_plain);
        figures_.draw_masked = medianOf(draw_masked);
        figures_.masked = medianOf(masked);
        figures_.flat = medianOf(flat);
        figures_.grouped = medianOf(grouped);
        figures_.plain = medianOf(plain);
        for (size_t i = 0; i < flat_.size(); ++i) {
            figures_.kept += !flat_[i];
            figures_.kept_exactly += !exact_[i];
            figures_.kept_masked += !masked_[i];
        }
    }

    /// Both ways of asking must agree with what can be seen.
    void judge() {
        const std::vector<uint8_t> seen = boxesInSight(scene_, frame_.batches(), frame_.boxes(), view_, {});
        figures_.truths = 1;
        for (size_t i = 0; i < seen.size(); ++i) {
            figures_.seen += seen[i];
            figures_.kept_of_truths += !flat_[i];
            figures_.false_culls += seen[i] && (flat_[i] || grouped_[i] || masked_[i]);
            figures_.false_culls_exactly += seen[i] && exact_[i];
        }
    }

    const Figures& figures() const { return figures_; }

private:
    void testPlainly(const ZBufferImage& image) {
        const std::vector<BoxAnswer> boxes = frame_.project();
        for (size_t i = 0; i < boxes.size(); ++i)
            exact_[i] = !boxes[i].doubt && (boxes[i].outside || isBehind(image, boxes[i].rect));
    }

    const OcclusionScene& scene_;
    OcclusionFrame& frame_;
    const View view_;
    DepthTiles tiles_;
    std::vector<uint8_t> flat_, grouped_, masked_, exact_;  ///< per box in view: hidden
    Figures figures_;
};

void addRows(const std::string& where, const Figures& sum, double views, Table& table) {
    const Rows add{table, where};
    const double per_box = 1e3 / std::max(sum.boxes, 1.0);
    add("rasterize", sum.draw / views * 1e-3, "ms", "scalar z-buffer in double", sum.draw_plain / views * 1e-3);
    add("rasterize", sum.draw / views * 1e-3, "ms", "without self-test", sum.draw_all / views * 1e-3);
    add("rasterize, masked", sum.draw_masked / views * 1e-3, "ms", "a depth per pixel", sum.draw / views * 1e-3);
    add("triangles rasterized", sum.offered / views, "triangles", "in the frustum", sum.triangles / views);
    add("triangles in the frustum a second", sum.triangles / sum.draw, "million/s", "scalar z-buffer in double",
        sum.triangles / sum.draw_plain);
    add("box test, flat", sum.flat * per_box, "ns", "every pixel of the z-buffer", sum.plain * per_box);
    add("box test, groups of 32", sum.grouped * per_box, "ns", "flat", sum.flat * per_box);
    add("box test, groups of 32, masked", sum.masked * per_box, "ns", "a depth per pixel", sum.grouped * per_box);
    add("boxes kept, masked", sum.kept_masked / views, "boxes", "same boxes, exact z-buffer", sum.kept_exactly / views);
    add("boxes kept", sum.kept / views, "boxes", "same boxes, exact z-buffer", sum.kept_exactly / views);
    add("boxes kept (over-estimate)", sum.kept_of_truths / sum.truths, "boxes", "seen by a 4x4 z-buffer",
        sum.seen / sum.truths);
    add("false culls against 4x4 samples", sum.false_culls / sum.truths, "boxes", "exact z-buffer at pixel centres",
        sum.false_culls_exactly / sum.truths);
    add("seam pixels resolved", sum.resolved / views, "pixels", "kept aside and open", sum.aside / views);
}

}  // namespace

void measureOcclusionCore(const Options& options, Table& table) {
    const int repeat = options.repeat ? options.repeat : 24;
    const std::vector<std::string> names = options.only.empty() ? occlusionSceneNames() : options.only;
    size_t done = 0;
    for (const std::string& name : names) {
        const OcclusionScene scene = makeOcclusionScene(name);
        OcclusionFrame frame(scene);
        for (const Size& size : kSizes) {
            Figures sum;
            for (size_t camera = 0; camera < scene.cameras.size(); ++camera) {
                const View asked = occlusionView(scene, camera, size.width, size.height);
                ViewMeasurement view(scene, frame, asked, options.occlusion_size ? options.occlusion_size : 8192);
                view.time(repeat);
                if (camera < size.truths) view.judge();
                sum.add(view.figures());
            }
            addRows(fmt::format("{} {}x{}", name, size.width, size.height), sum,
                    static_cast<double>(scene.cameras.size()), table);
            if (options.progress) options.progress(++done, names.size() * std::size(kSizes));
        }
    }
}

}  // namespace sightline::bench
