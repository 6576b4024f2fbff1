in vec2 local;
flat in vec4 paint;
flat in float mark;
flat in vec2 size_m;
out vec4 pixel;

// Marks of decals.py: 0 contact shade, 1 centre of mass (the drafting sign: a quartered disc), 2 open ring.
void main() {
    float radius = length(local), blur = fwidth(radius), cover;
    vec3 colour = paint.rgb;
    if (mark < 0.5) {
        float soft = clamp(1.0 - radius, 0.0, 1.0);
        cover = soft * soft * (3.0 - 2.0 * soft);
    } else if (mark < 1.5) {
        cover = smoothstep(1.0, 1.0 - blur, radius);
        vec2 edge = clamp(local / max(fwidth(local), 1e-5), -1.0, 1.0);
        float quarter = 0.5 - 0.5 * edge.x * edge.y;
        float rim = smoothstep(0.80 - blur, 0.80, radius);
        colour = mix(mix(paint.rgb, vec3(1.0), quarter), paint.rgb, rim);
    } else {
        cover = smoothstep(1.0, 1.0 - blur, radius) * smoothstep(0.72 - blur, 0.72, radius);
    }
    pixel = vec4(colour, paint.a * cover);
}
