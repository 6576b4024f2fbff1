uniform sampler2D atlas;    // r: the letter, g: the letter with a halo around it
in vec2 place;
flat in vec4 paint;
out vec4 pixel;

void main() {
    vec2 ink = texture(atlas, place).rg;
    pixel = vec4(mix(vec3(1.0), paint.rgb, ink.r), paint.a * max(ink.r, 0.85 * ink.g));
}
