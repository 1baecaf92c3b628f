#include "cases/commands/modal_changes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fem/element/load.h"

enum { NUMBERS = 3 };

_Static_assert((int)MODAL_REVISED_HARMONICS >= (int)FEM_MAX_LOAD_HARMONICS, "harmonics");

/* Relative difference of two ratios that rounding explains. */
static const double rounding = 1e-14;

/* Length of the key of a line "KEY = VALUE". */
static size_t key_length(const char *line) {
  return strcspn(line, " \n");
}

static const char *value_of(const char *line) {
  const char *sign = strstr(line, " = ");
  return sign ? sign + 3 : "";
}

static bool is_key(const char *line, const char *key) {
  return key_length(line) == strlen(key) && strncmp(line, key, strlen(key)) == 0;
}

/* Numbers of a line, at most NUMBERS; returns how many. */
static int numbers(const char *text, double value[NUMBERS]) {
  int   n = 0;
  char *end;
  for (const char *at = text; n < NUMBERS && *at && *at != '\n'; at = end) {
    value[n] = strtod(at, &end);
    if (end == at) break;
    n++;
  }
  return n;
}

/* Ratio of two real vectors; false if they are not parallel, or one is zero. */
static bool vector_ratio(const char *earlier, const char *now, double complex *ratio) {
  double    a[NUMBERS], b[NUMBERS], most = 0;
  int       largest = 0;
  const int n       = numbers(earlier, a);
  if (n == 0 || numbers(now, b) != n) return false;
  for (int i = 0; i < n; i++)
    if (fabs(a[i]) > most) most = fabs(a[largest = i]);
  if (most == 0 || b[largest] == 0) return false;
  const double r = b[largest] / a[largest];
  for (int i = 0; i < n; i++)
    if (fabs(b[i] - r * a[i]) > rounding * fabs(b[largest])) return false;
  *ratio = r;
  return true;
}

static bool factor_ratio(const char *earlier, const char *now, double complex *ratio) {
  double a[NUMBERS], b[NUMBERS];
  if (numbers(earlier, a) != 2 || numbers(now, b) != 2) return false;
  const double complex from = CMPLX(a[0], a[1]), to = CMPLX(b[0], b[1]);
  if (from == 0 || to == 0) return false;
  *ratio = to / from;
  return true;
}

static void scale(modal_revision *out, double complex ratio) {
  for (int k = 0; k <= MODAL_REVISED_HARMONICS; k++) out->ratio[k] *= ratio;
}

/* Two lines of one key whose values differ. */
static bool take(const char *earlier, const char *now, modal_revision *out) {
  static const char harmonics[] = "excitation.harmonics.";
  double complex    ratio;
  if (is_key(now, "modal.damping")) return true;
  if (is_key(now, "excitation.pressure") || is_key(now, "excitation.traction") ||
      is_key(now, "excitation.force.vector")) {
    if (!vector_ratio(value_of(earlier), value_of(now), &ratio)) return false;
    scale(out, ratio);
    return true;
  }
  if (strncmp(now, harmonics, strlen(harmonics)) != 0) return false;
  const long k = strtol(now + strlen(harmonics), NULL, 10);
  if (k < 0 || k > MODAL_REVISED_HARMONICS) return false;
  if (!factor_ratio(value_of(earlier), value_of(now), &ratio)) return false;
  out->ratio[k] *= ratio;
  return true;
}

bool modal_changes_find(const char *earlier, const char *settings, modal_revision *out) {
  for (int k = 0; k <= MODAL_REVISED_HARMONICS; k++) out->ratio[k] = 1;
  const char *a = earlier, *b = settings;
  while (*a && *b) {
    const size_t la = strcspn(a, "\n"), lb = strcspn(b, "\n"), key = key_length(a);
    if (key != key_length(b) || strncmp(a, b, key) != 0) return false;
    const bool same = la == lb && strncmp(a, b, la) == 0;
    if (!same && !take(a, b, out)) return false;
    a += la + (a[la] == '\n');
    b += lb + (b[lb] == '\n');
  }
  return !*a && !*b;
}
