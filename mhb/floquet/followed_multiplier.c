#include "mhb/floquet/followed_multiplier.h"

#include <math.h>

/* The second eigenvalue of a real one counts for g within this of the circle. */
static const double MEETING = 0.1;

/* The distance of the nearest eigenvalue from the expected place, over that of the second, must be
 * below this. Within CERTAIN it is taken anyhow. */
static const double NEARER = 0.5, CERTAIN = 1e-3;

/* The nearest of x[n] to a place, but for two; -1: none. */
static int nearest(int n, const double complex *x, double complex to, int but, int but_too) {
  int best = -1;
  for (int i = 0; i < n; i++)
    if (i != but && i != but_too && (best < 0 || cabs(x[i] - to) < cabs(x[best] - to))) best = i;
  return best;
}

/* The conjugate of a complex x[i], else the real one nearest to x[i]; -1: none. */
static int partner(int n, const double complex *x, int i) {
  int best = -1;
  for (int j = 0; j < n; j++) {
    bool same_kind = (cimag(x[j]) == 0) == (cimag(x[i]) == 0);
    if (j == i || !same_kind) continue;
    if (best < 0 || cabs(x[j] - conj(x[i])) < cabs(x[best] - conj(x[i]))) best = j;
  }
  return best;
}

static void place_real(int n, const double complex *x, int sign, int segments,
                       mhb_multiplier_place *place) {
  int            a = nearest(n, x, sign, -1, -1), b = nearest(n, x, sign, a, -1);
  double complex e1   = sign * x[a] - 1;
  double complex e2   = b < 0 ? -1 : sign * x[b] - 1;
  place->g            = -segments * creal(e1 * e2) / fmax(cabs(e2), MEETING);
  place->lambda       = x[a];
  place->half_sum     = 0;
  place->discriminant = -1;
}

static void place_pair(int n, const double complex *x, int a, int segments,
                       mhb_multiplier_place *place) {
  int            b       = partner(n, x, a);
  double complex half    = b < 0 ? 0 : 0.5 * (x[a] - x[b]);
  double         product = b < 0 ? NAN : creal(x[a] * x[b]);
  place->g               = pow(product, 0.5 * segments) - 1;
  place->half_sum        = b < 0 ? NAN : 0.5 * creal(x[a] + x[b]);
  place->discriminant    = creal(half * half);
  place->lambda          = cimag(x[a]) < 0 ? conj(x[a]) : x[a];
}

static const char *place_nearest(int n, const double complex *x, bool real_problem,
                                 double complex near, int segments, mhb_multiplier_place *place) {
  int a = nearest(n, x, near, -1, -1);
  if (a < 0) return "there is no multiplier";
  int    other  = real_problem ? partner(n, x, a) : -1;
  int    second = nearest(n, x, near, a, other);
  double away   = cabs(x[a] - near);
  if (second >= 0 && away > CERTAIN && away > NEARER * cabs(x[second] - near))
    return "two multipliers are equally near";
  if (real_problem) {
    place_pair(n, x, a, segments, place);
  } else {
    place->g            = pow(cabs(x[a]), segments) - 1;
    place->half_sum     = 0;
    place->discriminant = -1;
    place->lambda       = x[a];
  }
  return isfinite(place->g) ? NULL : "the pair of multipliers has parted";
}

const char *mhb_followed_multiplier_find(mhb_floquet *floquet, const mhb_solution *solution,
                                         const mhb_followed_multiplier *followed,
                                         double complex near, mhb_multiplier_place *place) {
  int         n;
  const char *why = mhb_floquet_set_map(floquet, solution, followed->refinement, followed->keep);
  if (why) return why;
  const double complex *x = mhb_floquet_eigenvalues(floquet, followed->wave, &n);
  if (!x) return "the eigensolver failed";
  int segments = mhb_floquet_segments(floquet);
  if (followed->sign)
    place_real(n, x, followed->sign, segments, place);
  else
    why = place_nearest(n, x, mhb_floquet_is_real(floquet, followed->wave), near, segments, place);
  place->multiplier = mhb_floquet_multiplier(floquet, followed->wave, place->lambda);
  return why;
}

/* The largest eigenvalue of a wave whose multiplier is not on the positive axis; 0: none. */
static double complex largest_off_axis(mhb_floquet *floquet, int wave) {
  int                   n;
  double complex        best = 0;
  const double complex *x    = mhb_floquet_eigenvalues(floquet, wave, &n);
  for (int i = 0; x && i < n; i++) {
    double complex mu = mhb_floquet_multiplier(floquet, wave, x[i]);
    if ((cimag(mu) != 0 || creal(mu) < 0) && cabs(x[i]) > cabs(best)) best = x[i];
  }
  return best;
}

const char *mhb_followed_multiplier_choose(mhb_floquet *floquet, const mhb_solution *solution,
                                           bool flip, mhb_followed_multiplier *followed,
                                           mhb_multiplier_place *place) {
  mhb_multipliers m;
  double complex  lambda = 0;
  mhb_floquet_evaluate(floquet, solution, &m);
  if (m.reason) return m.reason;
  int refinement = mhb_floquet_refinement(floquet);
  if (refinement == 0) return "no contact slips, opens or closes";
  *followed       = (mhb_followed_multiplier){.refinement = refinement};
  const char *why = mhb_floquet_set_map(floquet, solution, refinement, false);
  if (why) return why;
  for (int l = 0; l < mhb_floquet_waves(floquet); l++) {
    double complex of_l = largest_off_axis(floquet, l);
    if (cabs(of_l) <= cabs(lambda)) continue;
    lambda         = of_l;
    followed->wave = l;
  }
  if (lambda == 0) return "all multipliers are on the positive axis";
  double complex mu   = mhb_floquet_multiplier(floquet, followed->wave, lambda);
  bool           real = mhb_floquet_is_real(floquet, followed->wave) && cimag(mu) == 0;
  if (real != flip) return flip ? "the strongest multiplier is complex" : "it is real";
  if (real) followed->sign = creal(lambda) < 0 ? -1 : 1;
  return mhb_followed_multiplier_find(floquet, solution, followed, lambda, place);
}
