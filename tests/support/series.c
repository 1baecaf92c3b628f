#include "tests/support/series.h"

#include <math.h>

static const real TWO_PI = 6.283185307179586476925286766559L;

enum { CELLS = 48, BISECTIONS = 80 };

real signal_at(int m, const real *a, real t, int derivative) {
  real sum = derivative ? 0 : a[0];
  for (int k = 1; k <= m; k++) {
    real c = cosl(k * t), s = sinl(k * t);
    sum += derivative ? -k * (a[2 * k - 1] * s + a[2 * k] * c) : a[2 * k - 1] * c - a[2 * k] * s;
  }
  return sum;
}

void series_of_signal(int m, const real *a, real t, int order, real *c) {
  for (int j = 0; j <= order; j++) c[j] = j == 0 ? a[0] : 0;
  for (int k = 1; k <= m; k++) {
    /* d/dt rotates (value, slope/k) by a quarter */
    real co = cosl(k * t), si = sinl(k * t), factor = 1;
    real value = a[2 * k - 1] * co - a[2 * k] * si, slope = -a[2 * k - 1] * si - a[2 * k] * co;
    for (int j = 0; j <= order; j++) {
      c[j] += factor * value;
      real next = -value;
      value     = slope;
      slope     = next;
      factor *= (real)k / (j + 1);
    }
  }
}

real series_at(const real *c, int order, real t) {
  real sum = 0;
  for (int j = order; j >= 0; j--) sum = sum * t + c[j];
  return sum;
}

static real series_slope(const real *c, int order, real t) {
  real sum = 0;
  for (int j = order; j > 0; j--) sum = sum * t + j * c[j];
  return sum;
}

real series_product(const real *a, const real *b, int j) {
  real sum = 0;
  for (int i = 0; i <= j; i++) sum += a[i] * b[j - i];
  return sum;
}

/* The end of [low, high] to which the change of sign of value (or slope) converges; low keeps its
 * sign. */
static real bisect_series(const real *c, int order, int slope, real low, real high) {
  real (*f)(const real *, int, real) = slope ? series_slope : series_at;
  int sign                           = f(c, order, low) > 0;
  for (int i = 0; i < BISECTIONS; i++) {
    real mid = .5L * (low + high);
    if ((f(c, order, mid) > 0) == sign) {
      low = mid;
    } else {
      high = mid;
    }
  }
  return high;
}

real series_upcrossing(const real *c, int order, real h) {
  real before = 0;
  if (series_at(c, order, 0) > 0) return 0;
  for (int i = 1; i <= CELLS; i++) {
    real t = h * i / CELLS, top = t;
    if (series_at(c, order, t) <= 0) {
      int hill = series_slope(c, order, before) > 0 && series_slope(c, order, t) < 0;
      if (hill) top = bisect_series(c, order, 1, before, t);
    }
    if (series_at(c, order, top) > 0) return bisect_series(c, order, 0, before, top);
    before = t;
  }
  return -1;
}

static real bisect_signal(int m, const real *a, int derivative, real low, real high) {
  int sign = signal_at(m, a, low, derivative) > 0;
  for (int i = 0; i < BISECTIONS; i++) {
    real mid = .5L * (low + high);
    if ((signal_at(m, a, mid, derivative) > 0) == sign) {
      low = mid;
    } else {
      high = mid;
    }
  }
  return high;
}

int signal_roots(int m, const real *a, int room, real *root, int *rising) {
  int  n = 0, cells = CELLS * (m + 1);
  real t0 = 0, y0 = signal_at(m, a, 0, 0), d0 = signal_at(m, a, 0, 1);
  for (int i = 1; i <= cells; i++) {
    real t1 = TWO_PI * i / cells, y1 = signal_at(m, a, t1, 0), d1 = signal_at(m, a, t1, 1),
         mid = t1;
    int same = (y0 > 0) == (y1 > 0), turns = (d0 > 0) != (d1 > 0) && (d0 > 0) != (y0 > 0);
    if (same && turns) mid = bisect_signal(m, a, 1, t0, t1); /* two roots about an extreme? */
    real middle = signal_at(m, a, mid, 0);
    if ((middle > 0) != (y0 > 0) && n < room) {
      rising[n] = middle > 0;
      root[n++] = bisect_signal(m, a, 0, t0, mid);
    }
    if (same && (middle > 0) != (y1 > 0) && n < room) {
      rising[n] = y1 > 0;
      root[n++] = bisect_signal(m, a, 0, mid, t1);
    }
    t0 = t1;
    y0 = y1;
    d0 = d1;
  }
  return n;
}

void gauss_rule(real node[GAUSS_NODES], real weight[GAUSS_NODES]) {
  for (int i = 0; i < GAUSS_NODES; i++) {
    real x = -cosl(.5L * TWO_PI * (i + .75L) / (GAUSS_NODES + .5L)), slope = 1;
    for (int k = 0; k < 30; k++) {
      real p0 = 1, p1 = x;
      for (int n = 2; n <= GAUSS_NODES; n++) {
        real p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
        p0      = p1;
        p1      = p2;
      }
      slope = GAUSS_NODES * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    node[i]   = .5L * (1 + x);
    weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
}
