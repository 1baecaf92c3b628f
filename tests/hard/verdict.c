#include "tests/hard/verdict.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/numerics/fourier.h"

static int failures;

static void row(int good, const char *figure, const char *format, va_list list) {
  char text[160];
  vsnprintf(text, sizeof text, format, list);
  print_message("  %-62s %-26s %s\n", text, figure, good ? "pass" : "FAIL");
  failures += !good;
}

void verdict(double figure, double bound, const char *text, ...) {
  char    shown[64];
  va_list list;
  snprintf(shown, sizeof shown, "%9.2e <= %.1e", figure, bound);
  va_start(list, text);
  row(figure <= bound, shown, text, list);
  va_end(list);
}

void verdict_count(int count, int wanted, const char *text, ...) {
  char    shown[64];
  va_list list;
  snprintf(shown, sizeof shown, "%9d of %d", count, wanted);
  va_start(list, text);
  row(count == wanted, shown, text, list);
  va_end(list);
}

void verdict_all(void) {
  int n    = failures;
  failures = 0;
  if (n) fail_msg("%d rows failed", n);
}

mhb_response *covered_sweep(const modal_model *model, mhb_settings *s, double from, double to) {
  mhb_response *r = NULL;
  s->frequency[0] = from / SHB_TWO_PI;
  s->frequency[1] = to / SHB_TWO_PI;
  int status      = mhb_forced_response(model, s, NULL, NULL, NULL, &r);
  if (!r) fail_msg("no response: %s", shb_message());
  assert_true(status == SHB_OK || status == SHB_NOT_CONVERGED);
  for (int i = 2; i < r->n_branches; i++)
    if (!r->branch[i].complete)
      verdict_count(0, 1, "n0 %g covers the range (%s)",
                    r->branch[i].n_points ? r->branch[i].n0[0] : NAN, r->branch[i].reason);
  return r;
}

void point_of(const mhb_response *r, const mhb_branch *b, int i, double share, double *x) {
  int K = r->n_harmonics + 1, nb = mhb_real_size(r->n_harmonics), rows = 3 * r->n_pairs;
  for (int c = 0; c < rows; c++) {
    double complex A[K];
    for (int k = 0; k < K; k++)
      A[k] = (1 - share) * b->motion[(i * rows + c) * K + k] +
             (share > 0 ? share * b->motion[((i + 1) * rows + c) * K + k] : 0);
    mhb_to_real(r->n_harmonics, A, x + c * nb);
  }
}

double harmonic_of(const mhb_response *r, const mhb_branch *b, int point, int c, int k) {
  return cabs(b->motion[(point * 3 * r->n_pairs + c) * (r->n_harmonics + 1) + k]);
}

int count_special(const mhb_branch *b, int special) {
  int n = 0;
  for (int i = 0; i < b->n_points; i++) n += b->special[i] == special;
  return n;
}

int special_near(const mhb_branch *b, int special, double w) {
  int best = -1;
  for (int i = 0; i < b->n_points; i++) {
    if (b->special[i] != special) continue;
    double off = fabs(SHB_TWO_PI * b->frequency[i] - w);
    if (best < 0 || off < fabs(SHB_TWO_PI * b->frequency[best] - w)) best = i;
  }
  return best;
}

int distinct(const mhb_branch *b, int i, int step) {
  int k = i + step;
  while (k > 0 && k + 1 < b->n_points && fabs(b->frequency[k] / b->frequency[i] - 1) < 1e-7 &&
         b->special[k] != 0)
    k += step;
  return k;
}
