#include "mhb/branches/sweep_memory.h"

#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>

#include "mesh/base/memory.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/branch_stability.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/numerics/fourier.h"
#include "modal/model/residual_series.h"

static const double real = sizeof(double), complex_number = sizeof(double complex), giga = 1e9;

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

/* A ring's system is factored by blocks of a contact (mhb/numerics/block_cyclic). A row has three
 * blocks, their factors with the columns in common, and what is eliminated below. Beside it are the
 * receptances of each blade and contact, and one condensed by harmonics. */
static double ring_system(const mhb_sweep_size *z, int m) {
  enum { BLOCKS = 3 + 3 + 2, WORK = 6, BY_HARMONIC = 6 + 3 + 4 };
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
  return (z->blades ? of_ring(z) : of_balance(z)) + points + floquet;
}

/* ---- what fits ---- */

/* The largest number up to *number, a member of size, with which size fits; 0: none. */
static int fits(mhb_sweep_size *size, int *number, double left) {
  const int all = *number;
  int       low = 0, high = all; /* low fits, or is 0; bytes grow with the number */
  while (low < high) {
    *number = (low + high + 1) / 2;
    if (mhb_sweep_bytes(size) <= left)
      low = *number;
    else
      high = *number - 1;
  }
  *number = all;
  return low;
}

static shb_status refuse(mhb_sweep_size z, double left) {
  const double             needed   = mhb_sweep_bytes(&z);
  const int                number[] = {fits(&z, &z.harmonics, left), fits(&z, &z.pairs, left),
                                       fits(&z, &z.blades, left)};
  static const char *const key[]    = {"mhb.harmonics", "contact.points", "rotor.blades"};
  char                     fit[160] = "", ring[32] = "", workers[64] = "";
  int                      length = 0;
  for (int i = 0; i < 3; i++)
    if (number[i] > (i == 2 ? 1 : 0))
      length += snprintf(fit + length, sizeof fit - (size_t)length, "%s %s: %d fits",
                         length ? ", or" : ";", key[i], number[i]);
  if (z.blades) snprintf(ring, sizeof ring, "%d different blades, ", z.blades);
  if (z.sharing > 1) snprintf(workers, sizeof workers, " for each of %d processes", z.sharing);
  SHB_FAIL(
      SHB_ERR_INPUT,
      "the balance with %s%d contact point%s and %d harmonics needs about %.3g GB more memory, "
      "and %.3g GB are left%s%s",
      ring, z.pairs, z.pairs == 1 ? "" : "s", z.harmonics, needed / giga, left / giga, workers,
      fit);
}

shb_status mhb_sweep_threads(const modal_model *model, const mhb_settings *settings, int *threads) {
  const mhb_sweep_size size = mhb_sweep_size_of(model, settings);
  const double         each = mhb_sweep_bytes(&size), left = shb_memory_available() / size.sharing;
  *threads = omp_get_max_threads();
  if (each > left) return refuse(size, left);
  if (left < each * *threads) *threads = (int)(left / each);
  return SHB_OK;
}
