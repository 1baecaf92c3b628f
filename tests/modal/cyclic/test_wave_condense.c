/* Condensation of a sector at a nodal diameter: shapes, forces, residual terms, residual modes and
 * tails against dense solutions. */
#include "modal/cyclic/wave_condense.h"

#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "tests/support/fem.h"
#include "tests/support/small_wave.h"

enum { MODES = 5, TERMS = 3 };

/* One nodal diameter, its modes, and what the condensation gives. */
typedef struct {
  dense_wave         dense;
  wave_operator      op;
  wave_modes         modes;
  modal_condensation to;
  modal_model        model, imaginary, backward;
  double complex    *contact, *load, *probe; /* C^H b of the dofs, [][n] */
} scene;

static void make(const small_sector *sector, int diameter, int pairs, bool real_load, scene *s) {
  const wave_settings wanted = {.modes = MODES};
  *s                         = (scene){.to = {0}};
  dense_wave_create(sector, diameter, &s->dense);
  assert_ok(wave_operator_create(&sector->sector, sector->order, diameter, SMALL_BLADES, &s->op));
  assert_ok(wave_modes_solve(&s->op, &wanted, &sector->body, NULL, &s->modes));
  small_condensation(sector, pairs, &s->to);
  for (int i = 0; real_load && i < 2 * s->to.load.dofs.n; i++)
    s->to.load.weight[i] = creal(s->to.load.weight[i]);
  assert_ok(wave_condense(&s->op, &s->modes, &s->to, &s->model, &s->imaginary, &s->backward));
  s->contact = dense_wave_columns(&s->dense, &s->to.contact);
  s->load    = dense_wave_columns(&s->dense, &s->to.load.dofs);
  s->probe   = dense_wave_columns(&s->dense, &s->to.probe);
}

static void drop(scene *s) {
  modal_model_free(&s->model);
  modal_model_free(&s->imaginary);
  modal_model_free(&s->backward);
  free(s->contact);
  free(s->load);
  free(s->probe);
  small_condensation_free(&s->to);
  wave_modes_free(&s->modes);
  wave_operator_free(&s->op);
  dense_wave_free(&s->dense);
}

static double complex inner(const scene *s, const double complex *x, const double complex *y) {
  double complex sum;
  wave_inner((size_t)s->dense.n, 1, x, 1, y, &sum);
  return sum;
}

/* An array of the model, with its imaginary parts (NULL: real), against x_r^H y_c. rows, columns:
 * of the array. Returns the greatest difference over the greatest entry. */
static double off(const scene *s, int rows, const double complex *x, int columns,
                  const double complex *y, const double *re, const double *im) {
  double worst = 0, most = 0;
  for (int r = 0; r < rows; r++)
    for (int c = 0; c < columns; c++) {
      const double complex wanted = inner(s, x + r * s->dense.n, y + c * s->dense.n);
      const double complex given  = CMPLX(re[r * columns + c], im ? im[r * columns + c] : 0);
      worst                       = fmax(worst, cabs(given - wanted));
      most                        = fmax(most, cabs(wanted));
    }
  return worst / most;
}

/* [K + 1][rows] of a load against x_r^H V of the patterns; the backward wave has the conjugates. */
static double load_off(const scene *s, int rows, const double complex *x, const double complex *V,
                       const double complex *forward, const double complex *backward) {
  const modal_load *load  = &s->to.load;
  double            worst = 0, most = 0;
  for (int k = 0; k <= load->n_harmonics; k++)
    for (int r = 0; r < rows; r++) {
      double complex wanted[2] = {0, 0};
      for (int c = 0; c < load->dofs.n; c++) {
        const double complex v = inner(s, x + r * s->dense.n, V + c * s->dense.n);
        wanted[0] += load->weight[k * load->dofs.n + c] * v;
        wanted[1] += load->weight[k * load->dofs.n + c] * conj(v);
      }
      worst = fmax(worst, cabs(forward[k * rows + r] - wanted[0]));
      if (backward) worst = fmax(worst, cabs(backward[k * rows + r] - wanted[1]));
      most = fmax(most, cabs(wanted[0]));
    }
  return worst / most;
}

/* V <- P K^-1 M V, or first P K^-1 V. */
static void advance(const scene *s, bool first, int count, double complex *V) {
  double complex *MV = malloc((size_t)(s->dense.n * count) * sizeof *MV);
  dense_multiply(s->dense.n, s->dense.M, count, V, MV);
  if (!first) memcpy(V, MV, (size_t)(s->dense.n * count) * sizeof *V);
  dense_wave_solve(&s->dense, count, V);
  dense_wave_project_out(&s->dense, MODES, count, V);
  free(MV);
}

static double complex *copy(const scene *s, int count, const double complex *b) {
  double complex *V = malloc((size_t)(s->dense.n * count) * sizeof *V);
  memcpy(V, b, (size_t)(s->dense.n * count) * sizeof *V);
  return V;
}

static void check_shapes(const scene *s) {
  const modal_model *m = &s->model, *i = &s->imaginary, *b = &s->backward;
  const int          side = 3 * s->to.n_pairs, n = s->dense.n;
  assert_int_equal(m->n_modes, MODES);
  assert_int_equal(m->n_pairs, s->to.n_pairs);
  assert_int_equal(m->n_load, 1);
  assert_below(off(s, side, s->contact, MODES, s->modes.phi, m->right, i->right), 1e-13);
  assert_below(off(s, side, s->contact + side * n, MODES, s->modes.phi, m->left, i->left), 1e-13);
  assert_below(off(s, 3, s->probe, MODES, s->modes.phi, m->probe, i->probe), 1e-13);
  assert_below(load_off(s, MODES, s->modes.phi, s->load, m->modal_force, b->modal_force), 1e-13);
  for (int k = 0; k < MODES; k++) {
    assert_within(m->frequency[k], sqrt(s->dense.lambda[k]) / SHB_TWO_PI, 1e-9);
    assert_near(m->damping_ratio[k], 0.002, 0);
    assert_near(m->eigen_residual[k], s->modes.eigen_residual[k], 0);
  }
}

/* R, R2, R3 of contact, load and probe. Returns the greatest difference. */
static double check_terms(const scene *s) {
  const modal_model *m = &s->model, *i = &s->imaginary, *b = &s->backward;
  const int          nc     = s->to.contact.n;
  double            *R[][2] = {{m->residual_flexibility, i->residual_flexibility},
                               {m->residual_inertia, i->residual_inertia},
                               {m->residual_fourth, i->residual_fourth}};
  double            *P[][2] = {{m->probe_contact_residual, i->probe_contact_residual},
                               {m->probe_contact_inertia, i->probe_contact_inertia},
                               {m->probe_contact_fourth, i->probe_contact_fourth}};
  double complex    *L[][2] = {{m->load_residual, b->load_residual},
                               {m->load_inertia, b->load_inertia},
                               {m->load_fourth, b->load_fourth}};
  double complex    *Q[][2] = {{m->probe_load_residual, b->probe_load_residual},
                               {m->probe_load_inertia, b->probe_load_inertia},
                               {m->probe_load_fourth, b->probe_load_fourth}};
  double complex    *V = copy(s, nc, s->contact), *W = copy(s, s->to.load.dofs.n, s->load);
  double             worst = 0;
  for (int t = 0; t < TERMS; t++) {
    advance(s, t == 0, nc, V);
    advance(s, t == 0, s->to.load.dofs.n, W);
    worst = fmax(worst, off(s, nc, s->contact, nc, V, R[t][0], R[t][1]));
    worst = fmax(worst, off(s, 3, s->probe, nc, V, P[t][0], P[t][1]));
    worst = fmax(worst, load_off(s, nc, s->contact, W, L[t][0], L[t][1]));
    worst = fmax(worst, load_off(s, 3, s->probe, W, Q[t][0], Q[t][1]));
    for (int r = 0; r < nc; r++) /* Hermitian without rounding */
      for (int c = 0; c <= r; c++) {
        assert_true(R[t][0][r * nc + c] == R[t][0][c * nc + r]);
        assert_true(!R[t][1] || R[t][1][r * nc + c] == -R[t][1][c * nc + r]);
      }
  }
  free(V);
  free(W);
  return worst;
}

static void shapes_and_residual_terms(void **state) {
  for (int d = 1; d <= 2; d++) {
    scene s;
    make(*state, d, 2, false, &s);
    check_shapes(&s);
    const double worst = check_terms(&s);
    print_message("nodal diameter %d: residual terms off by %.1e\n", d, worst);
    assert_below(worst, 1e-9);
    drop(&s);
  }
}

/* Where the matrices are real nothing has an imaginary part, and both waves are one. */
static void real_waves_have_no_imaginary_parts(void **state) {
  for (int d = 0; d <= 3; d += 3) {
    scene s;
    make(*state, d, 2, false, &s);
    assert_null(s.imaginary.right);
    assert_null(s.imaginary.residual_flexibility);
    assert_null(s.backward.modal_force);
    check_shapes(&s);
    assert_below(check_terms(&s), 1e-9);
    drop(&s);
  }
}

/* A load in phase everywhere acts on both waves alike. */
static void a_real_load_has_no_backward_arrays(void **state) {
  scene s;
  make(*state, 1, 1, true, &s);
  assert_null(s.backward.modal_force);
  assert_null(s.backward.load_residual);
  assert_non_null(s.imaginary.right);
  check_shapes(&s);
  drop(&s);
}

/* b^H (K - w^2 M)^-1 b of two contact dofs by all modes of the dense pencil; at: w^2. */
static double complex exact(const scene *s, double at, int a, int b) {
  const int      n   = s->dense.n;
  double complex sum = 0;
  for (int k = 0; k < n; k++) {
    const double complex *phi = s->dense.phi + k * n;
    sum += inner(s, s->contact + a * n, phi) * inner(s, phi, s->contact + b * n) /
           (s->dense.lambda[k] - at);
  }
  return sum;
}

/* The same by the modes, terms and residual modes of the model. */
static double complex by_model(const scene *s, double at, int a, int b) {
  const modal_model *m = &s->model, *i = &s->imaginary;
  const int          ab = a * s->to.contact.n + b, r = m->n_residual;
  const double      *term[][2] = {{m->residual_flexibility, i->residual_flexibility},
                                  {m->residual_inertia, i->residual_inertia},
                                  {m->residual_fourth, i->residual_fourth}};
  double complex     sum       = 0;
  for (int t = 0; t < TERMS; t++) sum += pow(at, t) * CMPLX(term[t][0][ab], term[t][1][ab]);
  for (int k = 0; k < MODES; k++) {
    const double complex pa = CMPLX(m->right[a * MODES + k], i->right[a * MODES + k]);
    const double complex pb = CMPLX(m->right[b * MODES + k], i->right[b * MODES + k]);
    sum += pa * conj(pb) / (s->modes.lambda[k] - at);
  }
  for (int k = 0; k < r; k++) {
    const double         lambda = pow(SHB_TWO_PI * m->residual_frequency[k], 2);
    const double complex pa     = CMPLX(m->residual_shape[a * r + k], i->residual_shape[a * r + k]);
    const double complex pb     = CMPLX(m->residual_shape[b * r + k], i->residual_shape[b * r + k]);
    sum += pa * conj(pb) * pow(at / lambda, TERMS) / (lambda - at);
  }
  return sum;
}

/* Modes, terms and residual modes sum up to the receptance. What they leave out has the tail as its
 * first two terms, which are positive. */
static void the_receptance_is_that_of_the_sector(void **state) {
  scene s;
  make(*state, 1, 1, false, &s);
  const double       at    = 0.4 * s.dense.lambda[MODES - 1];
  const modal_model *m     = &s.model;
  double             worst = 0, most = 0;
  assert_true(m->n_residual > 0);
  assert_int_equal(m->tail_order, 2 * TERMS);
  for (int a = 0; a < 3; a++) /* of the right side */
    for (int b = 0; b < 3; b++) {
      const double complex wanted = exact(&s, at, a, b), left = wanted - by_model(&s, at, a, b);
      worst = fmax(worst, cabs(left));
      most  = fmax(most, cabs(wanted));
      if (a != b) continue;
      const double tail =
          pow(at, 2 * TERMS) * (m->contact_tail[2 * a] + at * m->contact_tail[2 * a + 1]);
      print_message("dof %d: %.2e left, its tail %.2e\n", a, creal(left), tail);
      assert_true(creal(left) > tail && creal(left) < 2 * tail);
    }
  print_message("%d residual modes: receptance off by %.1e\n", m->n_residual, worst / most);
  assert_below(worst / most, 1e-7);
  drop(&s);
}

/* 105 columns come in batches of 32, without residual modes; the tails are the next moments. */
static void many_columns_come_in_batches(void **state) {
  scene s;
  make(*state, 1, 17, false, &s);
  assert_int_equal(s.model.n_residual, 0);
  assert_int_equal(s.model.tail_order, TERMS);
  check_shapes(&s);
  const double worst = check_terms(&s);
  print_message("%d contact dofs: residual terms off by %.1e\n", s.to.contact.n, worst);
  assert_below(worst, 1e-9);
  for (int c = 0; c < s.to.contact.n; c += 5)
    for (int j = 0; j < 2; j++) { /* sum of |b^H phi|^2 / lambda^(4 + j) of the modes left out */
      double sum = 0;
      for (int k = MODES; k < s.dense.n; k++)
        sum += pow(cabs(inner(&s, s.contact + c * s.dense.n, s.dense.phi + k * s.dense.n)), 2) /
               pow(s.dense.lambda[k], 4 + j);
      assert_within(s.model.contact_tail[2 * c + j], sum, 1e-7);
    }
  drop(&s);
}

static void forces_are_spread_over_the_columns(void **state) {
  scene s;
  make(*state, 2, 1, false, &s);
  const size_t    n = (size_t)s.dense.n;
  double complex *X = random_complex(4 * n, 1);
  wave_spread(&s.op, &s.to.contact, 2, 3, 4, X);
  assert_below(complex_difference(3 * n, X, s.contact + 2 * n), 1e-15);
  for (size_t i = 3 * n; i < 4 * n; i++) assert_true(X[i] == 0);
  free(X);
  drop(&s);
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
      cmocka_unit_test(shapes_and_residual_terms),
      cmocka_unit_test(real_waves_have_no_imaginary_parts),
      cmocka_unit_test(a_real_load_has_no_backward_arrays),
      cmocka_unit_test(the_receptance_is_that_of_the_sector),
      cmocka_unit_test(many_columns_come_in_batches),
      cmocka_unit_test(forces_are_spread_over_the_columns),
  };
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failed;
}
