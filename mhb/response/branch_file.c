#include "mhb/response/branch_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/problem/parameter.h"
#include "mhb/response/face_wear.h"
#include "mhb/response/response.h"
#include "mhb/response/response_fields.h"
#include "mhb/response/ring_description.h"

static const char *const origin_name[] = {"end", "search", "flip", "aside"};
enum { N_ORIGINS = sizeof origin_name / sizeof *origin_name };

/* ---- writing ---- */

static const char *scale_of(char letter) {
  switch (letter) {
    case 'p':
      return "/pair";
    case 'q':
      return "/probe/name";
    case 'k':
      return "/harmonic";
    case 'f':
      return "/multiplier";
    case 'l':
      return "/line";
    case 'b':
      return "/blade";
    case 'i':
      return "/interface_name";
    case '3':
      return "/shroud_axis";
    case 'x':
      return "/axis";
    default:
      return "/contact_state";
  }
}
/* The harmonics of the branch are not those of the root's scale. */
static bool has_own_scale(const mhb_response *response, const mhb_branch *branch) {
  return branch->order != response->subharmonics || branch->n_harmonics != response->n_harmonics;
}

static shb_status write_field(hid_t group, const mhb_response *response, const mhb_branch *branch,
                              const mhb_field *f) {
  const h5_shape shape = mhb_field_shape(response, branch, f, branch->n_points);
  const void    *data  = mhb_field_get(branch, f);
  const char    *units = f->units ? f->units : mhb_parameter_unit(response->parameter);
  if (mhb_field_is_frequency(response, f)) return SHB_OK;
  switch (f->kind) {
    case MHB_DOUBLE:
      SHB_TRY(h5_write_double(group, f->name, shape, data, *units ? units : "-", f->long_name));
      break;
    case MHB_COMPLEX:
      SHB_TRY(h5_write_complex(group, f->name, shape, data, f->units, f->long_name));
      break;
    case MHB_INT:
      SHB_TRY(h5_write_int(group, f->name, shape, data, f->units, f->long_name));
      break;
  }
  if (f == mhb_fields) return SHB_OK; /* the frequency is the scale */
  SHB_TRY(h5_attach_scale(group, f->name, 0, mhb_fields[0].name));
  for (int i = 1; i < shape.rank; i++) {
    bool own = f->dims[i - 1] == 'k' && has_own_scale(response, branch);
    SHB_TRY(h5_attach_scale(group, f->name, i, own ? "harmonic" : scale_of(f->dims[i - 1])));
  }
  return SHB_OK;
}

/* The searches of a main branch. */
static shb_status write_searches(hid_t group, const mhb_response *response,
                                 const mhb_branch *branch) {
  int            n     = branch->n_searches;
  const h5_shape shape = H5_SHAPE((hsize_t)n);
  const char    *units = mhb_parameter_unit(response->parameter);
  double         value[n + 1];
  int            order[n + 1], starts[n + 1], found[n + 1], seed[n + 1], untraced[n + 1];
  if (n == 0) return SHB_OK;
  for (int i = 0; i < n; i++) {
    value[i]    = branch->search[i].value;
    order[i]    = branch->search[i].order;
    starts[i]   = branch->search[i].starts;
    found[i]    = branch->search[i].found;
    seed[i]     = branch->search[i].seed;
    untraced[i] = branch->search[i].untraced;
  }
  SHB_TRY(h5_write_double(group, "search/parameter", shape, value, *units ? units : "-",
                          "value of the parameter at which other curves were searched for"));
  SHB_TRY(h5_write_int(group, "search/order", shape, order, "-",
                       "periods of the excitation after which the motions searched for repeat"));
  SHB_TRY(h5_write_int(group, "search/starts", shape, starts, "-", "random starts made"));
  SHB_TRY(h5_write_int(group, "search/seed", shape, seed, "-", "seed of their random numbers"));
  SHB_TRY(h5_write_int(group, "search/found", shape, found, "-", "curves found"));
  return h5_write_int(group, "search/untraced", shape, untraced, "-",
                      "further motions found, whose curves were not traced");
}

/* Speed of the rotor in a run-up; not read back. */
static shb_status write_speed(hid_t group, const mhb_response *response, const mhb_branch *branch) {
  if (!response->run_up) return SHB_OK;
  double *speed = shb_alloc((size_t)branch->n_points, sizeof *speed);
  for (int i = 0; i < branch->n_points; i++)
    speed[i] = SHB_TWO_PI * branch->frequency[i] / response->engine_order;
  shb_status status = h5_write_double(group, "speed", H5_SHAPE((hsize_t)branch->n_points), speed,
                                      "rad/s", "speed of the rotor, frequency/engine_order");
  free(speed);
  SHB_TRY(status);
  return h5_attach_scale(group, "speed", 0, mhb_fields[0].name);
}

/* The text and the sweep of the motion that lasts. */
static shb_status write_lasting(hid_t group, const mhb_branch *branch) {
  const mhb_lasting_curve *c = &branch->lasting_curve;
  if (branch->lasting) SHB_TRY(h5_write_attribute_text(group, ".", "lasting", branch->lasting));
  if (c->n == 0) return SHB_OK;
  const h5_shape shape = H5_SHAPE((hsize_t)c->n);
  SHB_TRY(h5_write_double(group, "lasting/curve/frequency", shape, c->frequency, "Hz",
                          "middle of a window of a slow sweep of the ring"));
  SHB_TRY(h5_write_double(group, "lasting/curve/mean", shape, c->mean, "m",
                          "a period's peak of the output, mean over blades and periods"));
  SHB_TRY(h5_write_double(group, "lasting/curve/worst", shape, c->worst, "m",
                          "the same, 99.9 percentile over blades and periods"));
  SHB_TRY(h5_attach_scale(group, "lasting/curve/mean", 0, "lasting/curve/frequency"));
  return h5_attach_scale(group, "lasting/curve/worst", 0, "lasting/curve/frequency");
}

typedef struct {
  const char *name, *unit, *what;
  size_t      at;
} amplification_part;

#define PART(name) offsetof(mhb_amplification, name)
static const amplification_part amplification_parts[] = {
    {"amplification/factor", "-", "worst blade's peak over that of the tuned ring", PART(factor)},
    {"amplification/worst", "m", "peak of the output on the blade that swings highest",
     PART(worst)},
    {"amplification/worst_frequency", "Hz", "where that is", PART(worst_at)},
    {"amplification/mean", "m", "peak of the mean of the output over the blades", PART(mean)},
    {"amplification/mean_frequency", "Hz", "where that is", PART(mean_at)},
    {"amplification/tuned", "m", "peak of the output with equal blades", PART(tuned)},
    {"amplification/tuned_frequency", "Hz", "where that is", PART(tuned_at)}};
enum { N_PARTS = sizeof amplification_parts / sizeof *amplification_parts };

/* Of a ring of different blades. */
static shb_status write_amplification(hid_t group, const mhb_branch *branch) {
  const mhb_amplification *a = &branch->amplification;
  if (!(a->factor > 0)) return SHB_OK;
  for (int i = 0; i < N_PARTS; i++) {
    const amplification_part *p     = &amplification_parts[i];
    const double             *value = (const double *)(const void *)((const char *)a + p->at);
    SHB_TRY(h5_write_double(group, p->name, (h5_shape){.rank = 0}, value, p->unit, p->what));
  }
  return h5_write_int(group, "amplification/blade", (h5_shape){.rank = 0}, &a->blade, "-",
                      "the blade that swings highest, from 0");
}

static shb_status read_amplification(hid_t group, mhb_branch *branch) {
  mhb_amplification *a   = &branch->amplification;
  const h5_shape     one = {.rank = 0};
  if (!h5_exists(group, "amplification")) return SHB_OK;
  for (int i = 0; i < N_PARTS; i++) {
    double  *value;
    h5_shape shape = one;
    SHB_TRY(h5_read_double(group, amplification_parts[i].name, &shape, &value));
    memcpy((char *)a + amplification_parts[i].at, value, sizeof *value);
    free(value);
  }
  int     *blade;
  h5_shape shape = one;
  SHB_TRY(h5_read_int(group, "amplification/blade", &shape, &blade));
  a->blade = *blade;
  free(blade);
  return SHB_OK;
}

/* The modal amplitudes of the points kept. */
static shb_status write_modal(hid_t group, const mhb_response *response, const mhb_branch *branch) {
  const mhb_modal_motion *m = &branch->modal;
  const hsize_t           n = (hsize_t)m->n;
  const h5_shape shape = H5_SHAPE(n, (hsize_t)branch->n_harmonics + 1, (hsize_t)response->n_modes);
  if (m->n == 0) return SHB_OK;
  SHB_TRY(h5_write_int(group, "modal/point", H5_SHAPE(n), m->point, "-",
                       "points of the branch, from 0, of which modal amplitudes are kept"));
  SHB_TRY(h5_write_complex(group, "modal/amplitude", shape, m->amplitude, "m kg^1/2",
                           "amplitudes of the modes, harmonics: the motion is their sum times "
                           "/modes/shape of the modal file, less that of the modes left out"));
  SHB_TRY(h5_write_complex(
      group, "modal/force", H5_SHAPE(n, (hsize_t)branch->n_harmonics + 1, (hsize_t)m->n_contact),
      m->force, "N",
      "force on the blade at its contact dofs, in the order of /contact/dof of the modal file"));
  SHB_TRY(
      h5_write_double(group, "modal/scale", H5_SHAPE(n), m->scale, "-", "scale of the excitation"));
  SHB_TRY(h5_attach_scale(group, "modal/force", 0, "modal/point"));
  SHB_TRY(h5_attach_scale(group, "modal/scale", 0, "modal/point"));
  SHB_TRY(h5_attach_scale(group, "modal/amplitude", 0, "modal/point"));
  SHB_TRY(h5_attach_scale(group, "modal/amplitude", 1,
                          has_own_scale(response, branch) ? "harmonic" : "/harmonic"));
  return h5_attach_scale(group, "modal/amplitude", 2, "/modes/frequency");
}

/* group/name, made or opened. *group < 0 after an error. */
static shb_status make_group(hid_t at, const char *name, hid_t *group) {
  *group = H5Gcreate2(at, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  SHB_CHECK(*group >= 0, SHB_ERR_IO, "%s of the response cannot be written", name);
  return SHB_OK;
}

static shb_status open_group(hid_t at, const char *path, const char *name, hid_t *group) {
  *group = H5Gopen2(at, name, H5P_DEFAULT);
  SHB_CHECK(*group >= 0, SHB_ERR_INPUT, "%s: %s is not a readable group", path, name);
  return SHB_OK;
}

static shb_status write_fields(hid_t group, const mhb_response *response,
                               const mhb_branch *branch) {
  for (int i = 0; i < MHB_N_FIELDS; i++)
    if (mhb_field_kept(response, branch, &mhb_fields[i]))
      SHB_TRY(write_field(group, response, branch, &mhb_fields[i]));
  return SHB_OK;
}

static shb_status fill_segment(hid_t group, const mhb_response *response,
                               const mhb_unfinished *unfinished, int i) {
  const mhb_branch      *segment = &unfinished->segments->branch[i];
  const mhb_trace_state *state   = &unfinished->state[i];
  SHB_TRY(h5_write_double(group, "numbers", H5_SHAPE(state->n), state->number, "-",
                          "what determines how the curve goes on from its last point"));
  if (has_own_scale(response, segment))
    SHB_TRY(h5_write_counter(group, "harmonic", (hsize_t)segment->n_harmonics + 1,
                             "harmonic k of omega / order"));
  return write_fields(group, response, segment);
}

/* A curve under way, for a run that takes it up again. */
static shb_status write_unfinished(hid_t group, const mhb_response *response,
                                   const mhb_unfinished *unfinished) {
  hid_t resume;
  if (!unfinished) return SHB_OK;
  SHB_TRY(make_group(group, "resume", &resume));
  shb_status status = h5_write_attribute_int(resume, ".", "version", MHB_TRACE_STATE_VERSION);
  if (status == SHB_OK) status = h5_write_attribute_int(resume, ".", "segments", unfinished->n);
  for (int i = 0; i < unfinished->n && status == SHB_OK; i++) {
    char  name[32];
    hid_t segment;
    snprintf(name, sizeof name, "segment_%d", i);
    status = make_group(resume, name, &segment);
    if (status != SHB_OK) break;
    status = fill_segment(segment, response, unfinished, i);
    H5Gclose(segment);
  }
  H5Gclose(resume);
  return status;
}

static shb_status fill_branch(hid_t group, const mhb_response *response, const mhb_branch *branch) {
  char motion[MHB_RING_TEXT];
  SHB_TRY(h5_write_attribute_text(group, ".", "kind", mhb_branch_kind_name(branch->kind)));
  SHB_TRY(h5_write_attribute_text(group, ".", "reason", branch->reason));
  SHB_TRY(h5_write_attribute_int(group, ".", "complete", branch->complete));
  if (!branch->searched) SHB_TRY(h5_write_attribute_int(group, ".", "searched", 0));
  if (branch->flips_untraced > 0)
    SHB_TRY(h5_write_attribute_int(group, ".", "flips_untraced", branch->flips_untraced));
  if (branch->origin != MHB_FROM_END) {
    SHB_TRY(h5_write_attribute_text(group, ".", "origin", origin_name[branch->origin]));
    SHB_TRY(h5_write_attribute_int(group, ".", "order", branch->order));
    SHB_TRY(h5_write_attribute_int(group, ".", "main", branch->main));
  }
  if (has_own_scale(response, branch))
    SHB_TRY(h5_write_counter(
        group, "harmonic", (hsize_t)branch->n_harmonics + 1,
        "harmonic k of omega / order; x(t) = Re sum_k A_k exp(j k omega t / order)"));
  mhb_ring_describe(response, branch, motion);
  if (*motion) SHB_TRY(h5_write_attribute_text(group, ".", "ring_motion", motion));
  SHB_TRY(write_fields(group, response, branch));
  SHB_TRY(write_unfinished(group, response, branch->unfinished));
  SHB_TRY(write_searches(group, response, branch));
  SHB_TRY(write_lasting(group, branch));
  SHB_TRY(write_amplification(group, branch));
  SHB_TRY(write_modal(group, response, branch));
  if (response->face)
    SHB_TRY(mhb_face_wear_write(group, response->face, response->n_pairs, &branch->wear));
  return write_speed(group, response, branch);
}

shb_status mhb_branch_write(hid_t file, const mhb_response *response, int index) {
  char  name[32];
  hid_t group;
  snprintf(name, sizeof name, "/branch_%d", index);
  SHB_TRY(make_group(file, name, &group));
  shb_status status = fill_branch(group, response, &response->branch[index]);
  H5Gclose(group);
  return status;
}
/* ---- reading ---- */

static void copy_frequency(mhb_branch *branch) {
  size_t size   = sizeof(double) * (size_t)branch->n_points;
  branch->value = shb_alloc(size, 1 /*BYTES*/);
  if (size > 0) memcpy(branch->value, branch->frequency, size);
}

static shb_status read_field(hid_t group, const mhb_response *response, mhb_branch *branch,
                             const mhb_field *f) {
  h5_shape        shape    = mhb_field_shape(response, branch, f, branch->n_points);
  double         *real     = NULL;
  double complex *complex_ = NULL;
  int            *whole    = NULL;
  if (mhb_field_is_frequency(response, f)) {
    copy_frequency(branch);
    return SHB_OK;
  }
  if (mhb_field_is_later(f) && !h5_exists(group, f->name)) {
    void *none = shb_alloc_zeroed(h5_count(shape), mhb_field_bytes(f->kind));
    mhb_field_set(branch, f, none);
    const bool told = none == branch->error_spatial || none == branch->error_truncation_max ||
                      none == branch->error_multiplier;
    for (int i = 0; told && i < branch->n_points; i++) ((double *)none)[i] = -1;
    return SHB_OK;
  }
  switch (f->kind) {
    case MHB_DOUBLE:
      SHB_TRY(h5_read_double(group, f->name, &shape, &real));
      mhb_field_set(branch, f, real);
      break;
    case MHB_COMPLEX:
      SHB_TRY(h5_read_complex(group, f->name, &shape, &complex_));
      mhb_field_set(branch, f, complex_);
      break;
    case MHB_INT:
      SHB_TRY(h5_read_int(group, f->name, &shape, &whole));
      mhb_field_set(branch, f, whole);
      break;
  }
  return SHB_OK;
}

static shb_status read_kind(hid_t group, const char *path, int index, mhb_branch *branch) {
  char *text = NULL;
  SHB_TRY(h5_read_attribute_text(group, ".", "kind", &text));
  int kind = 0;
  while (text && kind < MHB_N_BRANCH_KINDS &&
         strcmp(text, mhb_branch_kind_name((mhb_branch_kind)kind)) != 0)
    kind++;
  bool known = text && kind < MHB_N_BRANCH_KINDS;
  free(text);
  SHB_CHECK(known, SHB_ERR_INPUT,
            "%s: /branch_%d: attribute kind must be nonlinear, open, stuck, integration or tracked",
            path, index);
  branch->kind = (mhb_branch_kind)kind;
  return SHB_OK;
}

/* Harmonics of a branch or segment, where they are not those of the root. */
static shb_status read_scale(hid_t group, const char *path, int index, mhb_branch *branch) {
  h5_shape harmonic;
  if (!h5_exists(group, "harmonic")) return SHB_OK;
  SHB_TRY(h5_shape_of(group, "harmonic", &harmonic));
  SHB_CHECK(harmonic.rank == 1 && harmonic.dim[0] >= 1 && harmonic.dim[0] <= MHB_MOST_ENTRIES,
            SHB_ERR_INPUT, "%s: /branch_%d/harmonic must be a list of 1 to %d", path, index,
            MHB_MOST_ENTRIES);
  branch->n_harmonics = (int)harmonic.dim[0] - 1;
  return SHB_OK;
}

/* Files of earlier versions have none of these: a branch is its own main one, with the order of the
 * file. */
static shb_status read_descent(hid_t group, const char *path, int index, mhb_branch *branch) {
  char *text     = NULL;
  int   searched = 1, origin = 0;
  SHB_TRY(h5_read_attribute_int(group, ".", "order", branch->order, &branch->order));
  SHB_TRY(h5_read_attribute_int(group, ".", "main", index, &branch->main));
  SHB_TRY(h5_read_attribute_int(group, ".", "searched", 1, &searched));
  SHB_TRY(h5_read_attribute_int(group, ".", "flips_untraced", 0, &branch->flips_untraced));
  SHB_TRY(h5_read_attribute_text(group, ".", "origin", &text));
  while (text && *text && origin < N_ORIGINS && strcmp(text, origin_name[origin]) != 0) origin++;
  free(text);
  SHB_CHECK(origin < N_ORIGINS, SHB_ERR_INPUT,
            "%s: /branch_%d: attribute origin must be end, search, flip or aside", path, index);
  SHB_CHECK(branch->order >= 1 && branch->main >= 0 && branch->main <= index, SHB_ERR_INPUT,
            "%s: /branch_%d: attribute order is %d, main is %d; 1 or more and 0 to %d are wanted",
            path, index, branch->order, branch->main, index);
  branch->origin   = (mhb_origin)origin;
  branch->searched = searched != 0;
  return read_scale(group, path, index, branch);
}

/* Files of earlier versions have none. */
static shb_status read_searches(hid_t group, const char *path, int index, mhb_branch *branch) {
  h5_shape shape;
  double  *value    = NULL;
  int     *count[5] = {NULL};
  if (!h5_exists(group, "search")) return SHB_OK;
  SHB_TRY(h5_shape_of(group, "search/parameter", &shape));
  SHB_CHECK(shape.rank == 1 && shape.dim[0] <= MHB_MOST_ENTRIES, SHB_ERR_INPUT,
            "%s: /branch_%d/search/parameter must be a list of at most %d", path, index,
            MHB_MOST_ENTRIES);
  static const char *const name[] = {"search/order", "search/starts", "search/found", "search/seed",
                                     "search/untraced"}; /* earlier versions lack the last two */
  shb_status               status = h5_read_double(group, "search/parameter", &shape, &value);
  for (int k = 0; k < 5 && status == SHB_OK; k++)
    if (k < 3 || h5_exists(group, name[k])) status = h5_read_int(group, name[k], &shape, &count[k]);
  for (hsize_t i = 0; i < shape.dim[0] && status == SHB_OK; i++)
    mhb_response_note_search(branch, &(mhb_search){.value    = value[i],
                                                   .order    = count[0][i],
                                                   .starts   = count[1][i],
                                                   .seed     = count[3] ? count[3][i] : 0,
                                                   .found    = count[2][i],
                                                   .untraced = count[4] ? count[4][i] : 0});
  free(value);
  for (int k = 0; k < 5; k++) free(count[k]);
  return status;
}

/* Checks that all codes of a list are in their range. */
static shb_status check_codes(const char *path, int index, const char *name, int n, const int *code,
                              int least, int most, const char *wanted) {
  for (int i = 0; code && i < n; i++)
    SHB_CHECK(code[i] >= least && code[i] <= most, SHB_ERR_INPUT,
              "%s: /branch_%d/%s: value %d (from 0) is %d; %s is wanted", path, index, name, i,
              code[i], wanted);
  return SHB_OK;
}

static shb_status check_points(const char *path, int index, const mhb_branch *branch) {
  int n = branch->n_points;
  for (int i = 0; i < n; i++)
    SHB_CHECK(branch->frequency[i] > 0, SHB_ERR_INPUT,
              "%s: /branch_%d/frequency: value %d (from 0) is %g Hz; all must be positive", path,
              index, i, branch->frequency[i]);
  SHB_TRY(check_codes(path, index, "stable", n, branch->stable, -1, 1, "1, 0 or -1"));
  SHB_TRY(check_codes(path, index, "special", n, branch->special, 0, MHB_N_SPECIALS - 1, "0 to 5"));
  SHB_TRY(check_codes(path, index, "mark", n, branch->mark, 0, MHB_ALL_MARKS, "0 to 7"));
  SHB_TRY(check_codes(path, index, "judged", n, branch->judged, 0, MHB_N_JUDGED - 1, "0 to 5"));
  SHB_TRY(check_codes(path, index, "lasting/kind", n, branch->lasting_kind, 0,
                      MHB_LASTING_KINDS - 1, "0 to 5"));
  SHB_TRY(
      check_codes(path, index, "ring/kind", n, branch->ring_kind, 0, MHB_RING_KINDS - 1, "0 to 4"));
  return check_codes(path, index, "loss", n, branch->loss, 0, MHB_N_LOSSES - 1, "0 to 3");
}

/* Files of earlier versions have neither. */
static shb_status read_lasting(hid_t group, mhb_branch *branch) {
  mhb_lasting_curve *c = &branch->lasting_curve;
  h5_shape           shape;
  SHB_TRY(h5_read_attribute_text(group, ".", "lasting", &branch->lasting));
  if (!h5_exists(group, "lasting") || !h5_exists(group, "lasting/curve")) return SHB_OK;
  SHB_TRY(h5_shape_of(group, "lasting/curve/frequency", &shape));
  SHB_TRY(h5_read_double(group, "lasting/curve/frequency", &shape, &c->frequency));
  SHB_TRY(h5_read_double(group, "lasting/curve/mean", &shape, &c->mean));
  SHB_TRY(h5_read_double(group, "lasting/curve/worst", &shape, &c->worst));
  c->n = (int)shape.dim[0];
  return SHB_OK;
}

/* Files of earlier versions have none. */
static shb_status read_modal(hid_t group, const char *path, int index, const mhb_response *response,
                             mhb_branch *branch) {
  mhb_modal_motion *m      = &branch->modal;
  h5_shape          points = H5_SHAPE(0);
  if (!h5_exists(group, "modal") || !h5_exists(group, "modal/point")) return SHB_OK;
  SHB_TRY(h5_read_int(group, "modal/point", &points, &m->point));
  for (hsize_t i = 0; i < points.dim[0]; i++)
    SHB_CHECK(m->point[i] >= 0 && m->point[i] < branch->n_points &&
                  (i == 0 || m->point[i] > m->point[i - 1]),
              SHB_ERR_INPUT,
              "%s: /branch_%d/modal/point: value %d (from 0) is %d; points 0 to %d, ascending, are "
              "wanted",
              path, index, (int)i, m->point[i], branch->n_points - 1);
  h5_shape shape =
      H5_SHAPE(points.dim[0], (hsize_t)branch->n_harmonics + 1, (hsize_t)response->n_modes);
  SHB_TRY(h5_read_complex(group, "modal/amplitude", &shape, &m->amplitude));
  h5_shape dofs = H5_SHAPE(points.dim[0], (hsize_t)branch->n_harmonics + 1, 0);
  SHB_TRY(h5_read_complex(group, "modal/force", &dofs, &m->force));
  SHB_TRY(h5_read_double(group, "modal/scale", &points, &m->scale));
  m->n_contact = (int)dofs.dim[2];
  m->n         = (int)points.dim[0];
  return SHB_OK;
}

/* The points of a branch whose kind, order and harmonics are known. */
static shb_status read_points(hid_t group, const char *path, int index,
                              const mhb_response *response, mhb_branch *branch) {
  h5_shape points;
  SHB_TRY(h5_shape_of(group, mhb_fields[0].name, &points));
  SHB_CHECK(points.rank == 1, SHB_ERR_INPUT, "%s: /branch_%d/frequency must be a list", path,
            index);
  branch->n_points = branch->capacity = (int)points.dim[0];
  for (int i = 0; i < MHB_N_FIELDS; i++)
    if (mhb_field_kept(response, branch, &mhb_fields[i]))
      SHB_TRY(read_field(group, response, branch, &mhb_fields[i]));
  return check_points(path, index, branch);
}

static shb_status read_segment(hid_t resume, const char *path, int index,
                               mhb_unfinished *unfinished) {
  char            name[32];
  hid_t           group;
  int             at;
  h5_shape        numbers = H5_SHAPE(0);
  mhb_trace_state state   = {0};
  snprintf(name, sizeof name, "segment_%d", unfinished->n);
  SHB_TRY(open_group(resume, path, name, &group));
  shb_status status = h5_read_double(group, "numbers", &numbers, &state.number);
  if (status == SHB_OK) {
    state.n = state.room               = (size_t)numbers.dim[0];
    unfinished->state[unfinished->n++] = state;
    at = mhb_response_branch(unfinished->segments, MHB_BRANCH_NONLINEAR);
  }
  mhb_branch *segment = status == SHB_OK ? &unfinished->segments->branch[at] : NULL;
  if (segment) status = read_scale(group, path, index, segment);
  if (status == SHB_OK) status = read_points(group, path, index, unfinished->segments, segment);
  H5Gclose(group);
  return status;
}

static shb_status read_segments(hid_t resume, const char *path, int index, int n,
                                mhb_unfinished *unfinished) {
  unfinished->state = shb_alloc_zeroed((size_t)n, sizeof *unfinished->state);
  for (int i = 0; i < n; i++) SHB_TRY(read_segment(resume, path, index, unfinished));
  return SHB_OK;
}

/* A curve under way. That of another version is left out: it is traced anew. */
static shb_status read_unfinished(hid_t group, const char *path, int index,
                                  const mhb_response *response, mhb_branch *branch) {
  int   version = 0, n = 0;
  hid_t resume;
  if (!h5_exists(group, "resume")) return SHB_OK;
  SHB_TRY(h5_read_attribute_int(group, "resume", "version", 0, &version));
  SHB_TRY(h5_read_attribute_int(group, "resume", "segments", 0, &n));
  if (version != MHB_TRACE_STATE_VERSION || n < 1 || n > MHB_MOST_ENTRIES) return SHB_OK;
  branch->unfinished                         = mhb_unfinished_create(response);
  branch->unfinished->segments->subharmonics = branch->order;
  SHB_TRY(open_group(group, path, "resume", &resume));
  shb_status status = read_segments(resume, path, index, n, branch->unfinished);
  H5Gclose(resume);
  return status;
}

static shb_status fill_from(hid_t group, const char *path, int index, mhb_response *response) {
  mhb_branch *branch = &response->branch[index];
  int         complete;
  SHB_TRY(read_kind(group, path, index, branch));
  SHB_TRY(h5_read_attribute_text(group, ".", "reason", &branch->reason));
  SHB_TRY(h5_read_attribute_int(group, ".", "complete", 0, &complete));
  branch->complete = complete != 0;
  SHB_TRY(read_descent(group, path, index, branch));
  SHB_TRY(read_points(group, path, index, response, branch));
  SHB_TRY(read_unfinished(group, path, index, response, branch));
  SHB_TRY(read_searches(group, path, index, branch));
  SHB_TRY(read_lasting(group, branch));
  SHB_TRY(read_amplification(group, branch));
  return read_modal(group, path, index, response, branch);
}

shb_status mhb_branch_read(hid_t file, const char *path, mhb_response *response) {
  char name[32];
  int  index = 0;
  index      = mhb_response_branch(response, MHB_BRANCH_NONLINEAR);
  snprintf(name, sizeof name, "/branch_%d", index);
  SHB_CHECK(h5_exists(file, name), SHB_ERR_INPUT, "%s: %s is missing", path, name);
  hid_t group;
  SHB_TRY(open_group(file, path, name, &group));
  shb_status status = fill_from(group, path, index, response);
  H5Gclose(group);
  return status;
}
