#include "mhb/balance/ring_limit.h"

#include "mhb/balance/stick_stiffness.h"
#include "mhb/numerics/block_cyclic.h"

/* to[2n][2n] column-major <- the real form of R S, complex R[n][n] and springs S of stuck pairs. */
static void set_springs(const mhb_law *law, int n, int k, int contact, const bool *stuck,
                        const double complex *R, double *to) {
  const int P = n / 3;
  for (int row = 0; row < n; row++, R += n)
    for (int j = 0; j < P; j++) {
      const int pair = contact * P + j;
      if (!stuck[pair]) continue;
      double complex RS[3]; /* S is symmetric: R S = (S R^T)^T */
      mhb_stick_force(&law[pair], k, R + 3 * j, RS);
      for (int c = 0; c < 3; c++) {
        double *at = to + (size_t)(3 * j + c) * 4 * (size_t)n + 2 * row;
        at[0] += creal(RS[c]);
        at[1] += cimag(RS[c]);
        at[2 * n] -= cimag(RS[c]);
        at[2 * n + 1] += creal(RS[c]);
      }
    }
}

shb_status mhb_ring_linear_limit(const mhb_ring_receptance *ring, const mhb_law *law, int k,
                                 const bool *stuck, double complex *u) {
  const int         n = ring->n, N = ring->blades;
  mhb_block_cyclic *f;
  SHB_TRY(mhb_block_cyclic_create(N, 2 * n, &f));
  for (int c = 0; c < N; c++) {
    const int after = (c + 1) % N, before = (c + N - 1) % N;
    double   *own = mhb_block_cyclic_at(f, f->own, c);
    for (int i = 0; i < 2 * n; i++) own[i * (2 * n + 1)] = 1;
    set_springs(law, n, k, c, stuck, mhb_ring_receptance_block(ring, k, c, MHB_RING_OWN), own);
    set_springs(law, n, k, before, stuck, mhb_ring_receptance_block(ring, k, c, MHB_RING_BEFORE),
                mhb_block_cyclic_at(f, f->before, c));
    set_springs(law, n, k, after, stuck, mhb_ring_receptance_block(ring, k, c, MHB_RING_AFTER),
                mhb_block_cyclic_at(f, f->after, c));
  }
  const int regular = mhb_block_cyclic_factor(f, 0);
  if (regular) mhb_block_cyclic_solve(f, (double *)u); /* complex numbers are pairs of reals */
  mhb_block_cyclic_destroy(f);
  SHB_CHECK(regular, SHB_ERR_INPUT, "the stuck system is singular at harmonic %d", k);
  return SHB_OK;
}
