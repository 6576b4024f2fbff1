// How much of the sky a point of a body sees past the body's own limbs. After Inigo Quilez, "Capsule occlusion"; asked per
// vertex, for it changes slowly. The capsules follow the joints in their texture (engine/render/occlusion.py).
const int CAPSULES = 16, FIRST_CAPSULE = 42;

float open_sky(vec3 world_m, vec3 normal, int figure) {
    float seen = 1.0;
    for (int k = 0; k < CAPSULES; ++k) {
        vec4 a = texelFetch(joints, ivec2(FIRST_CAPSULE + 2 * k, figure), 0);
        vec3 axis = texelFetch(joints, ivec2(FIRST_CAPSULE + 2 * k + 1, figure), 0).xyz - a.xyz;
        vec3 from = a.xyz - world_m;
        vec3 to = from + axis * clamp(-dot(from, axis) / dot(axis, axis), 0.0, 1.0);
        float away2 = max(dot(to, to), 1e-6), away = sqrt(away2);
        // what the point lies in or on belongs to the same limb: it hides nothing
        float apart = smoothstep(1.0, 1.5, away / a.w);
        seen *= 1.0 - 0.85 * apart * clamp(dot(to, normal) / away, 0.0, 1.0) * min(a.w * a.w / away2, 1.0);
    }
    return seen;
}
