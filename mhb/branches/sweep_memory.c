#include "mhb/branches/sweep_memory.h"

#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>

#include "mesh/base/memory.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/branch_stability.h"
#include "mhb/branches/lasting_motion.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/numerics/fourier.h"
#include "mhb/ring/lasting.h"
#include "modal/model/residual_series.h"

static const double real = sizeof(double), complex_number = sizeof(double complex);

/* Heap, plans and scratch of a thread that are no large arrays: chosen by the smallest sweeps of
 * test_sweep_memory. */
static const double A_THREAD = 5e6;

/* Evaluations of the contacts that a curve keeps: six points, the balance's own, the trial's. */
enum { EVALUATIONS = 8 };

/* Motion and force in three axes. A curve has so many points. */
enum { NUMBERS = 6, POINTS = 1000 };

mhb_sweep_size mhb_sweep_size_of(const modal_model *model, const mhb_settings *s) {
  const mhb_mistuned_ring *ring = s->ring;
  return (mhb_sweep_size){.pairs     = ring ? ring->n_pairs : model->n_pairs,
                          .harmonics = s->harmonics,
                          .blades    = ring ? ring->blades : 0,
                          .wave      = s->to_ground ? 1 : s->blades,
                          .modes     = ring ? ring->n_modes : model->n_modes,
                          .disc      = s->nodal_diameters != NULL,
                          .run_up    = s->run_up || s->disc_run_up,
                          .stability = mhb_judges_stability(s),
                          .lasting   = mhb_lasting_refusal(model, s) == NULL,
                          .points    = POINTS,
                          .sharing   = s->sharing > 1 ? s->sharing : 1};
}

static double square(double x) {
  return x * x;
}

/* Products of bases and derivatives of one contact by its motion, by far the largest arrays. */
static double evaluator(int m) {
  return 7 * real * square(mhb_real_size(m));
}

/* Derivatives of all contacts by their motion. */
static double derivatives(double contacts, int m) {
  return 9 * real * contacts * square(mhb_real_size(m));
}

/* Matrices of the harmonics 0 to m, of n rows. */
static double matrices(double n, int m) {
  return complex_number * square(n) * (m + 1);
}

/* The condensed matrix of all moving pairs. many: GMRES solves where it would be larger. */
static double dense(double unknowns, bool many) {
  return real * square(many ? fmin(unknowns, MHB_MOST_DENSE) : unknowns);
}

/* The balance with m harmonics and that with 2m, by which its truncation error is estimated. */
static double of_balance(const mhb_sweep_size *z) {
  const int    m = z->harmonics, top = mhb_truncation_highest(m);
  const bool   many = z->pairs >= MHB_MANY_PAIRS && !z->run_up;
  const double n = 3. * z->pairs, rows = n * mhb_real_size(m), twice = n * mhb_real_size(2 * m);
  const double kept  = EVALUATIONS * derivatives(z->pairs, m) + derivatives(z->pairs, 2 * m);
  const double solve = dense(rows, many) + dense(fmin(twice, MHB_MOST_DOUBLED), many);
  /* without GMRES the receptances are factored with the stuck pairs in them */
  const double stuck = z->run_up ? 2 * (matrices(n, m) + matrices(n, 2 * m)) : 0;
  const int    terms = 1 + (z->disc ? MODAL_TERMS : 0); /* the receptance and its residual terms */
  return kept + solve + stuck + evaluator(m) + 2 * evaluator(2 * m) +
         terms * (matrices(n, m) + matrices(n, top));
}

/* A ring's system is factored by blocks of a contact (mhb/numerics/block_cyclic). A row has a block
 * with the columns in common, and what is eliminated below. Beside it are the receptances of each
 * blade and contact, and one condensed by harmonics. */
static double ring_system(const mhb_sweep_size *z, int m) {
  enum { BLOCKS = 3 + 2, WORK = 6, BY_HARMONIC = 6 + 3 + 4 };
  const double N = z->blades, n = 3. * z->pairs, block = n * mhb_real_size(m);
  return real * square(block) * (BLOCKS * N + WORK) + N * BY_HARMONIC * matrices(n, m) +
         derivatives(N * z->pairs, m);
}

/* The system with 2m harmonics serves the truncation error. */
static double of_ring(const mhb_sweep_size *z) {
  const int    m        = z->harmonics;
  const double contacts = (double)z->blades * z->pairs;
  const double kept     = EVALUATIONS * derivatives(contacts, m) + derivatives(contacts, 2 * m);
  return ring_system(z, m) + ring_system(z, 2 * m) + kept + evaluator(m) + 2 * evaluator(2 * m);
}

double mhb_sweep_bytes(const mhb_sweep_size *z) {
  const double contacts = z->pairs * (z->blades ? z->blades : 1.);
  const double points   = complex_number * NUMBERS * z->points * contacts * (z->harmonics + 1.);
  const bool   mistuned = z->blades > 0;
  const double floquet  = z->stability ? mhb_branch_floquet_bytes(mistuned ? z->blades : z->wave,
                                                                 z->pairs, z->modes, mistuned)
                                       : 0;
  const double sweep    = (z->blades ? of_ring(z) : of_balance(z)) + floquet;
  const double after =
      z->lasting ? mhb_lasting_bytes(mistuned ? z->blades : z->wave, z->pairs, z->modes, mistuned)
                 : 0;
  return fmax(sweep, after) + points + A_THREAD;
}

/* ---- what fits ---- */

static double bytes_of_all(const void *size) {
  const mhb_sweep_size *z = size;
  return z->sharing * mhb_sweep_bytes(z);
}

static shb_status refuse(const mhb_sweep_size *size, double left) {
  mhb_sweep_size          z        = *size;
  const shb_memory_number number[] = {{"mhb.harmonics", &z.harmonics, 1},
                                      {"contact.points", &z.pairs, 1},
                                      {"rotor.blades", &z.blades, 2},
                                      {"processes", &z.sharing, 1}};
  char                    ring[32] = "", what[160];
  if (z.blades) snprintf(ring, sizeof ring, "%d different blades, ", z.blades);
  snprintf(what, sizeof what, "the balance with %s%d contact point%s and %d harmonics", ring,
           z.pairs, z.pairs == 1 ? "" : "s", z.harmonics);
  return shb_memory_refuse(
      &(shb_memory_need){what, bytes_of_all, &z, 4, number, left, size->sharing});
}

shb_status mhb_sweep_fits(const mhb_sweep_size *size) {
  const double left = shb_memory_available();
  return bytes_of_all(size) > left ? refuse(size, left) : SHB_OK;
}

shb_status mhb_sweep_threads(const modal_model *model, const mhb_settings *settings, int *threads) {
  const mhb_sweep_size size = mhb_sweep_size_of(model, settings);
  const double         all = bytes_of_all(&size), left = shb_memory_available();
  *threads = omp_get_max_threads();
  if (all > left) return refuse(&size, left);
  if (left < all * *threads) *threads = (int)(left / all);
  return SHB_OK;
}
