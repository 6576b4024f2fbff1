// A vertex carried by its joint. The texture has one row per figure and, for each of the 21 joints, the three rows of
// world_from_joint.
uniform sampler2D joints;

mat4x3 world_from_joint(float joint, int figure) {
    int column = 3 * int(joint + 0.5);
    vec4 x = texelFetch(joints, ivec2(column, figure), 0);
    vec4 y = texelFetch(joints, ivec2(column + 1, figure), 0);
    vec4 z = texelFetch(joints, ivec2(column + 2, figure), 0);
    return transpose(mat3x4(x, y, z));
}
