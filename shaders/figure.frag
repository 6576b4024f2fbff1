#define TAPS 6     // a body's own shadows are small and curved: fewer places do
#include "frame.glsl"
#include "tone.glsl"
#include "light.glsl"
#include "shadow.glsl"
in vec3 world_m;
in vec3 world_normal;
in vec3 paint;
in float ambient;
flat in vec4 skin;
out vec4 pixel;

// 1 where a painted part covers the pixel: its outline is drawn between vertices, as sharp as the pixels are.
float cover(float distance_m) {
    return 1.0 - smoothstep(-0.7, 0.7, distance_m / max(fwidth(distance_m), 1e-5));
}

// `gloss` of the glass before the eyes is 1, else low.
vec3 painted(vec3 colour, out float gloss) {
    float grey = dot(colour, vec3(0.30, 0.59, 0.11));
    vec3 dark = mix(vec3(0.042, 0.047, 0.058), colour * 0.30, clamp(0.10 + 1.1 * (max(colour.r, max(colour.g, colour.b)) - grey), 0.0, 0.85));
    float glass = cover(paint.y);
    vec3 seen = mix(colour, mix(dark, colour, 0.18), cover(paint.z));
    seen = mix(seen, dark, cover(paint.x));
    gloss = mix(0.12, 1.0, glass);
    return mix(seen, vec3(0.012, 0.014, 0.018), glass);
}

void main() {
    vec3 normal = normalize(world_normal);
    vec3 to_eye = normalize(eye_m.xyz - world_m);
    float gloss;
    vec3 albedo = painted(skin.rgb, gloss);
#ifdef GHOST
    // light only models a ghost: no shadow falls on it, its outline is denser than its middle
    float edge = 1.0 - abs(dot(normal, to_eye));
    vec3 light = lit_surface(mix(skin.rgb, albedo, 0.55), normal, to_eye, to_light.xyz, 0.85, 0.0, ambient);
    pixel = vec4(displayed(light), clamp(skin.a * (0.92 + 0.9 * edge * edge), 0.0, 1.0));
#else
    float shadow = key_light_at(world_m, normal, 1.9);
    vec3 light = lit_surface(albedo, normal, to_eye, to_light.xyz, shadow, gloss, ambient);
    // the floor takes light away from what stands close over it
    float near_floor = 1.0 - 0.35 * exp(-max(world_m.z, 0.0) * 14.0) * clamp(0.6 - 0.6 * normal.z, 0.0, 1.0);
    pixel = vec4(displayed(light * near_floor), 1.0);
#endif
}
