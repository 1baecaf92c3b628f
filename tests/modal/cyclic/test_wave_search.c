/* The search for missed modes: it counts as the dense pencil does, and finds what was left out. */
#include "modal/cyclic/wave_search.h"

#include "modal/common/session.h"
#include "modal/cyclic/small_hermitian.h"
#include "tests/support/fem.h"
#include "tests/support/small_wave.h"

/* P: columns of a block. BLOCKS: so many that the lowest modes have converged. */
enum { P = 4, BLOCKS = 12, BELOW = 6, NONE = -1 };

/* Take mode k out of W; NONE: nothing. */
static void leave_out(const dense_wave *w, int k, wave_basis *b) {
  if (k == NONE) return;
  double complex *M = malloc(P * b->order * sizeof *M), c[P];
  dense_multiply(w->n, w->M, P, b->W, M);
  wave_inner(b->order, 1, w->phi + (size_t)k * b->order, P, M, c);
  wave_add(b->order, -1, 1, w->phi + (size_t)k * b->order, c, P, b->W);
  free(M);
}

/* A run that never meets mode k, then a search below the mean of two eigenvalues. */
static modal_missed_modes search(const small_sector *s, int diameter, int k, double *limit) {
  double complex     R[P * P];
  dense_wave         w;
  wave_operator      op;
  wave_basis         b;
  modal_missed_modes out;
  bool               good = true;
  dense_wave_create(s, diameter, &w);
  assert_ok(wave_operator_create(&s->sector, s->order, diameter, SMALL_BLADES, &op));
  wave_basis_create(&op, P, BLOCKS, &b);
  wave_basis_randomise(&b, 0);
  leave_out(&w, k, &b);
  wave_basis_orthonormalise(&b, NULL, R, &good);
  for (int i = 0; i < BLOCKS && good; i++) {
    wave_basis_append(&b);
    wave_operator_solve(&op, P, b.MW, b.W);
    leave_out(&w, k, &b);
    wave_basis_orthonormalise(&b, b.D + P * P * i, b.B + P * P * i, &good);
  }
  assert_true(good);
  wave_basis_projection(P, BLOCKS, b.D, b.B, b.H);
  assert_true(small_hermitian_eigen(P * BLOCKS, b.H, b.theta, true));
  *limit = (w.lambda[BELOW - 1] + w.lambda[BELOW]) / 2;
  assert_ok(wave_search(&b, 1 / *limit, &out));
  wave_basis_free(&b);
  wave_operator_free(&op);
  dense_wave_free(&w);
  return out;
}

static void all_modes_are_confirmed(void **state) {
  for (int d = 0; d <= 2; d++) {
    double                   limit;
    const modal_missed_modes out = search(*state, d, NONE, &limit);
    print_message("nodal diameter %d: %d modes, %d steps, probability %.1e, ratio %.3f\n", d,
                  out.count, out.steps, out.probability, out.ratio);
    assert_int_equal(out.verdict, MODAL_VERDICT_COMPLETE);
    assert_int_equal(out.count, BELOW);
    assert_true(out.probability > 0 && out.probability <= 1e-9);
    assert_true(out.ratio > 0 && out.ratio < 1);
  }
}

static void a_mode_that_was_left_out_is_found(void **state) {
  for (int d = 0; d <= 2; d++)
    for (int k = 0; k < BELOW; k += 2) {
      double                   limit;
      const modal_missed_modes out = search(*state, d, k, &limit);
      print_message("nodal diameter %d without mode %d: %d modes, %d steps, ratio %.3f\n", d, k,
                    out.count, out.steps, out.ratio);
      assert_int_equal(out.verdict, MODAL_VERDICT_MISSING);
      assert_int_equal(out.count, BELOW - 1);
      assert_true(out.ratio > 1);
    }
}

/* A mode above the limit may be missing. */
static void a_mode_above_the_limit_is_no_matter(void **state) {
  double                   limit;
  const modal_missed_modes out = search(*state, 1, BELOW + 1, &limit);
  assert_int_equal(out.verdict, MODAL_VERDICT_COMPLETE);
  assert_int_equal(out.count, BELOW);
}

static int set_up(void **state) {
  static small_sector s;
  small_sector_create(&s);
  *state = &s;
  return 0;
}

static int tear_down(void **state) {
  small_sector_free(*state);
  return 0;
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_modes_are_confirmed),
      cmocka_unit_test(a_mode_that_was_left_out_is_found),
      cmocka_unit_test(a_mode_above_the_limit_is_no_matter),
  };
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failed;
}
