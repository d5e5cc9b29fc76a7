// Pictures of a frame: what the camera sees, and how many surfaces each pixel was drawn for.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sightline/studies/hidden/shade/light.h"
#include "sightline/studies/hidden/shade/unprojection.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/report/pictures/plan.h"
#include "sightline/tools/report/pictures/scene_look.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
using namespace studies;
namespace {

constexpr uint32_t kSamples = 2;  // per pixel and axis

}  // namespace

struct PictureMaker::Drawing {
    std::vector<Part> parts;  // by DrawItem::id
    ZBufferImage image;

    uint32_t objectAt(size_t sample) const {
        const uint32_t id = image.id[sample];
        return id == ZBufferImage::kNone ? id : parts[id].object;
    }
};

PictureMaker::PictureMaker(const Scene& scene) : scene_(scene) {
    size_t most = 0;
    for (const Mesh& mesh : scene.meshes) most = std::max(most, mesh.triangles());
    ones_.assign(most, 1);
    zeros_.assign(most, 0);
    for (const SceneObject& object : scene.objects)
        bounds_.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    world_ = coreOf(scene).bounds;
    diagonal_ = diagonalOf(world_);
}

PictureMaker::Drawing PictureMaker::render(const View& view, const std::vector<uint32_t>& objects,
                                           uint32_t samples) const {
    Drawing drawing;
    std::vector<DrawItem> items;
    for (const uint32_t index : objects) {
        const SceneObject& object = scene_.objects[index];
        const Mesh& mesh = scene_.meshes[object.mesh];
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const Primitive& primitive = mesh.primitives[p];
            const Material& material = scene_.materials[primitive.material];
            const bool solid = isSolid(material);
            DrawItem item;
            item.mesh.positions = mesh.positions;
            item.mesh.indices =
                std::span(mesh.indices)
                    .subspan(size_t{3} * primitive.first_triangle, size_t{3} * primitive.triangle_count);
            if (material.double_sided) item.double_sided = std::span(ones_).first(primitive.triangle_count);
            if (!solid) item.writes_depth = std::span(zeros_).first(primitive.triangle_count);
            item.transform = object.transform;
            item.id = static_cast<uint32_t>(drawing.parts.size());
            drawing.parts.push_back({index, p});
            items.push_back(item);
        }
    }
    ZBufferSettings settings;
    settings.samples = samples;
    drawing.image = renderZBuffer(items, view, settings);
    return drawing;
}

/// Flat shading: the normal comes from the depths of neighbouring samples of the same part.
/// @param draft  a pixel that one part fills is shaded at one sample of it: its creases are not smooth
void PictureMaker::shade(const View& view, const Drawing& drawing, bool draft, Frame& frame) const {
    const ZBufferImage& image = drawing.image;
    const uint32_t w = image.width, h = image.height;
    const Unprojection unprojection(view, w, h);
    const glm::dmat3 to_world = glm::transpose(glm::dmat3(view.view));
    const glm::dvec3 sun = defaultSun();
    const glm::dvec3 eye = eyePosition(view);
    // The air is clear up to the world: a model that is looked at from outside keeps its colours.
    const double clear = world_.empty() ? 0 : glm::length(glm::clamp(eye, world_.min, world_.max) - eye);
    std::vector<glm::dvec3> colours, hashed;
    for (const Part& part : drawing.parts) {
        const SceneObject& object = scene_.objects[part.object];
        colours.push_back(colourOf(scene_, object, scene_.meshes[object.mesh].primitives[part.primitive]));
        hashed.push_back(hashedColour(object.key));
    }

    const auto sample = [&](uint32_t x, uint32_t y) -> std::pair<glm::dvec3, glm::dvec3> {
        const size_t here = size_t{y} * w + x;
        const glm::dvec3 sky = skyColour(glm::normalize(to_world * unprojection.lineOfSight(x, y).direction).y);
        const uint32_t id = image.id[here];
        if (id == ZBufferImage::kNone) return {sky, sky};
        const auto neighbour = [&](uint32_t nx, uint32_t ny) {
            return nx < w && ny < h && image.id[size_t{ny} * w + nx] == id;
        };
        const glm::dvec3 point = unprojection.point(x, y, image.depth[here]);
        const auto slope = [&](uint32_t ax, uint32_t ay, uint32_t bx, uint32_t by) {
            if (neighbour(ax, ay)) return unprojection.point(ax, ay, image.depth[size_t{ay} * w + ax]) - point;
            if (neighbour(bx, by)) return point - unprojection.point(bx, by, image.depth[size_t{by} * w + bx]);
            return glm::dvec3(0.0);
        };
        const glm::dvec3 eye_normal = glm::cross(slope(x + 1, y, x - 1, y), slope(x, y + 1, x, y - 1));
        const double length = glm::length(eye_normal);
        const double light = length > 0 ? lightOn(to_world * (eye_normal / length), sun) : 0.7;
        const double distance = std::max(0.0, glm::length(point) - clear) / diagonal_;
        return {throughHaze(colours[id] * light, sky, distance), throughHaze(hashed[id] * light, sky, distance)};
    };

    frame.shaded = Image<Rgb>(w / kSamples, h / kSamples);
    frame.objects = frame.shaded;
    for (uint32_t y = 0; y < frame.shaded.height; ++y)
        for (uint32_t x = 0; x < frame.shaded.width; ++x) {
            glm::dvec3 sum(0.0), by_object(0.0);
            const auto placeOf = [&](uint32_t k) {
                return glm::uvec2(kSamples * x + k % kSamples, h - 1 - (kSamples * y + k / kSamples));
            };
            const auto idOf = [&](uint32_t k) { return image.id[size_t{placeOf(k).y} * w + placeOf(k).x]; };
            uint32_t samples = draft ? 1 : kSamples * kSamples;
            for (uint32_t k = 1; draft && k < kSamples * kSamples; ++k)
                if (idOf(k) != idOf(0)) samples = kSamples * kSamples;
            for (uint32_t k = 0; k < samples; ++k) {
                const auto [a, b] = sample(placeOf(k).x, placeOf(k).y);
                sum += a;
                by_object += b;
            }
            frame.shaded.at(x, y) = toBytes(sum / double(samples));
            frame.objects.at(x, y) = toBytes(by_object / double(samples));
        }
}

namespace {

Image<float> countFragments(const ZBufferImage& image) {
    Image<float> out(image.width / kSamples, image.height / kSamples);
    for (uint32_t y = 0; y < out.height * kSamples; ++y)
        for (uint32_t x = 0; x < out.width * kSamples; ++x)
            out.at(x / kSamples, out.height - 1 - y / kSamples) +=
                static_cast<float>(image.generated[size_t{y} * image.width + x]) / (kSamples * kSamples);
    return out;
}

}  // namespace

Image<glm::u8vec4> PictureMaker::ghosts(const View& view, const std::vector<uint32_t>& objects,
                                        std::span<const uint8_t> reasons) const {
    const Drawing drawn = render(view, objects, 1);
    const ZBufferImage& image = drawn.image;
    Image<glm::u8vec4> out(image.width, image.height, glm::u8vec4(0));
    const auto objectAt = [&](uint32_t x, uint32_t y) { return drawn.objectAt(size_t{y} * image.width + x); };
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const uint32_t object = objectAt(x, y);
            if (object == ZBufferImage::kNone) continue;
            const bool edge = (x > 0 && objectAt(x - 1, y) != object) || (y > 0 && objectAt(x, y - 1) != object) ||
                              (x + 1 < image.width && objectAt(x + 1, y) != object) ||
                              (y + 1 < image.height && objectAt(x, y + 1) != object);
            const uint32_t layers = std::min<uint32_t>(image.generated[size_t{y} * image.width + x], 6);
            glm::u8vec4 colour = kPlanPalette[std::min<int>(reasons[object], kPlanColours - 1)];
            colour.w = static_cast<uint8_t>(edge ? 235 : 36 + 22 * layers);
            out.at(x, image.height - 1 - y) = colour;
        }
    return out;
}

PictureMaker::Frame PictureMaker::draw(const View& view, std::span<const uint8_t> reasons) const {
    const glm::dmat4 clip = view.projection * view.view;
    std::vector<uint32_t> all, kept, culled;
    for (uint32_t i = 0; i < scene_.objects.size(); ++i) {
        if (bounds_[i].finite() && !mayBeInView(clip, bounds_[i])) continue;
        all.push_back(i);
        (reasons[i] == 0 ? kept : culled).push_back(i);
    }
    const Drawing drawn_all = render(view, all, kSamples);
    const Drawing drawn_kept = render(view, kept, kSamples);
    Frame frame;
    shade(view, drawn_all, false, frame);
    frame.culled = ghosts(view, culled, reasons);
    frame.all = countFragments(drawn_all.image);
    frame.kept = countFragments(drawn_kept.image);
    for (size_t i = 0; i < drawn_all.image.id.size() && frame.same; ++i)
        frame.same = drawn_all.objectAt(i) == drawn_kept.objectAt(i);
    return frame;
}

PictureMaker::Look PictureMaker::look(const View& view, const std::vector<uint32_t>& objects) const {
    const glm::dmat4 clip = view.projection * view.view;
    std::vector<uint32_t> in_view;
    for (const uint32_t i : objects)
        if (!bounds_[i].finite() || mayBeInView(clip, bounds_[i])) in_view.push_back(i);
    Drawing drawn = render(view, in_view, kSamples);
    Frame frame;
    shade(view, drawn, true, frame);
    Look look{std::move(frame.shaded), drawn.image.width, drawn.image.height, std::move(drawn.image.depth), {}};
    look.object.resize(drawn.image.id.size());
    for (size_t i = 0; i < look.object.size(); ++i) look.object[i] = drawn.objectAt(i);
    return look;
}

Rgb heatColour(double part) {
    // Black, violet, red, orange, pale yellow: lightness rises evenly, so that it reads without colour vision.
    static constexpr std::array<std::array<double, 3>, 7> kStops = {
        {{6, 6, 14}, {52, 16, 92}, {122, 28, 109}, {190, 55, 84}, {237, 105, 37}, {251, 180, 26}, {252, 252, 190}}};
    const double at = std::clamp(part, 0.0, 1.0) * (kStops.size() - 1);
    const size_t below = std::min(static_cast<size_t>(at), kStops.size() - 2);
    const double t = at - static_cast<double>(below);
    Rgb colour;
    for (int c = 0; c < 3; ++c)
        colour[c] = static_cast<uint8_t>(kStops[below][c] * (1 - t) + kStops[below + 1][c] * t + 0.5);
    return colour;
}

double heatScaleAbove(double value) {
    for (double scale = 8;; scale *= 10)
        for (const double factor : {1.0, 2.0, 5.0})
            if (!(factor * scale < value)) return factor * scale;
}

Image<float> reducedCounts(const Image<float>& counts, uint32_t step) {
    if (step <= 1) return counts;
    Image<float> out((counts.width + step - 1) / step, (counts.height + step - 1) / step);
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            float sum = 0;
            uint32_t of = 0;
            for (uint32_t v = y * step; v < std::min((y + 1) * step, counts.height); ++v)
                for (uint32_t u = x * step; u < std::min((x + 1) * step, counts.width); ++u, ++of)
                    sum += counts.at(u, v);
            out.at(x, y) = sum / static_cast<float>(of);
        }
    return out;
}

Image<Rgb> heatMap(const Image<float>& counts, double full) {
    constexpr double kColours = 63;  // few enough for a palette, too many to be told apart
    Image<Rgb> out(counts.width, counts.height);
    for (size_t i = 0; i < counts.pixels.size(); ++i) {
        const double part = std::min(std::sqrt(counts.pixels[i] / full), 1.0);
        out.pixels[i] = heatColour(std::round(part * kColours) / kColours);
    }
    return out;
}

}  // namespace sightline::tools
