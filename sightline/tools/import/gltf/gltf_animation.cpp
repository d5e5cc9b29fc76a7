// How far animations move joints and morph weights: ranges that hold at every time.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_deform.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sightline/tools/import/gltf/gltf_accessor.h"
#include "sightline/tools/import/gltf/gltf_features.h"

namespace sightline::tools::gltf {
namespace {

/// What an animation drives.
struct Channel {
    bool of_mesh = false;  ///< of all nodes that draw it
    uint32_t index = 0;    ///< node, or mesh
    std::string path;
};

/// `/nodes/5/translation` or `/meshes/2/weights`; none if the pointer aims elsewhere.
std::optional<Channel> readPointer(const std::string& pointer, size_t meshes, size_t nodes, const std::string& place) {
    const bool of_mesh = pointer.starts_with("/meshes/");
    const std::string_view head = of_mesh ? "/meshes/" : "/nodes/";
    if (!pointer.starts_with(head)) return std::nullopt;
    const size_t slash = pointer.find('/', head.size());
    const std::string digits = pointer.substr(head.size(), slash - head.size());
    if (slash == std::string::npos || digits.empty() || digits.size() > 9 ||
        digits.find_first_not_of("0123456789") != std::string::npos)
        fail(place, "pointer '{}' is not understood", printable(pointer));
    const size_t index = std::strtoul(digits.c_str(), nullptr, 10), count = of_mesh ? meshes : nodes;
    if (index >= count)
        fail(place, "pointer '{}' out of range: {} of {} {}", printable(pointer), index, count,
             of_mesh ? "meshes" : "nodes");
    return Channel{of_mesh, static_cast<uint32_t>(index), pointer.substr(slash + 1)};
}

std::optional<Channel> readChannel(const Json& json, size_t meshes, size_t nodes, const std::string& place) {
    const Json* target = findObject(json, "target", place);
    if (!target) fail(place, "target is missing");
    const std::string path = text(*target, "path", place);
    if (path == "pointer") {
        const Json* pointer = extension(*target, "KHR_animation_pointer", place);
        return pointer ? readPointer(text(*pointer, "pointer", place), meshes, nodes, place) : std::nullopt;
    }
    const std::optional<uint32_t> node = index(*target, "node", nodes, place);
    if (!node) return std::nullopt;
    return Channel{false, *node, path};
}

// Keys of `width` numbers each, and how far the curve next to them may leave what they span. Both ends of
// a stretch carry its excess, so that whichever is the extreme counts it.
struct Keys {
    size_t width = 0;
    std::vector<float> values;   // [size: width * keys]
    std::vector<double> excess;  // [size: width * keys], zeros unless the curve is a cubic spline

    size_t count() const { return width == 0 ? 0 : values.size() / width; }
};

// Splits (in-tangent, value, out-tangent) triplets. Of the Hermite basis, the two that weigh the values
// are a convex combination of them; each of the two that weigh the tangents stays within 4/27.
Keys splitSpline(Document& document, const std::vector<float>& triplets, size_t width, uint32_t input,
                 const std::string& place) {
    const std::vector<float> times = decodeFloats(document, input, 1, "time");
    const size_t keys = times.size();
    if (triplets.size() != keys * width * 3)
        fail(place, "spline has {} numbers for {} keys of {}", triplets.size(), keys, width);
    Keys out{width, std::vector<float>(keys * width), std::vector<double>(keys * width, 0.0)};
    const auto tangent = [&](size_t key, size_t part, size_t i) {
        return std::abs(static_cast<double>(triplets[(key * 3 + part) * width + i]));
    };
    for (size_t key = 0; key < keys; ++key)
        for (size_t i = 0; i < width; ++i) {
            out.values[key * width + i] = triplets[(key * 3 + 1) * width + i];
            if (key + 1 == keys) continue;
            const double duration = std::abs(double(times[key + 1]) - double(times[key]));
            const double excess = 4.0 / 27.0 * duration * (tangent(key, 2, i) + tangent(key + 1, 0, i));
            out.excess[key * width + i] = std::max(out.excess[key * width + i], excess);
            out.excess[(key + 1) * width + i] = excess;
        }
    return out;
}

Keys readKeys(Document& document, const Json& samplers, const Json& channel, size_t width, uint32_t components,
              const std::string& animation, const std::string& place) {
    const uint32_t sampler = requiredIndex(channel, "sampler", samplers.size(), place);
    const std::string sampler_place = animation + at(".samplers", sampler);
    const Json& json = objectAt(samplers, sampler, sampler_place);
    const uint32_t input = requiredIndex(json, "input", document.accessors.size(), sampler_place);
    const uint32_t output = requiredIndex(json, "output", document.accessors.size(), sampler_place);
    std::vector<float> values = decodeFloats(document, output, components, "animation output");
    if (width == 0) return {};
    const Json* interpolation = find(json, "interpolation");
    if (interpolation && !interpolation->is_string())
        document.notes.push_back(sampler_place + ": interpolation is no text, and counts as LINEAR");
    else if (interpolation && *interpolation == "CUBICSPLINE")
        return splitSpline(document, values, width, input, sampler_place);
    if (values.size() % width != 0) fail(sampler_place, "{} numbers are no keys of {}", values.size(), width);
    const size_t count = values.size();
    return {width, std::move(values), std::vector<double>(count, 0.0)};
}

void growTranslation(const Keys& keys, Motion& motion) {
    for (size_t key = 0; key < keys.count(); ++key) {
        glm::dvec3 value, excess;
        for (int axis = 0; axis < 3; ++axis) {
            value[axis] = keys.values[key * 3 + axis];
            excess[axis] = keys.excess[key * 3 + axis];
        }
        motion.translation.grow(value - excess);
        motion.translation.grow(value + excess);
    }
}

void growWeights(Document& document, const Keys& keys, size_t targets, Motion& motion, const std::string& place) {
    if (targets == 0 || keys.width == 0) return;
    if (motion.weights.empty()) document.budget.charge(targets, sizeof(Range), place);
    motion.weights.resize(targets);
    for (size_t i = 0; i < keys.values.size(); ++i) {
        motion.weights[i % keys.width].grow(keys.values[i] - keys.excess[i]);
        motion.weights[i % keys.width].grow(keys.values[i] + keys.excess[i]);
    }
}

void applyChannel(Document& document, const Json& samplers, const Json& json, const Channel& channel, size_t targets,
                  Motion& motion, const std::string& animation, const std::string& place) {
    const auto keys = [&](size_t width, uint32_t components) {
        return readKeys(document, samplers, json, width, components, animation, place);
    };
    if (channel.path == "rotation") {
        motion.animated = true;
    } else if (channel.path == "translation") {
        motion.animated = true;
        growTranslation(keys(3, 3), motion);
    } else if (channel.path == "scale") {
        motion.animated = true;
        const Keys scales = keys(3, 3);
        for (size_t i = 0; i < scales.values.size(); ++i)
            motion.scale = std::max(motion.scale, std::abs(double(scales.values[i])) + scales.excess[i]);
    } else if (channel.path == "weights") {
        growWeights(document, keys(targets, 1), targets, motion, place);
    } else if (channel.path.starts_with("weights/") && targets != 0) {
        const std::string digits = channel.path.substr(8);
        const size_t target = digits.empty() || digits.size() > 9 ? targets : std::strtoul(digits.c_str(), nullptr, 10);
        if (target >= targets) fail(place, "weight '{}' out of range: {} targets", printable(digits), targets);
        Range range;
        const Keys one = keys(1, 1);
        for (size_t i = 0; i < one.values.size(); ++i) {
            range.grow(one.values[i] - one.excess[i]);
            range.grow(one.values[i] + one.excess[i]);
        }
        if (motion.weights.empty()) document.budget.charge(targets, sizeof(Range), place);
        motion.weights.resize(targets);
        motion.weights[target].grow(range.low);
        motion.weights[target].grow(range.high);
    }
}

/// The nodes that pointers in a value aim at, whatever for: `/nodes/5/translation`. One without a number may aim at any.
void markPointers(const Json& value, NodeChanges& out) {
    if (value.is_structured())
        for (const Json& inner : value) markPointers(inner, out);
    if (!value.is_string()) return;
    const std::string& pointer = value.get_ref<const std::string&>();
    if (!pointer.starts_with("/nodes/")) return;
    const size_t digits = std::min(pointer.find_first_not_of("0123456789", 7), pointer.size()) - 7;
    const size_t node = digits > 0 && digits < 10 ? std::strtoul(pointer.c_str() + 7, nullptr, 10) : ~size_t{0};
    if (digits == 0) std::fill(out.moved.begin(), out.moved.end(), true);
    if (digits == 0) std::fill(out.shown.begin(), out.shown.end(), true);
    if (node < out.moved.size()) out.moved[node] = out.shown[node] = true;
}

/// Marks what a channel moves, shows or hides; nothing where it is not as the format asks, for nothing of it is read then.
void markChannel(const Json& channel, const std::string& place, NodeChanges& out) {
    try {
        const std::optional<Channel> read = readChannel(channel, 0, out.moved.size(), place);
        if (!read || read->of_mesh || read->path.starts_with("weights")) return;
        out.moved[read->index] = true;
        if (read->path.starts_with("extensions/")) out.shown[read->index] = true;
    } catch (const Fault&) {}
}

}  // namespace

NodeChanges nodeChanges(Document& document, size_t nodes) {
    NodeChanges out{std::vector<bool>(nodes, false), std::vector<bool>(nodes, false)};
    const JsonTable animations = document.json.table("animations");
    for (size_t a = 0; a < animations.size(); ++a) {
        const std::string animation = at("animations", a);
        const Json json = animations.object(a, animation);
        const Json& channels = table(json, "channels", animation);
        for (size_t c = 0; c < channels.size(); ++c) {
            const std::string place = animation + at(".channels", c);
            markChannel(objectAt(channels, c, place), place, out);
        }
    }
    const Json file = document.json.members({"extensions"});
    effectOfExtensions(file, document.unknown);
    if (const Json* extensions = findObject(file, "extensions", "")) markPointers(*extensions, out);
    return out;
}

std::vector<Motion> readMotions(Document& document, const NodeTree& tree, const std::vector<size_t>& targets) {
    std::vector<Motion> motions(tree.nodes.size());
    for (size_t i = 0; i < motions.size(); ++i) {
        motions[i].translation.grow(tree.nodes[i].translation);
        motions[i].scale = tree.nodes[i].scale;
    }
    const JsonTable animations = document.json.table("animations");
    for (size_t a = 0; a < animations.size(); ++a) {
        const std::string animation = at("animations", a);
        const Json json = animations.object(a, animation);
        const Json& samplers = table(json, "samplers", animation);
        const Json& channels = table(json, "channels", animation);
        for (size_t c = 0; c < channels.size(); ++c) {
            const std::string place = animation + at(".channels", c);
            const std::optional<Channel> channel =
                readChannel(objectAt(channels, c, place), targets.size(), tree.nodes.size(), place);
            if (!channel) continue;
            const auto apply = [&](size_t node) {
                const std::optional<uint32_t> mesh = tree.nodes[node].mesh;
                applyChannel(document, samplers, channels[c], *channel, mesh ? targets[*mesh] : 0, motions[node],
                             animation, place);
            };
            if (!channel->of_mesh) apply(channel->index);
            for (size_t node = 0; channel->of_mesh && node < tree.nodes.size(); ++node)
                if (tree.nodes[node].mesh == channel->index) apply(node);
        }
    }
    return motions;
}

}  // namespace sightline::tools::gltf
