#include "frame.glsl"
out vec3 direction;

// One triangle that covers the picture, at the far plane.
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    direction = view_forward.xyz + corner.x * view_right.w * view_right.xyz + corner.y * view_up.w * view_up.xyz;
    gl_Position = vec4(corner, 1.0, 1.0);
}
