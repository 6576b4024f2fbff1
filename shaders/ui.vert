uniform vec2 points;        // the picture's size in points
in vec2 place;              // points from its top left corner
in vec2 in_letters;
in vec4 colour;

out vec2 letter_at;
out vec4 paint;

void main() {
    letter_at = in_letters;
    paint = colour;
    gl_Position = vec4(place.x / points.x * 2.0 - 1.0, 1.0 - place.y / points.y * 2.0, 0.0, 1.0);
}
