/* Forced responses with known answers: amplitudes by time integration, peaks, folds, branches. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/main_branch.h"
#include "mhb/numerics/fourier.h"
#include "mhb/structure/stiffness_check.h"
#include "tests/support/check.h"
#include "tests/support/files.h"
#include "tests/support/settings.h"
#include "tests/support/solution.h"
#include "tests/support/three_degree.h"

/* First harmonics of v, u, w at w rad/s. */
static void solve_at(const modal_model *model, const mhb_settings *s, double w,
                     double amplitude[3]) {
  int    nb = mhb_real_size(s->harmonics);
  double x[3 * nb];
  cold_solution(model, s, w, 1e-11, x);
  for (int c = 0; c < 3; c++) amplitude[c] = hypot(x[c * nb + 1], x[c * nb + 2]);
}

static void amplitudes_of_time_integration(void **state) {
  (void)state;
  typedef struct {
    double n0, w, a[3], error[4];
  } row;
  static const row rows[] = {
      {1, 1.20, {0.027944, 0.147642, 0.008139}, {1e-6, 1e-6, 1e-6, 1e-6}},
      {-0.2, 1.00, {0.019624, 0.197890, 0.003763}, {1e-6, 1e-6, 1e-6, 1e-6}},
      {0, 1.05, {0.195617, 0.114818, 0.021163}, {1.7e-1, 1.5e-3, 8.3e-5, 7.8e-6}},
      {0.3, 1.42, {0.492394, 0.396878, 0.471625}, {1.1e-2, 1.8e-4, 1.8e-6, 2.3e-6}}};
  static const int H[4] = {1, 3, 7, 15};
  modal_model      model;
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    for (int h = 0; h < 4; h++) {
      mhb_settings s = ground_settings(0.4, 0.8, 0.5, rows[i].n0, H[h]);
      double       a[3], worst = 0, size = 0;
      solve_at(&model, &s, rows[i].w, a);
      for (int c = 0; c < 3; c++) {
        worst = fmax(worst, fabs(a[c] - rows[i].a[c]));
        size  = fmax(size, rows[i].a[c]);
      }
      print_message("n0 %4.1f W %.2f H %2d: error %.2e of %.2e\n", rows[i].n0, rows[i].w, H[h],
                    worst / size, rows[i].error[h]);
      /* the reference is printed to six decimals */
      assert_near(worst / size, 0, 2 * rows[i].error[h] + 0.6e-6 / size);
    }
  }
  modal_model_free(&model);
}

static mhb_response *sweep(const modal_model *model, mhb_settings *s, double from, double to) {
  mhb_response *response;
  s->frequency[0]   = from / SHB_TWO_PI;
  s->frequency[1]   = to / SHB_TWO_PI;
  shb_status status = mhb_forced_response(model, s, NULL, NULL, NULL, &response);
  if (status != SHB_OK) fail_msg("%s", shb_message());
  return response;
}

static double amplitude(const mhb_response *r, const mhb_branch *b, int point, int component) {
  int K = r->n_harmonics + 1;
  return cabs(b->motion[(point * 3 + component) * K + 1]);
}

/* The located fold nearest to w; NAN if there is none within 0.05. */
static double fold_near(const mhb_branch *b, double w) {
  double best = NAN;
  for (int i = 0; i < b->n_points; i++) {
    double at = SHB_TWO_PI * b->frequency[i];
    if (b->special[i] == MHB_FOLD && fabs(at - w) < 0.05 && !(fabs(best - w) < fabs(at - w)))
      best = at;
  }
  return best;
}

static int count_folds(const mhb_branch *b) {
  int n = 0;
  for (int i = 0; i < b->n_points; i++) n += b->special[i] == MHB_FOLD;
  return n;
}

/* The peak of one component nearest to w. */
static int peak_near(const mhb_response *r, const mhb_branch *b, int component, double w) {
  int best = -1;
  for (int i = 1; i + 1 < b->n_points; i++) {
    double here = amplitude(r, b, i, component);
    if (here < amplitude(r, b, i - 1, component) || here < amplitude(r, b, i + 1, component))
      continue;
    if (best < 0 ||
        fabs(SHB_TWO_PI * b->frequency[i] - w) < fabs(SHB_TWO_PI * b->frequency[best] - w))
      best = i;
  }
  return best;
}

static void three_degree_peaks_and_folds(void **state) {
  (void)state;
  static const struct {
    double n0;
    int    H, peaks, folds;
    double peak[3][2], fold[4];
  } rows[] = {{-0.2,
               11,
               3,
               4,
               {{0.255795, 0.960521}, {0.887011, 1.158727}, {0.631926, 1.311043}},
               {0.968825, 0.959129, 1.162961, 1.160645}},
              {0, 7, 3, 0, {{0.270514, 1.030220}, {0.532418, 1.190037}, {0.566835, 1.329447}}, {0}},
              {0.3, 11, 2, 2, {{0.250643, 1.245374}, {0.398957, 1.416445}}, {1.408680, 1.408382}},
              {0.5, 7, 1, 0, {{0.389205, 1.254187}}, {0}},
              {1, 7, 1, 0, {{0.560424, 1.362896}}, {0}}};
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 5; i++) {
    mhb_settings      s = ground_settings(0.4, 0.8, 0.5, rows[i].n0, rows[i].H);
    mhb_response     *r = sweep(&model, &s, 0.8, 1.7);
    const mhb_branch *b = &r->branch[2];
    print_message("n0 %4.1f: %d points, %d folds\n", rows[i].n0, b->n_points, count_folds(b));
    assert_int_equal(count_folds(b), rows[i].folds);
    for (int p = 0; p < rows[i].peaks; p++) {
      int at = peak_near(r, b, 1, rows[i].peak[p][1]);
      assert_true(at > 0);
      print_message("  peak %.6f at %.6f (%.6f at %.6f)\n", amplitude(r, b, at, 1),
                    SHB_TWO_PI * b->frequency[at], rows[i].peak[p][0], rows[i].peak[p][1]);
      assert_near(amplitude(r, b, at, 1), rows[i].peak[p][0], 1e-4);
      assert_near(SHB_TWO_PI * b->frequency[at], rows[i].peak[p][1], 4e-4);
    }
    for (int k = 0; k < rows[i].folds; k++)
      assert_near(fold_near(b, rows[i].fold[k]), rows[i].fold[k], 4e-4);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
}

/* Amplitudes at which the branch crosses w, by linear interpolation. */
static int crossings(const mhb_response *r, const mhb_branch *b, double w, double *found) {
  int n = 0;
  for (int i = 1; i < b->n_points && n < 8; i++) {
    double f0 = SHB_TWO_PI * b->frequency[i - 1] - w, f1 = SHB_TWO_PI * b->frequency[i] - w;
    if ((f0 < 0) == (f1 < 0)) continue;
    double s   = f0 / (f0 - f1);
    found[n++] = (1 - s) * amplitude(r, b, i - 1, 0) + s * amplitude(r, b, i, 0);
  }
  return n;
}

static void one_degree_with_jumps(void **state) {
  (void)state;
  static const struct {
    double n0, F, peak, at, fold[2], w, branch[3];
  } rows[] = {
      {-4.5, 0.1, 1.669613, 1.388351, {1.389887, 1.093215}, 1.30, {1.141048, 0.908380, 0.144518}},
      {1, 0.06, 0.668464, 2.086578, {2.086215, 3.078167}, 2.30, {0.012736, 0.432375, 0.461382}}};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    one_degree_model(0.02, 0, rows[i].F, &model);
    mhb_settings      s   = ground_settings(0, 9, 1, rows[i].n0, 31);
    mhb_response     *r   = sweep(&model, &s, 0.5, 3.6);
    const mhb_branch *b   = &r->branch[2];
    double            top = 0, at = 0, found[8];
    for (int p = 0; p < b->n_points; p++) {
      if (amplitude(r, b, p, 0) <= top) continue;
      top = amplitude(r, b, p, 0);
      at  = SHB_TWO_PI * b->frequency[p];
    }
    print_message("%c: %d points, %d folds, peak %.6f at %.6f, folds %.6f %.6f\n", 'A' + i,
                  b->n_points, count_folds(b), top, at, fold_near(b, rows[i].fold[0]),
                  fold_near(b, rows[i].fold[1]));
    assert_near(top, rows[i].peak, 1e-4);
    assert_near(at, rows[i].at, 2e-4);
    for (int k = 0; k < 2; k++) assert_near(fold_near(b, rows[i].fold[k]), rows[i].fold[k], 2e-3);
    assert_int_equal(crossings(r, b, rows[i].w, found), 3);
    for (int k = 0; k < 3; k++) {
      double nearest = INFINITY;
      for (int j = 0; j < 3; j++)
        if (fabs(found[j] - rows[i].branch[k]) < fabs(nearest - rows[i].branch[k]))
          nearest = found[j];
      assert_near(nearest, rows[i].branch[k], 2e-3 * rows[i].branch[0] + 2e-3);
    }
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
}

/* Largest displacement of u over a period. */
static double peak_amplitude(const mhb_settings *s, const modal_model *model, double w) {
  int    nb = mhb_real_size(s->harmonics);
  double x[3 * nb], basis[nb], top = 0;
  cold_solution(model, s, w, 1e-11, x);
  for (int i = 0; i < 20000; i++) {
    double sum = 0;
    mhb_basis(s->harmonics, SHB_TWO_PI * i / 20000, basis, NULL);
    for (int j = 0; j < nb; j++) sum += basis[j] * x[nb + j];
    top = fmax(top, fabs(sum));
  }
  return top;
}

static void friction_oscillator_from_a_cold_start(void **state) {
  (void)state;
  static const double rows[][2] = {
      {1.0, 0.79984}, {1.1, 1.01470}, {1.18, 2.39365184}, {1.30, 2.02243853}};
  modal_model model;
  one_degree_model(0.01, 1, 0.8, &model);
  for (int i = 0; i < 4; i++) {
    mhb_settings s = ground_settings(1, 1, 1, 1, 31);
    double       a = peak_amplitude(&s, &model, rows[i][0]);
    print_message("W %.2f: amplitude %.7f (%.7f)\n", rows[i][0], a, rows[i][1]);
    assert_near(a, rows[i][1], 2e-5 * rows[i][1]);
  }
  modal_model_free(&model);
}

/* The two ways to state a preload. With the static mean that an interference keeps, the contact is
 * looser. */
static void tip_contact_beam(void **state) {
  (void)state;
  static const double rows[2][2] = {{1.9634e-4, 268.10}, {1.7441e-4, 263.155}};
  modal_model         model;
  tip_contact_beam_model(8, &model);
  for (int i = 0; i < 2; i++) {
    mhb_settings s        = ground_settings(0.3, 2e5, 2e5, 100, 7);
    s.preload             = i ? MHB_INTERFERENCE : MHB_EQUILIBRIUM;
    mhb_response     *r   = sweep(&model, &s, SHB_TWO_PI * 215, SHB_TWO_PI * 320);
    const mhb_branch *b   = &r->branch[2];
    double            top = 0, at = 0;
    for (int p = 0; p < b->n_points; p++) {
      if (amplitude(r, b, p, 1) <= top) continue;
      top = amplitude(r, b, p, 1);
      at  = b->frequency[p];
    }
    print_message("%s: peak %.5e at %.3f Hz, %d points\n", i ? "interference" : "equilibrium", top,
                  at, b->n_points);
    assert_near(top, rows[i][0], 4e-4 * rows[i][0]);
    /* the reference has an error of 2e-4 in amplitude; the peak is so flat that its frequency moves
     * by 1e-3 */
    assert_near(at, rows[i][1], 1e-3 * rows[i][1]);
    double there[3];
    solve_at(&model, &s, SHB_TWO_PI * rows[i][1], there);
    assert_near(there[1], rows[i][0], 4e-4 * rows[i][0]);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
}

static void linear_limits_are_met(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s  = ground_settings(0.4, 0.8, 0.5, -1e6, 3);
  s.n_preloads    = 2;
  s.n0[1]         = 1e6;
  mhb_response *r = sweep(&model, &s, 0.8, 1.7);
  assert_int_equal(r->n_branches, 4);
  for (int i = 0; i < 2; i++) { /* branch 2 is open, 3 stuck: same peak as their limits */
    double top[2] = {0, 0}, at[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
      const mhb_branch *b = &r->branch[i + 2 * k];
      for (int p = 0; p < b->n_points; p++) {
        if (amplitude(r, b, p, 1) <= top[k]) continue;
        top[k] = amplitude(r, b, p, 1);
        at[k]  = b->frequency[p];
      }
    }
    assert_near(top[1] / top[0], 1, 1e-3);
    assert_near(at[1] / at[0], 1, 1e-3);
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* High friction and light preload: slip onset next to opening, the hardest place to pass. A curve
 * either covers the range, or goes on beyond a gap that its reason names. */
static void curves_go_on_beyond_a_gap(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s = ground_settings(8, 0.8, 0.5, 0.05, 5);
  s.n_preloads   = 4;
  memcpy(s.n0, (double[4]){0.05, 0.1, 0.2, 0.4}, 4 * sizeof(double));
  s.frequency[0] = 0.8 / SHB_TWO_PI;
  s.frequency[1] = 1.7 / SHB_TWO_PI;
  mhb_response *r;
  shb_status    status = mhb_forced_response(&model, &s, NULL, NULL, NULL, &r);
  int           gaps   = 0;
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    print_message("n0 %.2f: %d points, %s\n", b->n0[0], b->n_points, b->reason);
    assert_near(b->frequency[b->n_points - 1], s.frequency[1], 1e-9);
    assert_true(b->complete == (strcmp(b->reason, "end of range") == 0));
    if (!b->complete) assert_non_null(strstr(b->reason, "gap"));
    gaps += !b->complete;
    for (int p = 0; p < b->n_points; p++) assert_true(b->error_newton[p] < 1e-7);
  }
  assert_int_equal(status, gaps ? SHB_NOT_CONVERGED : SHB_OK);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* The probe of the model is its contact point. */
static void the_probe_moves_like_the_contact(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings      s    = ground_settings(0.4, 0.8, 0.5, 0.3, 5);
  mhb_response     *r    = sweep(&model, &s, 0.8, 1.7);
  const mhb_branch *b    = &r->branch[2];
  double            away = 0, most = 0;
  for (int i = 0; i < b->n_points * 3 * (b->n_harmonics + 1); i++) {
    away = fmax(away, cabs(b->probe[i] - b->motion[i]));
    most = fmax(most, cabs(b->motion[i]));
  }
  assert_true(b->n_points > 50);
  assert_below(away, 1e-8 * most);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* Motions that repeat with the excitation, balanced over several of its periods. The curve is that
 * of one period, and no point is taken for a copy of its start. */
static void more_periods_than_the_motion_has(void **state) {
  (void)state;
  static const double n0[] = {-0.3, -0.2, 0, 0.1, 0.3, 1, 2, 4};
  modal_model         model;
  three_degree_model(&model);
  for (int nu = 2; nu <= 4; nu++)
    for (int i = 0; i < 8; i++) {
      mhb_settings s = ground_settings(0.4, 0.8, 0.5, n0[i], 3 * nu);
      s.subharmonics = nu;
      s.stability    = MHB_STABILITY_NEVER;
      s.max_points   = 2000;
      for (int part = 0; part < 3; part++) {
        mhb_response     *r = sweep(&model, &s, 0.75 + 0.1 * part, 0.85 + 0.1 * part);
        const mhb_branch *b = &r->branch[2];
        assert_string_equal(b->reason, "end of range");
        assert_near(b->frequency[0], s.frequency[0], 1e-12);
        assert_int_equal(r->n_branches, 3);
        mhb_response_destroy(r);
      }
    }
  modal_model_free(&model);
}

/* The first point moves where more harmonics are taken at once: it is no return to the start. */
static void more_harmonics_at_the_start(void **state) {
  (void)state;
  static const double n0[] = {-.3, -.2, -.1, 0, .05, .1, .2, .3};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 8; i++)
    for (int from = 0; from < 10; from++) {
      mhb_settings s     = ground_settings(.4, .8, .5, n0[i], 1);
      s.motion_tolerance = 1e-3;
      s.stability        = MHB_STABILITY_NEVER;
      s.max_points       = 2000;
      mhb_response *r    = sweep(&model, &s, .95 + .05 * from, 1 + .05 * from);
      for (int k = 2; k < r->n_branches; k++) assert_true(r->branch[k].n_points > 3);
      assert_near(r->branch[2].frequency[0], s.frequency[0], 1e-12);
      mhb_response_destroy(r);
    }
  modal_model_free(&model);
}

/* A run that adds preloads to a file, or a whole one without a file to take from. */
static mhb_response *preloads(const modal_model *model, const char *path, bool resume, int n,
                              const double *n0) {
  char text[128] = "mu = 0.4\ncontact.n0 =";
  for (int i = 0; i < n; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text), " %.17g", n0[i]);
  strcat(text, "\ntolerance = 1e-8\n");
  shb_provenance from = {"case.yaml", "name: x\n", text, "shroudhb-mhb"};
  mhb_settings   s    = ground_settings(0.4, 0.8, 0.5, n0[0], 5);
  mhb_response  *r;
  s.frequency[0]  = 0.8 / SHB_TWO_PI;
  s.frequency[1]  = 1.7 / SHB_TWO_PI;
  s.n_preloads    = n;
  s.resume        = resume;
  s.search.starts = MHB_SEARCH_PEAKS;
  memcpy(s.n0, n0, sizeof *n0 * (size_t)n);
  assert_ok(mhb_forced_response(model, &s, path, &from, NULL, &r));
  return r;
}

/* Curves of preloads that an earlier file has are taken from it; the result is that of a whole run.
 * Their seconds tell that nothing was computed. */
static void added_preloads_alone_are_computed(void **state) {
  (void)state;
  static const double first[] = {0.1, 0.3}, then[] = {0.3, 0.05, 0.6};
  modal_model         model;
  three_degree_model(&model);
  mhb_response *before = preloads(&model, scratch("added.h5"), true, 2, first);
  mhb_response *added  = preloads(&model, scratch("added.h5"), true, 3, then);
  mhb_response *whole  = preloads(&model, scratch("whole.h5"), false, 3, then);
  assert_int_equal(added->n_branches, whole->n_branches);
  for (int i = 0; i < whole->n_branches; i++) {
    const mhb_branch *a = &added->branch[i], *b = &whole->branch[i];
    size_t            n = (size_t)b->n_points, K = (size_t)b->n_harmonics + 1;
    assert_int_equal(a->n_points, b->n_points);
    assert_int_equal(a->main, b->main);
    assert_int_equal(a->n_searches, b->n_searches);
    assert_memory_equal(a->frequency, b->frequency, sizeof(double) * n);
    assert_memory_equal(a->n0, b->n0, sizeof(double) * n);
    assert_memory_equal(a->stable, b->stable, sizeof(int) * n);
    assert_memory_equal(a->motion, b->motion, sizeof(double complex) * 3 * K * n);
  }
  size_t n = (size_t)added->branch[2].n_points;
  assert_memory_equal(added->branch[2].seconds, before->branch[3].seconds, sizeof(double) * n);
  print_message("%d branches, %zu points taken over\n", whole->n_branches, n);
  assert_true(n > 20);
  mhb_response_destroy(before);
  mhb_response_destroy(added);
  mhb_response_destroy(whole);
  modal_model_free(&model);
}

static void nothing_happens_without_excitation(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s  = ground_settings(0.4, 0.8, 0.5, 0.3, 3);
  s.scale         = 0;
  mhb_response *r = sweep(&model, &s, 0.8, 1.7);
  for (int p = 0; p < r->branch[2].n_points; p++)
    assert_near(amplitude(r, &r->branch[2], p, 1), 0, 1e-15);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* Stiffer than the blade by more than the limit: R = K^-1, K of three_degree_model, axes v, u, w.
 */
static void rigid_contacts_are_refused(void **state) {
  (void)state;
  static const double R[3]    = {2.0575 / 1.9865, 1.59 / 1.9865, 1.26 / 1.9865};
  static const char  *word[3] = {"contact.kv: ", "contact.ku: ", "contact.ku: "};
  modal_model         model;
  three_degree_model(&model);
  for (int axis = 0; axis < 3; axis++)
    for (int over = 0; over < 2; over++) {
      mhb_settings    s          = ground_settings(0.4, 0.8, 0.5, 0.3, 3);
      double         *k          = axis == 0 ? &s.kv : &s.ku[axis - 1 ? 2 : 0];
      mhb_receptance *receptance = NULL;
      *k                         = (over ? 1.001 : 0.999) * MHB_STIFFNESS_LIMIT / R[axis];
      assert_int_equal(mhb_receptance_create(&model, &s, 3, &receptance), SHB_OK);
      assert_int_equal(mhb_stiffness_check(receptance, &s), over ? SHB_ERR_INPUT : SHB_OK);
      if (over) assert_int_equal(strncmp(shb_message(), word[axis], 12), 0);
      mhb_receptance_destroy(receptance);
    }
  mhb_settings  s        = ground_settings(0.4, 0.8, 0.5, 0.3, 3);
  mhb_response *response = NULL;
  s.frequency[0] = s.frequency[1] = 0.2;
  s.parameter                     = MHB_IN_KV;
  s.range[1]                      = 1e9;
  assert_int_equal(mhb_forced_response(&model, &s, NULL, NULL, NULL, &response), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "contact.kv: 1e+09 N/m is 3.9e+08 times as stiff"));
  mhb_response_destroy(response);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(amplitudes_of_time_integration),
      cmocka_unit_test(three_degree_peaks_and_folds),
      cmocka_unit_test(rigid_contacts_are_refused),
      cmocka_unit_test(one_degree_with_jumps),
      cmocka_unit_test(friction_oscillator_from_a_cold_start),
      cmocka_unit_test(tip_contact_beam),
      cmocka_unit_test(linear_limits_are_met),
      cmocka_unit_test(curves_go_on_beyond_a_gap),
      cmocka_unit_test(the_probe_moves_like_the_contact),
      cmocka_unit_test(more_periods_than_the_motion_has),
      cmocka_unit_test(more_harmonics_at_the_start),
      cmocka_unit_test(added_preloads_alone_are_computed),
      cmocka_unit_test(nothing_happens_without_excitation),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
