/* The blade at rest: the sharp edges and the outline of its surface. */
const WIDTH = 460, HEIGHT = 520, MARGIN = 16;
const SHARP = 0.85; /* cosine of the angle between faces at a sharp edge */
const TURN = 0.7, TILT = 0.3; /* rad, where a viewer begins */

const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/* Rows right, up and towards the viewer, of a machine whose axis is axial. */
function viewRows(axial, turn = TURN, tilt = TILT) {
  const radial = Math.abs(axial[2]) > 0.5 ? [1, 0, 0] : [0, 0, 1], across = cross(axial, radial);
  const c = Math.cos(turn), s = Math.sin(turn), ct = Math.cos(tilt), st = Math.sin(tilt);
  const rows = [[], [], []];
  for (let d = 0; d < 3; d++) {
    const depth = c * axial[d] - s * across[d];
    rows[0][d] = c * across[d] + s * axial[d];
    rows[1][d] = ct * radial[d] + st * depth;
    rows[2][d] = st * radial[d] - ct * depth;
  }
  return rows;
}
/* The edges [a, b] that are drawn: sharp ones of surfaces that face the viewer, and the outline. */
function edges(node, index, rows) {
  const beside = new Map(), list = [];
  for (let t = 0; t < index.length; t += 3) {
    const corner = [0, 1, 2].map(i => index[t + i]), [p, q, r] = corner.map(node);
    const n = cross(q.map((v, d) => v - p[d]), r.map((v, d) => v - p[d]));
    const size = Math.sqrt(dot(n, n)) || 1, face = {n: n.map(v => v / size), front: false};
    face.front = dot(rows[2], face.n) > 0;
    corner.forEach((a, i) => {
      const b = corner[(i + 1) % 3], key = Math.min(a, b) + "," + Math.max(a, b);
      const other = beside.get(key);
      beside.set(key, face);
      if (!other) return;
      if (other.front !== face.front || (face.front && dot(other.n, face.n) < SHARP))
        list.push([a, b]);
    });
  }
  return list;
}
/* position [3 n], m; index: nodes of triangles; axial: unit vector of the engine axis. */
function stillView(position, index, axial) {
  const node = i => Array.from(position.subarray(3 * i, 3 * i + 3)), rows = viewRows(axial);
  const lo = [Infinity, Infinity], hi = [-Infinity, -Infinity], at = [];
  for (let i = 0; 3 * i < position.length; i++) {
    at.push([0, 1].map(d => dot(rows[d], node(i))));
    for (let d = 0; d < 2; d++) {
      lo[d] = Math.min(lo[d], at[i][d]);
      hi[d] = Math.max(hi[d], at[i][d]);
    }
  }
  const scale = Math.min((WIDTH - 2 * MARGIN) / Math.max(hi[0] - lo[0], 1e-12),
    (HEIGHT - 2 * MARGIN) / Math.max(hi[1] - lo[1], 1e-12));
  const middle = (WIDTH - scale * (hi[0] - lo[0])) / 2;
  const px = i => `${(middle + scale * (at[i][0] - lo[0])).toFixed(1)} ${
    (HEIGHT - MARGIN - scale * (at[i][1] - lo[1])).toFixed(1)}`;
  const d = edges(node, index, rows).map(([a, b]) => `M${px(a)}L${px(b)}`).join("");
  return {
    width: WIDTH, height: HEIGHT, panels: [], extra: `<path class="outline" d="${d}"/>`
  };
}

export {cross, viewRows, stillView};
