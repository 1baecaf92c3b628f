/* Values between designs: fields over two columns, and their level lines. */
import {place, levels} from "./study_columns.js";

/* Output on the levels of a grid, bilinear between them; NaN where a corner is missing. */
function gridField(a, b, o, slice) {
  const xs = levels(a), ys = levels(b), table = new Map();
  for (const i of slice) table.set(a.list[i] + "|" + b.list[i], o.list[i]);
  const places = [xs.map(v => place(a, v)), ys.map(v => place(b, v))];
  const cell = (at, t) => {
    let i = 0;
    while (i < at.length - 2 && t > at[i + 1]) i++;
    return [i, (t - at[i]) / (at[i + 1] - at[i])];
  };
  return (u, v) => {
    const [i, s] = cell(places[0], u), [j, t] = cell(places[1], v);
    const z = (p, q) => {
      const key = xs[i + p] + "|" + ys[j + q];
      return table.has(key) ? table.get(key) : NaN;
    };
    return (1 - s) * ((1 - t) * z(0, 0) + t * z(0, 1)) + s * ((1 - t) * z(1, 0) + t * z(1, 1));
  };
}
/* Scattered designs of two variables: inverse distance to the fourth power. More variables: a
   mean of the neighbourhood, as the others differ from dot to dot. */
function scatterField(a, b, o, slice, smooth) {
  const use = slice.filter(i => Number.isFinite(o.list[i])), n = use.length;
  const xs = Float64Array.from(use, i => place(a, a.list[i])),
        ys = Float64Array.from(use, i => place(b, b.list[i])),
        zs = Float64Array.from(use, i => o.list[i]);
  
  const width = Math.max(0.06, 0.5 * Math.max(n, 1) ** (-1 / 3)), far = (2.2 * width) ** 2;
  return (u, v) => {
    let sum = 0, weight = 0, least = Infinity;
    for (let k = 0; k < n; k++) {
      const d = (xs[k] - u) ** 2 + (ys[k] - v) ** 2;
      if (d < least) least = d;
      if (smooth && d > 4 * far) continue; /* a weight below 1e-4 */
      const w = smooth ? Math.exp(-d / (2 * width * width)) : 1 / (d * d + 1e-12);
      sum += w * zs[k];
      weight += w;
    }
    return least > far ? NaN : sum / weight;
  };
}
/* Every other row and column of a field [ny][nx] becomes the mean of its neighbours. */
function refine(field, nx, ny) {
  const fill = (to, p, q) => {
    field[to] = (field[p] + field[q]) / 2;
  };
  for (let j = 0; j < ny; j += 2)
    for (let i = 1; i < nx; i += 2) fill(j * nx + i, j * nx + i - 1, j * nx + i + 1);
  for (let j = 1; j < ny; j += 2)
    for (let i = 0; i < nx; i++) fill(j * nx + i, (j - 1) * nx + i, (j + 1) * nx + i);
}
/* Level lines through a field [ny][nx] by marching squares. */
function contour(g, field, nx, ny, level, X, Y) {
  let middle = null, least = Infinity;
  const cross = (p, q, a, b) => {
    const t = (level - a) / (b - a);
    return [X(p[0] + t * (q[0] - p[0])), Y(p[1] + t * (q[1] - p[1]))];
  };
  for (let j = 0; j + 1 < ny; j++)
    for (let i = 0; i + 1 < nx; i++) {
      const c = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]],
            z = c.map(([p, q]) => field[q * nx + p]);
      if (!z.every(Number.isFinite)) continue;
      const hits = [];
      for (let k = 0; k < 4; k++) {
        const m = (k + 1) % 4;
        if ((z[k] < level) !== (z[m] < level)) hits.push(cross(c[k], c[m], z[k], z[m]));
      }
      for (let k = 0; k + 1 < hits.length; k += 2) {
        g.moveTo(...hits[k]);
        g.lineTo(...hits[k + 1]);
        const d = Math.hypot(i / nx - 0.5, 0.5 * (j / ny - 0.5));
        if (d < least) [middle, least] = [hits[k], d];
      }
    }
  return middle;
}

export {gridField, scatterField, refine, contour};
