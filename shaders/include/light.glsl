// One warm key light and a hemisphere of cool sky over warm floor: enough to model a body, cheap enough for a software rasteriser.
const vec3 KEY = vec3(2.35, 2.24, 2.06);
const vec3 SKY = vec3(0.60, 0.66, 0.76);
const vec3 BOUNCE = vec3(0.37, 0.335, 0.30);

// `shadow`: how much of the key light arrives; `ambient`: how much of the rest. Diffuse with a soft terminator, a broad sheen and a rim that keeps the outline from sinking into the floor.
vec3 lit_surface(vec3 albedo, vec3 normal, vec3 to_eye, vec3 to_key, float shadow, float gloss, float ambient) {
    float facing = dot(normal, to_key);
    float key = clamp((facing + 0.12) / 1.12, 0.0, 1.0);
    vec3 hemisphere = mix(BOUNCE, SKY, 0.5 + 0.5 * normal.z);
    vec3 halfway = normalize(to_eye + to_key);
    float grazing = 1.0 - clamp(dot(normal, to_eye), 0.0, 1.0);
    float fresnel = grazing * grazing * grazing * grazing;
    float sheen = pow(clamp(dot(normal, halfway), 0.0, 1.0), mix(18.0, 90.0, gloss)) * mix(0.10, 0.9, gloss);
    vec3 light = albedo * (KEY * key * shadow * 0.68 + hemisphere * 0.58 * ambient);
    light += sheen * shadow * KEY * 0.35 * step(0.0, facing);
    light += ambient * fresnel * SKY * mix(0.16, 0.5, gloss) * (0.35 + 0.65 * clamp(normal.z * 0.5 + 0.5, 0.0, 1.0));
    return light;
}
