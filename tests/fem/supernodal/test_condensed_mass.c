/* The condensed mass of a subtree: against dense Schur complements. */
#include "fem/supernodal/condensed_mass.h"

#include <cblas.h>
#include <lapacke.h>

#include "tests/support/block_body.h"
#include "tests/support/check.h"

enum { MODES = 3, LOADS = 40 };

/* A body as the module takes it. The modes are any vectors. */
typedef struct {
  block_body      of;
  fem_loaded_body body;
  int            *below, *node, *entry, *load;
  double         *phi, *weight; /* [n][MODES] */
  int             asked, most;  /* calls of go_on, and how many of them it allows */
} scene;

static bool go_on(void *context, double share) {
  scene *s = context;
  assert_true(share >= 0 && share < 1);
  return ++s->asked <= s->most;
}

/* First panel of each subtree that is a range; -1: none. */
static void find_ranges(scene *s) {
  const block_factor *f    = &s->of.f;
  const int           n    = f->panels.n_panels;
  int                *size = malloc(((size_t)n + 1) * sizeof *size);
  for (int k = 0; k < n; k++) size[k] = 1, s->below[k] = k;
  for (int k = 0; k < n; k++) {
    const fem_panel *p = &f->panels.panel[k];
    if (p->rows == p->columns) continue;
    const int up = f->owner[block_factor_row(f, k, p->columns)];
    size[up] += size[k];
    if (s->below[k] < s->below[up]) s->below[up] = s->below[k];
  }
  for (int k = 0; k < n; k++)
    if (k - s->below[k] + 1 != size[k]) s->below[k] = -1;
  free(size);
}

/* Entries of the loads by rows of the factor. */
static void sort_entries(scene *s) {
  const block_body *b  = &s->of;
  int               at = 0;
  for (int r = 0; r < b->f.n; r++) {
    s->entry[r] = at;
    for (int c = 0; c < LOADS; c++)
      for (int e = b->load_start[c]; e < b->load_start[c + 1]; e++) {
        if (b->f.row[b->dof[e]] != r) continue;
        s->load[at]     = c;
        s->weight[at++] = b->weight[e];
      }
  }
  s->entry[b->f.n] = at;
}

static scene *make(block_grid grid) {
  scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  block_body_make(grid, LOADS, &s->of);
  const size_t n = (size_t)s->of.f.n, entries = (size_t)s->of.load_start[LOADS];
  uint64_t     seed = 61;
  s->below          = malloc(((size_t)s->of.f.panels.n_panels + 1) * sizeof(int));
  s->node           = malloc((n / 3 + 1) * sizeof(int));
  s->entry          = malloc((n + 1) * sizeof(int));
  s->load           = malloc((entries + 1) * sizeof(int));
  s->weight         = malloc((entries + 1) * sizeof(double));
  s->phi            = malloc((n * MODES + 1) * sizeof(double));
  assert_true(s->below && s->node && s->entry && s->load && s->weight && s->phi);
  for (size_t i = 0; i < n * MODES; i++) s->phi[i] = block_random(&seed);
  for (size_t i = 0; i < n / 3; i++) s->node[s->of.f.place[i]] = (int)i;
  find_ranges(s);
  sort_entries(s);
  s->most = 1 << 30;
  s->body = (fem_loaded_body){.panels  = &s->of.f.panels,
                              .value   = s->of.f.value,
                              .owner   = s->of.f.owner,
                              .below   = s->below,
                              .place   = s->of.f.place,
                              .node    = s->node,
                              .start   = s->of.start,
                              .column  = s->of.column,
                              .mass    = s->of.mass,
                              .modes   = MODES,
                              .phi     = s->phi,
                              .n_loads = LOADS,
                              .entry   = s->entry,
                              .load    = s->load,
                              .weight  = s->weight,
                              .go_on   = go_on,
                              .context = s};
  return s;
}

static void drop(scene *s) {
  block_body_free(&s->of);
  free(s->below);
  free(s->node);
  free(s->entry);
  free(s->load);
  free(s->weight);
  free(s->phi);
  free(s);
}

/* ------------------------------------------------------------------ dense */

/* A subtree's rows S are first .. end - 1. */
typedef struct {
  int     first, own; /* own: their number */
  double *E;          /* [size][own] motion of the rows by coordinates, modes taken off */
  double *KB;         /* [beyond][own] K_SB by columns */
  double *b;          /* [loads][own] */
  double *x;          /* [loads][own] K_SS^-1 b */
} dense;

static void copy_rows(const double *from, int first, int own, double *to) {
  memcpy(to, from + first, (size_t)own * sizeof *to);
}

/* E = [-K_SS^-1 K_SB, K_SS^-1 b, -K_SS^-1 K_SB phi_B - phi_S]. */
static dense solve_dense(const scene *s, int root, const fem_condensed *c) {
  const fem_panel *p = s->of.f.panels.panel;
  const size_t     n = (size_t)s->of.f.n;
  dense            d = {.first = p[s->below[root]].first};
  d.own              = p[root].first + p[root].columns - d.first;
  const size_t own = (size_t)d.own, b = (size_t)c->beyond, l = (size_t)c->loads;
  double      *KSS = malloc(own * own * sizeof *KSS);
  d.E              = calloc((size_t)c->size * own, sizeof *d.E);
  d.KB             = malloc(b * own * sizeof *d.KB);
  d.b              = malloc((l * own + 1) * sizeof *d.b);
  assert_true(KSS && d.E && d.KB && d.b);
  for (size_t j = 0; j < own; j++)
    copy_rows(s->of.K + ((size_t)d.first + j) * n, d.first, d.own, KSS + j * own);
  for (size_t i = 0; i < b; i++)
    copy_rows(s->of.K + (size_t)c->row[i] * n, d.first, d.own, d.KB + i * own);
  for (size_t i = 0; i < l; i++)
    copy_rows(s->of.b + (size_t)c->load[i] * n, d.first, d.own, d.b + i * own);
  memcpy(d.E, d.KB, b * own * sizeof *d.E);
  memcpy(d.E + b * own, d.b, l * own * sizeof *d.E);
  assert_int_equal(
      LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', d.own, (int)(b + l), KSS, d.own, d.E, d.own), 0);
  cblas_dscal((int)(b * own), -1, d.E, 1);
  d.x = d.E + b * own;
  for (size_t m = 0; m < MODES; m++) {
    double *e = d.E + (b + l + m) * own;
    for (size_t i = 0; i < b; i++)
      cblas_daxpy(d.own, s->phi[(size_t)c->row[i] * MODES + m], d.E + i * own, 1, e, 1);
    for (size_t r = 0; r < own; r++) e[r] -= s->phi[((size_t)d.first + r) * MODES + m];
  }
  free(KSS);
  return d;
}

static void free_dense(dense *d) {
  free(d->E);
  free(d->KB);
  free(d->b);
}

/* Q = E^T M_SS E + E^T M_SB P + P^T M_BS E, P the coordinates of the rows beyond. To be freed. */
static double *dense_mass(const scene *s, const fem_condensed *c, const dense *d) {
  const size_t own = (size_t)d->own, n = (size_t)s->of.f.n, size = (size_t)c->size;
  double      *Q = calloc(size * size, sizeof *Q), *Z = malloc(size * own * sizeof *Z);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, d->own, c->size, d->own, 1,
              s->of.M + (size_t)d->first * (n + 1), s->of.f.n, d->E, d->own, 0, Z, d->own);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, c->size, c->size, d->own, 1, d->E, d->own, Z,
              d->own, 0, Q, c->size);
  for (size_t i = 0; i < (size_t)c->beyond; i++)
    for (size_t j = 0; j < size; j++) {
      const double *M   = s->of.M + (size_t)c->row[i] * n + (size_t)d->first;
      const double  sum = cblas_ddot(d->own, M, 1, d->E + j * own, 1);
      Q[i * size + j] += sum;
      Q[j * size + i] += sum;
    }
  free(Z);
  return Q;
}

/* ------------------------------------------------------------------ tests */

/* The matrices of the subtree below a panel; NULL where go_on stops it. */
static fem_condensed *condense(scene *s, int root) {
  size_t         most;
  fem_condensed *c = fem_condensed_create(&s->body, root, &most);
  assert_non_null(c);
  double *stack = malloc((most + 1) * sizeof *stack);
  stack[most]   = 2.385; /* a mark beyond */
  if (!fem_condense(&s->body, root, stack, c)) {
    fem_condensed_free(c);
    c = NULL;
  }
  assert_true(stack[most] == 2.385);
  free(stack);
  return c;
}

static void check_coordinates(const scene *s, int root, const fem_condensed *c, const dense *d) {
  const fem_panel *p    = &s->of.f.panels.panel[root];
  int              seen = 0;
  assert_int_equal(c->beyond, p->rows - p->columns);
  for (int i = 0; i < c->beyond; i++)
    assert_int_equal(c->row[i], block_factor_row(&s->of.f, root, p->columns + i));
  for (int k = 0; k < LOADS; k++) { /* each load with an entry in the subtree, in order */
    bool in = false;
    for (int e = s->entry[d->first]; e < s->entry[d->first + d->own]; e++)
      in = in || s->load[e] == k;
    if (in) assert_int_equal(c->load[seen++], k);
  }
  assert_int_equal(seen, c->loads);
  assert_int_equal(c->size, c->beyond + c->loads + MODES);
}

/* U = -K_BS K_SS^-1 b and F = b^T K_SS^-1 b. Returns the greatest difference. */
static double flexibility_error(const fem_condensed *c, const dense *d) {
  double worst = 0;
  for (int j = 0; j < c->loads; j++) {
    const double *x = d->x + (size_t)j * (size_t)d->own;
    for (int i = 0; i < c->beyond; i++)
      worst = fmax(worst, fabs(c->U[i * c->loads + j] +
                               cblas_ddot(d->own, d->KB + (size_t)i * (size_t)d->own, 1, x, 1)));
    for (int i = 0; i < c->loads; i++)
      worst = fmax(worst, fabs(c->F[i * c->loads + j] -
                               cblas_ddot(d->own, d->b + (size_t)i * (size_t)d->own, 1, x, 1)));
  }
  return worst;
}

static double mass_error(const fem_condensed *c, const double *Q) {
  double worst = 0;
  for (int j = 0; j < c->size; j++)
    for (int i = j; i < c->size; i++)
      worst = fmax(worst, fabs(fem_lower_column(&c->Q, j)[i] - Q[i * c->size + j]));
  return worst;
}

/* Returns the number of rows of the subtree. */
static int check(scene *s, int root) {
  fem_condensed *c = condense(s, root);
  assert_non_null(c);
  dense   d = solve_dense(s, root, c);
  double *Q = dense_mass(s, c, &d);
  check_coordinates(s, root, c, &d);
  const double flexibility = flexibility_error(c, &d), mass = mass_error(c, Q);
  print_message("%d rows, %d beyond, %d loads: flexibility %.1e, mass %.1e\n", d.own, c->beyond,
                c->loads, flexibility, mass);
  assert_below(flexibility, 1e-14);
  assert_below(mass, 1e-12);
  const int own = d.own;
  free(Q);
  free_dense(&d);
  fem_condensed_free(c);
  return own;
}

/* Small subtrees are one step; that of a panel near the root has many. */
static void subtrees_of_a_body(void **state) {
  (void)state;
  scene *s    = make(block_grid_make((const int[]){15, 4, 3}, 1, 1));
  int    most = 0, checked = 0;
  for (int k = 0; k < s->of.f.panels.n_panels; k++) {
    const fem_panel *p = &s->of.f.panels.panel[k];
    const int        rows =
        s->below[k] < 0 ? 0 : p->first + p->columns - s->of.f.panels.panel[s->below[k]].first;
    if (rows == 0 || p->rows == p->columns || (k % 7 != 3 && rows < 250)) continue;
    const int own = check(s, k);
    if (own > most) most = own;
    checked++;
  }
  assert_true(checked > 3 && most > 400);
  drop(s);
}

/* Panels of one supernode: each step goes on with the arrays of the one before. */
static void panels_of_one_supernode(void **state) {
  (void)state;
  scene *s = make(block_grid_line(170, 170, false));
  assert_int_equal(s->of.f.panels.n_panels, 5);
  for (int k = 0; k < 4; k++) assert_int_equal(check(s, k), 120 * (k + 1));
  drop(s);
}

/* Without loads and modes only the motion of the rows beyond is left. */
static void a_body_without_loads_and_modes(void **state) {
  (void)state;
  scene *s         = make(block_grid_make((const int[]){9, 3, 2}, 1, 1));
  s->body.modes    = 0;
  int *none        = calloc((size_t)s->of.f.n + 1, sizeof *none);
  s->body.entry    = none;
  const int      k = s->of.f.panels.n_panels - 2;
  fem_condensed *c = condense(s, k);
  assert_non_null(c);
  assert_int_equal(c->loads, 0);
  assert_int_equal(c->size, c->beyond);
  dense d =
      solve_dense(s, k, &(fem_condensed){c->beyond, 0, c->beyond + MODES, c->row, 0, c->Q, 0, 0});
  double *Q = dense_mass(s, c, &d);
  assert_below(mass_error(c, Q), 1e-12);
  free(Q);
  free_dense(&d);
  fem_condensed_free(c);
  free(none);
  drop(s);
}

/* go_on is asked before each step; no memory is lost when it stops one. */
static void it_stops_when_asked_to(void **state) {
  (void)state;
  scene *s    = make(block_grid_make((const int[]){15, 4, 3}, 1, 1));
  int    root = s->of.f.panels.n_panels - 1;
  while (s->below[root] != 0 ||
         s->of.f.panels.panel[root].rows == s->of.f.panels.panel[root].columns)
    root--;
  fem_condensed_free(condense(s, root));
  const int steps = s->asked;
  print_message("%d steps\n", steps);
  assert_true(steps > 2);
  for (s->most = 0; s->most < steps; s->most++) {
    s->asked = 0;
    assert_null(condense(s, root));
    assert_int_equal(s->asked, s->most + 1);
  }
  fem_condensed_free(NULL);
  drop(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(subtrees_of_a_body),
      cmocka_unit_test(panels_of_one_supernode),
      cmocka_unit_test(a_body_without_loads_and_modes),
      cmocka_unit_test(it_stops_when_asked_to),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
