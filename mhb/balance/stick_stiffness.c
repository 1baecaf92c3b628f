#include "mhb/balance/stick_stiffness.h"

void mhb_stick_matrix(const mhb_balance *b, int k, const mhb_pair_kind *kind, double complex *A) {
  const int             n = 3 * b->n_pairs;
  const double complex *R = b->receptance->R + (size_t)k * (size_t)n * (size_t)n;
  for (int i = 0; i < n; i++, R += n)
    for (int a = 0; a < b->n_pairs; a++) {
      double complex row[3] = {0, 0, 0}; /* S is symmetric */
      if (kind[a] == MHB_PAIR_STUCK) mhb_stick_force(&b->law[a], k, R + 3 * a, row);
      for (int c = 0; c < 3; c++) A[(3 * a + c) * n + i] = row[c] + (i == 3 * a + c);
    }
}

bool mhb_all_pairs_linear(const mhb_balance *b) {
  for (int a = 0; a < b->n_pairs; a++)
    if (b->eval->info[a].share[MHB_STICK] < 1 && b->eval->info[a].share[MHB_SEPARATE] < 1)
      return false;
  return true;
}
