// A vertex carried by up to four joints, blended as dual quaternions (Kavan et al. 2008; engine/render/skinning.py).
// The texture has one row per figure and, for each of the 21 joints, the real and the dual part of world_from_rest, x = w.
uniform sampler2D joints;

const float SHOULDER_LINEAR = 0.4;    // as in skinning.py
const uint LEFT_SHOULDER = 6u, LEFT_ELBOW = 7u, RIGHT_SHOULDER = 10u, RIGHT_ELBOW = 11u;

struct Skinned {
    vec3 world_m;
    vec4 turn;
};

vec3 turned(vec4 q, vec3 v) {
    vec3 t = 2.0 * cross(q.yzw, v);
    return v + q.x * t + cross(q.yzw, t);
}

// The shift of a dual quaternion: 2 * dual * conjugate(real), its vector part.
vec3 shift(vec4 real, vec4 dual) {
    return 2.0 * (real.x * dual.yzw - dual.x * real.yzw + cross(real.yzw, dual.yzw));
}

vec3 moved(vec4 real, vec4 dual, vec3 v) {
    return turned(real, v) + shift(real, dual);
}

// Between trunk and upper arm.
bool at_shoulder(uint a, uint b) {
    bool arm = a == LEFT_SHOULDER || a == RIGHT_SHOULDER || b == LEFT_SHOULDER || b == RIGHT_SHOULDER;
    return arm && a != LEFT_ELBOW && a != RIGHT_ELBOW && b != LEFT_ELBOW && b != RIGHT_ELBOW;
}

Skinned skinned(vec3 rest_m, uvec4 joint, vec4 weight, int figure) {
    vec4 real = texelFetch(joints, ivec2(2 * int(joint.x), figure), 0);
    vec4 dual = texelFetch(joints, ivec2(2 * int(joint.x) + 1, figure), 0);
    if (weight.y <= 0.0) return Skinned(moved(real, dual, rest_m), real);
    vec4 first = real;
    bool soft = at_shoulder(joint.x, joint.y);
    vec3 linear = soft ? weight.x * moved(real, dual, rest_m) : vec3(0.0);
    real *= weight.x;
    dual *= weight.x;
    for (int k = 1; k < 4; ++k) {
        if (weight[k] <= 0.0) break;
        vec4 next = texelFetch(joints, ivec2(2 * int(joint[k]), figure), 0);
        vec4 next_dual = texelFetch(joints, ivec2(2 * int(joint[k]) + 1, figure), 0);
        float share = dot(next, first) < 0.0 ? -weight[k] : weight[k];
        real += share * next;
        dual += share * next_dual;
        if (soft) linear += weight[k] * moved(next, next_dual, rest_m);
    }
    float size = 1.0 / length(real);
    vec3 world_m = moved(real * size, dual * size, rest_m);
    return Skinned(soft ? mix(world_m, linear, SHOULDER_LINEAR) : world_m, real * size);
}
