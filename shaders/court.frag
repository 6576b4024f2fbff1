#include "frame.glsl"
#include "tone.glsl"
#include "light.glsl"
in vec3 world_m;
in vec3 world_normal;
in vec3 place;
out vec4 pixel;

const float MESH_M = 0.10, CORD_M = 0.004;

// How much of the pixel a net of cords covers, each way.
float cords(vec2 metres) {
    vec2 cell = metres / MESH_M, change = max(fwidth(cell), 1e-6);
    vec2 wide = vec2(CORD_M / MESH_M), drawn = max(wide, change);
    vec2 away = abs(fract(cell) - 0.5);
    vec2 covered = clamp((0.5 * drawn - (0.5 - away)) / change + 0.5, 0.0, 1.0) * wide / drawn;
    covered = mix(covered, wide, clamp(change * 2.0 - 0.5, 0.0, 1.0));
    return max(covered.x, covered.y) + 0.5 * min(covered.x, covered.y);
}

// Parts of the net, as court.py tells them: 0 mesh, 1 tape, 2 post, 3 antenna.
void main() {
    vec3 normal = normalize(world_normal), to_eye = normalize(eye_m.xyz - world_m);
    if (dot(normal, to_eye) < 0.0) normal = -normal;
    float kind = place.z;
    if (kind < 0.5) {
        pixel = vec4(vec3(0.16, 0.17, 0.19), clamp(1.5 * cords(place.xy), 0.0, 0.9));
        return;
    }
    vec3 albedo = kind < 1.5 ? vec3(0.80) : kind < 2.5 ? vec3(0.10, 0.19, 0.30) : mix(vec3(0.80), vec3(0.60, 0.03, 0.03), step(0.5, fract(place.y * 5.0)));
    pixel = vec4(displayed(lit_surface(albedo, normal, to_eye, to_light.xyz, 0.9, 0.15, 1.0)), 1.0);
}
