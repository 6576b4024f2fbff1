#define TAPS 6     // a body's own shadows are small and curved: fewer places do
#include "frame.glsl"
#include "tone.glsl"
#include "light.glsl"
#include "shadow.glsl"
in vec3 world_m;
in vec3 world_normal;
flat in vec4 paint;
flat in float material;
out vec4 pixel;

// Materials of mannequin.py: 0 shell, 1 joints, 2 visor, 3 shoes.
vec3 albedo_of(float material, vec3 colour) {
    float grey = dot(colour, vec3(0.30, 0.59, 0.11));
    vec3 dark = mix(vec3(0.042, 0.047, 0.058), colour * 0.30, clamp(0.10 + 1.1 * (max(colour.r, max(colour.g, colour.b)) - grey), 0.0, 0.85));
    if (material < 0.5) return colour;
    if (material < 1.5) return dark;
    if (material < 2.5) return vec3(0.012, 0.014, 0.018);
    return mix(dark, colour, 0.18);
}

void main() {
    vec3 normal = normalize(world_normal);
    vec3 to_eye = normalize(eye_m.xyz - world_m);
#ifdef GHOST
    // light only models a ghost: no shadow falls on it, its outline is denser than its middle
    float edge = 1.0 - abs(dot(normal, to_eye));
    vec3 albedo = mix(paint.rgb, albedo_of(material, paint.rgb), 0.55);
    vec3 light = lit_surface(albedo, normal, to_eye, to_light.xyz, 0.85, 0.0);
    pixel = vec4(displayed(light), clamp(paint.a * (0.92 + 0.9 * edge * edge), 0.0, 1.0));
#else
    float shadow = key_light_at(world_m, normal, 1.9);
    float gloss = material > 1.5 && material < 2.5 ? 1.0 : 0.12;
    vec3 light = lit_surface(albedo_of(material, paint.rgb), normal, to_eye, to_light.xyz, shadow, gloss);
    // the floor takes light away from what stands close over it
    float near_floor = 1.0 - 0.35 * exp(-max(world_m.z, 0.0) * 14.0) * clamp(0.6 - 0.6 * normal.z, 0.0, 1.0);
    pixel = vec4(displayed(light * near_floor), 1.0);
#endif
}
