#include "postproc/study/study_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/publish.h"
#include "modal/hdf5/h5.h"

static const char format[] = "shroudhb study";
enum { VERSION = 1, MOST_DESIGNS = 1000000, MOST_COLUMNS = 4096 };

static double coded(double value) {
  return isfinite(value) ? value : STUDY_UNKNOWN;
}

static double decoded(double value) {
  return value == STUDY_UNKNOWN ? NAN : value;
}

/* ---------------------------------------------------------------- writing */

static shb_status no_memory(void) {
  return shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "no memory for a study file");
}

/* Write a matrix of numbers, some of which may be unknown. Nothing is written if it is empty. */
static shb_status put(hid_t file, const char *path, h5_shape shape, const double *data,
                      const char *units, const char *long_name) {
  size_t n = h5_count(shape);
  if (n == 0) return SHB_OK;
  double *copy = malloc(n * sizeof *copy);
  if (!copy) return no_memory();
  for (size_t i = 0; i < n; i++) copy[i] = coded(data[i]);
  shb_status status = h5_write_double(file, path, shape, copy, units, long_name);
  free(copy);
  return status;
}

static shb_status put_columns(hid_t file, const char *name_path, const char *unit_path, int n,
                              const study_column *column) {
  const char **text = calloc((size_t)n + 1, sizeof *text);
  if (!text) return no_memory();
  for (int i = 0; i < n; i++) text[i] = column[i].name;
  shb_status status = n ? h5_write_strings(file, name_path, n, text, "name of the column") : SHB_OK;
  for (int i = 0; i < n; i++) text[i] = column[i].unit;
  if (status == SHB_OK && n) status = h5_write_strings(file, unit_path, n, text, "its SI unit");
  free(text);
  return status;
}

/* Write one number array of every design, `width` numbers each, at `slot` of the design. */
static shb_status put_matrix(hid_t file, const char *path, const design_study *s, int width,
                             size_t slot, const char *long_name) {
  size_t n = (size_t)s->n * (size_t)width;
  if (n == 0) return SHB_OK;
  double *all = malloc(n * sizeof *all);
  if (!all) return no_memory();
  for (int i = 0; i < s->n; i++) {
    const double *row = *(double *const *)((const char *)&s->design[i] + slot);
    memcpy(all + (size_t)i * (size_t)width, row, (size_t)width * sizeof *row);
  }
  shb_status status = put(file, path, H5_SHAPE((hsize_t)s->n, (hsize_t)width), all,
                          "SI; see the column's unit", long_name);
  free(all);
  return status;
}

static shb_status put_designs(hid_t file, const design_study *s) {
  const char **reason  = calloc((size_t)s->n + 1, sizeof *reason);
  const char **digest  = calloc((size_t)s->n + 1, sizeof *digest);
  int         *state   = calloc((size_t)s->n + 1, sizeof *state);
  int         *tried   = calloc((size_t)s->n + 1, sizeof *tried);
  double      *seconds = calloc((size_t)s->n + 1, sizeof *seconds);
  shb_status   status  = reason && digest && state && tried && seconds ? SHB_OK : no_memory();
  for (int i = 0; status == SHB_OK && i < s->n; i++) {
    reason[i]  = s->design[i].reason ? s->design[i].reason : "";
    digest[i]  = s->design[i].digest;
    state[i]   = (int)s->design[i].state;
    tried[i]   = s->design[i].tried_from;
    seconds[i] = s->design[i].seconds;
  }
  h5_shape shape = H5_SHAPE((hsize_t)s->n);
  bool     some  = s->n > 0;
  if (status == SHB_OK && some)
    status = h5_write_int(file, "/design/status", shape, state, "-",
                          "0 not run, 1 done, 2 failed, 3 not converged");
  if (status == SHB_OK && some)
    status = h5_write_int(file, "/design/tried_from", shape, tried, "-",
                          "design, from 0, from whose peak it was tried again; -1: it was not");
  if (status == SHB_OK && some)
    status = h5_write_strings(file, "/design/reason", s->n, reason, "why a design has no output");
  if (status == SHB_OK && some)
    status = h5_write_strings(file, "/design/digest", s->n, digest,
                              "of everything that the outputs depend on");
  if (status == SHB_OK && some)
    status = h5_write_double(file, "/design/seconds", shape, seconds, "s", "CPU time");
  free(reason);
  free(digest);
  free(tried);
  free(state);
  free(seconds);
  return status;
}

/* The points of all designs one after another. */
typedef struct {
  int    *start, *branch, *stable;
  double *frequency, *amplitude;
} flat_curves;

static void free_flat(flat_curves *f) {
  free(f->start);
  free(f->branch);
  free(f->stable);
  free(f->frequency);
  free(f->amplitude);
}

static shb_status take_flat(int n, int points, flat_curves *f) {
  size_t size  = (size_t)points + 1;
  f->start     = calloc((size_t)n + 1, sizeof *f->start);
  f->branch    = calloc(size, sizeof *f->branch);
  f->stable    = calloc(size, sizeof *f->stable);
  f->frequency = calloc(size, sizeof *f->frequency);
  f->amplitude = calloc(size, sizeof *f->amplitude);
  return f->start && f->branch && f->stable && f->frequency && f->amplitude ? SHB_OK : no_memory();
}

static void flatten(const design_study *s, flat_curves *f) {
  for (int i = 0, at = 0; i < s->n; i++) {
    const study_curve *c = &s->design[i].curve;
    for (int p = 0; p < c->n; p++, at++) {
      f->branch[at]    = c->branch[p];
      f->stable[at]    = c->stable[p];
      f->frequency[at] = c->frequency[p];
      f->amplitude[at] = c->amplitude[p];
    }
    f->start[i + 1] = at;
  }
}

static shb_status put_flat(hid_t file, int n, const flat_curves *f) {
  hsize_t  points = (hsize_t)f->start[n];
  h5_shape shape  = H5_SHAPE(points);
  SHB_TRY(h5_write_int(file, "/curve/start", H5_SHAPE((hsize_t)n + 1), f->start, "-",
                       "first point of each design; the last entry is the number of points"));
  if (points == 0) return SHB_OK;
  SHB_TRY(h5_write_int(file, "/curve/branch", shape, f->branch, "-", "branch of the response"));
  SHB_TRY(h5_write_double(file, "/curve/frequency", shape, f->frequency, "Hz", "frequency"));
  SHB_TRY(h5_write_double(file, "/curve/amplitude", shape, f->amplitude, "m",
                          "first harmonic of the first output"));
  return h5_write_int(file, "/curve/stable", shape, f->stable, "-",
                      "1 stable, 0 unstable, -1 not judged");
}

static shb_status put_curves(hid_t file, const design_study *s) {
  flat_curves flat   = {0};
  int         points = 0;
  for (int i = 0; i < s->n; i++) points += s->design[i].curve.n;
  shb_status status = take_flat(s->n, points, &flat);
  if (status == SHB_OK) {
    flatten(s, &flat);
    status = put_flat(file, s->n, &flat);
  }
  free_flat(&flat);
  return status;
}

static shb_status put_optimum(hid_t file, const design_study *s) {
  const study_optimum *o = &s->optimum;
  if (!o->method[0]) return SHB_OK;
  SHB_TRY(h5_write_int(file, "/optimum/on_bound", H5_SHAPE((hsize_t)s->n_keys), o->on_bound, "-",
                       "-1 at the lower bound, 1 at the upper, else 0"));
  if (o->n_history > 0)
    SHB_TRY(h5_write_int(file, "/optimum/history", H5_SHAPE((hsize_t)o->n_history), o->history, "-",
                         "designs, from 0, in the order of evaluation"));
  SHB_TRY(h5_write_attribute_text(file, "/optimum", "method", o->method));
  SHB_TRY(h5_write_attribute_text(file, "/optimum", "objective", o->objective));
  SHB_TRY(h5_write_attribute_text(file, "/optimum", "note", o->note ? o->note : ""));
  return h5_write_attribute_int(file, "/optimum", "best", o->best);
}

/* The arrays of the statistics. rows by columns: 0 stands for the rank 1. */
typedef struct {
  const char *path, *long_name;
  size_t      at;
  bool        rows;    /* a row an output */
  int         columns; /* 0 none, 1 a percentile each, 2 a key each */
} statistic;

#define AT(member) offsetof(study_uncertainty, member)
static const statistic statistics[] = {
    {"/uncertainty/level", "levels of the percentiles, percent", AT(level), false, 1},
    {"/uncertainty/mean", "mean of each output", AT(mean), true, 0},
    {"/uncertainty/deviation", "standard deviation", AT(deviation), true, 0},
    {"/uncertainty/percentile", "percentiles", AT(percentile), true, 1},
    {"/uncertainty/percentile_low", "lower ends of their intervals", AT(percentile_low), true, 1},
    {"/uncertainty/percentile_high", "upper ends of their intervals", AT(percentile_high), true, 1},
    {"/uncertainty/sobol_first", "first-order Sobol' indices", AT(first), true, 2},
    {"/uncertainty/sobol_first_low", "lower ends of their intervals", AT(first_low), true, 2},
    {"/uncertainty/sobol_first_high", "upper ends of their intervals", AT(first_high), true, 2},
    {"/uncertainty/sobol_total", "total Sobol' indices", AT(total), true, 2},
    {"/uncertainty/sobol_total_low", "lower ends of their intervals", AT(total_low), true, 2},
    {"/uncertainty/sobol_total_high", "upper ends of their intervals", AT(total_high), true, 2}};
enum { N_STATISTICS = sizeof statistics / sizeof *statistics };

static h5_shape shape_of(const design_study *s, const statistic *one) {
  hsize_t columns = one->columns == 1 ? (hsize_t)s->uncertainty.n_percentiles : (hsize_t)s->n_keys;
  hsize_t rows    = (hsize_t)s->n_outputs;
  if (!one->rows) return H5_SHAPE(columns);
  return one->columns ? H5_SHAPE(rows, columns) : H5_SHAPE(rows);
}

static shb_status put_uncertainty(hid_t file, const design_study *s) {
  const study_uncertainty *u = &s->uncertainty;
  if (!u->mean) return SHB_OK;
  for (int i = 0; i < N_STATISTICS; i++) {
    const statistic *one = &statistics[i];
    if (one->columns == 2 && !u->has_sobol) continue;
    const double *data = *(double *const *)((const char *)u + one->at);
    SHB_TRY(
        put(file, one->path, shape_of(s, one), data, "SI; see the column's unit", one->long_name));
  }
  SHB_TRY(h5_write_attribute_int(file, "/uncertainty", "samples", u->n_samples));
  SHB_TRY(h5_write_attribute_int(file, "/uncertainty", "failed", u->n_failed));
  return h5_write_attribute_double(file, "/uncertainty", "confidence", u->confidence);
}

/* The arrays of a robust study. */
typedef struct {
  const char *path, *long_name;
  size_t      at;
  bool        per_output, per_level; /* or per varied key without both */
} group_statistic;

#define ROBUST(member) offsetof(study_robust, member)
static const group_statistic group_statistics[] = {
    {"/robust/key", "values of the varied keys of each group", ROBUST(key), false, false},
    {"/robust/level", "levels of the percentiles, percent", ROBUST(level), false, true},
    {"/robust/mean", "mean of each output", ROBUST(mean), true, false},
    {"/robust/deviation", "standard deviation", ROBUST(deviation), true, false},
    {"/robust/percentile", "percentiles", ROBUST(percentile), true, true},
    {"/robust/percentile_low", "lower ends of their intervals", ROBUST(percentile_low), true, true},
    {"/robust/percentile_high", "upper ends of their intervals", ROBUST(percentile_high), true,
     true}};
enum { N_GROUP_STATISTICS = sizeof group_statistics / sizeof *group_statistics };

static h5_shape group_shape(const design_study *s, const group_statistic *one) {
  hsize_t g = (hsize_t)s->robust.n_groups, m = (hsize_t)s->n_outputs,
          q = (hsize_t)s->robust.n_percentiles;
  if (one->per_output) return one->per_level ? H5_SHAPE(g, m, q) : H5_SHAPE(g, m);
  return one->per_level ? H5_SHAPE(q) : H5_SHAPE(g, (hsize_t)s->robust.n_varied);
}

static shb_status put_robust(hid_t file, const design_study *s) {
  const study_robust *r = &s->robust;
  if (r->n_groups == 0) return SHB_OK;
  for (int i = 0; i < N_GROUP_STATISTICS; i++) {
    const group_statistic *one  = &group_statistics[i];
    const double          *data = *(double *const *)((const char *)r + one->at);
    SHB_TRY(put(file, one->path, group_shape(s, one), data, "SI; see the column's unit",
                one->long_name));
  }
  h5_shape groups = H5_SHAPE((hsize_t)r->n_groups);
  SHB_TRY(
      h5_write_int(file, "/robust/samples", groups, r->n_samples, "-", "samples of each group"));
  SHB_TRY(h5_write_int(file, "/robust/failed", groups, r->n_failed, "-", "samples left out"));
  return h5_write_attribute_double(file, "/robust", "confidence", r->confidence);
}

static const char *text_of(const char *text) {
  return text ? text : "";
}

static shb_status put_origin(hid_t file, const design_study *s) {
  shb_provenance origin = {.case_path = text_of(s->case_path),
                           .case_text = text_of(s->case_text),
                           .settings  = "",
                           .command   = "shroudhb-study"};
  SHB_TRY(h5_write_provenance(file, format, VERSION, &origin));
  SHB_TRY(h5_write_attribute_text(file, "/", "kind", "study"));
  SHB_TRY(h5_write_attribute_text(file, "/", "name", text_of(s->name)));
  SHB_TRY(h5_write_attribute_text(file, "/", "plan", s->plan));
  SHB_TRY(h5_write_attribute_text(file, "/", "study_path", text_of(s->path)));
  SHB_TRY(h5_write_attribute_text(file, "/", "study_text", text_of(s->text)));
  return h5_write_attribute_int(file, "/", "finished", s->finished);
}

static shb_status put_case_values(hid_t file, const design_study *s) {
  double *all = calloc((size_t)s->n_derivatives + 1, sizeof *all);
  if (!all) return no_memory();
  for (int i = 0; i < s->n_derivatives; i++) all[i] = s->derivative[i].at;
  shb_status status = put(file, "/derivative/case_value", H5_SHAPE((hsize_t)s->n_derivatives), all,
                          "SI", "value of the parameter in the case");
  free(all);
  return status;
}

static shb_status put_all(hid_t file, const void *context) {
  const design_study *s = context;
  SHB_TRY(put_origin(file, s));
  SHB_TRY(put_columns(file, "/design/key", "/design/unit", s->n_keys, s->key));
  SHB_TRY(put_columns(file, "/output/name", "/output/unit", s->n_outputs, s->output));
  SHB_TRY(
      put_columns(file, "/derivative/key", "/derivative/unit", s->n_derivatives, s->derivative));
  SHB_TRY(put_case_values(file, s));
  SHB_TRY(put_designs(file, s));
  SHB_TRY(put_matrix(file, "/design/value", s, s->n_keys, offsetof(study_design, key),
                     "values of the varied keys"));
  SHB_TRY(
      put_matrix(file, "/output/value", s, s->n_outputs, offsetof(study_design, value), "outputs"));
  SHB_TRY(put_matrix(file, "/output/error", s, s->n_outputs, offsetof(study_design, error),
                     "error estimates of the outputs"));
  SHB_TRY(put_matrix(file, "/derivative/value", s, s->n_derivatives,
                     offsetof(study_design, derivative), "d peak / d parameter"));
  SHB_TRY(put_curves(file, s));
  SHB_TRY(put_optimum(file, s));
  SHB_TRY(put_uncertainty(file, s));
  return put_robust(file, s);
}

shb_status study_file_write(const design_study *s, const char *path) {
  return h5_publish(path, put_all, s);
}

/* ---------------------------------------------------------------- reading */

static void free_texts(int n, char **text) {
  for (int i = 0; text && i < n; i++) free(text[i]);
  free(text);
}

/* Number of entries of a list of texts; 0 if the file has none. */
static shb_status get_texts(hid_t file, const char *path, int *n, char ***text) {
  *n    = 0;
  *text = NULL;
  return h5_exists(file, path) ? h5_read_strings(file, path, n, text) : SHB_OK;
}

/* Number of columns; their texts are read later. */
static shb_status count_columns(hid_t file, const char *path, int *n) {
  char **text;
  SHB_TRY(get_texts(file, path, n, &text));
  free_texts(*n, text);
  SHB_CHECK(*n <= MOST_COLUMNS, SHB_ERR_INPUT, "%s has %d entries, at most %d are wanted", path, *n,
            MOST_COLUMNS);
  return SHB_OK;
}

static shb_status get_column_texts(hid_t file, const char *path, int n, study_column *column,
                                   size_t at, size_t size) {
  char **text;
  int    found;
  SHB_TRY(get_texts(file, path, &found, &text));
  for (int i = 0; i < found && i < n; i++) snprintf((char *)&column[i] + at, size, "%s", text[i]);
  free_texts(found, text);
  SHB_CHECK(found == n, SHB_ERR_INPUT, "%s has %d entries, must have %d", path, found, n);
  return SHB_OK;
}

static shb_status get_columns(hid_t file, const char *name_path, const char *unit_path, int n,
                              study_column *column) {
  SHB_TRY(get_column_texts(file, name_path, n, column, offsetof(study_column, name), STUDY_NAME));
  return get_column_texts(file, unit_path, n, column, offsetof(study_column, unit), STUDY_UNIT);
}

/* Read a matrix into the designs. A missing one leaves unknown numbers. */
static shb_status get_matrix(hid_t file, const char *path, design_study *s, int width,
                             size_t slot) {
  double  *all   = NULL;
  h5_shape shape = H5_SHAPE((hsize_t)s->n, (hsize_t)width);
  if (s->n == 0 || width == 0) return SHB_OK;
  SHB_TRY(h5_read_double(file, path, &shape, &all));
  for (int i = 0; i < s->n; i++) {
    double *row = *(double **)((char *)&s->design[i] + slot);
    for (int j = 0; j < width; j++) row[j] = decoded(all[(size_t)i * (size_t)width + (size_t)j]);
  }
  free(all);
  return SHB_OK;
}

static shb_status add_designs(design_study *s, int n) {
  double *none = calloc((size_t)s->n_keys + 1, sizeof *none);
  bool    good = none != NULL;
  for (int i = 0; good && i < n; i++) good = design_study_add(s, none) != NULL;
  free(none);
  return good ? SHB_OK : no_memory();
}

static shb_status get_states(hid_t file, design_study *s) {
  int     *state = NULL, wrong = -1;
  h5_shape shape = H5_SHAPE(0);
  if (!h5_exists(file, "/design/status")) return SHB_OK;
  SHB_TRY(h5_read_int(file, "/design/status", &shape, &state));
  int        n      = shape.dim[0] > MOST_DESIGNS ? MOST_DESIGNS + 1 : (int)shape.dim[0];
  shb_status status = n <= MOST_DESIGNS
                          ? add_designs(s, n)
                          : shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                                     "/design/status has more than %d entries", MOST_DESIGNS);
  for (int i = 0; status == SHB_OK && i < n; i++) {
    if (state[i] < 0 || state[i] >= STUDY_N_STATES) wrong = i;
    if (wrong < 0) s->design[i].state = (study_state)state[i];
  }
  free(state);
  SHB_TRY(status);
  SHB_CHECK(wrong < 0, SHB_ERR_INPUT, "/design/status[%d] (from 0) must be 0 to %d", wrong,
            STUDY_N_STATES - 1);
  return SHB_OK;
}

static shb_status get_design_texts(hid_t file, design_study *s) {
  char **reason = NULL, **digest = NULL;
  int    n_reasons = 0, n_digests = 0;
  SHB_TRY(get_texts(file, "/design/reason", &n_reasons, &reason));
  shb_status status = get_texts(file, "/design/digest", &n_digests, &digest);
  bool       fits   = n_reasons == s->n && n_digests == s->n;
  for (int i = 0; status == SHB_OK && fits && i < s->n; i++) {
    study_design_set_reason(&s->design[i], reason[i]);
    snprintf(s->design[i].digest, STUDY_DIGEST, "%.*s", STUDY_DIGEST - 1, digest[i]);
  }
  free_texts(n_reasons, reason);
  free_texts(n_digests, digest);
  SHB_TRY(status);
  SHB_CHECK(fits, SHB_ERR_INPUT, "/design has %d states, %d reasons, %d digests", s->n, n_reasons,
            n_digests);
  return SHB_OK;
}

/* Files of former versions do not have it. */
static shb_status get_tried(hid_t file, design_study *s) {
  int     *tried = NULL;
  h5_shape shape = H5_SHAPE((hsize_t)s->n);
  if (s->n == 0 || !h5_exists(file, "/design/tried_from")) return SHB_OK;
  SHB_TRY(h5_read_int(file, "/design/tried_from", &shape, &tried));
  for (int i = 0; i < s->n; i++)
    s->design[i].tried_from = tried[i] >= 0 && tried[i] < s->n ? tried[i] : -1;
  free(tried);
  return SHB_OK;
}

static shb_status get_seconds(hid_t file, design_study *s) {
  double  *seconds = NULL;
  h5_shape shape   = H5_SHAPE((hsize_t)s->n);
  if (s->n == 0) return SHB_OK;
  SHB_TRY(h5_read_double(file, "/design/seconds", &shape, &seconds));
  for (int i = 0; i < s->n; i++) s->design[i].seconds = seconds[i];
  free(seconds);
  return SHB_OK;
}

static shb_status get_flat(hid_t file, int n, flat_curves *f) {
  h5_shape all = H5_SHAPE((hsize_t)n + 1);
  SHB_TRY(h5_read_int(file, "/curve/start", &all, &f->start));
  bool good = f->start[0] == 0;
  for (int i = 0; i < n; i++) good = good && f->start[i + 1] >= f->start[i];
  SHB_CHECK(good, SHB_ERR_INPUT, "/curve/start must begin with 0 and ascend");
  if (f->start[n] == 0) return SHB_OK;
  h5_shape points = H5_SHAPE((hsize_t)f->start[n]);
  SHB_TRY(h5_read_int(file, "/curve/branch", &points, &f->branch));
  SHB_TRY(h5_read_int(file, "/curve/stable", &points, &f->stable));
  SHB_TRY(h5_read_double(file, "/curve/frequency", &points, &f->frequency));
  return h5_read_double(file, "/curve/amplitude", &points, &f->amplitude);
}

static shb_status unflatten(const flat_curves *f, design_study *s) {
  for (int i = 0; i < s->n; i++) {
    int          n = f->start[i + 1] - f->start[i];
    study_curve *c = &s->design[i].curve;
    if (n == 0) continue;
    SHB_TRY(study_curve_take(c, n));
    for (int p = 0, at = f->start[i]; p < n; p++, at++) {
      c->branch[p]    = f->branch[at];
      c->stable[p]    = f->stable[at];
      c->frequency[p] = f->frequency[at];
      c->amplitude[p] = f->amplitude[at];
    }
  }
  return SHB_OK;
}

static shb_status get_curves(hid_t file, design_study *s) {
  flat_curves flat   = {0};
  shb_status  status = get_flat(file, s->n, &flat);
  if (status == SHB_OK) status = unflatten(&flat, s);
  free_flat(&flat);
  return status;
}

static shb_status get_label(hid_t file, const char *path, const char *name, char out[STUDY_NAME]) {
  char *text = NULL;
  SHB_TRY(h5_read_attribute_text(file, path, name, &text));
  snprintf(out, STUDY_NAME, "%s", text_of(text));
  free(text);
  return SHB_OK;
}

/* Read design numbers; each must be below the number of designs. */
static shb_status get_history(hid_t file, design_study *s) {
  study_optimum *o     = &s->optimum;
  h5_shape       shape = H5_SHAPE(0);
  bool           good  = true;
  int           *found = NULL;
  if (!h5_exists(file, "/optimum/history")) return design_study_take_optimum(s, 0);
  SHB_TRY(h5_read_int(file, "/optimum/history", &shape, &found));
  int        n      = shape.dim[0] > MOST_DESIGNS ? 0 : (int)shape.dim[0];
  shb_status status = design_study_take_optimum(s, n);
  for (int i = 0; status == SHB_OK && i < n; i++) {
    o->history[i] = found[i];
    good          = good && found[i] >= 0 && found[i] < s->n;
  }
  free(found);
  SHB_TRY(status);
  SHB_CHECK(good, SHB_ERR_INPUT, "/optimum/history names a design that is not there");
  return SHB_OK;
}

static shb_status get_optimum(hid_t file, design_study *s) {
  study_optimum *o        = &s->optimum;
  h5_shape       keys     = H5_SHAPE((hsize_t)s->n_keys);
  int           *on_bound = NULL;
  if (!h5_exists(file, "/optimum")) return SHB_OK;
  SHB_TRY(get_history(file, s));
  SHB_TRY(get_label(file, "/optimum", "method", o->method));
  SHB_TRY(get_label(file, "/optimum", "objective", o->objective));
  SHB_TRY(h5_read_attribute_text(file, "/optimum", "note", &o->note));
  SHB_TRY(h5_read_attribute_int(file, "/optimum", "best", -1, &o->best));
  SHB_CHECK(o->best >= -1 && o->best < s->n, SHB_ERR_INPUT, "/optimum: best is not a design");
  SHB_TRY(h5_read_int(file, "/optimum/on_bound", &keys, &on_bound));
  memcpy(o->on_bound, on_bound, (size_t)s->n_keys * sizeof *on_bound);
  free(on_bound);
  return SHB_OK;
}

static shb_status get_statistic(hid_t file, design_study *s, const statistic *one) {
  h5_shape shape = shape_of(s, one);
  double  *found = NULL, *data = *(double **)((char *)&s->uncertainty + one->at);
  if (h5_count(shape) == 0) return SHB_OK;
  SHB_TRY(h5_read_double(file, one->path, &shape, &found));
  for (size_t i = 0; i < h5_count(shape); i++) data[i] = decoded(found[i]);
  free(found);
  return SHB_OK;
}

static shb_status get_uncertainty(hid_t file, design_study *s) {
  study_uncertainty *u     = &s->uncertainty;
  h5_shape           shape = {0};
  if (!h5_exists(file, "/uncertainty")) return SHB_OK;
  if (h5_exists(file, "/uncertainty/level"))
    SHB_TRY(h5_shape_of(file, "/uncertainty/level", &shape));
  bool fits = shape.rank == 0 || (shape.rank == 1 && shape.dim[0] <= MOST_COLUMNS);
  SHB_CHECK(fits, SHB_ERR_INPUT, "/uncertainty/level must be a list");
  SHB_TRY(design_study_take_uncertainty(s, shape.rank ? (int)shape.dim[0] : 0,
                                        h5_exists(file, "/uncertainty/sobol_first")));
  for (int i = 0; i < N_STATISTICS; i++)
    if (statistics[i].columns != 2 || u->has_sobol) SHB_TRY(get_statistic(file, s, &statistics[i]));
  SHB_TRY(h5_read_attribute_int(file, "/uncertainty", "samples", 0, &u->n_samples));
  SHB_TRY(h5_read_attribute_int(file, "/uncertainty", "failed", 0, &u->n_failed));
  return h5_read_attribute_double(file, "/uncertainty", "confidence", NAN, &u->confidence);
}

static shb_status get_group_counts(hid_t file, const char *path, const design_study *s, int *out) {
  h5_shape groups = H5_SHAPE((hsize_t)s->robust.n_groups);
  int     *found  = NULL;
  SHB_TRY(h5_read_int(file, path, &groups, &found));
  memcpy(out, found, (size_t)s->robust.n_groups * sizeof *out);
  free(found);
  return SHB_OK;
}

static shb_status get_robust(hid_t file, design_study *s) {
  h5_shape keys = {0}, levels = {0};
  if (!h5_exists(file, "/robust")) return SHB_OK;
  SHB_TRY(h5_shape_of(file, "/robust/key", &keys));
  SHB_TRY(h5_shape_of(file, "/robust/level", &levels));
  bool fits = keys.rank == 2 && keys.dim[0] <= (hsize_t)s->n && keys.dim[0] > 0 &&
              keys.dim[1] > 0 && keys.dim[1] <= (hsize_t)s->n_keys && levels.rank == 1 &&
              levels.dim[0] <= MOST_COLUMNS;
  SHB_CHECK(fits, SHB_ERR_INPUT, "/robust does not fit to the designs");
  SHB_TRY(design_study_take_robust(s, (int)keys.dim[0], (int)keys.dim[1], (int)levels.dim[0]));
  for (int i = 0; i < N_GROUP_STATISTICS; i++) {
    const group_statistic *one   = &group_statistics[i];
    double                *found = NULL, *data = *(double **)((char *)&s->robust + one->at);
    h5_shape               shape = group_shape(s, one);
    SHB_TRY(h5_read_double(file, one->path, &shape, &found));
    for (size_t k = 0; k < h5_count(shape); k++) data[k] = decoded(found[k]);
    free(found);
  }
  SHB_TRY(get_group_counts(file, "/robust/samples", s, s->robust.n_samples));
  SHB_TRY(get_group_counts(file, "/robust/failed", s, s->robust.n_failed));
  return h5_read_attribute_double(file, "/robust", "confidence", NAN, &s->robust.confidence);
}

static shb_status get_origin(hid_t file, design_study *s) {
  int finished = 0;
  SHB_TRY(h5_read_attribute_text(file, "/", "name", &s->name));
  SHB_TRY(h5_read_attribute_text(file, "/", "study_path", &s->path));
  SHB_TRY(h5_read_attribute_text(file, "/", "study_text", &s->text));
  SHB_TRY(h5_read_attribute_text(file, "/", "case_path", &s->case_path));
  SHB_TRY(h5_read_attribute_text(file, "/", "case_text", &s->case_text));
  SHB_TRY(get_label(file, "/", "plan", s->plan));
  SHB_TRY(h5_read_attribute_int(file, "/", "finished", 0, &finished));
  s->finished = finished != 0;
  return SHB_OK;
}

static shb_status get_case_values(hid_t file, design_study *s) {
  double  *all   = NULL;
  h5_shape shape = H5_SHAPE((hsize_t)s->n_derivatives);
  if (s->n_derivatives == 0 || !h5_exists(file, "/derivative/case_value")) return SHB_OK;
  SHB_TRY(h5_read_double(file, "/derivative/case_value", &shape, &all));
  for (int i = 0; i < s->n_derivatives; i++) s->derivative[i].at = decoded(all[i]);
  free(all);
  return SHB_OK;
}

static shb_status get_all(hid_t file, design_study *s) {
  int n_keys, n_outputs, n_derivatives;
  SHB_TRY(h5_check_format(file, format, VERSION));
  SHB_TRY(count_columns(file, "/design/key", &n_keys));
  SHB_TRY(count_columns(file, "/output/name", &n_outputs));
  SHB_TRY(count_columns(file, "/derivative/key", &n_derivatives));
  SHB_TRY(design_study_create(n_keys, n_outputs, n_derivatives, s));
  SHB_TRY(get_origin(file, s));
  SHB_TRY(get_columns(file, "/design/key", "/design/unit", n_keys, s->key));
  SHB_TRY(get_columns(file, "/output/name", "/output/unit", n_outputs, s->output));
  SHB_TRY(get_columns(file, "/derivative/key", "/derivative/unit", n_derivatives, s->derivative));
  SHB_TRY(get_case_values(file, s));
  SHB_TRY(get_states(file, s));
  SHB_TRY(get_design_texts(file, s));
  SHB_TRY(get_tried(file, s));
  SHB_TRY(get_seconds(file, s));
  SHB_TRY(get_matrix(file, "/design/value", s, n_keys, offsetof(study_design, key)));
  SHB_TRY(get_matrix(file, "/output/value", s, n_outputs, offsetof(study_design, value)));
  SHB_TRY(get_matrix(file, "/output/error", s, n_outputs, offsetof(study_design, error)));
  SHB_TRY(
      get_matrix(file, "/derivative/value", s, n_derivatives, offsetof(study_design, derivative)));
  SHB_TRY(get_curves(file, s));
  SHB_TRY(get_optimum(file, s));
  SHB_TRY(get_uncertainty(file, s));
  return get_robust(file, s);
}

shb_status study_file_read(const char *path, design_study *s) {
  hid_t file;
  *s = (design_study){0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = get_all(file, s);
  h5_close(file);
  if (status != SHB_OK) design_study_free(s);
  return status;
}
