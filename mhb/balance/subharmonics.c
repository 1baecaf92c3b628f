#include "mhb/balance/subharmonics.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/vector.h"

/* A subharmonic part below this share of |x| is zero. */
static const double NEGLIGIBLE = 1e-6;

void mhb_subharmonic_embed(int rows, const double *x, int m, int factor, double *to, int wide) {
  int nb = 2 * m + 1, room = 2 * wide + 1;
  memset(to, 0, sizeof(double) * (size_t)(rows * room));
  for (int row = 0; row < rows; row++) {
    const double *a = x + row * nb;
    double       *b = to + row * room;
    b[0]            = a[0];
    for (int k = 1; k <= m && k * factor <= wide; k++) {
      b[2 * k * factor - 1] = a[2 * k - 1];
      b[2 * k * factor]     = a[2 * k];
    }
  }
}

void mhb_subharmonic_restrict(int rows, const double *x, int m, int factor, double *to,
                              int narrow) {
  int nb = 2 * m + 1, room = 2 * narrow + 1;
  memset(to, 0, sizeof(double) * (size_t)(rows * room));
  for (int row = 0; row < rows; row++) {
    const double *a = x + row * nb;
    double       *b = to + row * room;
    b[0]            = a[0];
    for (int k = 1; k <= narrow && k * factor <= m; k++) {
      b[2 * k - 1] = a[2 * k * factor - 1];
      b[2 * k]     = a[2 * k * factor];
    }
  }
}

void mhb_subharmonic_shift(const mhb_balance *b, const double *x, int j, double *to) {
  int nu = b->receptance->nu;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *a = x + row * b->nb;
    double       *c = to + row * b->nb;
    c[0]            = a[0];
    for (int k = 1; k <= b->m; k++) {
      double angle = SHB_TWO_PI * (k * j % nu) / nu, cosine = cos(angle), sine = sin(angle);
      double re = a[2 * k - 1], im = a[2 * k];
      c[2 * k - 1] = re * cosine - im * sine;
      c[2 * k]     = re * sine + im * cosine;
    }
  }
}

void mhb_subharmonic_component(const mhb_balance *b, const double *x, int d, double *part) {
  int stride = b->receptance->nu / d;
  memcpy(part, x, sizeof(double) * (size_t)b->n);
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    double *a = part + row * b->nb;
    a[0]      = 0;
    for (int k = stride; k <= b->m; k += stride) a[2 * k - 1] = a[2 * k] = 0;
  }
}

int mhb_subharmonic_period(const mhb_balance *b, const double *x) {
  int    nu = b->receptance->nu;
  double part[b->n], size = mhb_norm(x, b->n);
  for (int d = 1; d < nu; d++) {
    if (nu % d) continue;
    mhb_subharmonic_component(b, x, d, part);
    if (mhb_norm(part, b->n) <= NEGLIGIBLE * size) return d;
  }
  return nu;
}
