#include "frame.glsl"
uniform sampler2DShadow shadow_map;

// Places of a golden-angle spiral, each a bilinear comparison: a soft edge without visible steps.
#ifndef TAPS
#define TAPS 12
#endif
const vec2 SPIRAL[12] = vec2[](
    vec2(0.204, 0.000), vec2(-0.261, 0.239), vec2(0.040, -0.455), vec2(0.329, 0.428), vec2(-0.603, -0.107), vec2(0.571, -0.363),
    vec2(-0.190, 0.711), vec2(-0.369, -0.699), vec2(0.788, 0.288), vec2(-0.827, 0.327), vec2(0.392, -0.850), vec2(0.325, 0.924));

// 1 where the key light reaches, 0 in full shadow. The point is lifted along its normal so that no surface shades itself.
float key_light_at(vec3 world_m, vec3 normal, float softness_texels) {
    vec3 lifted = world_m + normal * shadow.y * (0.6 + 0.5 * softness_texels);
    vec3 place = (shadow_from_world * vec4(lifted, 1.0)).xyz;
    float reach = shadow.x * softness_texels, sum = 0.0;
    for (int i = 0; i < TAPS; ++i)
        sum += texture(shadow_map, vec3(place.xy + SPIRAL[i] * reach, place.z));
    return sum / float(TAPS);
}
