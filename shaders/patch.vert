#include "frame.glsl"
in vec3 vertex_m;
in vec4 colour;             // sRGB, alpha
out vec4 paint;

void main() {
    paint = colour;
    gl_Position = clip_from_world * vec4(vertex_m, 1.0);
    gl_Position.z -= 1e-5 * gl_Position.w;
}
