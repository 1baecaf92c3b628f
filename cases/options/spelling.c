#include "cases/options/spelling.h"

#include <limits.h>
#include <string.h>

static int lower(char c) {
  return c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c;
}

static int smaller(int a, int b) {
  return a < b ? a : b;
}

/* Optimal string alignment distance. Words above CASE_LONGEST_WORD have the largest distance. */
int case_edit_distance(const char *a, const char *b) {
  size_t n = strlen(a), m = strlen(b);
  if (n > CASE_LONGEST_WORD || m > CASE_LONGEST_WORD) return INT_MAX;
  int d[CASE_LONGEST_WORD + 1][CASE_LONGEST_WORD + 1];
  for (size_t i = 0; i <= n; i++) d[i][0] = (int)i;
  for (size_t j = 0; j <= m; j++) d[0][j] = (int)j;
  for (size_t i = 1; i <= n; i++) {
    for (size_t j = 1; j <= m; j++) {
      int p = lower(a[i - 1]), q = lower(b[j - 1]);
      d[i][j] = smaller(smaller(d[i - 1][j] + 1, d[i][j - 1] + 1), d[i - 1][j - 1] + (p != q));
      if (i > 1 && j > 1 && p == lower(b[j - 2]) && q == lower(a[i - 2]))
        d[i][j] = smaller(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[n][m];
}
