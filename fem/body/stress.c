#include "fem/body/stress.h"

#include <stdlib.h>
#include <string.h>

#include "fem/body/pressure.h"
#include "fem/element/finite_strain.h"
#include "fem/supernodal/hot.h"
#include "fem/supernodal/large_pages.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"

/* Extrapolation from the points of a rule to the nodes by a linear function of the reference
 * coordinates: node value = sum_p at[node][p] value_p. */
typedef struct {
  double at[MESH_NODES][FEM_POINTS];
} extrapolation;

/* Inverse of a symmetric positive definite 4x4 matrix by Gauss-Jordan elimination. */
static void invert(double A[4][4], double X[4][4]) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) X[i][j] = i == j;
  for (int c = 0; c < 4; c++) {
    double pivot = A[c][c];
    for (int j = 0; j < 4; j++) A[c][j] /= pivot, X[c][j] /= pivot;
    for (int i = 0; i < 4; i++) {
      double factor = i == c ? 0 : A[i][c];
      for (int j = 0; j < 4; j++) A[i][j] -= factor * A[c][j], X[i][j] -= factor * X[c][j];
    }
  }
}

/* Basis (1, r, s, t) at a point with these shape functions. */
static void linear_at(const mesh_topology *topology, const double *shape, double b[4]) {
  b[0] = 1;
  b[1] = b[2] = b[3] = 0;
  for (int i = 0; i < topology->nodes; i++)
    for (int d = 0; d < 3; d++) b[d + 1] += shape[i] * topology->place[i][d];
}

static void fit(const mesh_topology *topology, const fem_rule *rule, extrapolation *out) {
  double normal[4][4] = {{0}}, inverse[4][4];
  for (int p = 0; p < rule->n; p++) {
    double b[4];
    linear_at(topology, rule->shape[p], b);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) normal[i][j] += b[i] * b[j];
  }
  invert(normal, inverse);
  for (int node = 0; node < topology->nodes; node++) {
    const double *place = topology->place[node], a[4] = {1, place[0], place[1], place[2]};
    for (int p = 0; p < rule->n; p++) {
      double b[4], sum = 0;
      linear_at(topology, rule->shape[p], b);
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) sum += a[i] * inverse[i][j] * b[j];
      out->at[node][p] = sum;
    }
  }
}

/* Volume of the element times its nodal stresses. Returns the volume. */
static double add_element(const fem_body *body, const fem_material *own, const double x[][3],
                          const double u[][3], const fem_rule *rule, const extrapolation *to,
                          double nodal[][FEM_STRESSES]) {
  double volume = 0, stress[FEM_POINTS][FEM_STRESSES];
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3];
    volume += rule->weight[p] * fem_element_gradient(body->element, rule, p, x, g);
    fem_displacement_gradient(body->element->n, (const double(*)[3])g, u, H);
    fem_deformation_at(own, (const double(*)[3])H, &at);
    fem_cauchy(&at, stress[p]);
  }
  for (int i = 0; i < body->element->n; i++)
    for (int c = 0; c < FEM_STRESSES; c++) {
      nodal[i][c] = 0;
      for (int p = 0; p < rule->n; p++) nodal[i][c] += to->at[i][p] * stress[p][c];
      nodal[i][c] *= volume;
    }
  return volume;
}

/* What the mean at a node is taken over. */
typedef struct {
  extrapolation to[2];  /* from the rule of straight and of curved elements */
  int          *owner;  /* [n_nodes] region whose elements count; NULL: all elements do */
  double       *volume; /* [n_nodes] of the elements that count */
} recovery;

/* The region of greater E; of equal ones the first. */
static int stiffer(const fem_body *body, int a, int b) {
  const double Ea = body->material[a].E, Eb = body->material[b].E;
  if (Ea != Eb) return Ea > Eb ? a : b;
  return a < b ? a : b;
}

/* The stiffest of the materials at each node, on the cyclic sides of both sectors. */
static void find_owners(const fem_body *body, int *owner) {
  const mesh_fe *mesh = body->mesh;
  const int      n    = body->element->n;
  for (int i = 0; i < mesh->n_nodes; i++) owner[i] = -1;
  for (int i = 0; i < n * mesh->n_elements; i++) {
    int *own = &owner[mesh->connectivity[i]], here = mesh->region[i / n];
    *own = *own < 0 ? here : stiffer(body, *own, here);
  }
  for (int i = 0; mesh->image && i < mesh->n_nodes; i++) {
    const int left = mesh->image[i];
    if (left >= 0) owner[i] = owner[left] = stiffer(body, owner[i], owner[left]);
  }
}

static void recovery_destroy(recovery *r) {
  free(r->volume);
  free(r->owner);
  free(r);
}

static recovery *recovery_create(const fem_body *body) {
  const mesh_fe       *mesh     = body->mesh;
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  recovery            *r        = shb_alloc_zeroed(1, sizeof *r);
  r->volume                     = shb_alloc_zeroed((size_t)mesh->n_nodes, sizeof *r->volume);
  r->owner = mesh->region ? shb_alloc((size_t)mesh->n_nodes, sizeof *r->owner) : NULL;
  fit(topology, &body->element->straight, &r->to[0]);
  fit(topology, &body->element->curved, &r->to[1]);
  if (r->owner) find_owners(body, r->owner);
  return r;
}

static bool counts(const recovery *r, const mesh_fe *mesh, int element, int node) {
  return !r->owner || r->owner[node] == mesh->region[element];
}

/* Sums of the tensors of two partners on the cyclic sides <- those over the elements of both
 * sectors, each in the axes of its side. */
static void join_tensors(const mesh_fe *mesh, double complex phase,
                         double complex right[FEM_STRESSES], double complex left[FEM_STRESSES]) {
  double turn[3][3], back[3][3], part[2][FEM_STRESSES];
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 3; d++) turn[i][d] = back[d][i] = mesh->turn[i][d];
  for (int c = 0; c < FEM_STRESSES; c++)
    part[0][c] = creal(phase * left[c]), part[1][c] = cimag(phase * left[c]);
  for (int p = 0; p < 2; p++) vec3_turn_tensor(turn, part[p]);
  for (int c = 0; c < FEM_STRESSES; c++) {
    right[c] += CMPLX(part[0][c], part[1][c]);
    part[0][c] = creal(conj(phase) * right[c]), part[1][c] = cimag(conj(phase) * right[c]);
  }
  for (int p = 0; p < 2; p++) vec3_turn_tensor(back, part[p]);
  for (int c = 0; c < FEM_STRESSES; c++) left[c] = CMPLX(part[0][c], part[1][c]);
}

/* The same of their volumes; false: node is not on cyclic_right. */
static bool join_volumes(const mesh_fe *mesh, int node, recovery *r) {
  if (!mesh->image || mesh->image[node] < 0) return false;
  double *left    = &r->volume[mesh->image[node]];
  r->volume[node] = *left = r->volume[node] + *left;
  return true;
}

void fem_nodal_stress(const fem_body *body, const double *u, double (*stress)[FEM_STRESSES]) {
  const mesh_fe *mesh = body->mesh;
  recovery      *r    = recovery_create(body);
  memset(stress, 0, (size_t)mesh->n_nodes * sizeof *stress);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node = mesh->connectivity + body->element->n * (size_t)e;
    double     x[MESH_NODES][3], v[MESH_NODES][3], nodal[MESH_NODES][FEM_STRESSES];
    fem_body_element(body, e, u, x, v);
    const fem_rule *rule = fem_element_stiffness_rule(body->element, (const double(*)[3])x);
    double          here =
        add_element(body, fem_material_at(body->material, mesh, e), (const double(*)[3])x,
                    (const double(*)[3])v, rule, &r->to[rule == &body->element->curved], nodal);
    for (int i = 0; i < body->element->n; i++) {
      if (!counts(r, mesh, e, node[i])) continue;
      r->volume[node[i]] += here;
      for (int c = 0; c < FEM_STRESSES; c++) stress[node[i]][c] += nodal[i][c];
    }
  }
  for (int i = 0; i < mesh->n_nodes; i++) {
    double complex right[FEM_STRESSES], left[FEM_STRESSES];
    if (!join_volumes(mesh, i, r)) continue;
    const int partner = mesh->image[i];
    for (int c = 0; c < FEM_STRESSES; c++) right[c] = stress[i][c], left[c] = stress[partner][c];
    join_tensors(mesh, 1, right, left);
    for (int c = 0; c < FEM_STRESSES; c++)
      stress[i][c] = creal(right[c]), stress[partner][c] = creal(left[c]);
  }
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int c = 0; c < FEM_STRESSES; c++) stress[i][c] /= r->volume[i];
  recovery_destroy(r);
}

/* Motions at work on together. */
enum { LANES = 8 };

typedef double lanes[LANES];

/* Displacements of the nodes of an element in up to LANES motions, less those of its first node. */
static void gather(const fem_body *body, const int *node, int n, const double *motion,
                   lanes v[][3]) {
  const size_t stride = 3 * (size_t)body->mesh->n_nodes;
  memset(v, 0, (size_t)body->element->n * sizeof *v);
  for (int l = 0; l < n; l++) {
    const double *all = motion + (size_t)l * stride, *first = all + 3 * (size_t)node[0];
    for (int i = 1; i < body->element->n; i++)
      for (int a = 0; a < 3; a++) v[i][a][l] = all[3 * (size_t)node[i] + (size_t)a] - first[a];
  }
}

/* Changes of stress at a point of the rule. */
FEM_HOT static void change_at(int n, const double D[6][9], const double g[][3], const lanes v[][3],
                              lanes stress[FEM_STRESSES]) {
  lanes H[9] = {{0}};
  for (int i = 1; i < n; i++)
    for (int a = 0; a < 3; a++)
      for (int d = 0; d < 3; d++)
        for (int l = 0; l < LANES; l++) H[3 * a + d][l] += v[i][a][l] * g[i][d];
  memset(stress, 0, FEM_STRESSES * sizeof *stress);
  for (int c = 0; c < FEM_STRESSES; c++)
    for (int h = 0; h < 9; h++)
      for (int l = 0; l < LANES; l++) stress[c][l] += D[c][h] * H[h][l];
}

/* sum += the stresses at the points times their weights at a node. */
FEM_HOT static void add_to_node(int points, const double *weight, double volume,
                                lanes stress[][FEM_STRESSES], lanes sum[FEM_STRESSES]) {
  for (int p = 0; p < points; p++)
    for (int c = 0; c < FEM_STRESSES; c++)
      for (int l = 0; l < LANES; l++) sum[c][l] += volume * weight[p] * stress[p][c][l];
}

/* Add an element's volume times its nodal stresses to the sums of the nodes. */
static void add_changes(const fem_body *body, int e, const double *u, int n, const double *motion,
                        recovery *r, lanes (*sum)[FEM_STRESSES]) {
  const mesh_fe      *mesh  = body->mesh;
  const fem_material *own   = fem_material_at(body->material, mesh, e);
  const int           nodes = body->element->n, *node = mesh->connectivity + nodes * (size_t)e;
  double              x[MESH_NODES][3], at_rest[MESH_NODES][3], volume = 0;
  lanes               v[MESH_NODES][3], stress[FEM_POINTS][FEM_STRESSES];
  fem_body_element(body, e, u, x, at_rest);
  gather(body, node, n, motion, v);
  const fem_rule      *rule = fem_element_stiffness_rule(body->element, (const double(*)[3])x);
  const extrapolation *to   = &r->to[rule == &body->element->curved];
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3], D[6][9];
    volume +=
        rule->weight[p] * fem_element_gradient(body->element, rule, p, (const double(*)[3])x, g);
    fem_displacement_gradient(nodes, (const double(*)[3])g, (const double(*)[3])at_rest, H);
    fem_deformation_at(own, (const double(*)[3])H, &at);
    fem_cauchy_tangent(own, &at, D);
    change_at(nodes, (const double(*)[9])D, (const double(*)[3])g, (const lanes(*)[3])v, stress[p]);
  }
  for (int i = 0; i < nodes; i++) {
    if (!counts(r, mesh, e, node[i])) continue;
    r->volume[node[i]] += volume;
    add_to_node(rule->n, to->at[i], volume, stress, sum[node[i]]);
  }
}

/* Up to LANES motions; of a sector each pair of them is the real and the imaginary part of a wave.
 *   sum  out  [n_nodes], volumes times stresses */
static void sum_changes(const fem_body *body, const double *u, double complex phase, int n,
                        const double *motion, recovery *r, lanes (*sum)[FEM_STRESSES]) {
  const mesh_fe *mesh = body->mesh;
  memset(sum, 0, (size_t)mesh->n_nodes * sizeof *sum);
  memset(r->volume, 0, (size_t)mesh->n_nodes * sizeof *r->volume);
  for (int e = 0; e < mesh->n_elements; e++) add_changes(body, e, u, n, motion, r, sum);
  for (int i = 0; i < mesh->n_nodes; i++) {
    if (!join_volumes(mesh, i, r)) continue;
    lanes *own = sum[i], *partner = sum[mesh->image[i]];
    for (int l = 0; l < LANES; l += 2) {
      double complex right[FEM_STRESSES], left[FEM_STRESSES];
      for (int c = 0; c < FEM_STRESSES; c++) {
        right[c] = CMPLX(own[c][l], own[c][l + 1]);
        left[c]  = CMPLX(partner[c][l], partner[c][l + 1]);
      }
      join_tensors(mesh, phase, right, left);
      for (int c = 0; c < FEM_STRESSES; c++) {
        own[c][l] = creal(right[c]), own[c][l + 1] = cimag(right[c]);
        partner[c][l] = creal(left[c]), partner[c][l + 1] = cimag(left[c]);
      }
    }
  }
}

/* Up to LANES motions. */
static void change_few(const fem_body *body, const double *u, int n, const double *motion,
                       float *stress) {
  const size_t nodes        = (size_t)body->mesh->n_nodes;
  recovery    *r            = recovery_create(body);
  lanes(*sum)[FEM_STRESSES] = fem_large_alloc(nodes, sizeof *sum);
  sum_changes(body, u, 1, n, motion, r, sum);
  for (int l = 0; l < n; l++) {
    float *out = stress + FEM_STRESSES * nodes * (size_t)l;
    for (size_t i = 0; i < nodes; i++)
      for (int c = 0; c < FEM_STRESSES; c++)
        out[FEM_STRESSES * i + (size_t)c] = (float)(sum[i][c][l] / r->volume[i]);
  }
  free(sum);
  recovery_destroy(r);
}

void fem_nodal_stress_changes(const fem_body *body, const double *u, int n_sets,
                              const fem_motions *set) {
  const size_t nodes  = (size_t)body->mesh->n_nodes;
  int          groups = 0;
  for (int s = 0; s < n_sets; s++) groups += (set[s].n + LANES - 1) / LANES;
#pragma omp parallel for schedule(dynamic, 1)
  for (int g = 0; g < groups; g++) {
    int s = 0, first = LANES * g;
    for (; first >= set[s].n; s++) first -= (set[s].n + LANES - 1) / LANES * LANES;
    const size_t at = nodes * (size_t)first;
    change_few(body, u, PetscMin(LANES, set[s].n - first), set[s].motion + 3 * at,
               set[s].stress + FEM_STRESSES * at);
  }
}

void fem_nodal_stress_change(const fem_body *body, const double *u, int n, const double *motion,
                             float *stress) {
  const fem_motions all = {n, motion, stress};
  fem_nodal_stress_changes(body, u, 1, &all);
}

/* Work arrays of waves. */
typedef struct {
  recovery *r;
  double   *part; /* [LANES][n_nodes][3] */
  lanes (*sum)[FEM_STRESSES];
} wave_work;

/* Up to LANES/2 waves. */
static void change_waves(const fem_body *body, const double *u, double complex phase, int n,
                         const double complex *motion, const wave_work *w, float complex *stress) {
  const size_t nodes = (size_t)body->mesh->n_nodes, size = 3 * nodes;
  for (size_t l = 0; l < (size_t)n; l++)
    for (size_t i = 0; i < size; i++) {
      w->part[2 * l * size + i]       = creal(motion[l * size + i]);
      w->part[(2 * l + 1) * size + i] = cimag(motion[l * size + i]);
    }
  sum_changes(body, u, phase, 2 * n, w->part, w->r, w->sum);
  for (size_t l = 0; l < (size_t)n; l++)
    for (size_t i = 0; i < nodes; i++)
      for (size_t c = 0; c < FEM_STRESSES; c++)
        stress[FEM_STRESSES * (nodes * l + i) + c] = (float complex)CMPLX(
            w->sum[i][c][2 * l] / w->r->volume[i], w->sum[i][c][2 * l + 1] / w->r->volume[i]);
}

void fem_nodal_stress_wave(const fem_body *body, const double *u, double complex phase, int n,
                           const double complex *motion, float complex *stress) {
  const size_t    nodes = (size_t)body->mesh->n_nodes;
  const wave_work w     = {.r    = recovery_create(body),
                           .part = shb_alloc(LANES * 3 * nodes, sizeof *w.part),
                           .sum  = fem_large_alloc(nodes, sizeof *w.sum)};
  for (int first = 0; first < n; first += LANES / 2) {
    const int    count = n - first < LANES / 2 ? n - first : LANES / 2;
    const size_t at    = nodes * (size_t)first;
    change_waves(body, u, phase, count, motion + 3 * at, &w, stress + FEM_STRESSES * at);
  }
  free(w.part);
  free(w.sum);
  recovery_destroy(w.r);
}

PetscErrorCode fem_unbalanced_forces(const fem_body *body, const double *u, double (*unbalanced)[3],
                                     double load[3]) {
  const int n = body->element->n;
  PetscFunctionBeginUser;
  memset(unbalanced, 0, (size_t)body->mesh->n_nodes * sizeof *unbalanced);
  memset(load, 0, 3 * sizeof *load);
  for (int e = 0; e < body->mesh->n_elements; e++) {
    const int *node = body->mesh->connectivity + n * (size_t)e;
    double     x[MESH_NODES][3], v[MESH_NODES][3], internal[MESH_NODES][3], outer[MESH_NODES][3];
    double     m[MESH_NODES * MESH_NODES];

    const fem_material *own = fem_material_at(body->material, body->mesh, e);
    fem_body_element(body, e, u, x, v);
    const double(*at)[3] = (const double(*)[3])x, (*by)[3] = (const double(*)[3])v;
    fem_element_force(body->element, own, at, by, internal);
    fem_element_mass(body->element, own->rho, at, m);
    fem_rotation_load(&body->rotation, n, m, at, by, outer);
    for (int i = 0; i < 3 * n; i++) {
      unbalanced[node[i / 3]][i % 3] += internal[i / 3][i % 3] - outer[i / 3][i % 3];
      load[i % 3] += outer[i / 3][i % 3];
    }
  }
  PetscCall(fem_pressure_unbalanced(body, u, unbalanced, load));
  PetscFunctionReturn(0);
}
