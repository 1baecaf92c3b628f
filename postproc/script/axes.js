/* Axes: {lo, hi, log, unit, label}; with knee the axis is asinh(value / knee), both signs over
 * decades. Values are in SI; unit is the scale of the numbers at the ticks, 0: none. */
function place(a, v) {
  if (a.knee)
    return (Math.asinh(v / a.knee) - Math.asinh(a.lo / a.knee)) /
      (Math.asinh(a.hi / a.knee) - Math.asinh(a.lo / a.knee));
  if (a.log) return v > 0 ? Math.log(v / a.lo) / Math.log(a.hi / a.lo) : NaN;
  return (v - a.lo) / (a.hi - a.lo);
}
/* The value at a share of the axis. */
const valueAt = (a, t) => a.log ? a.lo * (a.hi / a.lo) ** t : a.lo + t * (a.hi - a.lo);

/* ---------------------------------------------------------------- ticks */
function evenTicks(lo, hi, wanted) {
  const raw = (hi - lo) / wanted, power = 10 ** Math.floor(Math.log10(raw)), ticks = [];
  const step = power * [1, 2, 5, 10].find(s => s === 10 || raw / power <= s + 1e-4);
  for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step && ticks.length < 40; k++)
    ticks.push(k * step);
  return ticks;
}
/* A step rounded up past the range leaves a single tick: then take finer steps. */
function linearTicks(lo, hi, wanted) {
  let ticks = [];
  for (let w = wanted; ticks.length < 2 && w <= 3 * wanted; w++) ticks = evenTicks(lo, hi, w);
  return ticks;
}
function logTicks(lo, hi, wanted) {
  const decades = Math.log10(hi / lo), ticks = [];
  if (decades < 0.5) return linearTicks(lo, hi, wanted);
  const parts = decades <= wanted / 2.5 ? [1, 2, 5] : [1], skip = Math.ceil(decades / wanted);
  for (let d = Math.floor(Math.log10(lo)); d <= Math.ceil(Math.log10(hi)); d++)
    for (const p of parts) {
      const t = p * 10 ** d;
      if (t >= lo * (1 - 1e-9) && t <= hi * (1 + 1e-9) && d % skip === 0) ticks.push(t);
    }
  return ticks;
}
function signedTicks(a, wanted) {
  const lowest = Math.floor(Math.log10(a.knee / a.unit)),
    highest = Math.ceil(Math.log10(Math.max(Math.abs(a.lo), Math.abs(a.hi)) / a.unit));
  const ticks = a.lo <= 0 && a.hi >= 0 ? [0] : [];
  for (const sign of [1, -1]) {
    let last = place(a, 0);
    for (let i = 0; i < 3 * (highest - lowest + 1); i++) {
      const t = sign * [1, 2, 5][i % 3] * 10 ** (lowest + Math.floor(i / 3)),
        at = place(a, t * a.unit);
      if (at < 0 || at > 1 || Math.abs(at - last) < 0.7 / wanted) continue;
      ticks.push(t);
      last = at;
    }
  }
  return ticks;
}
/* Round numbers in the unit of an axis. */
function ticksOf(a, wanted) {
  if (a.knee) return signedTicks(a, wanted);
  if (!(a.unit > 0)) return [];
  return (a.log ? logTicks : linearTicks)(a.lo / a.unit, a.hi / a.unit, wanted);
}

/* ---------------------------------------------------------------- ranges */
function signed(lo, hi, knee) {
  const a = Math.asinh(lo / knee), b = Math.asinh(hi / knee), air = 0.04 * (b - a);
  return {lo: knee * Math.sinh(a - air), hi: knee * Math.sinh(b + air), log: false, knee};
}
/* The range with 4 % of air on both sides. */
function around(lo, hi, log) {
  if (!(lo <= hi)) [lo, hi] = [0, 1];
  log = log && lo > 0;
  if (hi - lo <= 1e-12 * Math.max(Math.abs(lo), Math.abs(hi))) {
    const more = lo === 0 ? 1 : 0.05 * Math.abs(lo);
    lo -= more;
    hi += more;
  }
  const air = 0.04 * (log ? Math.log(hi / lo) : hi - lo);
  return log ? {lo: lo * Math.exp(-air), hi: hi * Math.exp(air), log} :
    {lo: lo - air, hi: hi + air, log};
}
const axis = (range, unitScale, label) => ({...range, unit: unitScale, label});

export {place, valueAt, linearTicks, logTicks, ticksOf, signed, around, axis};
