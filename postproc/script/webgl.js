/* The blade drawn with WebGL 2: the surface, displaced by its harmonics, coloured by a value. */
import {viewRows} from "./still.js";
import {turned, angleOf, extentOf} from "./motion.js";

const HARMONICS = 5, pairs = [...Array(HARMONICS).keys()];
const VERTEX = `#version 300 es
  in vec3 base; in float value;
  ${pairs.map(k => `in vec3 re${k}; in vec3 im${k};`).join("\n")}
  uniform mat3 turn, view; uniform vec3 centre; uniform vec2 size; uniform vec4 shift;
  uniform float phase[${2 * HARMONICS}];
  out vec3 at; out float shade;
  void main() {
    vec3 x = base;
    ${pairs.map(k => `x += phase[${2 * k}] * re${k} + phase[${2 * k + 1}] * im${k};`).join("\n")}
    at = view * (turn * x - centre);
    shade = value;
    gl_Position = vec4(at.xy * size + shift.xy, -at.z * shift.w, 1);
  }`;
const RAMP = [[38, 70, 120], [52, 128, 150], [120, 176, 130], [230, 190, 90], [190, 60, 40]];
const FRAGMENT = `#version 300 es
  precision highp float;
  in vec3 at; in float shade; out vec4 colour; uniform float faint;
  void main() {
    vec3 c[5] = vec3[5](${RAMP.map(c => `vec3(${c.map(v => (v / 255).toFixed(3))})`).join(",")});
    float s = clamp(shade, 0., 1.) * 4.; int i = min(int(s), 3);
    vec3 n = normalize(cross(dFdx(at), dFdy(at)));
    float light = .45 + .55 * abs(dot(n, normalize(vec3(.3, .5, .8))));
    colour = vec4(mix(mix(c[i], c[i + 1], s - float(i)), vec3(.75), faint) * light, 1);
  }`;
const UNIFORMS = ["turn", "view", "centre", "size", "shift", "phase", "faint"];
const columns = rows => [0, 1, 2].flatMap(d => rows.map(r => r[d]));

/* The colours of the values as a style. */
const rampStyle = `linear-gradient(90deg,${RAMP.map(c => `rgb(${c})`).join()})`;

function compile(gl) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
      throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return program;
}

class BladePicture {
  constructor(canvas, gl, blade) {
    Object.assign(this, {canvas, gl, blade, program: compile(gl), buffers: {}, where: {}});
    gl.useProgram(this.program);
    gl.enable(gl.DEPTH_TEST);
    for (const name of UNIFORMS) this.where[name] = gl.getUniformLocation(this.program, name);
    this.set("base", 3, blade.base);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, blade.index, gl.STATIC_DRAW);
  }
  /* Numbers of every node; without data they are zero. */
  set(name, width, data) {
    const {gl, buffers} = this, slot = gl.getAttribLocation(this.program, name);
    if (slot < 0) return;
    if (!data) {
      gl.disableVertexAttribArray(slot);
      gl.vertexAttrib3f(slot, 0, 0, 0);
      return;
    }
    if (!buffers[name]) buffers[name] = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, width, gl.FLOAT, false, 0, 0);
  }
  upload({harmonics, value}) {
    for (const k of pairs) {
      const h = harmonics[k];
      this.set("re" + k, 3, h && h.re);
      this.set("im" + k, 3, h && h.im);
    }
    this.set("value", 1, value);
  }
  /* Size of the canvas in its place; returns width over height. */
  fit() {
    const {canvas, gl} = this, w = Math.max(280, canvas.parentElement.clientWidth);
    const h = Math.min(560, 0.7 * w), fine = Math.min(2, window.devicePixelRatio || 1);
    if (canvas.width !== Math.round(w * fine)) {
      canvas.width = Math.round(w * fine);
      canvas.height = Math.round(h * fine);
      canvas.style.height = h + "px";
    }
    gl.viewport(0, 0, canvas.width, canvas.height);
    return w / h;
  }
  /* The motion at a time in periods, so many times as large; which: neighbours (extentOf). */
  draw(motion, camera, which, time, factor) {
    const {gl, where, blade} = this, all = extentOf(blade, which), aspect = this.fit();
    const scale = camera.zoom * 0.95 / all.radius;
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix3fv(where.view, false,
      columns(viewRows(blade.axis, camera.yaw, camera.tilt)));
    gl.uniform3fv(where.centre, all.centre);
    gl.uniform2f(where.size, scale / aspect, scale);
    gl.uniform4f(where.shift, camera.x, camera.y, 0, 0.2 / all.deep);
    for (let i = all.from; i <= all.to; i++) {
      const phase = new Float32Array(2 * HARMONICS);
      motion.ks.forEach((k, j) => {
        const angle = k * (2 * Math.PI * time / motion.order - i * motion.lag);
        phase[2 * j] = factor * Math.cos(angle);
        phase[2 * j + 1] = -factor * Math.sin(angle);
      });
      gl.uniform1fv(where.phase, phase);
      gl.uniform1f(where.faint, i ? 0.35 : 0);
      gl.uniformMatrix3fv(where.turn, false, columns(turned(blade.axis, angleOf(blade, i))));
      gl.drawElements(gl.TRIANGLES, blade.index.length,
        blade.wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, 0);
    }
  }
}

export {BladePicture, rampStyle};
