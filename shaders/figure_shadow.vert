#include "frame.glsl"
#include "skin.glsl"
in vec3 vertex_m;
in uvec4 joint;
in vec4 weight;
in float row;

void main() {
    vec3 world_m = skinned(vertex_m, joint, weight, int(row + 0.5)).world_m;
    gl_Position = vec4((shadow_from_world * vec4(world_m, 1.0)).xyz * 2.0 - 1.0, 1.0);
}
