#include "fem/body/sector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/pressure.h"
#include "fem/element/finite_strain.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

/* ------------------------------------------------------------------ stiffness */

/* Copy pattern and values of K(0). */
static PetscErrorCode copy_stiffness(Mat K, fem_sector *s) {
  const PetscInt *start, *column;
  PetscInt        n;
  PetscBool       done;
  double         *value;
  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(K, 0, PETSC_FALSE, PETSC_TRUE, &n, &start, &column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "no rows");
  const size_t count      = (size_t)start[n];
  int         *own_start  = shb_alloc((size_t)n + 1, sizeof *own_start);
  int         *own_column = shb_alloc(count + 1, sizeof *own_column);
  s->blocks               = (fem_blocks){(int)n, own_start, own_column};
  s->stiffness            = shb_alloc(9 * count + 1, sizeof *s->stiffness);
  memcpy(own_start, start, ((size_t)n + 1) * sizeof *own_start);
  memcpy(own_column, column, count * sizeof *own_column);
  PetscCall(MatSeqSBAIJGetArray(K, &value));
  memcpy(s->stiffness, value, 9 * count * sizeof *value);
  PetscCall(MatSeqSBAIJRestoreArray(K, &value));
  PetscCall(MatRestoreRowIJ(K, 0, PETSC_FALSE, PETSC_TRUE, &n, &start, &column, &done));
  PetscFunctionReturn(0);
}

/* Index of the block in row r and column c, which exists. */
static int find_block(const fem_blocks *b, int r, int c) {
  int low = b->start[r], high = b->start[r + 1] - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (b->column[middle] < c)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Call visit for each pair of nodes of an element of which one is turned. It gets the block, the
 * place in the element's matrix, and the sign of sin theta. */
typedef void (*visitor)(fem_sector *s, int block, const double *at, int order, double sign,
                        int *slot);

static void for_each_coupling(fem_sector *s, int n, const int *node, const double *K, int *slot,
                              visitor visit) {
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) {
      const int r = s->row[node[a]], c = s->row[node[b]];
      if (s->turned[node[a]] == s->turned[node[b]] || r < 0 || c < r) continue;
      visit(s, find_block(&s->blocks, r, c), K ? K + 3 * a * 3 * n + 3 * b : NULL, 3 * n,
            s->turned[node[a]] ? 1 : -1, slot);
    }
}

/* First pass: slot[block] = 1 + index of the block among the coupled ones. */
static void count_coupling(fem_sector *s, int block, const double *at, int order, double sign,
                           int *slot) {
  (void)at, (void)order, (void)sign;
  if (slot[block] == 0) slot[block] = ++s->n_coupled;
}

static void add_coupling(fem_sector *s, int block, const double *at, int order, double sign,
                         int *slot) {
  const int q   = slot[block] - 1;
  s->coupled[q] = block;
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) {
      s->cosine[q][d + 3 * e] += at[d * order + e];
      s->sine[q][d + 3 * e] += sign * at[d * order + e];
    }
}

static bool touches(const fem_sector *s, int n, const int *node) {
  for (int i = 0; i < n; i++)
    if (s->turned[node[i]]) return true;
  return false;
}

/* Tangent of an element in the frames of its block rows, as fem_system_create or
 * fem_tangent_assemble has it. */
static void element_tangent(const fem_body *body, const double *state, const fem_system *system,
                            int e, double *K) {
  const int           n   = body->element->n;
  const fem_material *own = fem_material_at(body->material, body->mesh, e);
  double              x[MESH_NODES][3], v[MESH_NODES][3], m[MESH_NODES * MESH_NODES];
  fem_body_element(body, e, state, x, v);
  if (state) {
    fem_element_tangent(body->element, own, (const double(*)[3])x, (const double(*)[3])v, K);
    fem_element_mass(body->element, own->rho, (const double(*)[3])x, m);
    fem_rotation_soften(&body->rotation, n, m, K);
  } else
    fem_element_stiffness(body->element, own, (const double(*)[3])x, K);
  fem_system_turn(system, n, body->mesh->connectivity + n * (size_t)e, K);
}

/* Elements, and loaded faces under pressure, at cyclic_right. */
static PetscErrorCode visit_all(const fem_body *body, const double *state, const fem_system *system,
                                fem_sector *s, int *slot, visitor visit) {
  const int            n     = body->element->n;
  const mesh_face_set *set   = &body->mesh->set[MESH_LOAD];
  const int            width = mesh_topology_of(body->mesh->kind)->face_nodes;
  const bool           whole = visit == add_coupling;
  double               K[FEM_DOFS * FEM_DOFS];
  PetscFunctionBeginUser;
  for (int e = 0; e < body->mesh->n_elements; e++) {
    const int *node = body->mesh->connectivity + n * (size_t)e;
    if (!touches(s, n, node)) continue;
    if (whole) element_tangent(body, state, system, e, K);
    for_each_coupling(s, n, node, whole ? K : NULL, slot, visit);
  }
  for (int f = 0; state && body->pressure != 0 && f < set->n; f++) {
    const int *node = set->nodes + width * (size_t)f;
    if (!touches(s, width, node)) continue;
    if (whole) PetscCall(fem_pressure_face_tangent(body, state, system, f, K));
    for_each_coupling(s, width, node, whole ? K : NULL, slot, visit);
  }
  PetscFunctionReturn(0);
}

/* Most nodes at cyclic_right meet an inner node from one side only: then K(0) has B or B^T alone in
 * their block. Otherwise it has more, and the block is any complex one. */
static signed char exponent_of(const double K[9], const double cosine[9], const double sine[9]) {
  const double rounding = 1e-12;
  double       size = 0, rest = 0, forward = 0, backward = 0;
  for (int i = 0; i < 9; i++) {
    size     = fmax(size, fmax(fabs(K[i]), fmax(fabs(cosine[i]), fabs(sine[i]))));
    rest     = fmax(rest, fabs(K[i] - cosine[i]));
    forward  = fmax(forward, fabs(cosine[i] - sine[i]) / 2);  /* B */
    backward = fmax(backward, fabs(cosine[i] + sine[i]) / 2); /* B^T */
  }
  if (rest > rounding * size) return FEM_ANY_BLOCK;
  return forward <= rounding * size ? 1 : backward <= rounding * size ? -1 : FEM_ANY_BLOCK;
}

static PetscErrorCode find_coupling(const fem_body *body, const double *state,
                                    const fem_system *system, fem_sector *s) {
  int *slot = shb_alloc_zeroed((size_t)s->blocks.start[s->blocks.n] + 1, sizeof *slot);
  PetscFunctionBeginUser;
  PetscCall(visit_all(body, state, system, s, slot, count_coupling));
  const size_t count = (size_t)s->n_coupled + 1;
  s->coupled         = shb_alloc_zeroed(count, sizeof *s->coupled);
  s->cosine          = shb_alloc_zeroed(count, sizeof *s->cosine);
  s->sine            = shb_alloc_zeroed(count, sizeof *s->sine);
  s->exponent        = shb_alloc_zeroed(count, sizeof *s->exponent);
  PetscCall(visit_all(body, state, system, s, slot, add_coupling));
  for (int q = 0; q < s->n_coupled; q++)
    s->exponent[q] =
        exponent_of(s->stiffness + 9 * (size_t)s->coupled[q], s->cosine[q], s->sine[q]);
  free(slot);
  PetscFunctionReturn(0);
}

double complex fem_sector_phase(int n, int blades) {
  const int m = (n % blades + blades) % blades;
  if (m == 0) return 1;
  if (2 * m == blades) return -1;
  return cexp(-I * (SHB_TWO_PI * m / blades));
}

shb_status fem_sector_analyse(const fem_sector *s, fem_hermitian_order **order) {
  const fem_hermitian_matrix K = {s->blocks, s->stiffness, s->n_coupled, s->coupled, s->exponent};
  return fem_hermitian_analyse(&K, order);
}

void fem_sector_coupled(const fem_sector *s, double complex phase, double complex (*value)[9]) {
  const double less = creal(phase) - 1, sine = -cimag(phase);
  for (int q = 0; q < s->n_coupled; q++) {
    const double *K = s->stiffness + 9 * (size_t)s->coupled[q];
    for (int i = 0; i < 9; i++)
      value[q][i] = CMPLX(K[i] + less * s->cosine[q][i], sine * s->sine[q][i]);
  }
}

/* ------------------------------------------------------------------ mass */

/* Elements around each node: element[start[i]] .. element[start[i + 1] - 1]. */
static int *elements_around(const mesh_fe *mesh, int **element) {
  const int each = mesh_topology_of(mesh->kind)->nodes, total = each * mesh->n_elements;
  int      *start = shb_alloc_zeroed((size_t)mesh->n_nodes + 2, sizeof *start);
  *element        = shb_alloc((size_t)total + 1, sizeof **element);
  for (int i = 0; i < total; i++) start[mesh->connectivity[i] + 2]++;
  for (int i = 0; i < mesh->n_nodes; i++) start[i + 2] += start[i + 1];
  for (int i = 0; i < total; i++) (*element)[start[mesh->connectivity[i] + 1]++] = i / each;
  return start;
}

/* Nodes that share an element with node i; seen[node] = 1 + i marks them, place gets their index.
 * Returns the end of the row. */
static int list_neighbours(const mesh_fe *mesh, const int *start, const int *element, int i,
                           int end, int *seen, fem_sector *s) {
  const int each = mesh_topology_of(mesh->kind)->nodes;
  for (int k = start[i]; k < start[i + 1]; k++)
    for (int b = 0; b < each; b++) {
      const int node = mesh->connectivity[each * (size_t)element[k] + (size_t)b];
      if (seen[node] == i + 1) continue;
      seen[node] = i + 1;
      if (s->mass_node) s->mass_node[end] = node;
      end++;
    }
  return end;
}

static void mass_pattern(const mesh_fe *mesh, fem_sector *s) {
  int *element, *start = elements_around(mesh, &element);
  int *seen     = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, sizeof *seen);
  s->mass_start = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, sizeof *s->mass_start);
  for (int pass = 0; pass < 2; pass++) {
    memset(seen, 0, (size_t)mesh->n_nodes * sizeof *seen);
    for (int i = 0; i < mesh->n_nodes; i++)
      s->mass_start[i + 1] = list_neighbours(mesh, start, element, i, s->mass_start[i], seen, s);
    if (pass > 0) continue;
    const size_t count = (size_t)s->mass_start[mesh->n_nodes] + 1;
    s->mass_node       = shb_alloc(count, sizeof *s->mass_node);
    s->mass            = shb_alloc_zeroed(count, sizeof *s->mass);
  }
  free(element);
  free(start);
  free(seen);
}

static void add_mass(const fem_body *body, int e, fem_sector *s) {
  const int  n    = body->element->n;
  const int *node = body->mesh->connectivity + n * (size_t)e;
  double     x[MESH_NODES][3], v[MESH_NODES][3], m[MESH_NODES * MESH_NODES];
  fem_body_element(body, e, NULL, x, v);
  fem_element_mass(body->element, fem_material_at(body->material, body->mesh, e)->rho,
                   (const double(*)[3])x, m);
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) {
      int at = s->mass_start[node[a]];
      while (s->mass_node[at] != node[b]) at++;
      s->mass[at] += m[n * a + b];
    }
}

size_t fem_sector_scratch(const fem_sector *s, int columns) {
  return 6 * (size_t)columns * ((size_t)s->n_nodes + 1);
}

/* Re and Im of factor v. */
static void turn_phase(double complex phase, double *v) {
  const double re = creal(phase) * v[0] - cimag(phase) * v[1];
  v[1]            = creal(phase) * v[1] + cimag(phase) * v[0];
  v[0]            = re;
}

/* v = phase T v, or with transposed phase T^T v. */
static void turn_vector(const double T[3][3], bool transposed, double complex phase,
                        double complex v[3]) {
  double in[3][2];
  for (int d = 0; d < 3; d++) in[d][0] = creal(v[d]), in[d][1] = cimag(v[d]);
  for (int d = 0; d < 3; d++) {
    double sum[2] = {0, 0};
    for (int e = 0; e < 3; e++)
      for (int part = 0; part < 2; part++)
        sum[part] += (transposed ? T[e][d] : T[d][e]) * in[e][part];
    turn_phase(phase, sum);
    v[d] = CMPLX(sum[0], sum[1]);
  }
}

void fem_sector_motion(const fem_sector *s, int node, double complex phase, const double complex *x,
                       double complex v[3]) {
  const int row = s->row[node];
  for (int d = 0; d < 3; d++) v[d] = row < 0 ? 0 : x[3 * (size_t)row + (size_t)d];
  if (row >= 0 && s->turned[node]) turn_vector(s->turn, false, phase, v);
}

void fem_sector_force(const fem_sector *s, int node, double complex phase, const double f[3],
                      double complex v[3]) {
  for (int d = 0; d < 3; d++) v[d] = f[d];
  if (s->turned[node]) turn_vector(s->turn, true, conj(phase), v);
}

void fem_sector_expand(const fem_sector *s, double complex phase, const double complex *x,
                       double complex *nodal) {
  for (int i = 0; i < s->n_nodes; i++) fem_sector_motion(s, i, phase, x, nodal + 3 * (size_t)i);
}

/* sum = M C X at node i, [columns][3] complex.
 *   V  in  [n_nodes][width] C X */
static void mass_row(const fem_sector *s, int i, size_t width, const double *V, double *sum) {
  memset(sum, 0, width * sizeof *sum);
  for (int k = s->mass_start[i]; k < s->mass_start[i + 1]; k++) {
    const double  m  = s->mass[k];
    const double *at = V + width * (size_t)s->mass_node[k];
    for (size_t c = 0; c < width; c++) sum[c] += m * at[c];
  }
}

/* Products in the order of the nodes: the columns of a node lie together. */
void fem_sector_mass(const fem_sector *s, double complex phase, int columns,
                     const double complex *X, double complex *Y, double *V) {
  const size_t width = 6 * (size_t)columns, order = 3 * (size_t)s->n_rows;
  double      *sum = V + width * (size_t)s->n_nodes;
  for (int i = 0; i < s->n_nodes; i++)
    for (size_t c = 0; c < (size_t)columns; c++) {
      double complex v[3];
      fem_sector_motion(s, i, phase, X + c * order, v);
      memcpy(V + width * (size_t)i + 6 * c, v, sizeof v);
    }
  memset(Y, 0, order * (size_t)columns * sizeof *Y);
  for (int i = 0; i < s->n_nodes; i++) {
    if (s->row[i] < 0) continue;
    mass_row(s, i, width, V, sum);
    for (size_t c = 0; c < (size_t)columns; c++) {
      double complex v[3], *y = Y + c * order + 3 * (size_t)s->row[i];
      memcpy(v, sum + 6 * c, sizeof v);
      if (s->turned[i]) turn_vector(s->turn, true, conj(phase), v);
      for (int d = 0; d < 3; d++) y[d] += v[d];
    }
  }
}

void fem_sector_mass_diagonal(const fem_sector *s, double *diagonal) {
  memset(diagonal, 0, (size_t)s->n_rows * sizeof *diagonal);
  for (int i = 0; i < s->n_nodes; i++)
    for (int k = s->mass_start[i]; k < s->mass_start[i + 1] && s->row[i] >= 0; k++)
      if (s->mass_node[k] == i) diagonal[s->row[i]] += s->mass[k];
}

/* ------------------------------------------------------------------ together */

static void copy_rows(const fem_system *system, fem_sector *s) {
  const size_t n = (size_t)system->n_nodes;
  s->n_nodes     = system->n_nodes;
  s->n_rows      = (int)system->n_free;
  s->row         = shb_alloc(n + 1, sizeof *s->row);
  s->turned      = shb_alloc(n + 1, sizeof *s->turned);
  for (size_t i = 0; i < n; i++) s->row[i] = (int)system->row[i];
  memcpy(s->turned, system->turned, n * sizeof *s->turned);
  memcpy(s->turn, system->turn, sizeof s->turn);
}

PetscErrorCode fem_sector_create(const fem_body *body, const double *state,
                                 const fem_system *system, fem_sector *s) {
  PetscFunctionBeginUser;
  memset(s, 0, sizeof *s);
  copy_rows(system, s);
  PetscCall(copy_stiffness(system->K, s));
  PetscCall(find_coupling(body, state, system, s));
  mass_pattern(body->mesh, s);
  for (int e = 0; e < body->mesh->n_elements; e++) add_mass(body, e, s);
  PetscFunctionReturn(0);
}

void fem_sector_free(fem_sector *s) {
  free(s->row);
  free(s->turned);
  free((void *)s->blocks.start);
  free((void *)s->blocks.column);
  free(s->stiffness);
  free(s->coupled);
  free(s->cosine);
  free(s->sine);
  free(s->exponent);
  free(s->mass_start);
  free(s->mass_node);
  free(s->mass);
  memset(s, 0, sizeof *s);
}
