uniform float strength;
in vec2 local;
flat in vec4 paint;
out vec4 pixel;

void main() {
    float radius = length(local), blur = fwidth(radius);
    float cover = smoothstep(1.0, 1.0 - blur, radius);
    vec3 colour = mix(paint.rgb, vec3(1.0), smoothstep(0.70 - blur, 0.70, radius) * 0.75);
    pixel = vec4(colour, paint.a * cover * strength);
}
