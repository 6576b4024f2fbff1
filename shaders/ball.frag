#ifdef SHADOW
void main() {}
#else
#include "frame.glsl"
#include "tone.glsl"
#include "light.glsl"
#include "shadow.glsl"
in vec3 world_m;
in vec3 world_normal;
in vec3 local;
flat in vec2 paint;
out vec4 pixel;

const vec3 WHITE = vec3(0.80, 0.79, 0.76), YELLOW = vec3(0.86, 0.56, 0.03), BLUE = vec3(0.025, 0.10, 0.40);

// Eighteen panels: each face of a cube blown up to a sphere carries three strips, those of neighbouring faces at right angles.
// Returns the colour; `seam` falls to 0 in the grooves between panels.
vec3 volleyball(vec3 p, out float seam) {
    vec3 a = abs(p);
    vec2 face;       // x across the strips, y along them, each -1..1 in equal angles
    float which;
    if (a.x >= a.y && a.x >= a.z) { face = vec2(p.y, p.z) / a.x; which = 0.0; }
    else if (a.y >= a.z) { face = vec2(p.z, p.x) / a.y; which = 1.0; }
    else { face = vec2(p.x, p.y) / a.z; which = 2.0; }
    face = atan(face) * (4.0 / 3.14159265);
    float strip = floor((face.x + 1.0) * 1.5);
    float to_strip_edge = abs(fract((face.x + 1.0) * 1.5 + 0.5) - 0.5) / 1.5;
    float to_face_edge = min(1.0 - abs(face.x), 1.0 - abs(face.y));
    float distance = min(to_strip_edge, to_face_edge);
    float blur = max(fwidth(local.x) + fwidth(local.y) + fwidth(local.z), 1e-4) * 0.9;
    seam = smoothstep(0.012 - 0.5 * blur, 0.030 + blur, distance);
    if (strip > 0.5 && strip < 1.5) return which < 0.5 ? BLUE : which < 1.5 ? YELLOW : WHITE;
    return which < 0.5 ? YELLOW : which < 1.5 ? WHITE : BLUE;
}

void main() {
    vec3 normal = normalize(world_normal), to_eye = normalize(eye_m.xyz - world_m), p = normalize(local);
    float seam = 1.0;
    vec3 albedo;
    if (paint.x < 0.5) albedo = volleyball(p, seam);
    else albedo = mix(vec3(0.55, 0.10, 0.07), vec3(0.80, 0.74, 0.66), smoothstep(-1.0, 1.0, (abs(p.z) - 0.32) / max(fwidth(p.z), 1e-4)));
    float shadow = paint.y < 0.999 ? 1.0 : key_light_at(world_m, normal, 1.6);
    vec3 light = lit_surface(albedo * mix(0.22, 1.0, seam), normal, to_eye, to_light.xyz, shadow, 0.25, 1.0);
    pixel = vec4(displayed(light), paint.y);
}
#endif
