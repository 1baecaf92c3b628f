#include "fem/body/assemble.h"

#include <string.h>

#include "fem/body/partition.h"

/* Elements around each block row r of this rank: element[start[r - first]] .. element[start[r -
 * first + 1] - 1]. */
typedef struct {
  int *start, *element;
} incidence;

static void find_free(const mesh_fe *mesh, bool *is_free) {
  const mesh_face_set *root = &mesh->set[MESH_ROOT];
  for (int i = 0; i < mesh->n_nodes; i++) is_free[i] = !mesh->image || mesh->image[i] < 0;
  for (int i = 0; i < mesh_topology_of(mesh->kind)->face_nodes * root->n; i++)
    is_free[root->nodes[i]] = false;
}

/* Give the nodes of cyclic_right the rows of their partners. */
static PetscErrorCode tie_sides(const mesh_fe *mesh, fem_system *system) {
  PetscFunctionBeginUser;
  if (!mesh->image) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(mesh->n_nodes, &system->turned));
  memcpy(system->turn, mesh->turn, sizeof system->turn);
  for (int i = 0; i < mesh->n_nodes; i++) {
    if (mesh->image[i] < 0) continue;
    system->turned[i] = true;
    system->row[i]    = system->row[mesh->image[i]];
  }
  PetscFunctionReturn(0);
}

/* Number the free nodes rank by rank, in mesh order inside a rank. */
static PetscErrorCode number_nodes(const mesh_fe *mesh, fem_system *system) {
  bool     *is_free;
  int      *rank_of, rank, n_ranks;
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(system->comm, &rank));
  PetscCallMPI(MPI_Comm_size(system->comm, &n_ranks));
  PetscCall(PetscMalloc3(mesh->n_nodes, &is_free, mesh->n_nodes, &rank_of, n_ranks + 1, &next));
  find_free(mesh, is_free);
  PetscCall(fem_partition(mesh, is_free, n_ranks, rank_of));
  PetscCall(PetscArrayzero(next, n_ranks + 1));
  for (int i = 0; i < mesh->n_nodes; i++)
    if (is_free[i]) next[rank_of[i] + 1]++;
  for (int r = 0; r < n_ranks; r++) next[r + 1] += next[r];
  system->n_free = next[n_ranks];
  system->first  = next[rank];
  system->last   = next[rank + 1];
  PetscCall(PetscMalloc1(mesh->n_nodes, &system->row));
  for (int i = 0; i < mesh->n_nodes; i++) system->row[i] = is_free[i] ? next[rank_of[i]]++ : -1;
  PetscCall(PetscFree3(is_free, rank_of, next));
  PetscCall(tie_sides(mesh, system));
  PetscFunctionReturn(0);
}

void fem_system_to_row(const fem_system *system, int node, const double v[3], double out[3]) {
  const double in[3] = {v[0], v[1], v[2]};
  const bool   turns = system->turned && system->turned[node];
  for (int d = 0; d < 3; d++)
    out[d] = !turns ? in[d]
                    : system->turn[0][d] * in[0] + system->turn[1][d] * in[1] +
                          system->turn[2][d] * in[2];
}

void fem_system_from_row(const fem_system *system, int node, const double v[3], double out[3]) {
  const double in[3] = {v[0], v[1], v[2]};
  const bool   turns = system->turned && system->turned[node];
  for (int d = 0; d < 3; d++)
    out[d] = !turns ? in[d]
                    : system->turn[d][0] * in[0] + system->turn[d][1] * in[1] +
                          system->turn[d][2] * in[2];
}

/* The rows, then the columns, of each turned node: Q_a^T K_ab Q_b. */
void fem_system_turn(const fem_system *system, int n, const int *node, double *K) {
  const int order = 3 * n;
  for (int a = 0; system->turned && a < n; a++) {
    if (!system->turned[node[a]]) continue;
    for (int j = 0; j < order; j++) {
      double *at = K + 3 * a * order + j, v[3] = {at[0], at[order], at[2 * order]};
      fem_system_to_row(system, node[a], v, v);
      for (int d = 0; d < 3; d++) at[d * order] = v[d];
    }
    for (int i = 0; i < order; i++)
      fem_system_to_row(system, node[a], K + i * order + 3 * a, K + i * order + 3 * a);
  }
}

static bool is_own(const fem_system *system, PetscInt row) {
  return row >= system->first && row < system->last;
}

static PetscErrorCode find_incidence(const mesh_fe *mesh, const fem_system *system,
                                     incidence *around) {
  const int each = mesh_topology_of(mesh->kind)->nodes, n = each * mesh->n_elements;
  const int n_own = (int)(system->last - system->first);
  int      *next;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_own + 1, &around->start));
  for (int i = 0; i < n; i++) {
    PetscInt row = system->row[mesh->connectivity[i]];
    if (is_own(system, row)) around->start[row - system->first + 1]++;
  }
  for (int r = 0; r < n_own; r++) around->start[r + 1] += around->start[r];
  PetscCall(PetscMalloc1(around->start[n_own], &around->element));
  PetscCall(PetscMalloc1(n_own, &next));
  PetscCall(PetscArraycpy(next, around->start, n_own));
  for (int i = 0; i < n; i++) {
    PetscInt row = system->row[mesh->connectivity[i]];
    if (is_own(system, row)) around->element[next[row - system->first]++] = i / each;
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(0);
}

/* Exact number of blocks in each row, in the columns of this rank (diagonal) and in the others.
 *   whole  in  false: of the upper triangle only */
static PetscErrorCode count_blocks(const mesh_fe *mesh, const fem_system *system,
                                   const incidence *around, bool whole, PetscInt *diagonal,
                                   PetscInt *off_diagonal) {
  const int each = mesh_topology_of(mesh->kind)->nodes;
  PetscInt *seen; /* last row in which this column was counted, plus 1 */
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(system->n_free, &seen));
  for (PetscInt row = system->first; row < system->last; row++) {
    PetscInt r      = row - system->first;
    diagonal[r]     = 0;
    off_diagonal[r] = 0;
    for (int k = around->start[r]; k < around->start[r + 1]; k++)
      for (int i = 0; i < each; i++) {
        PetscInt column = system->row[mesh->connectivity[each * around->element[k] + i]];
        if (column < (whole ? 0 : row) || seen[column] == row + 1) continue;
        seen[column] = row + 1;
        if (is_own(system, column))
          diagonal[r]++;
        else
          off_diagonal[r]++;
      }
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

static PetscErrorCode create_matrix(const fem_system *system, const PetscInt *diagonal,
                                    const PetscInt *off_diagonal, Mat *A) {
  const PetscInt n_own = 3 * (system->last - system->first), n = 3 * system->n_free;
  PetscFunctionBeginUser;
  PetscCall(MatCreate(system->comm, A));
  PetscCall(MatSetSizes(*A, n_own, n_own, n, n));
  PetscCall(MatSetType(*A, MATSBAIJ));
  PetscCall(MatSeqSBAIJSetPreallocation(*A, 3, 0, diagonal));
  PetscCall(MatMPISBAIJSetPreallocation(*A, 3, 0, diagonal, 0, off_diagonal));
  PetscCall(MatSetOption(*A, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  PetscCall(MatSetOption(*A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(MatSetOption(*A, MAT_SPD, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* Mass between nodes, one number a pair. */
static PetscErrorCode create_mass(const fem_system *system, const PetscInt *diagonal,
                                  const PetscInt *off_diagonal, Mat *m) {
  const PetscInt n_own = system->last - system->first;
  PetscFunctionBeginUser;
  PetscCall(MatCreate(system->comm, m));
  PetscCall(MatSetSizes(*m, n_own, n_own, system->n_free, system->n_free));
  PetscCall(MatSetType(*m, MATAIJ));
  PetscCall(MatSeqAIJSetPreallocation(*m, 0, diagonal));
  PetscCall(MatMPIAIJSetPreallocation(*m, 0, diagonal, 0, off_diagonal));
  PetscCall(MatSetOption(*m, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscFunctionReturn(0);
}

static PetscErrorCode create_matrices(const mesh_fe *mesh, fem_system *system, Mat *mass) {
  const PetscInt n_own = system->last - system->first;
  incidence      around;
  PetscInt      *diagonal, *off_diagonal;
  PetscFunctionBeginUser;
  PetscCall(find_incidence(mesh, system, &around));
  PetscCall(PetscMalloc2(n_own, &diagonal, n_own, &off_diagonal));
  PetscCall(count_blocks(mesh, system, &around, false, diagonal, off_diagonal));
  PetscCall(create_matrix(system, diagonal, off_diagonal, &system->K));
  if (system->turned)
    PetscCall(create_matrix(system, diagonal, off_diagonal, mass));
  else {
    PetscCall(count_blocks(mesh, system, &around, true, diagonal, off_diagonal));
    PetscCall(create_mass(system, diagonal, off_diagonal, mass));
  }
  PetscCall(PetscFree2(diagonal, off_diagonal));
  PetscCall(PetscFree(around.start));
  PetscCall(PetscFree(around.element));
  PetscFunctionReturn(0);
}

bool fem_system_rows(const mesh_fe *mesh, const fem_system *system, int element, PetscInt *rows,
                     PetscInt *columns) {
  const int each    = mesh_topology_of(mesh->kind)->nodes;
  bool      touches = false;
  for (int i = 0; i < each; i++) {
    columns[i] = system->row[mesh->connectivity[each * element + i]];
    rows[i]    = is_own(system, columns[i]) ? columns[i] : -1;
    touches    = touches || rows[i] >= 0;
  }
  return touches;
}

/* The mass of a sector is no multiple of the identity between a turned node and another.
 *   M  out  [3n][3n] */
static void spread_mass(const fem_system *system, int n, const int *node, const double *m,
                        double *M) {
  memset(M, 0, 9 * (size_t)n * (size_t)n * sizeof *M);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int d = 0; d < 3; d++) M[(3 * i + d) * 3 * n + 3 * j + d] = m[n * i + j];
  fem_system_turn(system, n, node, M);
}

static PetscErrorCode add_elements(const mesh_fe *mesh, const fem_material *material,
                                   const fem_element *element, const fem_system *system, Mat mass) {
  const int n = element->n;
  PetscFunctionBeginUser;
  for (int e = 0; e < mesh->n_elements; e++) {
    PetscInt   rows[MESH_NODES], columns[MESH_NODES];
    double     x[MESH_NODES][3], K[FEM_DOFS * FEM_DOFS];
    double     m[MESH_NODES * MESH_NODES];
    const int *node = mesh->connectivity + n * (size_t)e;

    const fem_material *own = fem_material_at(material, mesh, e);
    if (!fem_system_rows(mesh, system, e, rows, columns)) continue;
    for (int i = 0; i < n; i++) memcpy(x[i], mesh->coordinates + 3 * (size_t)node[i], sizeof x[i]);
    fem_element_stiffness(element, own, (const double(*)[3])x, K);
    fem_element_mass(element, own->rho, (const double(*)[3])x, m);
    fem_system_turn(system, n, node, K);
    PetscCall(MatSetValuesBlocked(system->K, n, rows, n, columns, K, ADD_VALUES));
    if (system->turned) {
      spread_mass(system, n, node, m, K);
      PetscCall(MatSetValuesBlocked(mass, n, rows, n, columns, K, ADD_VALUES));
    } else
      PetscCall(MatSetValues(mass, n, rows, n, columns, m, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode finish(Mat A) {
  PetscFunctionBeginUser;
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_create(MPI_Comm comm, const mesh_fe *mesh, const fem_material *material,
                                 fem_rules rules, fem_system *system) {
  fem_element *element;
  Mat          mass;

  PetscFunctionBeginUser;
  memset(system, 0, sizeof *system);
  system->comm    = comm;
  system->n_nodes = mesh->n_nodes;
  PetscCall(number_nodes(mesh, system));
  PetscCall(create_matrices(mesh, system, &mass));
  PetscCall(PetscNew(&element));
  PetscCall(fem_element_create(mesh->kind, rules, element));
  PetscCall(add_elements(mesh, material, element, system, mass));
  PetscCall(PetscFree(element));
  PetscCall(finish(system->K));
  PetscCall(finish(mass));
  if (system->turned) {
    system->M = mass;
    PetscFunctionReturn(0);
  }
  PetscCall(MatCreateMAIJ(mass, 3, &system->M));
  PetscCall(MatDestroy(&mass));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_shifted(const fem_system *system, double shift, Mat *A) {
  Mat mass;
  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(system->K, MAT_COPY_VALUES, A));
  if (system->turned) {
    PetscCall(MatAXPY(*A, -shift, system->M, SAME_NONZERO_PATTERN));
    PetscCall(MatSetOption(*A, MAT_SPD, PETSC_TRUE));
    PetscFunctionReturn(0);
  }
  PetscCall(MatSetOption(*A, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  PetscCall(MatMAIJGetAIJ(system->M, &mass));
  for (PetscInt row = system->first; row < system->last; row++) {
    const PetscInt    *column;
    const PetscScalar *value;
    PetscInt           n;
    PetscCall(MatGetRow(mass, row, &n, &column, &value));
    for (PetscInt i = 0; i < n; i++) {
      const double m        = -shift * value[i];
      const double block[9] = {m, 0, 0, 0, m, 0, 0, 0, m};
      if (column[i] >= row)
        PetscCall(MatSetValuesBlocked(*A, 1, &row, 1, column + i, block, ADD_VALUES));
    }
    PetscCall(MatRestoreRow(mass, row, &n, &column, &value));
  }
  PetscCall(finish(*A));
  PetscCall(MatSetOption(*A, MAT_SPD, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* Nodal values of a vector of all free dofs; clamped nodes zero. */
static PetscErrorCode to_nodes(const fem_system *system, Vec all, double *nodal) {
  const PetscScalar *value;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(all, &value));
  for (int i = 0; i < system->n_nodes; i++) {
    for (int d = 0; d < 3; d++)
      nodal[3 * (size_t)i + d] = system->row[i] < 0 ? 0 : value[3 * system->row[i] + d];
    fem_system_from_row(system, i, nodal + 3 * (size_t)i, nodal + 3 * (size_t)i);
  }
  PetscCall(VecRestoreArrayRead(all, &value));
  PetscFunctionReturn(0);
}

static PetscErrorCode scatter_to(VecScatter scatter, Vec x, Vec all) {
  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_gather(const fem_system *system, Vec x, double *nodal) {
  Vec        all;
  VecScatter scatter;
  int        rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(system->comm, &rank));
  PetscCall(VecScatterCreateToZero(x, &scatter, &all));
  PetscCall(scatter_to(scatter, x, all));
  if (rank == 0) PetscCall(to_nodes(system, all, nodal));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_share(const fem_system *system, Vec x, double *nodal) {
  Vec        all;
  VecScatter scatter;

  PetscFunctionBeginUser;
  PetscCall(VecScatterCreateToAll(x, &scatter, &all));
  PetscCall(scatter_to(scatter, x, all));
  PetscCall(to_nodes(system, all, nodal));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_destroy(fem_system *system) {
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&system->K));
  PetscCall(MatDestroy(&system->M));
  PetscCall(PetscFree(system->row));
  PetscCall(PetscFree(system->turned));
  PetscFunctionReturn(0);
}
