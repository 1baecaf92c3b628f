/* The contact law over a period of a known motion: load, friction, states. */
const Contact = (() => {
  "use strict";

  /* Signal c0 + sum ck cos kt + sk sin kt, from index at on, at n + 1 instants of the period. */
  function signal(data, at, top, n) {
    const x = new Float64Array(n + 1).fill(data[at]);
    for (let k = 1; k <= top; k++) {
      const c = data[at + 2 * k - 1], s = data[at + 2 * k], step = 2 * Math.PI * k / n;
      for (let i = 0; i <= n; i++) x[i] += c * Math.cos(step * i) + s * Math.sin(step * i);
    }
    return x;
  }
  /* Friction after an increment of stick [a, b] beyond the limit: f = (I + g K)^-1 t with
   * |f| = limit. The slip increment has the direction of f. */
  function onLimit(a, b, limit, law) {
    const size = Math.hypot(a, b);
    if (law.kuw === 0 && law.kuu === law.kww) return [a * limit / size, b * limit / size];
    const solve = g => {
      const p = 1 + g * law.kuu, q = g * law.kuw, r = 1 + g * law.kww, det = p * r - q * q;
      return [(r * a - q * b) / det, (p * b - q * a) / det];
    };
    let low = 0, high = 1 / law.kuu;
    while (Math.hypot(...solve(high)) > limit && high < 1e30) high *= 4;
    for (let i = 0; i < 60; i++) {
      const middle = (low + high) / 2;
      if (Math.hypot(...solve(middle)) > limit) low = middle;
      else
        high = middle;
    }
    return solve(high);
  }
  /* Steps are short against the highest harmonic; the error of a loop is of first order in them.
   * Laps are repeated until the friction at the end is that at the start. */
  function period(law, top, data, at) {
    const n = Math.max(1440, 96 * top), length = 2 * top + 1, close = 1e-6;
    const [v, u, w] = [0, 1, 2].map(axis => signal(data, at + axis * length, top, n));
    const load = v.map(x => Math.max(law.n0 + law.kv * x, 0));
    const fu = new Float64Array(n + 1), fw = new Float64Array(n + 1);
    const state = new Uint8Array(n + 1); /* from the instant before: 0 stuck, 1 slipping, 2 open */
    const mean = x => x.subarray(1).reduce((sum, e) => sum + e, 0) / n;
    const du = u[0] - mean(u), dw = w[0] - mean(w);
    let a = law.kuu * du + law.kuw * dw, b = law.kuw * du + law.kww * dw;
    const first = Math.hypot(a, b), most = law.mu * load[0];
    if (first > most) [a, b] = [a * most / first, b * most / first];
    for (let lap = 0; lap < 400; lap++) {
      fu[0] = a;
      fw[0] = b;
      for (let i = 1; i <= n; i++) {
        const limit = law.mu * load[i], p = u[i] - u[i - 1], q = w[i] - w[i - 1];
        a += law.kuu * p + law.kuw * q;
        b += law.kuw * p + law.kww * q;
        state[i] = load[i] <= 0 ? 2 : Math.hypot(a, b) > limit ? 1 : 0;
        if (state[i] === 2) a = b = 0;
        else if (state[i] === 1)
          [a, b] = onLimit(a, b, limit, law);
        fu[i] = a;
        fw[i] = b;
      }
      const size = Math.max(...load) * law.mu;
      if (Math.hypot(a - fu[0], b - fw[0]) <= close * size) break;
    }
    state[0] = state[n];
    let work = [0, 0];
    for (let i = 1; i <= n; i++) {
      work[0] += (fu[i] + fu[i - 1]) / 2 * (u[i] - u[i - 1]);
      work[1] += (fw[i] + fw[i - 1]) / 2 * (w[i] - w[i - 1]);
    }
    const share = [0, 1, 2].map(s => state.subarray(1).filter(e => e === s).length / n);
    return {n, v, u, w, fu, fw, load, state, work, share};
  }
  /* All contacts at stored point j of a branch: [{law, top, at}] and the data they lie in. */
  function unpack(contact, pairs) {
    const data = new Float32Array(Plot.bytes(contact.data).buffer), start = [];
    let at = 0;
    for (const k of contact.k) {
      start.push(at);
      at += pairs * (6 + 3 * (2 * k + 1));
    }
    const law = from => {
      const [mu, n0, kv, kuu, kuw, kww] = data.subarray(from, from + 6);
      return {mu, n0, kv, kuu, kuw, kww};
    };
    return {
      at: contact.at,
      period(j, pair) {
        const top = contact.k[j], from = start[j] + pair * (6 + 3 * (2 * top + 1));
        return {law: law(from), ...period(law(from), top, data, from + 6)};
      }
    };
  }
  return {period, unpack};
})();
