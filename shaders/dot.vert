#include "frame.glsl"
in vec2 corner;
in vec3 centre_m;
in vec4 colour;             // sRGB, alpha
in float radius_m;

out vec2 local;
flat out vec4 paint;

// A disc that always faces the viewer, never smaller than a few pixels.
void main() {
    gl_Position = clip_from_world * vec4(centre_m, 1.0);
    vec2 radius = radius_m / vec2(view_right.w, view_up.w);
    gl_Position.xy += corner * max(radius, 3.0 * picture_px.zw * gl_Position.w);
    gl_Position.z -= 4e-5 * gl_Position.w;
    local = corner;
    paint = colour;
}
