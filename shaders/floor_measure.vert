#include "frame.glsl"
in vec2 corner_m;
out vec3 world_m;

void main() {
    world_m = vec3(corner_m, 0.0);
    gl_Position = clip_from_world * vec4(world_m, 1.0);
}
