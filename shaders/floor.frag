#include "frame.glsl"
#include "tone.glsl"
#include "backdrop.glsl"
#ifdef GYM
#include "court.glsl"
#endif
#ifdef SHADED
#include "shadow.glsl"
#endif
in vec3 world_m;
out vec4 pixel;

const vec3 PLAIN = vec3(0.878, 0.882, 0.886), LINE = vec3(0.735, 0.755, 0.780), SHADE = vec3(0.475, 0.50, 0.545);

// How much of a pixel a net of lines covers. After Ben Golus, "The best darn grid shader (yet)": lines never get thinner than
// a pixel, they get paler instead, so nothing shimmers in the distance.
float net(vec2 metres, float spacing_m, float width_m) {
    vec2 place = metres / spacing_m, change = max(fwidth(place), 1e-6);
    vec2 wanted = vec2(width_m / spacing_m), drawn = clamp(wanted, change, vec2(0.5));
    vec2 away = 0.5 - abs(fract(place) - 0.5);
    vec2 covered = smoothstep(drawn * 0.5 + change * 0.75, drawn * 0.5 - change * 0.75, away) * clamp(wanted / drawn, 0.0, 1.0);
    covered = mix(covered, wanted, clamp(change * 2.0 - 1.0, 0.0, 1.0));
    return max(covered.x, covered.y);
}

void main() {
#ifdef GYM
    vec3 surface = court(world_m.xy);
#else
    vec3 surface = PLAIN;
    if (ground.w > 0.5) {
        float lines = max(0.55 * net(world_m.xy, 0.5, 0.006), 1.0 * net(world_m.xy, 2.5, 0.012));
        surface = mix(PLAIN, LINE, lines);
    }
#endif
#ifdef SHADED
    float light = key_light_at(world_m, vec3(0.0, 0.0, 1.0), 4.0);
    surface *= mix(SHADE / PLAIN, vec3(1.0), light);
#endif
#ifdef GYM
    pixel = vec4(varnished(surface, world_m), 1.0);
#else
    float away = distance(world_m.xy, ground.xy) / ground.z;
    float gone = smoothstep(0.25, 1.0, away);
    pixel = vec4(mix(surface, paper(normalize(world_m - eye_m.xyz)), gone), 1.0);
#endif
}
