#include "frame.glsl"
in vec2 corner;             // 0..1
in vec4 box_px;             // left, top, width, height on the picture
in vec4 box_atlas;          // the same in the atlas, 0..1
in vec4 colour;

out vec2 place;
flat out vec4 paint;

void main() {
    vec2 pixel = box_px.xy + corner * box_px.zw;
    place = box_atlas.xy + corner * box_atlas.zw;
    paint = colour;
    gl_Position = vec4(pixel.x * picture_px.z * 2.0 - 1.0, 1.0 - pixel.y * picture_px.w * 2.0, 0.0, 1.0);
}
