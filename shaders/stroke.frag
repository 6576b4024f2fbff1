uniform float strength;     // 1 in plain sight; less for the pass that shows what is hidden behind things
flat in vec4 paint;
out vec4 pixel;

void main() {
    pixel = vec4(paint.rgb, paint.a * strength);
}
