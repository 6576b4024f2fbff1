// What every pass of one frame shares. Uploaded once; engine/render/frame.py lays out the same bytes.
layout(std140) uniform Frame {
    mat4 clip_from_world;
    mat4 shadow_from_world;   // to texture coordinates and depth, 0..1
    vec4 eye_m;               // xyz
    vec4 to_light;            // xyz unit, towards the key light; w: 1 where shadows are drawn
    vec4 picture_px;          // width, height, 1 / width, 1 / height
    vec4 ground;              // x, y centre of the floor; z: distance at which it has faded, m; w: 1 with lines
    vec4 shadow;              // x: size of a shadow texel in the map 0..1; y: the same in metres; z: 1 in the gymnasium; w: 1 with
                              // reflections
    vec4 view_up;             // xyz: camera's up; w: tangent of half the vertical field of view
    vec4 view_right;          // xyz: camera's right; w: the same, horizontally
    vec4 view_forward;        // xyz: where the camera looks
};

bool is_gym() {
    return shadow.z > 0.5;
}
