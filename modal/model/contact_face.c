#include "modal/model/contact_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Parts of the file. */
typedef struct {
  h5_shape nodes, set, entries, weights, areas;
  double  *node, *weight, *area; /* [n][3], [entry], [pair] */
  int     *set_of, *entry;       /* [element][corners], [entry][3] */
} parts;

static void parts_free(parts *p) {
  free(p->node);
  free(p->weight);
  free(p->area);
  free(p->set_of);
  free(p->entry);
}

static bool is_there(hid_t file) {
  static const char *const names[] = {
      "/mesh",    "/mesh/nodes",    "/mesh/sets",      "/mesh/sets/contact_right",
      "/contact", "/contact/nodes", "/contact/weight", "/contact/area"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (!h5_exists(file, names[i])) return false;
  return !h5_exists(file, "/contact/interface");
}

static shb_status read_parts(hid_t file, parts *p) {
  p->nodes = H5_SHAPE(0, 3);
  p->areas = p->weights = H5_SHAPE(0);
  p->entries            = H5_SHAPE(0, 3);
  p->set                = H5_SHAPE(0, 0);
  SHB_TRY(h5_read_double(file, "/mesh/nodes", &p->nodes, &p->node));
  SHB_TRY(h5_read_int(file, "/mesh/sets/contact_right", &p->set, &p->set_of));
  SHB_TRY(h5_read_int(file, "/contact/nodes", &p->entries, &p->entry));
  SHB_TRY(h5_read_double(file, "/contact/weight", &p->weights, &p->weight));
  return h5_read_double(file, "/contact/area", &p->areas, &p->area);
}

static shb_status check(const char *path, const parts *p) {
  const int nodes = (int)p->nodes.dim[0], pairs = (int)p->areas.dim[0];
  SHB_CHECK(p->weights.dim[0] == p->entries.dim[0] && p->set.dim[1] > 0 && p->set.dim[1] <= 9,
            SHB_ERR_INPUT, "%s: /contact/weight or /mesh/sets/contact_right has a wrong shape",
            path);
  for (size_t i = 0; i < h5_count(p->set); i++)
    SHB_CHECK(p->set_of[i] >= 0 && p->set_of[i] < nodes, SHB_ERR_INPUT,
              "%s: /mesh/sets/contact_right: value %zu (from 0) is %d; nodes 0 to %d are wanted",
              path, i, p->set_of[i], nodes - 1);
  for (size_t i = 0; i < p->entries.dim[0]; i++) {
    const int *entry = p->entry + 3 * i;
    SHB_CHECK(entry[0] >= 0 && entry[0] < pairs && entry[1] >= 0 && entry[1] < nodes, SHB_ERR_INPUT,
              "%s: /contact/nodes: row %zu (from 0) is %d, %d; patches 0 to %d and "
              "nodes 0 to %d are wanted",
              path, i, entry[0], entry[1], pairs - 1, nodes - 1);
  }
  return SHB_OK;
}

/* place[mesh node] <- node of the face, -1 elsewhere; returns their number. */
static int number_nodes(const parts *p, int *place) {
  int n = 0;
  for (size_t i = 0; i < p->nodes.dim[0]; i++) place[i] = -1;
  for (size_t i = 0; i < h5_count(p->set); i++)
    if (place[p->set_of[i]] < 0) place[p->set_of[i]] = n++;
  return n;
}

static void allocate(modal_contact_face *f, int entries) {
  const size_t n = (size_t)f->n_nodes;
  f->node        = shb_alloc_zeroed(3 * n, sizeof *f->node);
  f->area        = shb_alloc_zeroed(n, sizeof *f->area);
  f->element     = shb_alloc_zeroed((size_t)f->n_elements * (size_t)f->corners, sizeof *f->element);
  f->entry_node  = shb_alloc_zeroed((size_t)entries, sizeof *f->entry_node);
  f->entry_pair  = shb_alloc_zeroed((size_t)entries, sizeof *f->entry_pair);
  f->entry_part  = shb_alloc_zeroed((size_t)entries, sizeof *f->entry_part);
}

/* A node of no pair, as corners of quadratic elements with one pair a node, takes the mean over the
 * nodes of its elements. Its area is 0, so sums stay. */
static void add_corners(modal_contact_face *f, double *sum) {
  const int own = f->n_entries;
  for (int i = 0; i < f->n_elements * f->corners; i++) {
    const int at = f->element[i], first = i - i % f->corners;
    if (f->area[at] != 0) continue;
    for (int e = 0; e < own; e++)
      for (int c = first; c < first + f->corners; c++) {
        if (f->element[c] != f->entry_node[e] || f->element[c] == at) continue;
        f->entry_node[f->n_entries]   = at;
        f->entry_pair[f->n_entries]   = f->entry_pair[e];
        f->entry_part[f->n_entries++] = 1;
        sum[at] += 1;
      }
  }
}

/* Weights of quadratic elements may be negative at corners: parts go by their size. */
static void fill(const parts *p, const int *place, modal_contact_face *f) {
  double *sum = shb_alloc_zeroed((size_t)f->n_nodes, sizeof *sum);
  for (size_t i = 0; i < p->nodes.dim[0]; i++)
    if (place[i] >= 0) memcpy(f->node + 3 * place[i], p->node + 3 * i, 3 * sizeof *f->node);
  for (size_t i = 0; i < h5_count(p->set); i++) f->element[i] = place[p->set_of[i]];
  for (size_t i = 0; i < p->entries.dim[0]; i++) {
    const int    at = place[p->entry[3 * i + 1]], pair = p->entry[3 * i];
    const double area = p->weight[i] * p->area[pair];
    if (at < 0) continue;
    f->entry_node[f->n_entries]   = at;
    f->entry_pair[f->n_entries]   = pair;
    f->entry_part[f->n_entries++] = fabs(area);
    f->area[at] += area;
    sum[at] += fabs(area);
  }
  add_corners(f, sum);
  for (int e = 0; e < f->n_entries; e++)
    f->entry_part[e] = sum[f->entry_node[e]] > 0 ? f->entry_part[e] / sum[f->entry_node[e]] : 0;
  free(sum);
}

/* Most entries of one node. */
static int most_entries(const parts *p) {
  int *count = shb_alloc_zeroed(p->nodes.dim[0], sizeof *count), most = 0;
  for (size_t i = 0; i < p->entries.dim[0]; i++) {
    int *at = &count[p->entry[3 * i + 1]];
    if (++*at > most) most = *at;
  }
  free(count);
  return most;
}

/* Entries that add_corners may make: each entry once for each other node of each of its elements.
 */
static int room_of(const modal_contact_face *f, const parts *p) {
  return f->n_elements * f->corners * f->corners * most_entries(p);
}

shb_status modal_contact_face_read(const char *path, modal_contact_face *f) {
  hid_t      file;
  parts      p = {0};
  shb_status status;
  *f = (modal_contact_face){0};
  SHB_TRY(h5_open(path, &file));
  if (!is_there(file)) return h5_close(file);
  status = read_parts(file, &p);
  h5_close(file);
  if (status == SHB_OK) status = check(path, &p);
  if (status == SHB_OK) {
    int *place    = shb_alloc(p.nodes.dim[0], sizeof *place);
    f->n_nodes    = number_nodes(&p, place);
    f->n_elements = (int)p.set.dim[0];
    f->corners    = (int)p.set.dim[1];
    allocate(f, (int)p.entries.dim[0] + room_of(f, &p));
    fill(&p, place, f);
    free(place);
  }
  parts_free(&p);
  return status;
}

void modal_contact_face_join(modal_contact_face *f, const modal_joining *j) {
  for (int e = 0; e < f->n_entries; e++) f->entry_pair[e] = j->patch[f->entry_pair[e]];
}

void modal_contact_face_free(modal_contact_face *f) {
  free(f->node);
  free(f->area);
  free(f->element);
  free(f->entry_node);
  free(f->entry_pair);
  free(f->entry_part);
  *f = (modal_contact_face){0};
}

void modal_contact_face_spread(const modal_contact_face *f, const double *of_pair, int rows,
                               double *out) {
  memset(out, 0, (size_t)f->n_nodes * (size_t)rows * sizeof *out);
  for (int e = 0; e < f->n_entries; e++)
    for (int row = 0; row < rows; row++)
      out[f->entry_node[e] * rows + row] +=
          f->entry_part[e] * of_pair[f->entry_pair[e] * rows + row];
}
