#include "frame.glsl"
// The gymnasium as one box around everything, seen slightly out of focus so that it stays behind the people.
// engine/render/passes/court.py knows the same places. Display-referred, as the floor is.
const vec3 HALL_LOW = vec3(-24.0, -13.0, 0.0), HALL_HIGH = vec3(16.0, 13.0, 9.0);

// 1 between low and high, fading over `blur` on both sides.
float within(float x, float low, float high, float blur) {
    return smoothstep(low - blur, low + blur, x) * (1.0 - smoothstep(high - blur, high + blur, x));
}

// A row of bars of that width, one every `spacing`.
float bars(float x, float spacing, float width, float blur) {
    float away = abs(fract(x / spacing) - 0.5) * spacing;
    return 1.0 - smoothstep(0.5 * width - blur, 0.5 * width + blur, away);
}

vec3 wall(float along, float z, bool windows, float blur) {
    vec3 plaster = mix(vec3(0.845, 0.850, 0.850), vec3(0.900, 0.905, 0.905), smoothstep(2.0, 8.0, z));
    vec3 pads = vec3(0.400, 0.475, 0.545) * (1.0 - 0.07 * bars(along, 1.5, 0.06, blur));
    vec3 wood = vec3(0.760, 0.690, 0.595) * (1.0 - 0.05 * bars(along, 0.36, 0.10, blur));
    vec3 seen = mix(pads, wood, smoothstep(1.95 - blur, 1.95 + blur, z));
    seen = mix(seen, plaster, smoothstep(3.30 - blur, 3.30 + blur, z));
    if (windows) {
        float pane = within(z, 5.0, 7.6, blur) * (1.0 - bars(along, 2.5, 0.28, blur));
        seen = mix(seen, vec3(0.965, 0.980, 0.995), pane);
    }
    // a little darker into the corners between wall and floor
    return seen * (0.90 + 0.10 * smoothstep(0.0, 1.2, z));
}

vec3 ceiling(vec2 place, float blur) {
    float lamp = bars(place.x, 4.0, 0.55, blur) * within(abs(place.y), -1.0, 10.5, blur) * bars(place.y + 1.5, 3.0, 2.2, blur);
    float beam = bars(place.x + 2.0, 4.0, 0.30, blur);
    return mix(vec3(0.800, 0.808, 0.815) - 0.07 * beam, vec3(0.985, 0.988, 0.985), lamp);
}

// What is seen from a place in a direction; from outside, through the near wall.
vec3 hall(vec3 from, vec3 direction, float softness) {
    vec3 safe = direction + vec3(equal(direction, vec3(0.0))) * 1e-6;
    vec3 reach = mix(HALL_LOW - from, HALL_HIGH - from, step(0.0, safe)) / safe;
    float far = min(reach.x, min(reach.y, reach.z));
    vec3 at = from + far * direction;
    float blur = softness + 1.5 * far * view_up.w * picture_px.w;
    if (far == reach.z) return direction.z > 0.0 ? ceiling(at.xy, blur) : vec3(0.70, 0.66, 0.60);
    if (far == reach.y) return wall(at.x, at.z, true, blur);
    return wall(at.y, at.z, false, blur);
}
