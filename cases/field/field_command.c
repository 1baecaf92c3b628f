#include "cases/field/field_command.h"

#include <stdlib.h>
#include <string.h>

#include "cases/commands/up_to_date.h"
#include "mesh/base/publish.h"
#include "modal/hdf5/h5.h"
#include "postproc/analysis/file_origin.h"
#include "postproc/field/field_grid.h"
#include "postproc/field/field_scene.h"
#include "postproc/field/kept_point.h"

enum { STEPS = 24, PATH = 4096 };

/* A kept point with the amplitude of the output. */
typedef struct {
  int    branch, kept;
  double height;
} candidate;

static int falling(const void *a, const void *b) {
  const candidate *p = a, *q = b;
  if (p->height != q->height) return p->height < q->height ? 1 : -1;
  return p->branch != q->branch ? p->branch - q->branch : p->kept - q->kept;
}

static bool is_open_or_stuck(const mhb_branch *b) {
  return b->kind == MHB_BRANCH_OPEN || b->kind == MHB_BRANCH_STUCK;
}

/* Kept peaks, and the highest kept point of each curve, highest first. */
static int list_peaks(const mhb_response *response, const command_options *o, bool limits,
                      candidate *list) {
  int n = 0;
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    if (o->branch >= 0 ? o->branch != i : is_open_or_stuck(b) != limits) continue;
    const int highest = b->modal.n > 0 ? post_highest_kept(response, b) : -1;
    for (int a = 0; a < b->modal.n; a++) {
      const int point = b->modal.point[a];
      if (a == highest || b->special[point] == MHB_PEAK)
        list[n++] = (candidate){i, a, mhb_response_output(response, b, point)};
    }
  }
  qsort(list, (size_t)n, sizeof *list, falling);
  return n;
}

static shb_status choose_peak(const mhb_response *response, const command_options *o,
                              candidate *chosen) {
  size_t total = 1;
  for (int i = 0; i < response->n_branches; i++) total += (size_t)response->branch[i].modal.n;
  candidate *list = malloc(total * sizeof *list);
  SHB_CHECK(list, SHB_ERR_IO, "out of memory for the peaks");
  int n = list_peaks(response, o, false, list);
  if (n == 0 && o->branch < 0) n = list_peaks(response, o, true, list);
  const int rank = o->peak > 0 ? o->peak : 1;
  if (rank <= n) *chosen = list[rank - 1];
  free(list);
  SHB_CHECK(n > 0, SHB_ERR_INPUT,
            "%s: no motion of the blade was kept%s; see mhb.save, and run shroudhb mhb again",
            o->path, o->branch >= 0 ? " on this branch" : "");
  SHB_CHECK(rank <= n, SHB_ERR_INPUT, "--peak %d: there are %d", rank, n);
  return SHB_OK;
}

static shb_status choose_point(const mhb_branch *b, const command_options *o, candidate *chosen) {
  int nearest = -1;
  for (int a = 0; a < b->modal.n; a++) {
    const int distance = abs(b->modal.point[a] - o->point);
    if (nearest < 0 || distance < abs(b->modal.point[nearest] - o->point)) nearest = a;
  }
  SHB_CHECK(o->point < b->n_points, SHB_ERR_INPUT, "--point %d: branch %d has the points 0 to %d",
            o->point, o->branch, b->n_points - 1);
  SHB_CHECK(nearest >= 0, SHB_ERR_INPUT,
            "branch %d: no point was kept; see mhb.save, and run shroudhb mhb again", o->branch);
  SHB_CHECK(
      b->modal.point[nearest] == o->point, SHB_ERR_INPUT,
      "point %d of branch %d was not kept, the nearest is %d; mhb.save: all keeps every point",
      o->point, o->branch, b->modal.point[nearest]);
  *chosen = (candidate){o->branch, nearest, 0};
  return SHB_OK;
}

static shb_status choose(const mhb_response *response, const command_options *o,
                         candidate *chosen) {
  SHB_CHECK(o->branch < response->n_branches, SHB_ERR_INPUT,
            "--branch %d: the response has the branches 0 to %d", o->branch,
            response->n_branches - 1);
  SHB_CHECK(!o->ring || response->blades > 1, SHB_ERR_INPUT,
            "--ring: the response is that of a blade without neighbours");
  if (o->point >= 0) return choose_point(&response->branch[o->branch], o, chosen);
  return choose_peak(response, o, chosen);
}

/* rotor.axis among the settings of the modal file; x, the default, if it has none. */
static mesh_axis axis_of(const char *settings) {
  static const char *const word[] = {"x", "y", "z", "-x", "-y", "-z"};
  const char              *line   = strstr(settings, "rotor.axis = ");
  if (!line) return MESH_AXIS_X;
  line += strlen("rotor.axis = ");
  for (int i = MESH_AXIS_X; i <= MESH_AXIS_MZ; i++) {
    const size_t n = strlen(word[i]);
    if (strncmp(line, word[i], n) == 0 && (line[n] == '\n' || line[n] == '\0')) return i;
  }
  return MESH_AXIS_X;
}

/* Everything that is read. */
typedef struct {
  mhb_response    *response;
  post_blade_field field;
  post_origin      modal, origin; /* of the modal file, of the response */
  post_period      period;
} material;

static void release(material *m) {
  post_period_free(&m->period);
  post_blade_field_free(&m->field);
  mhb_response_destroy(m->response);
  post_origin_free(&m->modal);
  post_origin_free(&m->origin);
}

static shb_status gather(const command_options *o, const char *modal, material *m) {
  candidate chosen = {0};
  SHB_TRY(mhb_response_read(o->path, &m->response));
  SHB_TRY(choose(m->response, o, &chosen));
  SHB_TRY(post_blade_field_read_motion(modal, &m->field));
  SHB_CHECK(m->field.n_nodes > 0, SHB_ERR_INPUT,
            "%s has no /mesh or no modes/stress; make it with shroudhb modal", modal);
  SHB_TRY(post_blade_field_match(&m->field, m->response, modal));
  SHB_TRY(up_to_date_check_modal(o->path, modal));
  SHB_TRY(post_origin_open(modal, &m->modal));
  SHB_TRY(post_origin_open(o->path, &m->origin));
  SHB_TRY(post_period_create(&m->field, m->response, chosen.branch, chosen.kept,
                             axis_of(m->modal.settings), &m->period));
  SHB_CHECK(!o->ring || m->period.closes, SHB_ERR_INPUT,
            "--ring: a wave of %d periods does not close around %d blades", m->period.order,
            m->period.blades);
  return SHB_OK;
}

/* ---------------------------------------------------------------- a mode */

/* Greatest displacement of a mode in the files, m. */
static const double MODE_SIZE = 1e-3;

/* Hz, of a mode of the file. */
static shb_status mode_frequency(const char *path, const post_blade_field *f, int mode,
                                 int diameter, double *frequency) {
  char     name[64] = "/modes/frequency";
  h5_shape shape    = H5_SHAPE((hsize_t)f->n_modes);
  double  *all;
  hid_t    file;
  if (diameter >= 0) snprintf(name, sizeof name, "/nodal_diameter_%d/modes/frequency", diameter);
  SHB_TRY(h5_open(path, &file));
  shb_status status = h5_read_double(file, name, &shape, &all);
  h5_close(file);
  SHB_TRY(status);
  *frequency = all[mode - 1];
  free(all);
  return SHB_OK;
}

/* The nodal diameter asked for, 0 by default; -1 without a disc. */
static shb_status find_diameter(const command_options *o, const post_blade_field *f,
                                int *diameter) {
  *diameter = f->n_waves > 0 && o->diameter < 0 ? 0 : o->diameter;
  SHB_CHECK(f->n_waves > 0 || o->diameter < 0, SHB_ERR_INPUT,
            "--nodal-diameter: %s holds a clamped blade; leave it out", o->path);
  SHB_CHECK(f->n_waves > 0 || !o->ring, SHB_ERR_INPUT,
            "--ring: %s holds the modes of one clamped blade", o->path);
  for (int i = 0; i < f->n_waves; i++)
    if (f->diameter[i] == *diameter) return SHB_OK;
  SHB_CHECK(f->n_waves == 0, SHB_ERR_INPUT,
            "--nodal-diameter %d: %s does not hold it; modal.nodal_diameters: all computes all",
            *diameter, o->path);
  return SHB_OK;
}

static shb_status gather_mode(const command_options *o, material *m) {
  int    diameter;
  double frequency = 0;
  SHB_TRY(post_blade_field_read_motion(o->path, &m->field));
  SHB_CHECK(m->field.n_nodes > 0, SHB_ERR_INPUT,
            "%s has no /mesh or no modes/stress; make it with shroudhb modal", o->path);
  SHB_CHECK(o->rank <= m->field.n_modes, SHB_ERR_INPUT, "--mode %d: %s has the modes 1 to %d",
            o->rank, o->path, m->field.n_modes);
  SHB_TRY(find_diameter(o, &m->field, &diameter));
  SHB_TRY(post_blade_field_read_wave(&m->field, o->path, diameter));
  SHB_TRY(mode_frequency(o->path, &m->field, o->rank, diameter, &frequency));
  SHB_TRY(post_origin_open(o->path, &m->modal));
  SHB_TRY(post_origin_open(o->path, &m->origin));
  return post_period_of_mode(&m->field, o->rank, diameter, frequency, MODE_SIZE,
                             axis_of(m->modal.settings), &m->period);
}

/* ---------------------------------------------------------------- files */

int field_stem(const char *path) {
  static const char *const ending[] = {".response.h5", ".modal.h5", ".h5"};
  const size_t             n        = strlen(path);
  for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
    const size_t m = strlen(ending[i]);
    if (n > m && strcmp(path + n - m, ending[i]) == 0) return (int)(n - m);
  }
  return (int)n;
}

static void output_path(const command_options *o, const post_period *p, const char *ending,
                        char out[PATH]) {
  const int stem      = field_stem(o->path);
  char      point[40] = "";
  if (p->mode > 0 && p->diameter >= 0)
    snprintf(point, sizeof point, "_mode_%d_%d", p->diameter, p->mode);
  else if (p->mode > 0)
    snprintf(point, sizeof point, "_mode_%d", p->mode);
  else if (o->point >= 0 || o->peak > 0 || o->branch >= 0)
    snprintf(point, sizeof point, "_%d_%d", p->branch, p->point);
  snprintf(out, PATH, "%.*s.%s%s.%s", stem, o->path, o->ring ? "ring" : "field", point, ending);
}

static void print_note(const post_period *p, const post_scene_note *note, FILE *out) {
  if (p->mode > 0) {
    if (p->diameter >= 0) fprintf(out, "nodal diameter %d, ", p->diameter);
    fprintf(out, "mode %d: %.6g Hz; at a greatest displacement of %.4g mm von Mises is %.4g MPa\n",
            p->mode, p->frequency, 1e3 * MODE_SIZE, note->greatest_stress / 1e6);
    return;
  }
  fprintf(out, "branch %d, point %d: %.6g Hz, greatest displacement %.4g mm, von Mises %.4g MPa\n",
          p->branch, p->point, p->frequency, 1e3 * note->greatest_displacement,
          note->greatest_stress / 1e6);
  if (p->field->static_stress)
    fputs("the static part at speed is in arrays of its own, not in these numbers\n", out);
}

static shb_status publish(const command_options *o, const material *m, FILE *out) {
  char               grid[PATH], picture[PATH], settings[128];
  const int          steps = o->steps > 0 ? o->steps : STEPS;
  post_buffer        glb   = {0};
  post_scene_note    note;
  const post_period *p = &m->period;
  if (p->mode > 0)
    snprintf(settings, sizeof settings, "mode = %d\nnodal_diameter = %d\nsteps = %d\nring = %d\n",
             p->mode, p->diameter, steps, o->ring);
  else
    snprintf(settings, sizeof settings, "branch = %d\npoint = %d\nsteps = %d\nring = %d\n",
             p->branch, p->point, steps, o->ring);
  const shb_provenance provenance = {m->origin.case_path, m->origin.case_text, settings,
                                     "shroudhb-field"};
  output_path(o, &m->period, "vtkhdf", grid);
  output_path(o, &m->period, "glb", picture);
  SHB_TRY(shb_publish_check(grid));
  SHB_TRY(shb_publish_check(picture));
  shb_status status = post_field_scene(&m->period, steps, o->ring, o->scale, &note, &glb);
  if (status == SHB_OK) status = post_field_grid(&m->period, steps, o->ring, &provenance, grid);
  if (status == SHB_OK) status = post_buffer_publish(&glb, picture);
  post_buffer_free(&glb);
  SHB_TRY(status);
  if (!out) return SHB_OK;
  print_note(&m->period, &note, out);
  fprintf(out, "%s\n%s  displacement times %.4g\n", grid, picture, note.scale);
  return SHB_OK;
}

shb_status field_write(const command_options *options, FILE *out) {
  char     beside[PATH];
  material m = {0};
  snprintf(beside, sizeof beside, "%.*s.modal.h5", field_stem(options->path), options->path);
  shb_status status = options->rank > 0
                          ? gather_mode(options, &m)
                          : gather(options, options->modal ? options->modal : beside, &m);
  if (status == SHB_OK) status = publish(options, &m, out);
  release(&m);
  return status;
}
