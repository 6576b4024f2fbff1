#include "frame.glsl"
#include "hall.glsl"
// A volleyball court (FIVB, Rules of the Game 2021-2024, section 1): 18 m by 9 m, lines of 5 cm that belong to it, attack lines
// with their outer edge 3 m from the net's middle. The court is maple, the free zone painted. Display-referred.
const vec2 COURT_MIDDLE = vec2(-6.0, 0.0), COURT_HALF = vec2(9.0, 4.5);
const float LINE_M = 0.05, ATTACK_M = 3.0;
const vec3 MAPLE = vec3(0.835, 0.765, 0.660), FREE = vec3(0.585, 0.655, 0.700), WHITE_LINE = vec3(0.955, 0.955, 0.945);
const float PLANK_M = 0.085, PLANK_LENGTH_M = 1.4;

// How much of the pixel lies within a strip |x - middle| < half, box filtered.
float strip(float x, float middle, float half_m, float pixel_m) {
    float reach = 0.5 * pixel_m;
    float low = max(x - reach, middle - half_m), high = min(x + reach, middle + half_m);
    return clamp((high - low) / max(pixel_m, 1e-5), 0.0, 1.0);
}

float noise(vec2 cell) {
    return fract(sin(dot(cell, vec2(12.9898, 78.233))) * 43758.5453);
}

// Boards along X, each of its own tone, with fine joints; far away only their mean is left.
float boards(vec2 place, vec2 pixel_m) {
    float row = floor(place.y / PLANK_M);
    float along = place.x / PLANK_LENGTH_M + noise(vec2(row, 7.0));
    float tone = 0.055 * (noise(vec2(row, floor(along))) - 0.5);
    float gap = strip(fract(place.y / PLANK_M) * PLANK_M, 0.0, 0.0016, pixel_m.y) + strip(fract(along) * PLANK_LENGTH_M, 0.0, 0.0016, pixel_m.x);
    float plain = smoothstep(0.25 * PLANK_M, 1.1 * PLANK_M, pixel_m.y);
    return 1.0 + mix(tone - 0.16 * gap, 0.0, plain);
}

vec3 court(vec2 place_m) {
    vec2 place = place_m - COURT_MIDDLE, pixel_m = fwidth(place), away = abs(place);
    vec2 outside = smoothstep(-0.5 * pixel_m, 0.5 * pixel_m, away - COURT_HALF);
    vec3 surface = mix(MAPLE, FREE, max(outside.x, outside.y)) * boards(place, pixel_m);
    // only inside do side lines run along the court, and end and attack lines across it
    float ends = strip(away.x, COURT_HALF.x - 0.5 * LINE_M, 0.5 * LINE_M, pixel_m.x);
    float attack = strip(away.x, ATTACK_M - 0.5 * LINE_M, 0.5 * LINE_M, pixel_m.x) + strip(place.x, 0.0, 0.5 * LINE_M, pixel_m.x);
    float sides = strip(away.y, COURT_HALF.y - 0.5 * LINE_M, 0.5 * LINE_M, pixel_m.y);
    float lines = max((ends + attack) * (1.0 - outside.y), sides * (1.0 - outside.x));
    return mix(surface, WHITE_LINE, 0.92 * clamp(lines, 0.0, 1.0));
}

// Varnish: the hall mirrored, out of focus, more the flatter one looks.
vec3 varnished(vec3 surface, vec3 world_m) {
    vec3 ray = normalize(world_m - eye_m.xyz);
    float grazing = 1.0 - clamp(-ray.z, 0.0, 1.0), fresnel = grazing * grazing * grazing * grazing * grazing;
    float share = 0.05 + 0.42 * fresnel;
    vec3 mirrored = shadow.w > 0.5 ? hall(world_m, reflect(ray, vec3(0.0, 0.0, 1.0)), 0.35) : vec3(0.84, 0.85, 0.855);
    return mix(surface, mirrored, share);
}
