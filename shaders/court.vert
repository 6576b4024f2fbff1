#include "frame.glsl"
in vec3 vertex_m;
in vec3 normal;
in vec3 paint;         // across the mesh of the net, metres; z: what it is

out vec3 world_m;
out vec3 world_normal;
out vec3 place;

void main() {
    world_m = vertex_m;
    world_normal = normal;
    place = paint;
    gl_Position = clip_from_world * vec4(vertex_m, 1.0);
}
