#include "frame.glsl"
in vec2 corner;             // x: 0 at the start, 1 at the end; y: -1..1 across
in vec3 start_m;
in vec3 end_m;
in vec4 colour;             // sRGB, alpha
in vec2 width_px;           // at the start and at the end: an arrow's head tapers to nothing

flat out vec4 paint;

// A line of constant width on the screen: a quad turned towards the viewer.
void main() {
    vec4 a = clip_from_world * vec4(start_m, 1.0), b = clip_from_world * vec4(end_m, 1.0);
    const float NEAR = 0.05;
    if (a.w < NEAR && b.w > NEAR) a = mix(a, b, (NEAR - a.w) / (b.w - a.w));
    if (b.w < NEAR && a.w > NEAR) b = mix(b, a, (NEAR - b.w) / (a.w - b.w));
    vec2 along = (b.xy / b.w - a.xy / a.w) * picture_px.xy;
    along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
    vec4 place = corner.x < 0.5 ? a : b;
    float width = corner.x < 0.5 ? width_px.x : width_px.y;
    place.xy += vec2(-along.y, along.x) * corner.y * width * picture_px.zw * place.w;
    place.z -= 4e-5 * place.w;
    paint = colour;
    gl_Position = place;
}
