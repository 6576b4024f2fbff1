#include "measure.glsl"
in vec3 world_m;
flat in float who;
out vec4 pixel;

void main() {
    pixel = measured(world_m, 2.0 + who);
}
