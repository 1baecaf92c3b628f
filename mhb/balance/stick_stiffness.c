#include "mhb/balance/stick_stiffness.h"

void mhb_stick_matrix(int n_pairs, const mhb_law *law, const mhb_pair_kind *kind, int k,
                      const double complex *R, double complex *A) {
  const int n = 3 * n_pairs;
  for (int i = 0; i < n; i++, R += n)
    for (int a = 0; a < n_pairs; a++) {
      double complex row[3] = {0, 0, 0}; /* S is symmetric */
      if (kind[a] == MHB_PAIR_STUCK) mhb_stick_force(&law[a], k, R + 3 * a, row);
      for (int c = 0; c < 3; c++) A[(3 * a + c) * n + i] = row[c] + (i == 3 * a + c);
    }
}
