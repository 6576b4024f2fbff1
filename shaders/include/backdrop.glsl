#include "frame.glsl"
#include "hall.glsl"
// The paper behind everything: brightest at the horizon, where the floor melts into it. Display-referred.
vec3 paper(vec3 direction) {
    vec3 horizon = vec3(0.925, 0.932, 0.940), zenith = vec3(0.735, 0.775, 0.825);
    return mix(horizon, zenith, smoothstep(0.02, 0.85, direction.z));
}

// What lies behind everything in a direction: the paper, or the hall's walls.
vec3 backdrop(vec3 direction) {
    return is_gym() ? hall(eye_m.xyz, direction, 0.05) : paper(direction);
}
