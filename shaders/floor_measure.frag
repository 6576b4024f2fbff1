#include "measure.glsl"
in vec3 world_m;
out vec4 pixel;

void main() {
    pixel = measured(world_m, 1.0);
}
