#include "frame.glsl"
#include "skin.glsl"
#include "openness.glsl"
in vec3 vertex_m;     // in the identity pose, from the pelvis
in vec3 normal;
in uvec4 joint;
in vec4 weight;
in vec3 paint_m;      // how far from dark parts, glass and shoes
in float openness;    // of folds in the skin itself
in vec4 colour;       // linear, alpha; per figure
in float row;         // of the joint texture; per figure

out vec3 world_m;
out vec3 world_normal;
out vec3 paint;
out float ambient;
flat out vec4 skin;

void main() {
    Skinned place = skinned(vertex_m, joint, weight, int(row + 0.5));
    world_m = place.world_m;
    world_normal = turned(place.turn, normal);
    paint = paint_m;
    ambient = openness * open_sky(world_m, world_normal, int(row + 0.5));
    skin = colour;
    gl_Position = clip_from_world * vec4(world_m, 1.0);
}
