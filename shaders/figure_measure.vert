#include "frame.glsl"
#include "skin.glsl"
in vec3 vertex_m;
in uvec4 joint;
in vec4 weight;
in float row;

out vec3 world_m;
flat out float who;

void main() {
    world_m = skinned(vertex_m, joint, weight, int(row + 0.5)).world_m;
    who = row;
    gl_Position = clip_from_world * vec4(world_m, 1.0);
}
