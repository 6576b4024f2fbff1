"use strict";
// Plays what demos/exporting/html.py put into this page. World: X ahead, Y left, Z up, metres. Matrices are column-major.

// --- small vectors and matrices ------------------------------------------------------------------------------------

const add = (a, b) => a.map((x, i) => x + b[i]);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map(x => x * s);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => scale(a, 1 / Math.hypot(...a));
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

function times(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++)
    for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}

function lookAt(eye, target) {
  const back = unit(sub(eye, target)), right = unit(cross([0, 0, 1], back)), up = cross(back, right);
  const axes = [right, up, back];
  return [0, 1, 2].flatMap(c => [...axes.map(axis => axis[c]), 0]).concat(axes.map(axis => -dot(axis, eye)), 1);
}

function perspective(fov, aspect, near, far) {
  const f = 1 / Math.tan(fov / 2), d = 1 / (near - far);
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) * d, -1, 0, 0, 2 * far * near * d, 0];
}

function orthographic(half, near, far) {
  const d = 1 / (near - far);
  return [1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 2 * d, 0, 0, 0, (far + near) * d, 1];
}

// --- shaders --------------------------------------------------------------------------------------------------------

const HEAD = "#version 300 es\nprecision highp float; precision highp int; precision highp sampler2DShadow;\n";

const FIGURE_VERTEX = HEAD + `
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in uvec4 joints;
layout(location = 3) in vec4 weights;
layout(location = 4) in vec3 colour;
layout(location = 5) in vec4 paint;
uniform mat4 camera, bones[21];
uniform float size_m;                        // what the greatest coordinate of the mesh stands for
out vec3 world_m, facing, tint;
out vec4 edges;
void main() {
  vec4 w = weights / dot(weights, vec4(1.0));
  mat4 bone = w.x * bones[joints.x] + w.y * bones[joints.y] + w.z * bones[joints.z] + w.w * bones[joints.w];
  world_m = (bone * vec4(place * size_m, 1.0)).xyz;
  facing = mat3(bone) * normal;
  tint = colour * colour;                    // stored as square roots, so that dark tones keep their steps
  edges = paint;
  gl_Position = camera * vec4(world_m, 1.0);
}`;

const LIGHT = `
uniform sampler2DShadow shadows;
uniform mat4 light;
uniform vec3 to_light, eye_m, horizon;
uniform float texel_m;
vec3 shown(vec3 x) {                         // Narkowicz's fit of the ACES film curve, then gamma
  x *= 0.8;
  return pow(clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0), vec3(1.0 / 2.2));
}
float lit(vec3 p, vec3 normal) {             // 1 in the light, 0 in shadow; softened over a few texels
  vec3 at = (light * vec4(p + 2.0 * texel_m * normal, 1.0)).xyz * 0.5 + 0.5;
  if (any(greaterThan(abs(at - 0.5), vec3(0.49)))) return 1.0;
  float sum = 0.0, step = 1.3 / float(textureSize(shadows, 0).x);
  for (int i = -1; i <= 1; i++) for (int j = -1; j <= 1; j++)
    sum += texture(shadows, vec3(at.xy + step * vec2(i, j), at.z - 0.0002));
  return sum / 9.0;
}`;

const FIGURE_PIXEL = HEAD + LIGHT + `
in vec3 world_m, facing, tint;
in vec4 edges;                               // how far from the dark parts, the glass, the shoes; 0 in folds
uniform vec3 palette[4];
uniform bool painted;
out vec4 pixel;
vec3 paint() {
  vec3 own = clamp(0.5 + edges.xyz / max(fwidth(edges.xyz), 1e-3), 0.0, 1.0);
  return mix(palette[3], mix(palette[2], mix(palette[1], palette[0], own.x), own.y), own.z);
}
void main() {
  vec3 albedo = painted ? paint() : tint;
  float open = painted ? 0.3 + 0.7 * clamp(edges.w, 0.0, 1.0) : 1.0;
  vec3 normal = normalize(facing), to_eye = normalize(eye_m - world_m);
  float towards = dot(normal, to_light), key = clamp((towards + 0.12) / 1.12, 0.0, 1.0) * lit(world_m, normal);
  vec3 hemisphere = mix(vec3(0.37, 0.335, 0.30), vec3(0.60, 0.66, 0.76), 0.5 + 0.5 * normal.z);
  float grazing = pow(1.0 - clamp(dot(normal, to_eye), 0.0, 1.0), 4.0);
  float sheen = pow(clamp(dot(normal, normalize(to_eye + to_light)), 0.0, 1.0), 24.0) * 0.08 * step(0.0, towards);
  vec3 sun = vec3(2.35, 2.24, 2.06);
  vec3 seen = albedo * (sun * key * 0.68 + hemisphere * 0.58 * open) + sheen * key * sun + grazing * 0.12 * hemisphere;
  pixel = vec4(shown(seen), 1.0);
}`;

const SHADOW_PIXEL = HEAD + "void main() {}";

const FLOOR_VERTEX = HEAD + `
uniform mat4 camera;
uniform vec3 centre_m;
out vec3 world_m;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  world_m = vec3(centre_m.xy + 60.0 * corner, 0.0);
  gl_Position = camera * vec4(world_m, 1.0);
}`;

const FLOOR_PIXEL = HEAD + LIGHT + `
uniform vec3 centre_m;
uniform float fade_m;
in vec3 world_m;
out vec4 pixel;
float net(float spacing_m, float width_m) {  // lines get paler instead of thinner than a pixel (Golus)
  vec2 at = world_m.xy / spacing_m, change = max(fwidth(at), 1e-6), wanted = vec2(width_m / spacing_m);
  vec2 drawn = clamp(wanted, change, vec2(0.5)), away = 0.5 - abs(fract(at) - 0.5);
  vec2 lines = smoothstep(drawn * 0.5 + change, drawn * 0.5 - change, away) * clamp(wanted / drawn, 0.0, 1.0);
  return max(lines.x, lines.y);
}
void main() {
  vec3 paint = mix(vec3(0.885), vec3(0.735, 0.755, 0.78), max(0.55 * net(0.5, 0.006), net(2.5, 0.012)));
  paint *= mix(vec3(0.55, 0.575, 0.62), vec3(1.0), lit(world_m, vec3(0.0, 0.0, 1.0)));
  pixel = vec4(mix(paint, horizon, smoothstep(0.25, 1.0, distance(world_m.xy, centre_m.xy) / fade_m)), 1.0);
}`;

// --- the picture ----------------------------------------------------------------------------------------------------

const SHADOW_PX = 2048, HORIZON = [0.925, 0.932, 0.94], TO_LIGHT = unit([0.45, 0.35, 1.0]), FOV = 0.6;

function program(gl, vertex, pixel) {
  const made = gl.createProgram();
  const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, pixel]].map(([kind, text]) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    return shader;
  });
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS))
    throw new Error([gl.getProgramInfoLog(made), ...shaders.map(shader => gl.getShaderInfoLog(shader))].join(" "));
  const places = new Map();
  const place = name => places.get(name) ?? (places.set(name, gl.getUniformLocation(made, name)), places.get(name));
  return {
    use: () => gl.useProgram(made),
    matrix: (name, value) => gl.uniformMatrix4fv(place(name), false, value),
    vector: (name, value) => gl.uniform3fv(place(name), value),
    number: (name, value) => gl.uniform1f(place(name), value),
    unit: (name, value) => gl.uniform1i(place(name), value),
  };
}

function uploaded(gl, mesh, array) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  const attribute = (slot, name, kind, set) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, array(mesh[name]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(slot);
    set(slot, 4, kind);
  };
  const share = (slot, count, kind) => gl.vertexAttribPointer(slot, count, kind, true, 0, 0);
  attribute(0, "places", gl.SHORT, share);
  attribute(1, "normals", gl.BYTE, share);
  attribute(2, "joints", gl.UNSIGNED_BYTE, (slot, count, kind) => gl.vertexAttribIPointer(slot, count, kind, 0, 0));
  attribute(3, "weights", gl.UNSIGNED_BYTE, share);
  attribute(4, "colours", gl.UNSIGNED_BYTE, share);
  if (mesh.paint) attribute(5, "paint", gl.BYTE, share);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, array(mesh.triangles), gl.STATIC_DRAW);
  return {vertices, count: array(mesh.triangles).length, size_m: mesh.size_m, painted: Boolean(mesh.paint)};
}

function renderer(canvas, reach_m, palette) {
  const gl = canvas.getContext("webgl2", {antialias: true, alpha: false});
  if (!gl) throw new Error("this browser has no WebGL 2, which the picture needs");
  const figure = program(gl, FIGURE_VERTEX, FIGURE_PIXEL), shadow = program(gl, FIGURE_VERTEX, SHADOW_PIXEL);
  const floor = program(gl, FLOOR_VERTEX, FLOOR_PIXEL), bare = gl.createVertexArray();
  const map = gl.createTexture(), target = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, map);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_PX, SHADOW_PX);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, map, 0);
  figure.use();
  figure.vector("palette", palette.flat());
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);

  function everything(shader, camera, drawn) {
    shader.use();
    shader.matrix("camera", camera);
    for (const {mesh, bones} of drawn) {
      shader.matrix("bones", bones);
      shader.number("size_m", mesh.size_m);
      shader.unit("painted", mesh.painted);
      gl.bindVertexArray(mesh.vertices);
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0);
    }
  }

  function draw(drawn, eye, centre) {
    const wide = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
    const high = Math.max(1, Math.round(canvas.clientHeight * devicePixelRatio));
    if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    const light = times(orthographic(reach_m, 1, 60), lookAt(add(centre, scale(TO_LIGHT, 30)), centre));
    const camera = times(perspective(FOV, wide / high, 0.1, 200), lookAt(eye, centre));

    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, SHADOW_PX, SHADOW_PX);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    everything(shadow, light, drawn);

    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, wide, high);
    gl.clearColor(...HORIZON, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    for (const shader of [figure, floor]) {
      shader.use();
      shader.matrix("light", light);
      shader.vector("to_light", TO_LIGHT);
      shader.vector("eye_m", eye);
      shader.vector("horizon", HORIZON);
      shader.number("texel_m", 2 * reach_m / SHADOW_PX);
    }
    everything(figure, camera, drawn);
    if (eye[2] < 0) return;
    floor.use();
    floor.matrix("camera", camera);
    floor.vector("centre_m", centre);
    floor.number("fade_m", 8 + 2 * reach_m);
    gl.bindVertexArray(bare);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }
  return {gl, draw};
}

// --- the motion -----------------------------------------------------------------------------------------------------

// Columns of the rotation by a quaternion w x y z, times a length.
function axes(w, x, y, z, s = 1) {
  return [
    s * (1 - 2 * (y * y + z * z)), s * 2 * (x * y + w * z), s * 2 * (x * z - w * y),
    s * 2 * (x * y - w * z), s * (1 - 2 * (x * x + z * z)), s * 2 * (y * z + w * x),
    s * 2 * (x * z + w * y), s * 2 * (y * z - w * x), s * (1 - 2 * (x * x + y * y)),
  ];
}

// The quaternion at `at`, a share `part` of the way to that of the next frame; both are on the same side.
function between(turns, at, next, part) {
  const q = [0, 1, 2, 3].map(k => turns[at + k] + part * (turns[next + k] - turns[at + k]));
  return scale(q, 1 / Math.hypot(...q));
}

const mixed = (track, frame, next, part) =>
  [0, 1, 2].map(k => track[3 * frame + k] + part * (track[3 * next + k] - track[3 * frame + k]));

const turned = (m, v) => [0, 1, 2].map(r => m[r] * v[0] + m[3 + r] * v[1] + m[6 + r] * v[2]);
const product = (a, b) => [0, 3, 6].flatMap(c => turned(a, b.slice(c, c + 3)));

// Forward kinematics, and from it what takes each corner from rest to the world.
function person_bones(person, frame, next, part) {
  const bones = new Float32Array(16 * 21), count = person.parents.length, places = [], turns = [];
  for (let j = 0; j < count; j++) {
    const up = person.parents[j], q = between(person.turns, 4 * (count * frame + j), 4 * (count * next + j), part);
    places[j] = up < 0 ? mixed(person.root, frame, next, part) : add(places[up], turned(turns[up], person.offsets[j]));
    turns[j] = up < 0 ? axes(...q) : product(turns[up], axes(...q));
    const shift = sub(places[j], turned(turns[j], person.rest[j]));
    for (let c = 0; c < 3; c++) bones.set(turns[j].slice(3 * c, 3 * c + 3), 16 * j + 4 * c);
    bones.set([...shift, 1], 16 * j + 12);
  }
  return bones;
}

function ball_bones(ball, frame, next, part) {
  const bones = new Float32Array(16), m = axes(...between(ball.turns, 4 * frame, 4 * next, part), ball.radius_m);
  for (let c = 0; c < 3; c++) bones.set(m.slice(3 * c, 3 * c + 3), 4 * c);
  bones.set([...mixed(ball.places, frame, next, part), 1], 12);
  return bones;
}

// --- the page -------------------------------------------------------------------------------------------------------

const element = id => document.getElementById(id);

async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

async function main() {
  const head = JSON.parse(element("head").textContent), data = await unpacked(element("data").textContent);
  const kinds = {f4: Float32Array, i2: Int16Array, u2: Uint16Array, i1: Int8Array, u1: Uint8Array};
  const array = ([kind, at, length]) => new kinds[kind](data, at, length);
  const view = renderer(element("view"), head.reach_m, head.palette), meshes = head.meshes.map(m => uploaded(view.gl, m, array));
  for (const person of head.people) [person.root, person.turns] = [array(person.root), array(person.turns)];
  for (const ball of head.balls)
    [ball.places, ball.turns, ball.seen] = [array(ball.places), array(ball.turns), array(ball.seen)];

  const body = document.body, last = head.frames - 1, end_s = last / head.fps, path = array(head.centre);
  const wish = new URLSearchParams(location.hash.slice(1)), asked = (name, usual) => Number(wish.get(name) ?? usual);
  const home = {azimuth: head.camera[0], elevation: head.camera[1], distance: head.camera[2], pan: [0, 0, 0]};
  const camera = {...home, azimuth: asked("azimuth", home.azimuth), elevation: asked("elevation", home.elevation),
    distance: asked("distance", home.distance)};
  const now = {s: clamp(asked("t", 0), 0, end_s), rate: asked("speed", 1), playing: !wish.has("t")};

  function at(s) {
    const place = clamp(s, 0, end_s) * head.fps, frame = Math.min(Math.floor(place), last);
    return [frame, Math.min(frame + 1, last), place - frame];
  }

  function eye_and_centre() {
    const centre = add([...mixed(path, ...at(now.s))], camera.pan), a = camera.azimuth * Math.PI / 180;
    const e = camera.elevation * Math.PI / 180, back = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    return [add(centre, scale(back, camera.distance)), centre];
  }

  function draw() {
    const moment = at(now.s), drawn = head.people.map(p => ({mesh: meshes[p.mesh], bones: person_bones(p, ...moment)}));
    for (const ball of head.balls)
      if (ball.seen[moment[0]]) drawn.push({mesh: meshes[ball.mesh], bones: ball_bones(ball, ...moment)});
    view.draw(drawn, ...eye_and_centre());
    const phase = head.phases.findLast(p => p.from_s <= now.s + 1e-6);
    element("caption").textContent = `${head.title}\n${phase ? phase.name.replaceAll("_", " ") : ""}`;
    element("clock").textContent = `${now.s.toFixed(2)} / ${end_s.toFixed(2)} s`;
    element("cursor").style.left = `${end_s ? 100 * now.s / end_s : 0}%`;
    element("timeline").setAttribute("aria-valuenow", now.s.toFixed(3));
    body.dataset.state = now.playing ? "playing" : "paused";
    body.dataset.time = now.s.toFixed(4);
    body.dataset.camera = [camera.azimuth, camera.elevation, camera.distance].map(x => x.toFixed(3)).join(" ");
  }

  let before = null, waiting = false;
  function ask() {
    if (!waiting) requestAnimationFrame(step);
    waiting = true;
  }
  function step(ms) {
    waiting = false;
    if (now.playing && before !== null) now.s += Math.min(ms - before, 250) / 1000 * now.rate;
    if (now.s > end_s) now.s = end_s > 0 ? now.s % end_s : 0;
    before = now.playing ? ms : null;
    draw();
    if (now.playing) ask();
  }
  function go(s) {
    [now.s, now.playing, before] = [clamp(s, 0, end_s), false, null];
    ask();
  }
  function play(playing) {
    [now.playing, before] = [playing, null];
    ask();
  }

  // controls, as in the window of Brace
  const canvas = element("view"), timeline = element("timeline"), speed = element("speed");
  canvas.oncontextmenu = event => event.preventDefault();
  canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
  canvas.onpointermove = event => {
    if (!event.buttons) return;
    if (event.buttons & 2 || event.shiftKey) {
      const [eye, centre] = eye_and_centre(), back = unit(sub(eye, centre)), right = unit(cross([0, 0, 1], back));
      const metres = 2 * camera.distance * Math.tan(FOV / 2) / canvas.clientHeight;
      camera.pan = add(camera.pan, add(scale(right, -event.movementX * metres), scale(cross(back, right), event.movementY * metres)));
    } else {
      camera.azimuth -= 0.4 * event.movementX;
      camera.elevation = clamp(camera.elevation + 0.3 * event.movementY, -5, 88);
    }
    ask();
  };
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    camera.distance = clamp(camera.distance * Math.exp(0.0013 * event.deltaY), 0.5, 60);
    ask();
  }, {passive: false});
  const scrub = event => {
    const box = timeline.getBoundingClientRect();
    go((event.clientX - box.left) / box.width * end_s);
  };
  timeline.onpointerdown = event => { timeline.setPointerCapture(event.pointerId); scrub(event); };
  timeline.onpointermove = event => { if (event.buttons) scrub(event); };
  element("play").onclick = () => play(!now.playing);
  speed.onchange = () => { now.rate = Number(speed.value); };
  const faster = by => {
    speed.selectedIndex = clamp(speed.selectedIndex + by, 0, speed.length - 1);
    speed.onchange();
  };
  const one = 1 / head.fps, keys = {
    " ": () => play(!now.playing), ".": () => go(now.s + one), ",": () => go(now.s - one),
    "ArrowRight": () => go(now.s + one), "ArrowLeft": () => go(now.s - one), "Backspace": () => { now.s = 0; ask(); },
    "-": () => faster(-1), "=": () => faster(1), "x": () => { Object.assign(camera, home); ask(); },
  };
  addEventListener("keydown", event => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (!keys[key] || event.ctrlKey || event.metaKey || event.altKey || event.target === speed) return;
    event.preventDefault();
    keys[key]();
  });
  addEventListener("resize", ask);
  canvas.addEventListener("webglcontextlost", () => location.reload());

  const share = s => `${end_s ? 100 * s / end_s : 0}%`;
  head.phases.forEach((phase, k) => {
    const bar = document.createElement("div"), to_s = head.phases[k + 1]?.from_s ?? end_s;
    Object.assign(bar.style, {left: share(phase.from_s), width: share(to_s - phase.from_s), background: phase.colour});
    bar.title = phase.name.replaceAll("_", " ");
    element("phases").append(bar);
  });
  for (const [s, kind] of head.marks) {
    const mark = document.createElement("div");
    [mark.className, mark.style.left, mark.title] = ["mark", share(s), `${kind} at ${s.toFixed(2)} s`];
    element("phases").append(mark);
  }
  timeline.setAttribute("aria-valuemin", 0);
  timeline.setAttribute("aria-valuemax", end_s);
  ask();
}

main().catch(trouble => {
  element("message").textContent = trouble.message;
  document.body.dataset.state = "failed";
});
