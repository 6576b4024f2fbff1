#include "frame.glsl"
#include "skin.glsl"
in vec3 vertex_m;
in vec2 tag;
in float row;

void main() {
    vec3 world_m = world_from_joint(tag.x, int(row + 0.5)) * vec4(vertex_m, 1.0);
    gl_Position = vec4((shadow_from_world * vec4(world_m, 1.0)).xyz * 2.0 - 1.0, 1.0);
}
