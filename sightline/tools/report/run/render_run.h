// What hidden-surface methods made of one frame, beside one another, as plain data, and its JSON form.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sightline/studies/hidden/compare.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/shade/shade.h"
#include "sightline/studies/hidden/zbuffer/z_fighting.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::tools {
using namespace studies;

/// The counts that HiddenImage keeps for each sample.
enum class Heat : uint8_t { kGenerated, kTested, kPassed, kShaded };
inline constexpr int kHeats = 4;
inline constexpr std::string_view kHeatNames[kHeats] = {"generated", "tested", "passed", "shaded"};
const std::vector<uint16_t>& countsOf(const HiddenImage& image, Heat heat);

/// How often samples have how many fragments.
struct CountStatistics {
    static constexpr size_t kMostBars = 33;

    double mean = 0;
    uint32_t maximum = 0;
    std::vector<uint64_t> histogram;  ///< samples by count; the last of kMostBars holds all larger counts as well
};
CountStatistics statisticsOf(std::span<const uint16_t> counts);

/// A counter as JSON, tables and readers call it.
struct CounterName {
    std::string_view name;   ///< of its field
    std::string_view title;  ///< for a reader
    uint64_t (*value)(const HiddenCounters&);
};
std::span<const CounterName> counterNames();

/// The nearest surface at each sample by a z-buffer in double, which all methods are compared with: one thread, no
/// tiles, no formats. HiddenCounters::geometry is filled.
HiddenImage plainZBuffer(const DrawList& list, const View& view, const ProjectorSettings& settings);

struct MethodResult {
    HiddenMethod method = HiddenMethod::kZBuffer;
    HiddenImage image;                ///< its counters are those of the timed runs, but for bytes of depth
    HiddenCounters counted;           ///< of the run that filled the counts of samples; zero without
    double milliseconds = 0;          ///< median over the repeats
    double prepare_milliseconds = 0;  ///< what could be kept from frame to frame; not in the above
    Agreement agreement;              ///< with plainZBuffer()'s image
    AgreementBands bands;             ///< that it was judged by

    std::string_view name() const { return kHiddenMethodNames[static_cast<int>(method)]; }
};

struct LeftOut {
    HiddenMethod method = HiddenMethod::kZBuffer;
    std::string why;
};

/// Samples whose two nearest surfaces a depth format cannot tell apart.
struct FormatFights {
    DepthFormat format = DepthFormat::kReversedFloat;
    uint64_t overlaid = 0;  ///< samples with two surfaces or more
    uint64_t fighting = 0;  ///< of them: the two lie apart, and have the same depth
    uint64_t coplanar = 0;  ///< of them: the two lie at the same place
};

struct RenderRun {
    std::string scene;                                    ///< as it was named by the user
    std::string command;                                  ///< that repeats this run
    uint64_t objects = 0, triangles = 0;                  ///< of the scene
    uint64_t objects_in_view = 0, triangles_in_view = 0;  ///< that methods were given
    uint64_t polygons_in_view = 0;                        ///< what is left of them to draw
    uint32_t width = 0, height = 0;
    uint32_t frame = 0, frames = 0;
    CameraFrame camera;
    int repeat = 1;
    RenderSettings settings;
    Shading shading = Shading::kFlat;
    bool shadows = true;
    Heat heat = Heat::kGenerated;
    std::vector<MethodResult> methods;
    std::vector<LeftOut> left_out;
    std::vector<FormatFights> fights;  ///< of all formats, or empty
    ZFightingMap fight_map;            ///< of the settings' format, if there are `fights`

    const MethodResult* find(HiddenMethod method) const;
};

/// Why the z-buffer's samples that are wrong are so by what was asked for, and no failure of the method: a coarse depth
/// format, or another comparison than for what is nearer. Empty if that is no reason, or nothing is wrong.
std::string whyInexact(const RenderRun& run, const MethodResult& result);

/// False for the painter's algorithm, and for a z-buffer that is wrong with a reason.
bool isExact(const RenderRun& run, const MethodResult& result);

/// Why a method is not practical for what is in view; empty if it is. Newell's comparisons may grow with the square of
/// the polygons, and a BSP tree takes some kilobytes a triangle, whether it is seen or not.
std::string whyImpractical(const RenderRun& run, HiddenMethod method);

/// A counter of fragments, of which there are counts of samples.
uint64_t fragmentsOf(const HiddenCounters& counters, Heat heat);

/// Draws with one method: `repeat` times for the time, and once more where counts are wanted. In that run the z-buffer
/// looks at the fragments that its hierarchy rejects unseen, and counts them as generated.
MethodResult drawMethod(const RenderList& scene, const View& view, RenderSettings settings, HiddenMethod method,
                        int repeat);

/// Fills MethodResult::agreement.
/// @param reference  plainZBuffer()'s image
void judge(const RenderList& scene, const View& view, const HiddenImage& reference, const RenderSettings& settings,
           MethodResult& result);

/// Fills RenderRun::fights and fight_map.
void findFights(const RenderList& scene, const View& view, const ShareWork& share, RenderRun& run);

/// The schema `sightline.render/1`. Names that are not UTF-8 are mended.
std::string renderJson(const RenderRun& run);

}  // namespace sightline::tools
