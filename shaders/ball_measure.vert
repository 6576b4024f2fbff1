#include "frame.glsl"
in vec3 vertex;             // of the unit sphere
in vec4 place_m;            // centre, radius; per ball

out vec3 world_m;
flat out float who;

void main() {
    world_m = place_m.xyz + place_m.w * vertex;
    who = float(gl_InstanceID);
    gl_Position = clip_from_world * vec4(world_m, 1.0);
}
