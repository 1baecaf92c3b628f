#include "contact_faces.h"

#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/first_solution.h"
#include "modal/model/model.h"

enum { MOST_POINTS = 2000, DENSE_POINTS = 3, MOST_DENSE = 4000, MOST_FILES = 8 };

typedef struct {
  int    pairs, points, moving;
  double ms, estimate; /* mean of the moving points: step, truncation estimate */
  double iterations;   /* of GMRES, mean of the last solutions */
  double newton;       /* corrections, mean */
  double residual;     /* worst */
  double peak, at;     /* m, Hz: first harmonic of the face, mean over the pairs */
  double first;        /* s until the first solution */
  double dense;        /* ms a point; 0: not run */
  double apart;        /* of the tangents by both, relative */
  int    size, smooth; /* coefficients of the basis; columns of U */
} face_row;

static double processor_ms(void) {
  return 1e3 * shb_processor_seconds();
}

mhb_settings contact_faces_settings(void) {
  return (mhb_settings){.blades       = 40,
                        .engine_order = 5,
                        .mu           = .3,
                        .kv           = .8e6,
                        .ku           = {.5e6, 0, .5e6},
                        .n_preloads   = 1,
                        .n0           = {100},
                        .frequency    = {200, 262},
                        .harmonics    = 7,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8,
                        .max_points   = MOST_POINTS};
}

static double mean_motion(const mhb_balance *b, const double *x) {
  double sum = 0;
  for (int a = 0; a < b->n_pairs; a++) {
    const double *u = x + (size_t)(3 * a + 1) * (size_t)b->nb;
    sum += b->receptance->share[a] * hypot(u[1], u[2]);
  }
  return sum;
}

static int any_moves(const mhb_balance *b, const mhb_evaluation *e) {
  for (int a = 0; a < b->n_pairs; a++)
    if (e->kind[a] == MHB_PAIR_NONLINEAR) return 1;
  return 0;
}

/* The same steps by the dense solver, which forms R. */
static void walk_dense(mhb_arclength *path, mhb_truncation *truncation, face_row *row) {
  mhb_balance      *b       = mhb_curve_balance(path);
  mhb_condensation *system  = mhb_balance_curve_of(path)->newton->system;
  mhb_condensation *doubled = truncation->system;
  mhb_woodbury     *kept[2] = {system->low_rank, doubled->low_rank};
  double            ms      = 0;
  int               steps   = 0;
  system->low_rank = doubled->low_rank = NULL;
  path->step                           = .02;
  for (; steps < DENSE_POINTS; steps++) {
    double started = processor_ms();
    if (mhb_arclength_step(path) != MHB_ARCLENGTH_ON) break;
    mhb_balance_use(b, path->next.evaluation);
    mhb_truncation_error(truncation, path->next.x);
    ms += processor_ms() - started;
    mhb_arclength_advance(path);
  }
  row->dense        = steps ? ms / steps : 0;
  system->low_rank  = kept[0];
  doubled->low_rank = kept[1];
}

/* Largest difference of both solvers' Newton steps at a point. */
static void compare(mhb_arclength *path, face_row *row) {
  mhb_balance      *b      = mhb_curve_balance(path);
  mhb_condensation *system = mhb_balance_curve_of(path)->newton->system;
  mhb_woodbury     *kept   = system->low_rank;
  size_t            n      = (size_t)b->n;
  double *one = calloc(2 * n, sizeof(double)), *other = one + n, accuracy = system->accuracy;
  if (!one) return;
  mhb_balance_use(b, path->current.evaluation);
  memcpy(one, path->current.slope, sizeof(double) * n);
  memcpy(other, one, sizeof(double) * n);
  system->accuracy = 1e-14;
  int ok = mhb_condensation_factor(system, NULL, NULL) && mhb_condensation_solve(system, one);
  system->low_rank = NULL;
  ok = ok && mhb_condensation_factor(system, NULL, NULL) && mhb_condensation_solve(system, other);
  system->low_rank = kept;
  system->accuracy = accuracy;
  double length    = mhb_norm(other, b->n);
  for (size_t i = 0; i < n; i++) one[i] -= other[i];
  row->apart = ok ? mhb_norm(one, b->n) / length : NAN;
  free(one);
}

static shb_status walk(mhb_arclength *path, mhb_truncation *truncation, face_row *row) {
  mhb_balance *b = mhb_curve_balance(path);
  for (int outcome = MHB_ARCLENGTH_ON; outcome == MHB_ARCLENGTH_ON && row->points < MOST_POINTS;
       row->points++) {
    double started = processor_ms();
    outcome        = (int)mhb_arclength_step(path);
    SHB_CHECK(outcome != MHB_ARCLENGTH_STALLED, SHB_NOT_CONVERGED, "the path of %d pairs was lost",
              b->n_pairs);
    double stepped = processor_ms();
    mhb_balance_use(b, path->next.evaluation);
    mhb_truncation_error(truncation, path->next.x);
    double ended  = processor_ms();
    row->residual = fmax(row->residual, path->next.residual);
    double motion = mean_motion(b, path->next.x);
    if (motion > row->peak) {
      row->peak = motion;
      row->at   = path->next.value / SHB_TWO_PI;
    }
    if (any_moves(b, path->next.evaluation)) {
      const mhb_woodbury *w = mhb_balance_curve_of(path)->newton->system->low_rank;
      row->moving++;
      row->ms += stepped - started;
      row->estimate += ended - stepped;
      row->newton += path->next.iterations;
      row->iterations += w ? w->iterations : 0;
      row->size = w && w->basis ? w->basis->size : 0;
    }
    mhb_arclength_advance(path);
    if (row->dense == 0 && row->moving == 10 && b->n <= MOST_DENSE) {
      compare(path, row);
      walk_dense(path, truncation, row);
    }
  }
  int moving = row->moving > 0 ? row->moving : 1;
  row->ms /= moving;
  row->estimate /= moving;
  row->newton /= moving;
  row->iterations /= moving;
  return SHB_OK;
}

/* The model keeps no residual matrices, as in a sweep without motions that last. */
static shb_status read_face(const char *file, modal_model *model, mhb_settings *s,
                            mhb_receptance **alike) {
  SHB_TRY(modal_model_read(file, model));
  SHB_TRY(mhb_receptance_create(model, s, 0, alike));
  s->alike = *alike;
  modal_model_release_terms(model, 0);
  return SHB_OK;
}

static shb_status run_face(const char *file, face_row *row) {
  modal_model     model;
  mhb_receptance *alike = NULL;
  mhb_settings    s     = contact_faces_settings();
  mhb_balance    *b;
  mhb_arclength  *path;
  mhb_truncation *truncation;
  int             iterations;
  double          low = SHB_TWO_PI * s.frequency[0], started = processor_ms();
  omp_set_num_threads(1); /* processor time of one thread */
  openblas_set_num_threads(1);
  shb_memory_map_large(); /* as the program does */
  SHB_TRY(read_face(file, &model, &s, &alike));
  SHB_TRY(mhb_balance_create(&model, &s, &b));
  mhb_balance_set_preload(b, s.n0[0]);
  path = mhb_balance_curve_create(b, low, SHB_TWO_PI * s.frequency[1]);
  SHB_TRY(mhb_truncation_create(b, &truncation));
  *row      = (face_row){.pairs = b->n_pairs};
  double *x = calloc((size_t)b->n, sizeof(double));
  SHB_CHECK(mhb_first_solution(mhb_balance_curve_of(path)->newton, b, low, path->tolerance, x,
                               &iterations) == MHB_CONVERGED &&
                mhb_arclength_start(path, x, low, 1) == MHB_CONVERGED,
            SHB_NOT_CONVERGED, "no first solution of %d pairs", b->n_pairs);
  row->smooth       = b->product ? b->product->n_smooth : 0;
  row->first        = 1e-3 * (processor_ms() - started);
  shb_status status = walk(path, truncation, row);
  free(x);
  mhb_truncation_destroy(truncation);
  mhb_arclength_destroy(path);
  mhb_balance_destroy(b);
  mhb_receptance_destroy(alike);
  modal_model_free(&model);
  return status;
}

static shb_status run(const void *file, void *row) {
  return run_face(file, row);
}

/* Goal, ms a point with the estimate. */
static double goal_of(int pairs) {
  return pairs <= 22 ? 7 : pairs <= 84 ? 25 : pairs <= 237 ? 75 : 200;
}

shb_status bench_contact_faces(char **files, int n, int *failed) {
  face_row row[MOST_FILES] = {{0}};
  printf("\n%5s %6s %6s %8s %8s %8s %6s %6s %5s %6s %6s %8s %8s %9s %8s %9s %8s\n", "pairs",
         "points", "moving", "step ms", "estim ms", "ms/point", "goal", "newton", "GMRES", "basis",
         "smooth", "first s", "MB", "residual", "dense ms", "peak um", "apart");
  for (int i = 0; i < n && i < MOST_FILES; i++) {
    double megabytes = 0, all;
    SHB_TRY(bench_in_child(files[i], run, files[i], &row[i], sizeof row[i], &megabytes));
    const face_row *r = &row[i];
    all               = r->ms + r->estimate;
    printf(
        "%5d %6d %6d %8.2f %8.2f %8.2f %6.0f %6.2f %5.1f %6d %6d %8.2f %8.0f %9.1e %8.1f %9.4f "
        "%8.1e"
        " %s\n",
        r->pairs, r->points, r->moving, r->ms, r->estimate, all, goal_of(r->pairs), r->newton,
        r->iterations, r->size, r->smooth, r->first, megabytes, r->residual, r->dense,
        1e6 * r->peak, r->apart, all <= goal_of(r->pairs) ? "PASS" : "FAIL");
    fflush(stdout);
    *failed += !(r->residual <= 1e-8) || r->apart > 1e-11;
  }
  if (n > 1) {
    const face_row *a = &row[0], *z = &row[n - 1];
    printf("ms a point ~ pairs^%.2f\n",
           log((z->ms + z->estimate) / (a->ms + a->estimate)) / log((double)z->pairs / a->pairs));
  }
  return SHB_OK;
}
