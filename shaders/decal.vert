#include "frame.glsl"
in vec2 corner;             // -1..1
in vec4 place_m;            // x, y, z centre, heading
in vec2 half_m;             // half sizes along and across the heading
in vec4 colour;             // sRGB, alpha
in float kind;

out vec2 local;
flat out vec4 paint;
flat out float mark;
flat out vec2 size_m;

void main() {
    float c = cos(place_m.w), s = sin(place_m.w);
    vec2 offset = corner * half_m;
    vec3 world_m = place_m.xyz + vec3(c * offset.x - s * offset.y, s * offset.x + c * offset.y, 0.0);
    local = corner;
    paint = colour;
    mark = kind;
    size_m = half_m;
    gl_Position = clip_from_world * vec4(world_m, 1.0);
    gl_Position.z -= 2e-5 * gl_Position.w;
}
