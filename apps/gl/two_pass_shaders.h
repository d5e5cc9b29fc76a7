// The shaders of two-pass culling.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline {

/// Items and parts as all shaders see them. Places are relative to the eye: (high - eye's high) + (low - eye's low).
inline constexpr const char* kTwoPassCommon = R"(#version 450 core
struct Item {
    vec4 columns[3];  // of the transform; w: 0
    vec4 high, low;   // its translation, in two floats
};
layout(std430, binding = 0) readonly buffer Items { Item items[]; };
layout(location = 0) uniform mat4 to_clip;  // from places relative to the eye, reversed depth
layout(location = 4) uniform vec3 eye_high;
layout(location = 5) uniform vec3 eye_low;
vec3 offsetOf(Item item) {
    precise vec3 offset = (item.high.xyz - eye_high) + (item.low.xyz - eye_low);
    return offset;
}
)";

inline constexpr const char* kTwoPassVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in uint item;
flat out uint number;
void main() {
    Item at = items[item];
    vec3 place = mat3(at.columns[0].xyz, at.columns[1].xyz, at.columns[2].xyz) * position + offsetOf(at);
    gl_Position = to_clip * vec4(place, 1.0);
    number = item;
}
)";

inline constexpr const char* kTwoPassFragment = R"(#version 450 core
flat in uint number;
layout(location = 0) out uint shown;
void main() { shown = number; }
)";

/// Both passes over the parts. late: 0 or 1.
inline constexpr const char* kTwoPassCull = R"(
layout(local_size_x = 64) in;
struct Part {
    vec3 center;  // of its box in the item's own space
    uint item;
    vec4 half_size;
};
struct Command {
    uint count, instances, first, base_vertex, base_instance;
};
layout(std430, binding = 1) readonly buffer Parts { Part parts[]; };
layout(std430, binding = 2) buffer Commands { Command commands[]; };
layout(std430, binding = 3) buffer Seen { uint seen[]; };    // in the last frame
layout(std430, binding = 4) buffer Early { uint early[]; };  // drawn in this frame's early pass
layout(std430, binding = 5) buffer Late { uint late_drawn[]; };
layout(location = 6) uniform uint part_count;
layout(location = 7) uniform uint late;
layout(location = 8) uniform ivec2 size;
layout(binding = 0) uniform sampler2D depths;
layout(binding = 1) uniform sampler2D pyramid;

const float kPixels = 0.125;  // that rounding may move an edge in the image
const float kRounding = 1e-5; // of products and sums here, as a part of their terms

struct Bounds {
    vec3 center, half_size;
};

Bounds boundsOf(uint part) {
    Item at = items[parts[part].item];
    mat3 turn = mat3(at.columns[0].xyz, at.columns[1].xyz, at.columns[2].xyz);
    mat3 size = mat3(abs(turn[0]), abs(turn[1]), abs(turn[2]));
    vec3 offset = offsetOf(at), center = parts[part].center;
    Bounds box;
    box.center = turn * center + offset;
    box.half_size = size * parts[part].half_size.xyz + kRounding * (size * abs(center) + abs(offset)) * 0.1;
    return box;
}

bool touchesFrustum(Bounds box) {
    mat4 rows = transpose(to_clip);
    for (int plane = 0; plane < 6; ++plane) {
        vec4 row = plane < 4 ? rows[3] + (plane % 2 == 0 ? 1.0 : -1.0) * rows[plane / 2]
                             : (plane == 4 ? rows[3] - rows[2] : rows[2]);
        float reach = dot(abs(row.xyz), box.half_size);
        float terms = dot(abs(row.xyz), abs(box.center)) + abs(row.w);
        if (dot(row.xyz, box.center) + row.w < -reach - kRounding * (reach + terms)) return false;
    }
    return true;
}

/// Whether something of a box may be nearer than what is there, at some sample.
bool mayShow(Bounds box) {
    vec2 low = vec2(1e30), high = vec2(-1e30);
    float nearest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        vec3 side = vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1) * 2.0 - 1.0;
        vec4 clip = to_clip * vec4(box.center + side * box.half_size, 1.0);
        if (!(clip.w > 0.0) || clip.z > clip.w * (1.0 - 1e-4)) return true;  // it may reach the near plane
        vec2 place = (0.5 + 0.5 * clip.xy / clip.w) * vec2(size);
        low = min(low, place);
        high = max(high, place);
        nearest = max(nearest, clip.z / clip.w);
    }
    ivec2 first = clamp(ivec2(floor(clamp(low - kPixels, vec2(-1.0), vec2(size)))), ivec2(0), size - 1);
    ivec2 last = clamp(ivec2(floor(clamp(high + kPixels, vec2(-1.0), vec2(size)))), ivec2(0), size - 1);
    int level = 0;
    while (any(greaterThan((last >> level) - (first >> level), ivec2(1)))) ++level;
    float farthest = 1.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = ivec2(i % 2 == 0 ? first.x : last.x, i / 2 == 0 ? first.y : last.y) >> level;
        float depth = level == 0 ? texelFetch(depths, texel, 0).x : texelFetch(pyramid, texel, level - 1).x;
        farthest = min(farthest, depth);
    }
    bool parallel = to_clip[0].w == 0.0 && to_clip[1].w == 0.0 && to_clip[2].w == 0.0;
    return nearest * (1.0 + kRounding) + (parallel ? kRounding : 0.0) >= farthest;
}

void main() {
    uint part = gl_GlobalInvocationID.x;
    if (part >= part_count) return;
    Bounds box = boundsOf(part);
    bool touches = touchesFrustum(box);
    if (late == 0) {
        bool drawn = touches && seen[part] != 0;
        early[part] = uint(drawn);
        commands[part].instances = uint(drawn);
        return;
    }
    bool shows = touches && mayShow(box);
    seen[part] = uint(shows);
    bool drawn = shows && early[part] == 0;
    late_drawn[part] = uint(drawn);
    commands[part].instances = uint(drawn);
}
)";

/// A level of the pyramid from the one before, or from the depths. What lies beyond the image hides nothing less.
inline constexpr const char* kTwoPassReduce = R"(#version 450 core
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D from;
layout(binding = 0, r32f) writeonly uniform image2D to;
layout(location = 0) uniform int level;  // of `from`
layout(location = 1) uniform ivec2 size; // of `from`
void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(to)))) return;
    float farthest = 1.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = 2 * texel + ivec2(i % 2, i / 2);
        if (all(lessThan(at, size))) farthest = min(farthest, texelFetch(from, at, level).x);
    }
    imageStore(to, texel, vec4(farthest));
}
)";

}  // namespace sightline
