uniform sampler2D letters;
in vec2 letter_at;
in vec4 paint;
out vec4 pixel;

void main() {
    pixel = paint * texture(letters, letter_at);
}
