#include "mesh/core/cyclic_sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"

/* Sides of which less than this share of the nodes match belong to another angle. */
static const double MOST_ORPHANS = 0.5;

typedef struct {
  double at[3]; /* m; of the left side turned onto the right one */
  double key;   /* coordinate along a direction that lies in no plane of symmetry of the mesh */
  int    node;
} place;

typedef struct {
  int    n;
  place *at; /* [n] by key */
} side;

typedef struct {
  mesh_fe  *mesh;
  mesh_axis axis;
  int       blades;
  double    tolerance;   /* m */
  side      right, left; /* left: turned */
  int       orphans;     /* right nodes without a partner */
  int       worst;       /* the one farthest from any left node */
  double    distance;    /* m, its distance */
} pairing;

static int by_key(const void *a, const void *b) {
  double p = ((const place *)a)->key, q = ((const place *)b)->key;
  return (p > q) - (p < q);
}

/* Nodes of a set turned by angle, each once, sorted. */
static void collect(const mesh_fe *mesh, mesh_set_id id, mesh_axis axis, double angle, side *out) {
  const mesh_face_set *set   = &mesh->set[id];
  const int            count = mesh_topology_of(mesh->kind)->face_nodes * set->n;
  char                *seen  = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, 1);
  out->n                     = 0;
  out->at                    = shb_alloc((size_t)count + 1, sizeof *out->at);
  for (int i = 0; i < count; i++) {
    const int node = set->nodes[i];
    if (seen[node]) continue;
    seen[node] = 1;
    place *p   = &out->at[out->n++];
    mesh_axis_rotate(axis, angle, mesh->coordinates + 3 * (size_t)node, p->at);
    p->key  = 0.5773 * p->at[0] + 0.6180 * p->at[1] + 0.5337 * p->at[2];
    p->node = node;
  }
  free(seen);
  qsort(out->at, (size_t)out->n, sizeof *out->at, by_key);
}

/* Place nearest to at among those whose key is within reach; NULL: none. */
static const place *nearest(const side *s, const place *at, double reach, double *distance) {
  int low = 0, high = s->n;
  while (low < high) {
    int middle = (low + high) / 2;
    if (s->at[middle].key < at->key - reach)
      low = middle + 1;
    else
      high = middle;
  }
  const place *best = NULL;
  *distance         = INFINITY;
  for (; low < s->n && s->at[low].key <= at->key + reach; low++) {
    const double here = vec3_distance(s->at[low].at, at->at);
    if (here < *distance) best = &s->at[low];
    *distance = fmin(*distance, here);
  }
  return best;
}

/* Find the partner of every right node.
 *   partner  out  [right.n] place on the left, or NULL */
static void match(pairing *p, const place **partner, mesh_cyclic_sides *out) {
  p->orphans  = 0;
  p->distance = 0;
  p->worst    = -1;
  for (int i = 0; i < p->right.n; i++) {
    double distance;
    partner[i] = nearest(&p->left, &p->right.at[i], 2 * p->tolerance, &distance);
    if (partner[i] && distance <= p->tolerance) {
      out->gap = fmax(out->gap, distance);
      continue;
    }
    partner[i] = NULL;
    p->orphans++;
    (void)nearest(&p->left, &p->right.at[i], INFINITY, &distance);
    if (distance > p->distance) p->worst = i;
    p->distance = fmax(p->distance, distance);
  }
}

/* Angle about the axis from the mean of the left side, unturned, to that of the right one, rad. */
static double angle_between(const mesh_fe *mesh, mesh_axis axis, const side *left,
                            const side *right) {
  double      mean[2][3] = {{0}}, axes[3][3];
  const side *both[2]    = {left, right};
  for (int s = 0; s < 2; s++)
    for (int i = 0; i < both[s]->n; i++)
      for (int d = 0; d < 3; d++)
        mean[s][d] += mesh->coordinates[3 * (size_t)both[s]->at[i].node + (size_t)d] / both[s]->n;
  mesh_axes_at(axis, mean[0], axes);
  return atan2(vec3_dot(axes[0], mean[1]), vec3_dot(axes[2], mean[1]));
}

static shb_status refuse(const pairing *p) {
  const mesh_fe *mesh  = p->mesh;
  const double   angle = fabs(angle_between(mesh, p->axis, &p->left, &p->right));
  const double   other = SHB_TWO_PI / angle, wanted = SHB_TWO_PI / p->blades;
  SHB_CHECK(p->orphans < MOST_ORPHANS * p->right.n || lround(other) == p->blades, SHB_ERR_INPUT,
            "the cyclic sides are %.6g deg apart, a sector of %.5g blades; rotor.blades is %d "
            "(%.6g deg)",
            angle * 360 / SHB_TWO_PI, other, p->blades, wanted * 360 / SHB_TWO_PI);
  if (p->orphans == 0)
    SHB_FAIL(SHB_ERR_INPUT,
             "cyclic sides do not match: cyclic_right has %d nodes, cyclic_left %d; mesh one side "
             "as a periodic copy of the other",
             p->right.n, p->left.n);
  const place *worst = &p->right.at[p->worst];
  SHB_FAIL(SHB_ERR_INPUT,
           "cyclic sides do not match: %d of %d nodes of cyclic_right have no partner; node %ld at "
           "(%g, %g, %g) m is %.3g m from the nearest node of cyclic_left turned by the sector "
           "angle, at most %.2g m is allowed; mesh one side as a periodic copy of the other",
           p->orphans, p->right.n, mesh->node_tag[worst->node], worst->at[0], worst->at[1],
           worst->at[2], p->distance, p->tolerance);
}

/* clamped[node] = 1 in group root. */
static char *list_clamped(const mesh_fe *mesh) {
  const mesh_face_set *root    = &mesh->set[MESH_ROOT];
  char                *clamped = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, 1);
  for (int i = 0; i < mesh_topology_of(mesh->kind)->face_nodes * root->n; i++)
    clamped[root->nodes[i]] = 1;
  return clamped;
}

static shb_status check_pair(const mesh_fe *mesh, const char *clamped, const place *right,
                             const place *left) {
  const double *x = right->at;
  SHB_CHECK(right->node != left->node, SHB_ERR_INPUT,
            "node %ld at (%g, %g, %g) m is on both cyclic sides, on the engine axis; give the disc "
            "a bore",
            mesh->node_tag[right->node], x[0], x[1], x[2]);
  SHB_CHECK(clamped[right->node] == clamped[left->node], SHB_ERR_INPUT,
            "node %ld at (%g, %g, %g) m of cyclic_right is %s, its partner %ld on cyclic_left is "
            "%s; let group root reach both sides alike",
            mesh->node_tag[right->node], x[0], x[1], x[2],
            clamped[right->node] ? "in group root" : "not in group root",
            mesh->node_tag[left->node], clamped[left->node] ? "in it" : "not");
  return SHB_OK;
}

/* Record the partners in the mesh. */
static shb_status store(const pairing *p, const place *const *partner) {
  mesh_fe   *mesh    = p->mesh;
  char      *clamped = list_clamped(mesh);
  shb_status status  = SHB_OK;
  mesh->image        = shb_alloc((size_t)mesh->n_nodes + 1, sizeof *mesh->image);
  for (int i = 0; i < mesh->n_nodes; i++) mesh->image[i] = -1;
  for (int i = 0; status == SHB_OK && i < p->right.n; i++) {
    status                           = check_pair(mesh, clamped, &p->right.at[i], partner[i]);
    mesh->image[p->right.at[i].node] = partner[i]->node;
  }
  free(clamped);
  if (status != SHB_OK) {
    free(mesh->image);
    mesh->image = NULL;
  }
  return status;
}

/* Rotation by the sector angle: its columns are the turned unit vectors. */
static void set_turn(mesh_axis axis, int blades, double turn[3][3]) {
  for (int d = 0; d < 3; d++) {
    double unit[3] = {d == 0, d == 1, d == 2}, turned[3];
    mesh_axis_rotate(axis, SHB_TWO_PI / blades, unit, turned);
    for (int e = 0; e < 3; e++) turn[e][d] = turned[e];
  }
}

static shb_status pair(pairing *p, mesh_cyclic_sides *out) {
  mesh_fe     *mesh   = p->mesh;
  const double sector = SHB_TWO_PI / p->blades;
  collect(mesh, MESH_CYCLIC_RIGHT, p->axis, 0, &p->right);
  collect(mesh, MESH_CYCLIC_LEFT, p->axis, sector, &p->left);
  const place **partner = shb_alloc((size_t)p->right.n + 1, sizeof(place *));
  match(p, partner, out);
  shb_status status = p->orphans > 0 || p->right.n != p->left.n ? refuse(p) : store(p, partner);
  free(partner);
  return status;
}

/* Swap the groups if the right one lies at the negative angle. With two blades both lie so. */
static void orient(mesh_fe *mesh, mesh_axis axis, const side *left, const side *right, int blades) {
  const double angle = angle_between(mesh, axis, left, right);
  if (angle >= 0 || fabs(angle) > SHB_TWO_PI / 2 - 1e-6 || blades == 2) return;
  const mesh_face_set swap     = mesh->set[MESH_CYCLIC_RIGHT];
  mesh->set[MESH_CYCLIC_RIGHT] = mesh->set[MESH_CYCLIC_LEFT];
  mesh->set[MESH_CYCLIC_LEFT]  = swap;
}

static void orient_sides(pairing *p) {
  collect(p->mesh, MESH_CYCLIC_RIGHT, p->axis, 0, &p->right);
  collect(p->mesh, MESH_CYCLIC_LEFT, p->axis, 0, &p->left);
  orient(p->mesh, p->axis, &p->left, &p->right, p->blades);
  free(p->right.at);
  free(p->left.at);
  p->right = p->left = (side){0, NULL};
}

shb_status mesh_cyclic_pair(mesh_fe *mesh, mesh_axis axis, int blades, mesh_cyclic_sides *out) {
  const int n[2] = {mesh->set[MESH_CYCLIC_RIGHT].n, mesh->set[MESH_CYCLIC_LEFT].n};
  char      found[MESH_FOUND + 40];
  pairing   p = {.mesh = mesh, .axis = axis, .blades = blades};
  *out        = (mesh_cyclic_sides){0};
  if (n[0] == 0 && n[1] == 0) return SHB_OK;
  SHB_CHECK(n[0] && n[1], SHB_ERR_INPUT,
            "group %s is absent or empty; a sector needs both cyclic sides; %s",
            mesh_set_name(n[0] ? MESH_CYCLIC_LEFT : MESH_CYCLIC_RIGHT), mesh_fe_found(mesh, found));
  SHB_CHECK(blades >= 2, SHB_ERR_INPUT,
            "rotor.blades: the mesh has cyclic sides, and the number of its sectors is wanted, 2 "
            "or more");
  p.tolerance = MESH_CYCLIC_GAP * mesh_fe_extent(mesh);
  orient_sides(&p);
  shb_status status = pair(&p, out);
  if (status == SHB_OK) {
    out->n = p.right.n;
    set_turn(axis, blades, mesh->turn);
  }
  free(p.right.at);
  free(p.left.at);
  return status;
}

mesh_fe mesh_cyclic_alternating(const mesh_fe *mesh) {
  mesh_fe view = *mesh;
  for (int i = 0; i < 9; i++) view.turn[i / 3][i % 3] *= -1;
  return view;
}
