#include "mhb/response/response_samples.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Probability beyond each bound. */
static const double BEYOND = 0.025;

enum { QUANTILES = 3 };
static const double QUANTILE[QUANTILES] = {0.5, 0.95, 0.99};

mhb_samples *mhb_samples_create(int n, int preloads, int blades) {
  mhb_samples *s   = shb_alloc_zeroed(1, sizeof *s);
  const size_t all = (size_t)n * (size_t)preloads;
  *s               = (mhb_samples){.n = n, .preloads = preloads, .blades = blades};
  s->n0            = shb_alloc_zeroed((size_t)preloads, sizeof(double));
  s->deviation     = shb_alloc_zeroed((size_t)n * (size_t)blades, sizeof(double));
  s->factor        = shb_alloc_zeroed(all, sizeof(double));
  s->frequency     = shb_alloc_zeroed(all, sizeof(double));
  s->blade         = shb_alloc_zeroed(all, sizeof(int));
  s->mark          = shb_alloc_zeroed(all, sizeof(int));
  return s;
}

void mhb_samples_destroy(mhb_samples *s) {
  if (!s) return;
  free(s->n0);
  free(s->deviation);
  free(s->factor);
  free(s->frequency);
  free(s->blade);
  free(s->mark);
  free(s);
}

static const double *factors_of(const mhb_samples *s, int preload) {
  return s->factor + (size_t)preload * (size_t)s->n;
}

int mhb_samples_done(const mhb_samples *s, int preload) {
  int done = 0;
  for (int i = 0; i < s->n; i++) done += factors_of(s, preload)[i] > 0;
  return done;
}

static bool is_result(const mhb_samples *s, int preload, int i) {
  return factors_of(s, preload)[i] > 0 && !s->mark[(size_t)preload * (size_t)s->n + (size_t)i];
}

int mhb_samples_marked(const mhb_samples *s, int preload) {
  int results = 0;
  for (int i = 0; i < s->n; i++) results += is_result(s, preload, i);
  return mhb_samples_done(s, preload) - results;
}

int mhb_samples_worst(const mhb_samples *s, int preload) {
  const double *factor = factors_of(s, preload);
  int           worst  = -1;
  for (int i = 0; i < s->n; i++)
    if (is_result(s, preload, i) && (worst < 0 || factor[i] > factor[worst])) worst = i;
  return worst;
}

/* ---- distribution ---- */

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* P(B = k) of B binomial in n trials of probability p. */
static double binomial(int n, int k, double p) {
  return exp(lgamma(n + 1.) - lgamma(k + 1.) - lgamma(n - k + 1.) + k * log(p) +
             (n - k) * log1p(-p));
}

/* Ranks from 1: x_(low) <= quantile <= x_(high), each wrong with a probability of at most BEYOND;
 * 0: none. B samples are below the quantile: x_(r) is above it if B < r. */
static void ranks(int n, double p, int *low, int *high) {
  double below = 0, above = 0;
  *low = *high = 0;
  for (int r = 1; r <= n; r++) {
    below += binomial(n, r - 1, p); /* P(B <= r - 1) */
    if (below > BEYOND) break;
    *low = r;
  }
  for (int r = n; r >= 1; r--) {
    above += binomial(n, r, p); /* P(B >= r) */
    if (above > BEYOND) break;
    *high = r;
  }
}

/* A marked sample counts as the least of all for the lower bound, as the largest for the upper. */
void mhb_samples_quantile(const mhb_samples *s, int preload, double p, double out[3]) {
  const int n = mhb_samples_done(s, preload), marked = mhb_samples_marked(s, preload);
  double   *x = shb_alloc((size_t)n, sizeof *x);
  int       low, high, m = 0;
  out[0] = out[1] = out[2] = NAN;
  for (int i = 0; i < s->n; i++)
    if (is_result(s, preload, i)) x[m++] = factors_of(s, preload)[i];
  if (m > 0) {
    qsort(x, (size_t)m, sizeof *x, by_value);
    const double at = p * (m - 1), part = at - floor(at);
    const int    i = (int)at;
    out[0]         = i + 1 < m ? (1 - part) * x[i] + part * x[i + 1] : x[m - 1];
    ranks(n, p, &low, &high);
    if (low > marked) out[1] = x[low - 1 - marked];
    if (high > 0 && high <= m) out[2] = x[high - 1];
  }
  free(x);
}

/* ---- file ---- */

static shb_status write_distribution(hid_t file, const mhb_samples *s) {
  const hsize_t preloads = (hsize_t)s->preloads;
  double        all[s->preloads * QUANTILES * 3];
  int           worst[s->preloads];
  for (int i = 0; i < s->preloads; i++) {
    worst[i] = mhb_samples_worst(s, i);
    for (int q = 0; q < QUANTILES; q++)
      mhb_samples_quantile(s, i, QUANTILE[q], all + (size_t)(i * QUANTILES + q) * 3);
  }
  for (int i = 0; i < s->preloads * QUANTILES * 3; i++)
    if (isnan(all[i])) all[i] = 0;
  SHB_TRY(h5_write_double(file, "/samples/quantile", H5_SHAPE(QUANTILES), QUANTILE, "-",
                          "of the amplification factor"));
  SHB_TRY(h5_write_double(
      file, "/samples/distribution", H5_SHAPE(preloads, QUANTILES, 3), all, "-",
      "quantiles of the amplification factor: value of the samples not marked, lower "
      "and upper bound of 95 % confidence wherever the marked ones are; 0: too "
      "few samples"));
  return h5_write_int(file, "/samples/worst", H5_SHAPE(preloads), worst, "-",
                      "sample with the largest factor, from 0, of those not marked; -1: none");
}

shb_status mhb_samples_write(hid_t file, const mhb_samples *s) {
  const hsize_t n = (hsize_t)s->n, preloads = (hsize_t)s->preloads;
  SHB_TRY(h5_write_double(file, "/samples/n0", H5_SHAPE(preloads), s->n0, "N", "normal preload"));
  SHB_TRY(h5_write_double(file, "/samples/deviation", H5_SHAPE(n, (hsize_t)s->blades), s->deviation,
                          "-", "relative frequency deviations of the blades of each sample"));
  SHB_TRY(h5_write_double(file, "/samples/factor", H5_SHAPE(preloads, n), s->factor, "-",
                          "amplification factor: worst blade over the tuned peak; 0: not done"));
  SHB_TRY(h5_write_double(file, "/samples/frequency", H5_SHAPE(preloads, n), s->frequency, "Hz",
                          "where the worst blade is highest"));
  SHB_TRY(h5_write_int(file, "/samples/blade", H5_SHAPE(preloads, n), s->blade, "-",
                       "the worst blade, from 0"));
  SHB_TRY(h5_write_int(file, "/samples/mark", H5_SHAPE(preloads, n), s->mark, "-",
                       "1: the estimated error of the peak, or of the tuned one, is above the "
                       "tolerance; the sample is no result"));
  return write_distribution(file, s);
}

/* Read a list into an array that is there. */
static shb_status read_into(hid_t file, const char *name, h5_shape shape, double *to) {
  double *values;
  SHB_TRY(h5_read_double(file, name, &shape, &values));
  memcpy(to, values, sizeof *to * h5_count(shape));
  free(values);
  return SHB_OK;
}

static shb_status read_all(hid_t file, mhb_samples *s) {
  h5_shape table = H5_SHAPE((hsize_t)s->preloads, (hsize_t)s->n);
  int     *blade, *mark;
  SHB_TRY(read_into(file, "/samples/n0", H5_SHAPE((hsize_t)s->preloads), s->n0));
  SHB_TRY(read_into(file, "/samples/deviation", H5_SHAPE((hsize_t)s->n, (hsize_t)s->blades),
                    s->deviation));
  SHB_TRY(read_into(file, "/samples/factor", table, s->factor));
  SHB_TRY(read_into(file, "/samples/frequency", table, s->frequency));
  SHB_TRY(h5_read_int(file, "/samples/blade", &table, &blade));
  memcpy(s->blade, blade, sizeof *blade * h5_count(table));
  free(blade);
  if (!h5_exists(file, "/samples/mark")) return SHB_OK; /* earlier versions */
  SHB_TRY(h5_read_int(file, "/samples/mark", &table, &mark));
  memcpy(s->mark, mark, sizeof *mark * h5_count(table));
  free(mark);
  return SHB_OK;
}

shb_status mhb_samples_read(hid_t file, mhb_samples **out) {
  h5_shape table, pattern;
  *out = NULL;
  if (!h5_exists(file, "/samples")) return SHB_OK;
  SHB_TRY(h5_shape_of(file, "/samples/factor", &table));
  SHB_TRY(h5_shape_of(file, "/samples/deviation", &pattern));
  SHB_CHECK(table.rank == 2 && pattern.rank == 2 && table.dim[1] == pattern.dim[0] &&
                table.dim[0] * table.dim[1] <= 1 << 24 && pattern.dim[1] <= 1 << 14,
            SHB_ERR_INPUT, "/samples/factor and /samples/deviation do not fit together");
  *out              = mhb_samples_create((int)table.dim[1], (int)table.dim[0], (int)pattern.dim[1]);
  shb_status status = read_all(file, *out);
  if (status == SHB_OK) return SHB_OK;
  mhb_samples_destroy(*out);
  *out = NULL;
  return status;
}
