// A picture drawn with fewer pixels, at its full size.
uniform sampler2D drawn;
in vec2 place;
out vec4 pixel;

void main() {
    pixel = texture(drawn, place);
}
