/* NAME.converge.h5. Unknown numbers are written as -1: HDF5 files of ours hold finite numbers
 * only. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"
#include "postproc/analysis/convergence.h"

static const char format[] = "shroudhb convergence";
enum { VERSION = 1, MOST_RUNGS = 10000 };

static const struct {
  const char *path, *units, *long_name;
  size_t      at;
} columns[] = {
    {"/unknowns", "-", "unknowns of the balance; of the finite elements for a mesh",
     offsetof(post_rung, unknowns)},
    {"/seconds", "s", "one core, the balance; with meshing and modes for a mesh",
     offsetof(post_rung, seconds)},
    {"/total", "s", "with the program's start and reading", offsetof(post_rung, total)},
    {"/memory", "bytes", "greatest resident memory", offsetof(post_rung, memory)},
    {"/error/peak", "-", "relative error of the highest peak, worst preload",
     offsetof(post_rung, peak)},
    {"/error/frequency", "-", "relative error of its frequency", offsetof(post_rung, frequency)},
    {"/error/curve", "-", "distance of the curves: greater of |ln f/f'| and |a - a'|/max a",
     offsetof(post_rung, curve)},
    {"/error/integration", "-",
     "|a - a'|/max a at the points of time integration, against those, the greatest",
     offsetof(post_rung, integration)},
};
enum { N_COLUMNS = sizeof columns / sizeof *columns, N_CODES = 4 };

static const struct {
  const char *path, *long_name;
  int         most;
} codes[N_CODES] = {
    {"/ladder",
     "0 harmonics, 1 auto, 2 accuracy, 3 modes, 4 modes without residual, 5 mesh, 6 together, "
     "7 contact points",
     POST_N_LADDERS - 1},
    {"/state", "0 not run, 1 complete, 2 a curve has a gap, 3 failed", POST_RUNG_FAILED},
    {"/reference", "1: the finest of its ladder", 1},
    {"/of_case", "1: as in the case", 1}};

static double *slot(post_rung *r, int column) {
  return (double *)((char *)r + columns[column].at);
}

static int code_of(const post_rung *r, int which) {
  const int value[N_CODES] = {(int)r->ladder, (int)r->state, r->reference, r->of_case};
  return value[which];
}

static void set_code(post_rung *r, int which, int value) {
  if (which == 0) r->ladder = (post_ladder)value;
  if (which == 1) r->state = (post_rung_state)value;
  if (which == 2) r->reference = value != 0;
  if (which == 3) r->of_case = value != 0;
}

/* ---------------------------------------------------------------- writing */

static shb_status write_lists(hid_t file, const post_convergence *s, const char **name,
                              double *real, int *whole) {
  h5_shape shape = H5_SHAPE((hsize_t)s->n);
  for (int i = 0; i < s->n; i++) name[i] = s->rung[i].name;
  SHB_TRY(h5_write_strings(file, "/rung", s->n, name, "the setting"));
  for (int c = 0; c < N_CODES; c++) {
    for (int i = 0; i < s->n; i++) whole[i] = code_of(&s->rung[i], c);
    SHB_TRY(h5_write_int(file, codes[c].path, shape, whole, "-", codes[c].long_name));
  }
  for (int c = 0; c < N_COLUMNS; c++) {
    for (int i = 0; i < s->n; i++) {
      double value = *slot(&s->rung[i], c);
      real[i]      = isfinite(value) ? value : -1;
    }
    SHB_TRY(h5_write_double(file, columns[c].path, shape, real, columns[c].units,
                            columns[c].long_name));
  }
  return SHB_OK;
}

typedef struct {
  const post_convergence *convergence;
  const shb_provenance   *provenance;
} contents;

static shb_status write_parts(hid_t file, const void *context) {
  const contents         *c = context;
  const post_convergence *s = c->convergence;
  SHB_TRY(h5_write_provenance(file, format, VERSION, c->provenance));
  SHB_TRY(h5_write_attribute_text(file, "/", "output", s->output));
  SHB_TRY(h5_write_attribute_text(file, "/", "note", s->note ? s->note : ""));
  SHB_TRY(h5_write_attribute_double(file, "/", "tolerance", s->tolerance));
  SHB_TRY(h5_write_attribute_int(file, "/", "preloads", s->n_preloads));
  SHB_TRY(h5_write_attribute_int(file, "/", "integration_points", s->n_points));
  size_t       n      = (size_t)s->n + 1;
  const char **name   = calloc(n, sizeof *name);
  double      *real   = calloc(n, sizeof *real);
  int         *whole  = calloc(n, sizeof *whole);
  shb_status   status = name && real && whole ? write_lists(file, s, name, real, whole)
                                              : shb_fail(SHB_ERR_IO, __FILE__, __LINE__,
                                                         "no memory for %d rungs", s->n);
  free(name);
  free(real);
  free(whole);
  return status;
}

shb_status post_convergence_write(const post_convergence *s, const char *path,
                                  const shb_provenance *provenance) {
  return h5_publish(path, write_parts, &(contents){s, provenance});
}

/* ---------------------------------------------------------------- reading */

static shb_status read_names(hid_t file, const char *path, post_convergence *s) {
  char **name = NULL;
  int    n    = 0;
  SHB_TRY(h5_read_strings(file, "/rung", &n, &name));
  bool fits = n >= 0 && n <= MOST_RUNGS;
  for (int i = 0; i < n; i++) {
    post_rung *r = fits ? post_convergence_add(s) : NULL;
    if (r) snprintf(r->name, sizeof r->name, "%s", name[i]);
    free(name[i]);
  }
  free(name);
  SHB_CHECK(fits && s->n == n, SHB_ERR_INPUT, "%s: /rung holds %d rungs; at most %d are wanted",
            path, n, MOST_RUNGS);
  return SHB_OK;
}

static shb_status read_codes(hid_t file, const char *path, int which, post_convergence *s) {
  h5_shape shape = H5_SHAPE((hsize_t)s->n);
  int     *value = NULL, wrong = -1;
  SHB_TRY(h5_read_int(file, codes[which].path, &shape, &value));
  for (int i = 0; i < s->n; i++) {
    if (value[i] < 0 || value[i] > codes[which].most) wrong = i;
    if (wrong < 0) set_code(&s->rung[i], which, value[i]);
  }
  int found = wrong < 0 ? 0 : value[wrong];
  free(value);
  SHB_CHECK(wrong < 0, SHB_ERR_INPUT, "%s: %s: value %d (from 0) is %d; 0 to %d is wanted", path,
            codes[which].path, wrong, found, codes[which].most);
  return SHB_OK;
}

static shb_status read_columns(hid_t file, int which, post_convergence *s) {
  h5_shape shape = H5_SHAPE((hsize_t)s->n);
  double  *value = NULL;
  SHB_TRY(h5_read_double(file, columns[which].path, &shape, &value));
  for (int i = 0; i < s->n; i++) *slot(&s->rung[i], which) = value[i] >= 0 ? value[i] : NAN;
  free(value);
  return SHB_OK;
}

static shb_status read_parts(hid_t file, const char *path, post_convergence *s) {
  char *output = NULL;
  SHB_TRY(h5_check_format(file, format, VERSION));
  SHB_TRY(h5_read_attribute_text(file, "/", "output", &output));
  snprintf(s->output, sizeof s->output, "%s", output ? output : "");
  free(output);
  SHB_TRY(h5_read_attribute_text(file, "/", "note", &s->note));
  SHB_TRY(h5_read_attribute_double(file, "/", "tolerance", 0, &s->tolerance));
  SHB_TRY(h5_read_attribute_int(file, "/", "preloads", 0, &s->n_preloads));
  SHB_TRY(h5_read_attribute_int(file, "/", "integration_points", 0, &s->n_points));
  SHB_TRY(read_names(file, path, s));
  for (int c = 0; c < N_CODES; c++) SHB_TRY(read_codes(file, path, c, s));
  for (int c = 0; c < N_COLUMNS; c++) SHB_TRY(read_columns(file, c, s));
  return SHB_OK;
}

shb_status post_convergence_read(const char *path, post_convergence *s) {
  hid_t file;
  *s = (post_convergence){0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = read_parts(file, path, s);
  h5_close(file);
  if (status != SHB_OK) post_convergence_free(s);
  return status;
}
