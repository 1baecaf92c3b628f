#include "mhb/numerics/vector.h"

#include <math.h>

double mhb_norm(const double *x, int n) {
  double top = 0, sum = 0;
  for (int i = 0; i < n; i++) top = fmax(top, fabs(x[i]));
  for (int i = 0; i < n && top == 0; i++) /* fmax passes over NaN */
    if (isnan(x[i])) return NAN;
  if (top == 0) return 0;
  for (int i = 0; i < n; i++) sum += (x[i] / top) * (x[i] / top);
  return top * sqrt(sum);
}

double mhb_dot(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}
