// The page of `render --report`: the run's JSON, and every method's pictures.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/render_page.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "sightline/tools/report/page/page.h"
#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
using namespace studies;
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kPictureSide = 800;  // [pixels]

std::string pictureJson(const Image<Rgb>& image) { return dataUri(encodePng(reduced(image, kPictureSide))); }

/// The largest value that heat maps of all methods share.
double commonScale(const RenderRun& run) {
    double scale = 8;
    for (const MethodResult& result : run.methods) scale = std::max(scale, heatScale(countsOf(result.image, run.heat)));
    return scale;
}

std::string heatJson(const HiddenImage& image, const std::vector<uint16_t>& counts, double scale) {
    return pictureJson(heatMap(countPicture(image, counts), scale));
}

/// What is drawn of each method; `picture` is missing where it is the one before it, `wrong` where nothing is.
Json methodsJson(const RenderList& scene, const View& view, const RenderRun& run, const PictureSettings& settings,
                 const TakePicture& take) {
    const double scale = commonScale(run);
    const HiddenImage reference = plainZBuffer(scene.list(), view, run.settings.projector);
    const Image<Rgb> truth = shadedPicture(scene, view, reference, settings);
    const HiddenImage* drawn = nullptr;
    Image<Rgb> picture;
    Json out = Json::array();
    for (const MethodResult& result : run.methods) {
        Json entry = {{"exact", isExact(run, result)}, {"why", whyInexact(run, result)}};
        if (!drawn || drawn->surface != result.image.surface) {
            picture = shadedPicture(scene, view, result.image, settings);
            entry["picture"] = pictureJson(picture);
        }
        drawn = &result.image;
        if (take) take(result, picture);
        const std::vector<uint16_t>& counts = countsOf(result.image, run.heat);
        if (!counts.empty()) entry["heat"] = heatJson(result.image, counts, scale);
        if (!result.agreement.agrees()) entry["wrong"] = pictureJson(differencePicture(truth, reference, result.image));
        out.push_back(std::move(entry));
    }
    return out;
}

/// Depth complexity is a fact of the scene: the painter generates every fragment, hidden or not.
Json depthJson(const RenderRun& run) {
    const MethodResult* result = run.find(HiddenMethod::kPainter);
    if (!result) result = run.methods.empty() ? nullptr : &run.methods.front();
    if (!result || result->image.generated.empty()) return nullptr;
    const double scale = heatScale(result->image.generated);
    return {{"method", result->name()},
            {"scale", scale},
            {"heat", heatJson(result->image, result->image.generated, scale)}};
}

/// What the hierarchy spared the z-buffer: fragments found and fragments tested, on one scale.
Json hierarchyJson(const RenderRun& run) {
    const MethodResult* result = run.find(HiddenMethod::kZBuffer);
    if (!result || result->image.tested.empty()) return nullptr;
    const HiddenCounters& did = result->image.counters;
    if (did.hierarchy_rejected_polygons + did.hierarchy_rejected_tiles + did.hierarchy_accepted_tiles == 0)
        return nullptr;
    const double scale = heatScale(result->image.generated);
    return {{"scale", scale},
            {"generated", heatJson(result->image, result->image.generated, scale)},
            {"tested", heatJson(result->image, result->image.tested, scale)}};
}

/// Where the z-buffer's format cannot tell surfaces apart.
Json fightsJson(const RenderList& scene, const View& view, const RenderRun& run, const PictureSettings& settings) {
    if (run.fights.empty() || run.fight_map.fights.empty()) return nullptr;
    const Image<Rgb> picture =
        shadedPicture(scene, view, plainZBuffer(scene.list(), view, run.settings.projector), settings);
    return pictureJson(fightPicture(picture, run.fight_map));
}

}  // namespace

std::string renderPage(const RenderList& scene, const View& view, const RenderRun& run, const PictureSettings& settings,
                       const TakePicture& take) {
    Json page;
    page["page"] = "render";
    page["command"] = run.command;
    page["frames"] = run.frames;
    page["linked"] = static_cast<bool>(take);
    page["scale"] = commonScale(run);
    for (const CounterName& counter : counterNames()) page["titles"][std::string(counter.name)] = counter.title;
    page["methods"] = methodsJson(scene, view, run, settings, take);
    page["depth"] = depthJson(run);
    page["hierarchy"] = hierarchyJson(run);
    page["fights"] = fightsJson(scene, view, run, settings);
    std::string text = jsonText(page);
    text.pop_back();
    return pageWith(text + ",\"run\":" + renderJson(run) + "}");
}

}  // namespace sightline::tools
