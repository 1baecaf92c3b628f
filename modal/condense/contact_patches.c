#include "modal/condense/contact_patches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/core/face_pairing.h"
#include "modal/condense/face_partition.h"
#include "modal/model/joined_pairs.h"

static const double degree = SHB_PI / 180;

/* Shared data of the builders. */
typedef struct {
  const mesh_fe       *mesh;
  const mesh_face_set *right;
  const mesh_pairing  *pairing; /* partners of the right nodes, or NULL */
  double               sector;  /* rad */
  mesh_axis            axis;
  modal_facets         facets;
  double              *node_area; /* [n_nodes] m2, zero outside the current patch */
} builder;

static double norm(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void into_axes(const double axes[3][3], const double v[3], double out[3]) {
  for (int a = 0; a < 3; a++) out[a] = axes[a][0] * v[0] + axes[a][1] * v[1] + axes[a][2] * v[2];
}

static void allocate(int n_pairs, bool has_left, int capacity, modal_patches *out) {
  const size_t n = (size_t)n_pairs, entries = (size_t)capacity + 1;
  out->n_pairs  = n_pairs;
  out->has_left = has_left;
  out->start    = shb_alloc_zeroed(n + 1, sizeof *out->start);
  out->weight   = shb_alloc_zeroed(entries, sizeof *out->weight);
  if (has_left) out->left_weight = shb_alloc_zeroed(entries, sizeof *out->left_weight);
  out->area   = shb_alloc_zeroed(n, sizeof *out->area);
  out->normal = shb_alloc_zeroed(3 * n, sizeof *out->normal);
  for (int side = 0; side <= (int)has_left; side++) {
    out->node[side]     = shb_alloc_zeroed(entries, sizeof *out->node[side]);
    out->centroid[side] = shb_alloc_zeroed(3 * n, sizeof *out->centroid[side]);
    out->axes[side]     = shb_alloc_zeroed(n, sizeof *out->axes[side]);
  }
}

static int compare(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

/* Add a right node to the last patch, one entry for each left node that it meets. The first entry
 * carries the weight of the right node. */
static void add_entry(const builder *b, int patch, int node, double weight, modal_patches *out) {
  const mesh_pairing *pairing = b->pairing;
  if (!pairing) {
    out->node[0][out->start[patch + 1]]  = node;
    out->weight[out->start[patch + 1]++] = weight;
    return;
  }
  const int *found = bsearch(&node, pairing->right, (size_t)pairing->n, sizeof node, compare);
  int        at    = (int)(found - pairing->right);
  for (int i = pairing->start[at]; i < pairing->start[at + 1]; i++) {
    int entry               = out->start[patch + 1]++;
    out->node[0][entry]     = node;
    out->weight[entry]      = i == pairing->start[at] ? weight : 0;
    out->node[1][entry]     = pairing->left[i];
    out->left_weight[entry] = weight * pairing->share[i];
  }
}

/* Mean position of a patch. On projected faces the left centroid is the right one rotated back:
 * their axes then correspond although the faces are apart. */
static void find_centroid(const builder *b, int patch, int side, modal_patches *out) {
  const double *weight   = side ? out->left_weight : out->weight;
  double       *centroid = out->centroid[side] + 3 * patch;
  if (side == 1 && out->projected) {
    mesh_axis_rotate(b->axis, -b->sector, out->centroid[0] + 3 * patch, centroid);
    return;
  }
  for (int e = out->start[patch]; e < out->start[patch + 1]; e++)
    for (int d = 0; d < 3; d++)
      centroid[d] += weight[e] * b->mesh->coordinates[3 * (size_t)out->node[side][e] + d];
}

/* Centroid, axes, normal from the entries and the patch's integral of n dA. */
static shb_status finish_patch(const builder *b, int patch, const double normal[3],
                               modal_patches *out) {
  double length = norm(normal);
  for (int side = 0; side <= (int)out->has_left; side++) {
    double *centroid = out->centroid[side] + 3 * patch, radial[3], along[3];
    find_centroid(b, patch, side, out);
    mesh_axis_vector(b->axis, along);
    for (int d = 0; d < 3; d++) radial[d] = centroid[d] * (along[d] == 0);
    SHB_CHECK(
        norm(radial) > 0, SHB_ERR_INPUT,
        "group contact_right: a contact patch is centred on the engine axis; check rotor.axis");
    mesh_axes_at(b->axis, centroid, out->axes[side][patch]);
  }
  SHB_CHECK(length > 1e-6 * out->area[patch], SHB_ERR_INPUT,
            "group contact_right: the normals of contact patch %d cancel; is it a closed surface?",
            patch);
  double unit[3] = {normal[0] / length, normal[1] / length, normal[2] / length};
  into_axes((const double(*)[3])out->axes[0][patch], unit, out->normal + 3 * patch);
  return SHB_OK;
}

/* Largest angle between the normals of facets and the mean normal of their patch, and where. */
typedef struct {
  double angle; /* rad */
  int    facet;
} spread;

static void widen(const builder *b, int facet, const double mean[3], spread *s) {
  double own[3] = {0}, dot = 0;
  for (int i = 0; i < b->facets.nodes; i++)
    for (int d = 0; d < 3; d++) own[d] += b->facets.normal[facet][i][d];
  for (int d = 0; d < 3; d++) dot += own[d] * mean[d];
  const double angle = acos(fmax(-1, fmin(1, dot / (norm(own) * norm(mean)))));
  if (angle <= s->angle) return;
  *s = (spread){angle, facet};
}

/* The contact law has one normal a patch. */
static shb_status check_flat(const builder *b, const spread *s) {
  const double *at = b->facets.centroid[s->facet];
  SHB_CHECK(s->angle <= MODAL_FLAT * degree, SHB_ERR_INPUT,
            "group contact_right: its face at (%.4g, %.4g, %.4g) m is turned by %.3g deg against "
            "the mean of its contact patch, which the contact law takes as flat (at most %d deg); "
            "give every flat face an interface of its own (contact.interfaces), or a curved one "
            "more contact.points",
            at[0], at[1], at[2], s->angle / degree, MODAL_FLAT);
  return SHB_OK;
}

/* Entries of a right node, at most. */
static int entries_each(const builder *b) {
  return b->pairing && b->pairing->projected ? b->facets.nodes : 1;
}

/* points >= 1: facets of equal index form a patch. Entries are in the order of the nodes. */
static shb_status build_patch(builder *b, int patch, modal_patches *out) {
  double normal[3] = {0};
  for (int f = 0; f < b->facets.n; f++) {
    if (b->facets.patch[f] != patch) continue;
    out->area[patch] += b->facets.total[f];
    for (int i = 0; i < b->facets.nodes; i++) {
      b->node_area[b->right->nodes[b->facets.nodes * f + i]] += b->facets.area[f][i];
      for (int d = 0; d < 3; d++) normal[d] += b->facets.normal[f][i][d];
    }
  }
  out->start[patch + 1] = out->start[patch];
  for (int i = 0; i < b->mesh->n_nodes; i++) {
    if (fabs(b->node_area[i]) > 1e-12 * out->area[patch])
      add_entry(b, patch, i, b->node_area[i] / out->area[patch], out);
    b->node_area[i] = 0;
  }
  SHB_TRY(finish_patch(b, patch, normal, out));
  spread s = {.angle = 0};
  for (int f = 0; f < b->facets.n; f++)
    if (b->facets.patch[f] == patch) widen(b, f, normal, &s);
  return check_flat(b, &s);
}

/* points = 0: a patch for each node with more than a thousandth of the largest nodal area. Corner
 * nodes are left out: their area is small on slightly curved triangles and negative on quadrangles.
 * The other areas are scaled to the area of the face. */
static shb_status build_nodes(builder *b, double (*normal)[3], modal_patches *out) {
  double largest = 0, kept = 0;
  int    n = 0, n_nodes = b->mesh->n_nodes;
  for (int f = 0; f < b->facets.n; f++)
    for (int i = 0; i < b->facets.nodes; i++) {
      int node = b->right->nodes[b->facets.nodes * f + i];
      b->node_area[node] += b->facets.area[f][i];
      for (int d = 0; d < 3; d++) normal[node][d] += b->facets.normal[f][i][d];
    }
  for (int i = 0; i < n_nodes; i++) largest = fmax(largest, b->node_area[i]);
  for (int i = 0; i < n_nodes; i++) {
    if (b->node_area[i] <= 1e-3 * largest) continue;
    kept += b->node_area[i];
    n++;
  }
  allocate(n, b->pairing != NULL, n * entries_each(b), out);
  for (int i = 0, patch = 0; i < n_nodes; i++) {
    if (b->node_area[i] <= 1e-3 * largest) continue;
    out->area[patch]      = b->node_area[i] * out->total_area / kept;
    out->start[patch + 1] = out->start[patch];
    add_entry(b, patch, i, 1, out);
    SHB_TRY(finish_patch(b, patch, normal[i], out));
    patch++;
  }
  return SHB_OK;
}

/* psi and phi of the mean normal at the face's centroid. */
static shb_status measure_face(const builder *b, modal_patches *out) {
  double normal[3] = {0}, centroid[3] = {0}, axes[3][3], v[3];
  for (int f = 0; f < b->facets.n; f++) {
    out->total_area += b->facets.total[f];
    for (int d = 0; d < 3; d++) {
      centroid[d] += b->facets.total[f] * b->facets.centroid[f][d];
      for (int i = 0; i < b->facets.nodes; i++) normal[d] += b->facets.normal[f][i][d];
    }
  }
  SHB_CHECK(out->total_area > 0, SHB_ERR_INPUT, "group contact_right has no area");
  for (int d = 0; d < 3; d++) centroid[d] /= out->total_area;
  mesh_axes_at(b->axis, centroid, axes);
  into_axes((const double(*)[3])axes, normal, v);
  out->psi = atan2(v[1], v[0]);
  out->phi = atan2(-v[2], hypot(v[0], v[1]));
  return SHB_OK;
}

/* A node on the edge of two faces has facets of both. Only nodes with a patch count. */
static shb_status check_nodes(const builder *b, double (*normal)[3]) {
  spread s       = {.angle = 0};
  double largest = 0;
  for (int i = 0; i < b->mesh->n_nodes; i++) largest = fmax(largest, b->node_area[i]);
  for (int f = 0; f < b->facets.n; f++)
    for (int i = 0; i < b->facets.nodes; i++) {
      const int node = b->right->nodes[b->facets.nodes * f + i];
      if (b->node_area[node] > 1e-3 * largest) widen(b, f, normal[node], &s);
    }
  return check_flat(b, &s);
}

static shb_status build(builder *b, int points, modal_patches *out) {
  SHB_TRY(modal_facets_create(b->mesh, b->right, &b->facets));
  SHB_TRY(measure_face(b, out));
  if (points == 0) {
    double(*normal)[3] = shb_alloc_zeroed((size_t)b->mesh->n_nodes, sizeof *normal);
    shb_status status  = build_nodes(b, normal, out);
    if (status == SHB_OK) status = check_nodes(b, normal);
    free(normal);
    return status;
  }
  SHB_TRY(modal_facets_partition(&b->facets, points));
  allocate(points, b->pairing != NULL, b->facets.nodes * b->facets.n * entries_each(b), out);
  for (int patch = 0; patch < points; patch++) SHB_TRY(build_patch(b, patch, out));
  return SHB_OK;
}

static shb_status check_groups(const mesh_fe *mesh, bool to_ground) {
  char found[MESH_FOUND + 40];
  for (int id = MESH_CONTACT_RIGHT; id <= MESH_CONTACT_LEFT; id++) {
    if (id == MESH_CONTACT_LEFT && to_ground) continue;
    SHB_CHECK(mesh->set[id].n > 0, SHB_ERR_INPUT,
              "the mesh has no group \"%s\"; contact.to: %s needs it; %s",
              mesh_set_name((mesh_set_id)id), to_ground ? "ground" : "neighbour",
              mesh_fe_found(mesh, found));
  }
  return SHB_OK;
}

shb_status modal_patches_create(const mesh_fe *mesh, mesh_axis axis, int blades, bool to_ground,
                                int points, modal_patches *out) {
  memset(out, 0, sizeof *out);
  SHB_TRY(check_groups(mesh, to_ground));
  mesh_pairing pairing = {0};
  if (!to_ground) SHB_TRY(mesh_pairing_create(mesh, axis, blades, &pairing));
  builder b         = {.mesh      = mesh,
                       .right     = &mesh->set[MESH_CONTACT_RIGHT],
                       .pairing   = to_ground ? NULL : &pairing,
                       .sector    = to_ground ? 0 : SHB_TWO_PI / blades,
                       .axis      = axis,
                       .node_area = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, sizeof(double))};
  out->projected    = pairing.projected;
  out->gap          = pairing.gap;
  shb_status status = build(&b, points, out);
  modal_facets_free(&b.facets);
  free(b.node_area);
  mesh_pairing_free(&pairing);
  if (status != SHB_OK) modal_patches_free(out);
  return status;
}

/* Append the patches of one interface. */
static void append(const modal_patches *part, int which, int pairs, modal_patches *out) {
  const size_t entries = (size_t)part->start[part->n_pairs], n = (size_t)part->n_pairs;
  const int    first = out->start[pairs], sides = part->has_left ? 2 : 1;
  for (size_t p = 0; p < n; p++) {
    out->interface[(size_t)pairs + p] = which;
    out->start[(size_t)pairs + p + 1] = first + part->start[p + 1];
  }
  memcpy(out->weight + first, part->weight, entries * sizeof *out->weight);
  if (part->has_left)
    memcpy(out->left_weight + first, part->left_weight, entries * sizeof *out->left_weight);
  memcpy(out->area + pairs, part->area, n * sizeof *out->area);
  memcpy(out->normal + 3 * pairs, part->normal, 3 * n * sizeof *out->normal);
  for (int side = 0; side < sides; side++) {
    memcpy(out->node[side] + first, part->node[side], entries * sizeof *out->node[side]);
    memcpy(out->centroid[side] + 3 * pairs, part->centroid[side], 3 * n * sizeof(double));
    memcpy(out->axes[side] + pairs, part->axes[side], n * sizeof *out->axes[side]);
  }
  out->projected = out->projected || part->projected;
  out->gap       = fmax(out->gap, part->gap);
  out->total_area += part->total_area;
}

void modal_patches_join(int n, const modal_patches *part, modal_patches *out) {
  int pairs = 0, entries = 0;
  memset(out, 0, sizeof *out);
  for (int i = 0; i < n; i++) {
    pairs += part[i].n_pairs;
    entries += part[i].start[part[i].n_pairs];
  }
  out->interface = shb_alloc((size_t)pairs, sizeof *out->interface);
  allocate(pairs, part[0].has_left, entries, out);
  for (int i = 0, at = 0; i < n; at += part[i++].n_pairs) append(&part[i], i, at, out);
  out->psi = part[0].psi;
  out->phi = part[0].phi;
}

static shb_status check_angle(const char *name, const double *given, double face) {
  if (!given) return SHB_OK;
  double off = remainder(*given - face, 360 * degree);
  SHB_CHECK(
      fabs(off) <= degree, SHB_ERR_INPUT,
      "contact.%s: %.4g deg given, but the faces of group contact_right have %.4g deg; correct "
      "it or leave it out",
      name, *given / degree, face / degree);
  return SHB_OK;
}

shb_status modal_patches_check_angles(const modal_patches *patches, const double *psi,
                                      const double *phi) {
  SHB_TRY(check_angle("psi", psi, patches->psi));
  return check_angle("phi", phi, patches->phi);
}

void modal_patches_dofs(const modal_patches *patches, modal_dofs *dofs) {
  for (int side = 0; side <= (int)patches->has_left; side++)
    for (int p = 0; p < patches->n_pairs; p++) {
      int           first = patches->start[p], n = patches->start[p + 1] - first;
      const double *weight = side ? patches->left_weight : patches->weight;
      for (int a = 0; a < 3; a++)
        modal_dofs_add(dofs, n, patches->node[side] + first, weight + first,
                       patches->axes[side][p][a]);
    }
}

void modal_patches_free(modal_patches *patches) {
  free(patches->interface);
  free(patches->start);
  free(patches->weight);
  free(patches->left_weight);
  free(patches->area);
  free(patches->normal);
  for (int side = 0; side < 2; side++) {
    free(patches->node[side]);
    free(patches->centroid[side]);
    free(patches->axes[side]);
  }
  memset(patches, 0, sizeof *patches);
}
