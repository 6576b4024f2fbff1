#include "frame.glsl"
in vec3 vertex;             // of the unit sphere: its own normal
in vec4 place_m;            // centre, radius; per ball
in vec4 turn;               // orientation w x y z; per ball
in vec2 look;               // kind, alpha; per ball

out vec3 world_m;
out vec3 world_normal;
out vec3 local;             // on the unit sphere, turning with the ball
flat out vec2 paint;

vec3 turned(vec4 q, vec3 v) {
    vec3 t = 2.0 * cross(q.yzw, v);
    return v + q.x * t + cross(q.yzw, t);
}

void main() {
    world_normal = turned(turn, vertex);
    world_m = place_m.xyz + place_m.w * world_normal;
    local = vertex;
    paint = look;
#ifdef SHADOW
    gl_Position = vec4((shadow_from_world * vec4(world_m, 1.0)).xyz * 2.0 - 1.0, 1.0);
#else
    gl_Position = clip_from_world * vec4(world_m, 1.0);
#endif
}
