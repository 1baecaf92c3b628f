#include "mesh/base/constants.h"
#include "postproc/analysis/curves.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

enum { MOST = 8192 };

typedef struct {
  int    n;
  double f[MOST], a[MOST];
} points;

/* One-degree oscillator, damping ratio zeta, natural frequency 103.6 Hz: |H| on a grid that misses
 * its peak. */
static void oscillator(points *p, int n, double zeta) {
  p->n = n;
  for (int i = 0; i < n; i++) {
    p->f[i]  = 91.3 + 24.71 * i / (n - 1);
    double r = p->f[i] / 103.6;
    p->a[i]  = 2.385 / sqrt(pow(1 - r * r, 2) + pow(2 * zeta * r, 2));
  }
}

static post_peak one_peak(const points *p) {
  post_peak *peaks;
  int        n;
  assert_ok(post_find_peaks(p->n, p->f, p->a, &peaks, &n));
  assert_int_equal(n, 1);
  post_peak peak = peaks[0];
  free(peaks);
  return peak;
}

/* Peak at r^2 = 1 - 2 zeta^2 of height 1/(2 zeta sqrt(1 - zeta^2)); half power at r^2 = 1 - 2
 * zeta^2 -+ 2 zeta sqrt(1 - zeta^2). */
static void resonance(void **state) {
  (void)state;
  static points p;
  const double  zeta = 0.021, f0 = 103.6;
  double        half = 2 * zeta * sqrt(1 - zeta * zeta), mid = 1 - 2 * zeta * zeta;
  double        width = f0 * (sqrt(mid + half) - sqrt(mid - half));
  oscillator(&p, 300, zeta);
  post_peak peak = one_peak(&p);
  assert_near(peak.amplitude, 2.385 / half, 2e-7 * 2.385 / half);
  assert_near(peak.at, f0 * sqrt(mid), 1e-4);
  assert_near(peak.bandwidth, width, 2e-3 * width);
  assert_near(peak.damping, zeta, 2e-3 * zeta);
  assert_false(peak.edge);
}

/* Between peak and half power the curve turns back: by 0.1 % of the width, which is then known; by
 * 5 %, then it is not. */
static void turning_back_by_a_hair(void **state) {
  (void)state;
  static points p;
  oscillator(&p, 300, 0.021);
  post_peak peak = one_peak(&p);
  int       i    = peak.point + 8;
  assert_true(p.a[i] > peak.amplitude / M_SQRT2);
  for (int by = 0; by < 2; by++) {
    oscillator(&p, 300, 0.021);
    p.f[i]           = p.f[i - 1] - (by ? 0.05 : 0.001) * peak.bandwidth;
    post_peak turned = one_peak(&p);
    if (by == 0) assert_near(turned.bandwidth, peak.bandwidth, 1e-2 * peak.bandwidth);
    if (by == 1) assert_true(isnan(turned.bandwidth));
  }
}

/* Errors over the spacing: third order or better for the amplitude, second for frequency and
 * bandwidth. The error depends on the position of the grid, so the slope is taken over several
 * halvings. */
static void order(void **state) {
  (void)state;
  static points p;
  const double  zeta = 0.021, f0 = 103.6;
  double        half = 2 * zeta * sqrt(1 - zeta * zeta), mid = 1 - 2 * zeta * zeta;
  double        width = f0 * (sqrt(mid + half) - sqrt(mid - half)), error[2][3] = {{0}};
  for (int level = 0; level < 2; level++)
    for (int shift = 0; shift < 9; shift++) { /* largest error of nine grids */
      oscillator(&p, (level ? 1280 : 160) + shift * (level ? 24 : 3), zeta);
      post_peak peak  = one_peak(&p);
      error[level][0] = fmax(error[level][0], fabs(peak.amplitude * half / 2.385 - 1));
      error[level][1] = fmax(error[level][1], fabs(peak.at - f0 * sqrt(mid)));
      error[level][2] = fmax(error[level][2], fabs(peak.bandwidth - width));
    }
  assert_true(log2(error[0][0] / error[1][0]) / 3 > 2.8);
  assert_true(log2(error[0][1] / error[1][1]) / 3 > 1.8);
  assert_true(log2(error[0][2] / error[1][2]) / 3 > 1.8);
}

static void bent(points *p, const fixture_curve *c, int n) {
  p->n = n;
  for (int i = 0; i < n; i++) {
    double theta = 0.013 + (SHB_PI - 0.031) * i / (n - 1);
    p->f[i]      = fixture_frequency(c, theta);
    p->a[i]      = fixture_amplitude(c, theta);
  }
}

/* Softening: the peak and two folds from their closed forms; no bandwidth across a fold. */
static void folds(void **state) {
  (void)state;
  static points       p;
  const fixture_curve c = {2.385e-4, 110.3, -3.1 / (2.385e-4 * 2.385e-4), 0.83};
  double theta[2]       = {fixture_fold(&c, 0.3, SHB_PI / 3), fixture_fold(&c, SHB_PI / 3, 1.57)},
         error[2]       = {0};
  for (int level = 0; level < 2; level++) {
    post_fold *fold;
    int        n;
    bent(&p, &c, level ? 1600 : 200);
    post_peak peak = one_peak(&p);
    assert_near(peak.amplitude, c.top, 1e-5 * c.top);
    assert_near(peak.at, c.centre + c.bend * c.top * c.top, level ? 2e-5 : 1e-3);
    assert_true(isnan(peak.bandwidth));
    assert_ok(post_find_folds(p.n, p.f, p.a, NULL, &fold, &n));
    assert_int_equal(n, 2);
    assert_true(fold[0].upper);
    assert_false(fold[1].upper);
    for (int i = 0; i < 2; i++) {
      error[level] = fmax(error[level], fabs(fold[i].at - fixture_frequency(&c, theta[i])));
      assert_near(fold[i].amplitude, fixture_amplitude(&c, theta[i]), level ? 1e-7 : 1e-6);
    }
    free(fold);
  }
  assert_true(error[1] < 1e-7);
  assert_true(log2(error[0] / error[1]) / 3 > 2.5);
}

/* A fold located by the solver is taken once and unchanged, though rounding moves the turn to its
 * neighbour. */
static void flagged(void **state) {
  (void)state;
  const double f[] = {100, 101, 101.5, 101.50000001, 101.2, 100.9}, a[] = {1, 2, 3, 3.1, 3.6, 4};
  const int    special[] = {0, 0, 1, 0, 0, 0};
  post_fold   *fold;
  int          n;
  assert_ok(post_find_folds(6, f, a, special, &fold, &n));
  assert_int_equal(n, 1);
  assert_int_equal(fold[0].point, 2);
  assert_near(fold[0].at, 101.5, 0);
  assert_true(fold[0].upper);
  free(fold);
  const double still[] = {100, 101, 101, 101, 100}; /* a run of equal frequencies turns once */
  assert_ok(post_find_folds(5, still, a, NULL, &fold, &n));
  assert_int_equal(n, 1);
  free(fold);
  assert_ok(post_find_folds(4, still, a, NULL, &fold, &n)); /* a run at the end does not turn */
  assert_int_equal(n, 0);
  assert_null(fold);
}

static int peaks_of(int n, const double *a, int top[8]) {
  double     f[16] = {0};
  post_peak *peaks;
  int        found;
  for (int i = 0; i < n; i++) f[i] = 100 + i;
  assert_ok(post_find_peaks(n, f, a, &peaks, &found));
  for (int i = 0; i < found; i++) {
    top[i] = peaks[i].point;
    assert_true(isfinite(peaks[i].at) && isfinite(peaks[i].amplitude));
    assert_true(peaks[i].amplitude >= a[peaks[i].point]);
  }
  if (found) assert_int_equal(peaks[post_highest_peak(found, peaks)].point >= 0, 1);
  free(peaks);
  return found;
}

static void cases(void **state) {
  (void)state;
  int top[8];
  assert_int_equal(peaks_of(0, NULL, top), 0);
  assert_int_equal(peaks_of(1, (const double[]){0}, top), 0);
  assert_int_equal(peaks_of(1, (const double[]){2}, top), 1); /* an edge */
  assert_int_equal(peaks_of(4, (const double[]){0, 0, 0, 0}, top), 0);
  assert_int_equal(peaks_of(4, (const double[]){1, 2, 3, 4}, top), 1); /* rising to the edge */
  assert_int_equal(top[0], 3);
  assert_int_equal(peaks_of(6, (const double[]){1, 5, 5, 5, 2, 1}, top),
                   1); /* a plateau is one peak */
  assert_int_equal(top[0], 1);
  assert_int_equal(peaks_of(7, (const double[]){1, 5, 4.95, 5.01, 2, 1, 0}, top),
                   1); /* a 1 % dip is a ripple */
  assert_int_equal(top[0], 3);
  assert_int_equal(peaks_of(7, (const double[]){1, 5, 3, 6, 2, 3, 1}, top), 3);
  assert_int_equal(peaks_of(7, (const double[]){0, 0, 7, 0, 0, 0, 0}, top),
                   1); /* neighbours without motion */
  assert_int_equal(peaks_of(5, (const double[]){9, 2, 3, 2, 1}, top),
                   2); /* an edge and a lesser peak */
}

/* A closed curve has no edge, even if it starts at its maximum up to rounding. */
static void closed(void **state) {
  (void)state;
  double     f[41], a[41];
  post_peak *peaks;
  int        n;
  for (int i = 0; i <= 40; i++) {
    f[i] = 10 + cos(SHB_TWO_PI * i / 40);
    a[i] = 3 + sin(SHB_TWO_PI * i / 40 + SHB_PI / 2);
  }
  assert_ok(post_find_peaks(41, f, a, &peaks, &n));
  for (int i = 0; i < n; i++) assert_false(peaks[i].edge);
  free(peaks);
  f[40] += 0.1; /* open */
  assert_ok(post_find_peaks(41, f, a, &peaks, &n));
  assert_int_equal(n, 1);
  assert_true(peaks[0].edge);
  free(peaks);
}

/* An edge peak has no bandwidth. */
static void edge(void **state) {
  (void)state;
  const double f[] = {90, 91, 92}, a[] = {3, 2, 1};
  post_peak   *peaks;
  int          n;
  assert_ok(post_find_peaks(3, f, a, &peaks, &n));
  assert_int_equal(n, 1);
  assert_true(peaks[0].edge);
  assert_near(peaks[0].at, 90, 0);
  assert_true(isnan(peaks[0].bandwidth) && isnan(peaks[0].damping));
  free(peaks);
  assert_int_equal(post_highest_peak(0, NULL), -1);
}

/* A fold pair 1e-6 apart is left out, wider ones stay. */
static void hairlines_are_no_folds(void **state) {
  (void)state;
  double     f[]        = {100, 105, 110, 110 - 1e-4, 115, 120, 118, 125};
  double     a[]        = {1, 2, 3, 3.01, 4, 5, 6, 7};
  int        special[8] = {0}, n;
  post_fold *folds;
  assert_int_equal(post_find_folds(8, f, a, special, &folds, &n), SHB_OK);
  assert_int_equal(n, 2);
  assert_true(folds[0].at > 117 && folds[1].at > 117);
  free(folds);
}

/* An unmarked reversal by rounding or of 1e-6 is no fold, though the vertices of the two parabolas
 * are far apart. */
static void ripples_are_no_folds(void **state) {
  (void)state;
  const double back[] = {2e-14, 1e-6};
  for (int k = 0; k < 2; k++) {
    double     f[]        = {100, 105, 110, 110 * (1 - back[k]), 120, 119, 125};
    double     a[]        = {1, 2, 3, 3.5, 5, 6, 7};
    int        special[7] = {0, 0, 2, 2, 1, 1, 0}, n;
    post_fold *folds;
    assert_ok(post_find_folds(7, f, a, special, &folds, &n));
    assert_int_equal(n, 2);
    assert_true(folds[0].at == 120 && folds[0].upper && folds[1].at == 119 && !folds[1].upper);
    free(folds);
    assert_ok(post_find_folds(5, f, a, NULL, &folds, &n));
    assert_int_equal(n, 0);
    free(folds);
  }
}

/* A curve leaves the range at its upper end (108) with a high amplitude and returns with a low one.
 * The largest value is an edge peak, and the turn of the points is no fold. */
static void left_the_range(void **state) {
  (void)state;
  double     f[] = {100, 104, 108, 108, 103, 101, 105, 108}, a[] = {1, 2, 4, 3, 2, 1, 0.5, 0.2};
  int        special[8] = {0, 0, 0, 0, 0, 1, 0, 0}, n;
  post_fold *folds;
  post_peak *peaks;
  for (int k = 0; k < 2; k++) {
    assert_ok(post_find_folds(8, f, a, k ? special : NULL, &folds, &n));
    assert_int_equal(n, 1);
    assert_false(folds[0].upper);
    assert_int_equal(folds[0].point, 5);
    free(folds);
  }
  assert_ok(post_find_peaks(8, f, a, &peaks, &n));
  assert_int_equal(n, 1);
  assert_true(peaks[0].edge && peaks[0].point == 2 && peaks[0].at == 108);
  free(peaks);
}

/* A constant curve is level. A curve that ends on a plateau has an edge peak, whatever the
 * rounding. The largest value is reported even if it exceeds the plateau by less than a ripple. */
static void plateaus(void **state) {
  (void)state;
  const double  x[]     = {-2, -1, 0, 1, 2};
  const double  flat[]  = {3, 3 + 1e-9, 3, 3 - 1e-9, 3};
  const double  ends[]  = {1, 2, 3, 3 + 1e-9, 3 - 1e-9};
  const double  bump[]  = {1, 3.02, 3, 3, 3};
  const double *curve[] = {flat, ends, bump};
  const double  at[]    = {-2, 2, -1};
  for (int i = 0; i < 3; i++) {
    post_peak *peaks;
    int        n;
    assert_ok(post_find_peaks(5, x, curve[i], &peaks, &n));
    assert_int_equal(n, 1);
    assert_near(peaks[0].at, at[i], i == 2 ? 0.5 : 0);
    assert_int_equal(peaks[0].edge, i < 2);
    assert_int_equal(peaks[0].level, i == 0);
    free(peaks);
  }
}

/* Near 0 the range sets the scale for the width of a fold pair. */
static void folds_around_zero(void **state) {
  (void)state;
  const double a[] = {1, 2, 3, 4};
  for (int k = 0; k < 4; k++) {
    double     at = k < 2 ? 0 : -100, width = k % 2 ? 1e-9 : 3;
    double     x[4] = {at - 200, at + width, at, at + 200};
    post_fold *folds;
    int        n;
    assert_ok(post_find_folds(4, x, a, (const int[]){0, 1, 1, 0}, &folds, &n));
    assert_int_equal(n, k % 2 ? 0 : 2);
    free(folds);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(resonance),
                                     cmocka_unit_test(order),
                                     cmocka_unit_test(folds),
                                     cmocka_unit_test(turning_back_by_a_hair),
                                     cmocka_unit_test(flagged),
                                     cmocka_unit_test(cases),
                                     cmocka_unit_test(edge),
                                     cmocka_unit_test(closed),
                                     cmocka_unit_test(hairlines_are_no_folds),
                                     cmocka_unit_test(plateaus),
                                     cmocka_unit_test(folds_around_zero),
                                     cmocka_unit_test(ripples_are_no_folds),
                                     cmocka_unit_test(left_the_range)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
