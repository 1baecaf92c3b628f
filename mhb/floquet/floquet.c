#include "mhb/floquet/floquet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/arena.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/floquet/bloch.h"
#include "mhb/floquet/linear_exponents.h"

static const double MARGIN = 1e-3;

/* Sub-steps are halved until the largest multiplier changes by less than DISTANCE times its
 * distance from 1. The change must also be below ROUGH at the first comparison, below FINE later.
 * The first comparison is with a result of lower order. FINEST: refinement of half the sub-steps in
 * the settings. */
static const double DISTANCE = 0.5, ROUGH = 2e-2, FINE = 1e-3;

/* A mode counts for the first sub-steps if contacts raise its squared frequency by this share.
 * CYCLE: sub-steps a cycle of the fastest such mode. */
static const double SHIFTED = 0.1, CYCLE = 3;
enum { MAX_STATES = 600, FINEST = 32 };

/* Of a ring of many cells more modes are integrated, up to REACH times the highest frequency. With
 * more the largest multipliers of 237 points of the example of 40 blades change by 3e-3.
 *
 * The lowest mode that answers statically is at least STATIC times as fast as the excitation, or
 * the multipliers are not judged. With a mode at 2.12 times left out, of six, the largest
 * multiplier is 2e-4 off (tests/mhb/floquet/test_floquet.c). A ring of 96 blades
 * with EO 88 has 0.94 with one mode of twelve, where the next one lies below the excitation. It has
 * 1.004 with two, 1.025 with four, 1.074 with seven and 1.066 with all. */
static const double REACH = 5, STATIC = 2;

/* Contacts from which on stuck ones are springs of the structure. Measured, see
 * docs/theory/stability.md. */
enum { CONDENSED = 8 };

struct mhb_floquet {
  mhb_modal_structure     structure; /* all modes */
  mhb_modal_structure     reduced;   /* those that are integrated */
  mhb_transition_schedule schedule;
  mhb_linear_exponents    exponents;
  mhb_contact_evaluator  *contact;
  mhb_monodromy          *monodromy; /* NULL: too many states even with one mode */
  mhb_bloch               bloch;
  double                 *coarse; /* the matrix of twice the sub-step */
  int             refinement;     /* of the finer one in the last evaluation; 0: none was used */
  int             nu, max_states;
  double          highest;    /* rad/s, of the excitation */
  double          statical;   /* rad/s, the lowest mode without dynamics; INFINITY: all have */
  int            *state;      /* [pair] */
  double complex *multiplier; /* [states] */
  double complex *kept;       /* [states] while those of another solution are computed */
  shb_arena       arena;      /* of coarse too, which changes places with the monodromy's M */
};

/* Number of modes a blade within max_states. */
static int affordable(int blades, int contacts, int modes, int max_states) {
  const int left = max_states - 2 * contacts, most = left > 0 ? left / (2 * blades) : 0;
  return most < modes ? most : modes;
}

/* The lowest frequency of a mode over all blades or nodal diameters, rad/s. */
static double frequency_of(const mhb_modal_structure *all, int mode) {
  const mhb_disc_modes *disc  = all->disc;
  const int             sets  = disc ? disc->diameters : all->mistuned ? all->blades : 1;
  double                least = INFINITY;
  for (int i = 0; i < sets; i++)
    least = fmin(least, (disc ? disc->omega : all->omega)[i * all->modes + mode]);
  return least;
}

/* The map is [states][states of a cell]: with more cells it has room for more modes. */
static int modes_of(const mhb_floquet *s) {
  const mhb_modal_structure *all  = &s->structure;
  const int                  more = (int)(s->max_states * sqrt(mhb_floquet_cells(s)));
  const int least = affordable(all->blades, all->contacts, all->modes, s->max_states);
  const int most  = affordable(all->blades, all->contacts, all->modes, more);
  int       kept  = least;
  while (kept < most && frequency_of(all, kept) <= REACH * s->highest) kept++;
  return kept;
}

static void note_statical(mhb_floquet *s) {
  const int kept = s->monodromy ? s->reduced.modes : 0;
  s->statical    = kept < s->structure.modes ? frequency_of(&s->structure, kept) : INFINITY;
}

/* Solvers of the map: M, coarse, and those of the Bloch problems (bloch.c). */
static double map_bytes(double states) {
  enum { REAL_ONES = 3, COMPLEX_ONES = 2 };
  return states * states * (REAL_ONES * sizeof(double) + COMPLEX_ONES * sizeof(double complex));
}

double mhb_floquet_bytes(int blades, int pairs, int modes, bool mistuned, int max_states) {
  enum { FULL = 3, BANDS = 2, SAMPLES = 4 * 128 }; /* start, compliance, flexibility */
  const double real = sizeof(double), contacts = (double)blades * pairs, n = 3 * contacts;
  const int    kept   = affordable(blades, blades * pairs, modes, max_states);
  const double states = kept > 0 ? 2. * kept * blades + 2 * contacts : 0;
  const double rows = 2. * kept * blades + 8 * contacts, width = fmin(n, 9. * 3 * pairs);
  const double linear = mistuned && kept > 0 ? (double)kept * blades : modes;
  const double given = mistuned ? n : 3. * pairs, number = mistuned ? real : 2 * real;
  const double constant_states = number * (4 * linear * linear + given * (2 * given + 2 * linear));
  double       bytes           = constant_states + (mistuned ? real * n * n : 0);
  if (kept > 0)
    bytes += map_bytes(states) + real * (rows * states + FULL * n * n + BANDS * n * width) +
             contacts * SAMPLES * sizeof(mhb_contact_sample);
  return bytes;
}

static bool is_condensed(const mhb_modal_structure *s) {
  return s->sides == 1 && s->blades == 1 && !s->disc && s->pairs >= CONDENSED;
}

static shb_status fill(mhb_floquet *s, const mhb_receptance *receptance,
                       const mhb_settings *settings, int substeps) {
  SHB_TRY(mhb_modal_structure_create(receptance, settings, receptance->n_modes,
                                     settings->ring ? MHB_STRUCTURE_WHOLE : MHB_STRUCTURE_LEAN,
                                     &s->structure));
  const mhb_modal_structure *all_modes = &s->structure;
  int                        m         = settings->harmonics,
      all = 2 * (all_modes->modes * all_modes->blades + all_modes->contacts);
  mhb_transition_schedule_create(all_modes->blades, all_modes->pairs, all_modes->wave,
                                 all_modes->mistuned, &s->schedule);
  SHB_TRY(mhb_contact_evaluator_create(m, m, settings->tolerance, &s->contact));
  if (modes_of(s) > 0) {
    SHB_TRY(mhb_modal_structure_create(receptance, settings, modes_of(s), MHB_STRUCTURE_WHOLE,
                                       &s->reduced));
    s->monodromy = mhb_monodromy_create(&s->reduced, &s->schedule, s->contact, m,
                                        (substeps + 1) / 2, FINEST, is_condensed(&s->reduced));
    int cells    = mhb_floquet_cells(s),
        states   = 2 * s->schedule.cell * (s->reduced.modes + all_modes->pairs);
    mhb_bloch_create(cells, states, &s->bloch);
    s->coarse = shb_arena_take(&s->arena, (size_t)cells * (size_t)states * (size_t)states,
                               sizeof *s->coarse);
  }
  const mhb_modal_structure *linear = all_modes->mistuned && s->monodromy ? &s->reduced : all_modes;
  mhb_linear_exponents_create(linear, &s->exponents);
  note_statical(s);
  s->nu         = settings->subharmonics;
  s->state      = shb_arena_take(&s->arena, (size_t)s->schedule.orbits, sizeof(int));
  s->multiplier = shb_arena_take(&s->arena, (size_t)all, sizeof(double complex));
  s->kept       = shb_arena_take(&s->arena, (size_t)all, sizeof(double complex));
  return SHB_OK;
}

shb_status mhb_floquet_create(const mhb_receptance *receptance, const mhb_settings *settings,
                              int substeps, int max_states, mhb_floquet **out) {
  SHB_CHECK(substeps >= 1, SHB_ERR_INPUT, "stability needs at least one sub-step a period, not %d",
            substeps);
  mhb_floquet *s    = shb_alloc_zeroed(1, sizeof *s);
  s->max_states     = max_states > 0 ? max_states : MAX_STATES;
  s->highest        = SHB_TWO_PI * fmax(settings->frequency[0], settings->frequency[1]);
  shb_status status = fill(s, receptance, settings, substeps);
  if (status != SHB_OK) {
    mhb_floquet_destroy(s);
    return status;
  }
  *out = s;
  return SHB_OK;
}

void mhb_floquet_destroy(mhb_floquet *s) {
  if (!s) return;
  mhb_bloch_destroy(&s->bloch);
  mhb_monodromy_destroy(s->monodromy);
  mhb_contact_evaluator_destroy(s->contact);
  mhb_linear_exponents_destroy(&s->exponents);
  mhb_transition_schedule_destroy(&s->schedule);
  mhb_modal_structure_destroy(&s->reduced);
  mhb_modal_structure_destroy(&s->structure);
  shb_arena_free(&s->arena);
  free(s);
}

void mhb_floquet_move(mhb_floquet *s, const mhb_receptance *receptance) {
  mhb_modal_structure_set(receptance, &s->structure);
  s->exponents.known = 0;
  if (!s->monodromy) return;
  mhb_modal_structure_set(receptance, &s->reduced);
  mhb_monodromy_forget(s->monodromy);
  note_statical(s);
}

int mhb_floquet_cells(const mhb_floquet *s) {
  return s->structure.blades / s->schedule.cell;
}

int mhb_floquet_states(const mhb_floquet *s) {
  return s->monodromy ? mhb_floquet_cells(s) * s->monodromy->n : 0;
}

static double square(double complex z) {
  return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* By falling modulus. Insertion sort is stable: conjugates, of equal modulus, stay side by side. */
static void sort(int n, double complex *x) {
  for (int i = 1; i < n; i++) {
    double complex z    = x[i];
    double         size = square(z);
    int            j    = i;
    for (; j > 0 && square(x[j - 1]) < size; j--) x[j] = x[j - 1];
    x[j] = z;
  }
}

static void set_multipliers(mhb_floquet *s, int n, mhb_multipliers *out) {
  sort(n, s->multiplier);
  out->n          = n;
  out->multiplier = s->multiplier;
  out->largest    = n ? cabs(s->multiplier[0]) : 0;
  if (n == 0 || cimag(s->multiplier[0]) != 0) {
    out->crossing = MHB_THROUGH_PAIR;
  } else {
    out->crossing = creal(s->multiplier[0]) > 0 ? MHB_THROUGH_PLUS_ONE : MHB_THROUGH_MINUS_ONE;
  }
}

/* No contact slips, opens or closes. */
static int is_linear(const mhb_floquet *s, const mhb_solution *solution) {
  for (int a = 0; a < s->schedule.orbits; a++)
    if (!s->schedule.constant_state[a] ||
        (s->schedule.state[a] == MHB_SLIDE && solution->law[a].mu > 0))
      return 0;
  return 1;
}

static const char *linear(mhb_floquet *s, const mhb_solution *solution, double period,
                          mhb_multipliers *out) {
  mhb_linear_exponents *x = &s->exponents;
  for (int a = 0; a < s->schedule.orbits; a++) s->state[a] = s->schedule.state[a];
  if (!mhb_linear_exponents_set(x, s->state, solution->law)) return "the eigensolver failed";
  for (int i = 0; i < x->n; i++) s->multiplier[i] = cexp(x->exponent[i] * period);
  out->modes         = x->structure->modes;
  s->bloch.n_aligned = 0;
  set_multipliers(s, x->n, out);
  return NULL;
}

/* Multipliers of the matrix S. */
static const char *multipliers_of(mhb_floquet *s, const double *S, mhb_multipliers *out) {
  const mhb_transition_schedule *t = &s->schedule;
  int                            n = s->monodromy->n;
  if (!mhb_bloch_multipliers(&s->bloch, n, S, t->n_segments, t->blade_shift % s->bloch.cells,
                             s->multiplier))
    return "the eigensolver failed";
  out->modes = s->reduced.modes;
  set_multipliers(s, s->bloch.cells * n, out);
  return NULL;
}

/* M of a refinement; the last one goes to coarse. Returns NULL, or the reason of a failure. */
static const char *refine(mhb_floquet *s, const mhb_solution *solution, double omega,
                          int refinement, bool keep) {
  mhb_monodromy *d    = s->monodromy;
  double        *swap = d->M;
  d->M                = s->coarse;
  s->coarse           = swap;
  const char *why     = mhb_monodromy_set(d, solution, omega, refinement, keep);
  if (why) return why;
  for (int i = 0; i < s->bloch.cells * d->n * d->n; i++)
    if (!isfinite(d->M[i])) return "the disturbances overflow";
  return NULL;
}

/* coarse <- (4 M - coarse)/3. The error is even in h and of second order; of fourth after this. */
static const double *extrapolated(mhb_floquet *s) {
  const mhb_monodromy *d = s->monodromy;
  for (int i = 0; i < s->bloch.cells * d->n * d->n; i++)
    s->coarse[i] = d->M[i] + (d->M[i] - s->coarse[i]) / 3;
  return s->coarse;
}

static int is_accurate(const mhb_multipliers *out, double most) {
  return out->change <= fmax(0.1 * MARGIN, fmin(most, DISTANCE * fabs(out->largest - 1)));
}

/* b^T S b of a shape of a pair: the squared frequency that a sticking contact adds. */
static double stiffening(const mhb_law *of, const double b[3]) {
  double sum = of->kv * b[0] * b[0];
  if (of->mu > 0)
    sum += of->ku[0] * b[1] * b[1] + 2 * of->ku[1] * b[1] * b[2] + of->ku[2] * b[2] * b[2];
  return sum;
}

static double stiffening_of_blade(const mhb_modal_structure *structure, const mhb_law *law,
                                  int mode) {
  double sum = 0;
  for (int k = 0; k < structure->sides * structure->pairs; k++) {
    int side = k / structure->pairs, pair = k % structure->pairs;
    sum += stiffening(
        &law[pair], structure->shape +
                        (size_t)(side * structure->modes + mode) * (size_t)(3 * structure->pairs) +
                        3 * pair);
  }
  return sum;
}

/* The same of mode `at` of all nodal diameters. */
static double stiffening_of_disc(const mhb_disc_modes *disc, const mhb_law *law, int at) {
  const double complex *phi = disc->shape + (size_t)at * (size_t)disc->n;
  double                sum = 0;
  for (int pair = 0; 3 * pair < disc->n; pair++) {
    double re[3], im[3];
    for (int i = 0; i < 3; i++) {
      re[i] = creal(phi[3 * pair + i]);
      im[i] = cimag(phi[3 * pair + i]);
    }
    sum += stiffening(&law[pair], re) + stiffening(&law[pair], im);
  }
  return sum;
}

/* First refinement: CYCLE sub-steps a cycle of the fastest mode that the contacts stiffen. */
static int first_refinement(const mhb_floquet *s, const mhb_law *law, double omega) {
  const mhb_modal_structure *structure  = &s->reduced;
  double                     fastest    = 0; /* squared */
  int                        refinement = 1;
  const mhb_disc_modes      *disc       = structure->disc;
  const int sets = disc ? disc->diameters : structure->mistuned ? structure->blades : 1;
  for (int i = 0; i < structure->modes * sets; i++) {
    double omega_i = disc ? disc->omega[i] : structure->omega[i], own = omega_i * omega_i;
    double more = disc ? stiffening_of_disc(disc, law, i)
                       : stiffening_of_blade(structure, law, i % structure->modes);
    if (more > SHIFTED * own) fastest = fmax(fastest, own + more);
  }
  while (s->monodromy->substeps * refinement * omega < CYCLE * sqrt(fastest) &&
         4 * refinement < FINEST)
    refinement *= 2;
  return refinement;
}

/* Modulus of the largest multiplier without extrapolation. */
static double second_order(mhb_floquet *s) {
  const mhb_monodromy *d = s->monodromy;
  return mhb_bloch_continued(&s->bloch, d->n, d->M, s->schedule.n_segments);
}

/* Slip, opening, closing: sub-steps are halved until the largest multiplier is accurate. */
static const char *nonlinear(mhb_floquet *s, const mhb_solution *solution, double omega,
                             mhb_multipliers *out) {
  if (!s->monodromy) return "more states than max_states";
  if (s->statical < STATIC * solution->omega) return "too few modes are integrated";
  int         first = first_refinement(s, solution->law, omega);
  const char *why   = refine(s, solution, omega, first, false);
  if (!why) why = refine(s, solution, omega, 2 * first, false);
  for (int refinement = 2 * first; !why; refinement *= 2) {
    double before = out->largest;
    s->refinement = refinement;
    why           = multipliers_of(s, extrapolated(s), out);
    if (!why && refinement == 2 * first) before = second_order(s);
    out->change = fabs(out->largest - before);
    if (why || is_accurate(out, refinement == 2 * first ? ROUGH : FINE)) return why;
    if (refinement == FINEST) break;
    why = refine(s, solution, omega, 2 * refinement, false);
  }
  if (!why && out->change > MARGIN && fabs(out->largest - 1) <= out->change)
    why = "the sub-steps do not settle it";
  return why;
}

/* Multipliers left out: ones of constantly stuck contacts, zeros of missing friction states. */
static void count_left_out(const mhb_floquet *s, const mhb_solution *solution,
                           mhb_multipliers *out) {
  const mhb_transition_schedule *t = &s->schedule;
  for (int j = 0; j < s->structure.contacts; j++) {
    double mu = solution->law[mhb_transition_schedule_orbit(t, j)].mu;
    if (mu == 0 || (t->constant_state[j] && t->state[j] == MHB_SEPARATE)) continue;
    if (t->constant_state[j] && t->state[j] == MHB_STICK) {
      out->n_stuck += 2;
    } else {
      out->n_zero += 2 - mhb_friction_states(t->state[j], t->constant_state[j], mu);
    }
  }
}

static double margin_of(const mhb_multipliers *m) {
  return 1 + fmax(MARGIN, m->change);
}

static void set_verdict(mhb_multipliers *out) {
  const double margin = margin_of(out);
  for (int i = 0; i < out->n; i++) out->n_unstable += cabs(out->multiplier[i]) > margin;
  if (out->reason) {
    out->verdict = MHB_UNDECIDED;
  } else if (out->largest > margin) {
    out->verdict = MHB_UNSTABLE;
  } else {
    out->verdict = out->largest > 1 ? MHB_MARGINAL : MHB_STABLE;
  }
}

void mhb_floquet_evaluate(mhb_floquet *s, const mhb_solution *solution, mhb_multipliers *out) {
  double omega  = solution->omega / s->nu;
  *out          = (mhb_multipliers){.change = -1, .error = -1};
  s->refinement = 0;
  if (!mhb_transition_schedule_set(&s->schedule, solution->info)) {
    out->reason = "the contact law lost its way, or has too many transitions";
  } else if (is_linear(s, solution)) {
    out->reason = linear(s, solution, SHB_TWO_PI / omega, out);
  } else {
    out->reason = nonlinear(s, solution, omega, out);
  }
  if (!out->reason) count_left_out(s, solution, out);
  set_verdict(out);
  for (int i = 0; out->verdict == MHB_UNSTABLE && i < s->bloch.n_aligned; i++)
    out->n_fold += s->bloch.aligned[i] > margin_of(out);
}

double mhb_floquet_distance(const mhb_multipliers *m) {
  return fabs(m->largest - margin_of(m));
}

void mhb_floquet_set_error(double error, mhb_multipliers *m) {
  m->error = error;
  if (!(error < mhb_floquet_distance(m))) m->verdict = MHB_UNDECIDED;
}

void mhb_floquet_judge_error(mhb_floquet *s, const mhb_solution *better, double remaining,
                             mhb_multipliers *m) {
  double complex *own = s->multiplier;
  mhb_multipliers of_better;
  s->multiplier = s->kept;
  mhb_floquet_evaluate(s, better, &of_better);
  s->kept             = s->multiplier;
  s->multiplier       = own;
  const double change = of_better.reason ? INFINITY : fabs(of_better.largest - m->largest);
  mhb_floquet_set_error(change / (1 - remaining), m);
}

int mhb_floquet_refinement(const mhb_floquet *s) {
  return s->refinement;
}

const char *mhb_floquet_set_map(mhb_floquet *s, const mhb_solution *solution, int refinement,
                                bool keep) {
  double omega = solution->omega / s->nu;
  if (!s->monodromy) return "more states than max_states";
  if (!mhb_transition_schedule_set(&s->schedule, solution->info))
    return "the contact law lost its way, or has too many transitions";
  if (is_linear(s, solution)) return "no contact slips, opens or closes";
  const char *why = refine(s, solution, omega, refinement / 2, keep);
  if (!why) why = refine(s, solution, omega, refinement, true);
  if (!why) extrapolated(s);
  return why;
}

int mhb_floquet_waves(const mhb_floquet *s) {
  return mhb_bloch_waves(&s->bloch);
}

bool mhb_floquet_is_real(const mhb_floquet *s, int wave) {
  return mhb_bloch_is_real(&s->bloch, wave);
}

int mhb_floquet_segments(const mhb_floquet *s) {
  return s->schedule.n_segments;
}

const double complex *mhb_floquet_eigenvalues(mhb_floquet *s, int wave, int *n) {
  *n = s->monodromy->n;
  return mhb_bloch_eigenvalues(&s->bloch, *n, s->coarse, wave, s->multiplier) ? s->multiplier
                                                                              : NULL;
}

double complex mhb_floquet_multiplier(const mhb_floquet *s, int wave, double complex lambda) {
  const mhb_transition_schedule *t = &s->schedule;
  return mhb_bloch_multiplier(&s->bloch, wave, t->n_segments, t->blade_shift % s->bloch.cells,
                              lambda);
}
