#include "frame.glsl"
// Instead of a picture: how far along the view a point is, metres, and whose it is (engine/render/measures.py).
vec4 measured(vec3 world_m, float whose) {
    return vec4(dot(world_m - eye_m.xyz, view_forward.xyz), whose, 0.0, 1.0);
}
