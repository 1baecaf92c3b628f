#include "cases/field/face_command.h"

#include <stdlib.h>

#include "cases/field/field_command.h"
#include "postproc/analysis/file_origin.h"
#include "postproc/field/contact_grid.h"

enum { PATH = 4096 };

/* A peak with maps. */
typedef struct {
  int    branch, row, point;
  double height; /* of the first output, m */
} candidate;

static int falling(const void *a, const void *b) {
  const candidate *p = a, *q = b;
  if (p->height != q->height) return p->height < q->height ? 1 : -1;
  return p->branch != q->branch ? p->branch - q->branch : p->row - q->row;
}

/* Peaks with maps of the chosen curve, or of all; *list is malloc'ed. */
static shb_status list_peaks(const command_options *o, hid_t file, const mhb_response *response,
                             const post_contact_face *face, candidate **list, int *n) {
  *n    = 0;
  *list = NULL;
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    post_contact_maps maps;
    if (o->branch >= 0 && o->branch != i) continue;
    SHB_TRY(post_contact_maps_read(file, face, i, &maps));
    candidate *longer = realloc(*list, (size_t)(*n + maps.n + 1) * sizeof **list);
    if (longer) *list = longer;
    for (int row = 0; longer && row < maps.n; row++)
      if (maps.point[row] >= 0 && maps.point[row] < b->n_points)
        longer[(*n)++] =
            (candidate){i, row, maps.point[row], mhb_response_output(response, b, maps.point[row])};
    post_contact_maps_free(&maps);
    SHB_CHECK(longer, SHB_ERR_IO, "out of memory for the peaks");
  }
  if (*n > 0) qsort(*list, (size_t)*n, sizeof **list, falling);
  return SHB_OK;
}

static shb_status choose(const command_options *o, const candidate *list, int n,
                         candidate *chosen) {
  const int rank = o->peak > 0 ? o->peak : 1;
  SHB_CHECK(n > 0, SHB_ERR_INPUT, "%s: no peak%s has maps of the contact face", o->path,
            o->branch >= 0 ? " of this branch" : "");
  SHB_CHECK(o->point >= 0 || rank <= n, SHB_ERR_INPUT, "--peak %d: there are %d", rank, n);
  *chosen = list[o->point < 0 ? rank - 1 : 0];
  for (int i = 0; o->point >= 0 && i < n; i++)
    if (abs(list[i].point - o->point) < abs(chosen->point - o->point)) *chosen = list[i];
  SHB_CHECK(o->point < 0 || chosen->point == o->point, SHB_ERR_INPUT,
            "point %d of branch %d is no peak; the nearest is %d", o->point, o->branch,
            chosen->point);
  return SHB_OK;
}

static shb_status publish(const command_options *o, hid_t file, const mhb_response *response,
                          const post_contact_face *face, const candidate *chosen, FILE *out) {
  char              path[PATH], point[40] = "", settings[64];
  const double      frequency = response->branch[chosen->branch].frequency[chosen->point];
  post_contact_maps maps      = {0};
  post_origin       origin    = {0};
  if (o->point >= 0 || o->peak > 0 || o->branch >= 0)
    snprintf(point, sizeof point, "_%d_%d", chosen->branch, chosen->point);
  snprintf(path, sizeof path, "%.*s.face%s.vtkhdf", field_stem(o->path), o->path, point);
  snprintf(settings, sizeof settings, "branch = %d\npoint = %d\n", chosen->branch, chosen->point);
  shb_status status = post_contact_maps_read(file, face, chosen->branch, &maps);
  if (status == SHB_OK) status = post_origin_open(o->path, &origin);
  if (status == SHB_OK) {
    const shb_provenance from = {origin.case_path, origin.case_text, settings, "shroudhb-field"};
    status = post_contact_grid(face, &maps, chosen->row, chosen->branch, frequency, &from, path);
  }
  post_contact_maps_free(&maps);
  post_origin_free(&origin);
  if (status == SHB_OK && out)
    fprintf(out, "branch %d, point %d: %.6g Hz\n%s\n", chosen->branch, chosen->point, frequency,
            path);
  return status;
}

static shb_status work(const command_options *o, hid_t file, const mhb_response *response,
                       const post_contact_face *face, FILE *out) {
  candidate *list = NULL, chosen;
  int        n    = 0;
  SHB_CHECK(face->n_nodes > 0, SHB_ERR_INPUT,
            "%s: has no maps of the contact face; they need a mesh and one contact interface",
            o->path);
  SHB_CHECK(o->branch < response->n_branches, SHB_ERR_INPUT,
            "--branch %d: the response has the branches 0 to %d", o->branch,
            response->n_branches - 1);
  shb_status status = list_peaks(o, file, response, face, &list, &n);
  if (status == SHB_OK) status = choose(o, list, n, &chosen);
  if (status == SHB_OK) status = publish(o, file, response, face, &chosen, out);
  free(list);
  return status;
}

shb_status face_write(const command_options *options, FILE *out) {
  hid_t             file     = H5I_INVALID_HID;
  mhb_response     *response = NULL;
  post_contact_face face     = {0};
  shb_status        status   = mhb_response_read(options->path, &response);
  if (status == SHB_OK) status = h5_open(options->path, &file);
  if (status == SHB_OK) status = post_contact_face_read(file, &face);
  if (status == SHB_OK) status = work(options, file, response, &face, out);
  post_contact_face_free(&face);
  h5_close(file);
  mhb_response_destroy(response);
  return status;
}
