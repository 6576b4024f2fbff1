#include "frame.glsl"
#include "skin.glsl"
in vec3 vertex_m;
in vec3 normal;
in vec2 tag;          // joint, material
in vec4 colour;       // linear, alpha; per figure
in float row;         // of the joint texture; per figure

out vec3 world_m;
out vec3 world_normal;
flat out vec4 paint;
flat out float material;

void main() {
    mat4x3 place = world_from_joint(tag.x, int(row + 0.5));
    world_m = place * vec4(vertex_m, 1.0);
    world_normal = mat3(place) * normal;
    paint = colour;
    material = tag.y;
    gl_Position = clip_from_world * vec4(world_m, 1.0);
}
