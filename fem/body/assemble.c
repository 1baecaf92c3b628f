#include "fem/body/assemble.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/element_sums.h"
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

static PetscErrorCode create_matrix(const fem_system *system, Mat *A) {
  const PetscInt n_own = 3 * (system->last - system->first), n = 3 * system->n_free;
  PetscFunctionBeginUser;
  PetscCall(MatCreate(system->comm, A));
  PetscCall(MatSetSizes(*A, n_own, n_own, n, n));
  PetscCall(MatSetType(*A, MATSBAIJ));
  PetscFunctionReturn(0);
}

/* After the preallocation: on several ranks the options are those of its parts. */
static PetscErrorCode set_options(Mat A) {
  PetscFunctionBeginUser;
  PetscCall(MatSetOption(A, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  PetscCall(MatSetOption(A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* Mass between nodes, one number a pair. */
static PetscErrorCode create_mass(const fem_system *system, Mat *m) {
  const PetscInt n_own = system->last - system->first;
  PetscFunctionBeginUser;
  PetscCall(MatCreate(system->comm, m));
  PetscCall(MatSetSizes(*m, n_own, n_own, system->n_free, system->n_free));
  PetscCall(MatSetType(*m, MATAIJ));
  PetscFunctionReturn(0);
}

/* Rows of all blocks, or of those of the upper triangle.
 *   start   out  [n_own + 1]
 *   column  out  [start[n_own]] ascending in a row */
typedef struct {
  PetscInt *start, *column;
} pattern;

static PetscErrorCode list_columns(const mesh_fe *mesh, const fem_system *system,
                                   const incidence *around, const PetscInt *count, pattern *out) {
  const int      each = mesh_topology_of(mesh->kind)->nodes;
  const PetscInt n    = system->n_free;
  PetscInt      *seen;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &seen));
  PetscCall(PetscCalloc1(n + 1, &out->start));
  for (PetscInt r = 0; r < n; r++) out->start[r + 1] = out->start[r] + count[r];
  PetscCall(PetscMalloc1(out->start[n], &out->column));
  for (PetscInt r = 0; r < n; r++) {
    PetscInt at = out->start[r];
    for (int k = around->start[r]; k < around->start[r + 1]; k++)
      for (int i = 0; i < each; i++) {
        const PetscInt column = system->row[mesh->connectivity[each * around->element[k] + i]];
        if (column < 0 || seen[column] == r + 1) continue;
        seen[column]      = r + 1;
        out->column[at++] = column;
      }
    PetscCall(PetscSortInt(count[r], out->column + out->start[r]));
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

/* The blocks at and above the diagonal. */
static PetscErrorCode take_upper(PetscInt n, const pattern *all, pattern *out) {
  PetscInt at = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n + 1, &out->start));
  PetscCall(PetscMalloc1((all->start[n] + n) / 2, &out->column));
  for (PetscInt r = 0; r < n; r++) {
    out->start[r] = at;
    for (PetscInt k = all->start[r]; k < all->start[r + 1]; k++)
      if (all->column[k] >= r) out->column[at++] = all->column[k];
  }
  out->start[n] = at;
  PetscFunctionReturn(0);
}

static PetscErrorCode pattern_free(pattern *p) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->start));
  PetscCall(PetscFree(p->column));
  PetscFunctionReturn(0);
}

/* On one rank: K and M with their patterns and zeros. */
static PetscErrorCode create_zero(const mesh_fe *mesh, const incidence *around, PetscInt *count,
                                  PetscInt *none, fem_system *system, Mat *mass) {
  pattern all, upper;
  PetscFunctionBeginUser;
  PetscCall(count_blocks(mesh, system, around, true, count, none));
  PetscCall(list_columns(mesh, system, around, count, &all));
  PetscCall(take_upper(system->n_free, &all, &upper));
  PetscCall(create_matrix(system, &system->K));
  PetscCall(MatSeqSBAIJSetPreallocationCSR(system->K, 3, upper.start, upper.column, NULL));
  PetscCall(set_options(system->K));
  if (system->turned) {
    PetscCall(create_matrix(system, mass));
    PetscCall(MatSeqSBAIJSetPreallocationCSR(*mass, 3, upper.start, upper.column, NULL));
    PetscCall(set_options(*mass));
  } else {
    PetscCall(create_mass(system, mass));
    PetscCall(MatSeqAIJSetPreallocationCSR(*mass, all.start, all.column, NULL));
    PetscCall(MatSetOption(*mass, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  }
  PetscCall(pattern_free(&upper));
  PetscCall(pattern_free(&all));
  PetscFunctionReturn(0);
}

/* On several ranks: K and M with room for their numbers. */
static PetscErrorCode create_room(const mesh_fe *mesh, const incidence *around, PetscInt *diagonal,
                                  PetscInt *off_diagonal, fem_system *system, Mat *mass) {
  PetscFunctionBeginUser;
  PetscCall(count_blocks(mesh, system, around, false, diagonal, off_diagonal));
  PetscCall(create_matrix(system, &system->K));
  PetscCall(MatMPISBAIJSetPreallocation(system->K, 3, 0, diagonal, 0, off_diagonal));
  PetscCall(set_options(system->K));
  PetscCall(count_blocks(mesh, system, around, true, diagonal, off_diagonal));
  PetscCall(create_mass(system, mass));
  PetscCall(MatMPIAIJSetPreallocation(*mass, 0, diagonal, 0, off_diagonal));
  PetscCall(MatSetOption(*mass, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscFunctionReturn(0);
}

static PetscErrorCode create_matrices(const mesh_fe *mesh, bool one_rank, fem_system *system,
                                      Mat *mass) {
  const PetscInt n_own = system->last - system->first;
  incidence      around;
  PetscInt      *diagonal, *off_diagonal;
  PetscFunctionBeginUser;
  PetscCall(find_incidence(mesh, system, &around));
  PetscCall(PetscMalloc2(n_own, &diagonal, n_own, &off_diagonal));
  if (one_rank)
    PetscCall(create_zero(mesh, &around, diagonal, off_diagonal, system, mass));
  else
    PetscCall(create_room(mesh, &around, diagonal, off_diagonal, system, mass));
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

/* What the matrices of an element need. */
typedef struct {
  const mesh_fe      *mesh;
  const fem_material *material;
  const fem_element  *element;
  const fem_system   *system;
} source;

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

/* fem_elements.compute */
static void compute(const void *context, int e, double *K, double *M) {
  const source       *from = context;
  const int           n    = from->element->n;
  const int          *node = from->mesh->connectivity + n * (size_t)e;
  const fem_material *own  = fem_material_at(from->material, from->mesh, e);
  double              x[MESH_NODES][3], m[MESH_NODES * MESH_NODES];
  for (int i = 0; i < n; i++)
    memcpy(x[i], from->mesh->coordinates + 3 * (size_t)node[i], sizeof x[i]);
  fem_element_stiffness(from->element, own, (const double(*)[3])x, K);
  fem_element_mass(from->element, own->rho, (const double(*)[3])x, m);
  fem_system_turn(from->system, n, node, K);
  if (from->system->turned)
    spread_mass(from->system, n, node, m, M);
  else
    memcpy(M, m, (size_t)(n * n) * sizeof *M);
}

/* On several ranks; there are no sectors. */
static PetscErrorCode add_elements(const source *from, Mat mass) {
  const int n = from->element->n;
  PetscFunctionBeginUser;
  for (int e = 0; e < from->mesh->n_elements; e++) {
    PetscInt rows[MESH_NODES], columns[MESH_NODES];
    double   K[FEM_DOFS * FEM_DOFS], m[MESH_NODES * MESH_NODES];
    if (!fem_system_rows(from->mesh, from->system, e, rows, columns)) continue;
    compute(from, e, K, m);
    PetscCall(MatSetValuesBlocked(from->system->K, n, rows, n, columns, K, ADD_VALUES));
    PetscCall(MatSetValues(mass, n, rows, n, columns, m, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode borrow(Mat A, bool blocks, fem_row_values *out) {
  PetscInt  n;
  PetscBool done;
  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, blocks, &n, &out->start, &out->column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "no rows");
  if (blocks)
    PetscCall(MatSeqSBAIJGetArray(A, &out->value));
  else
    PetscCall(MatSeqAIJGetArray(A, &out->value));
  PetscFunctionReturn(0);
}

static PetscErrorCode give_back(Mat A, bool blocks, fem_row_values *from) {
  PetscInt  n;
  PetscBool done;
  PetscFunctionBeginUser;
  if (blocks)
    PetscCall(MatSeqSBAIJRestoreArray(A, &from->value));
  else
    PetscCall(MatSeqAIJRestoreArray(A, &from->value));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, blocks, &n, &from->start, &from->column, &done));
  PetscFunctionReturn(0);
}

/* Add the elements on all threads but the first one, which works beside them. */
static PetscErrorCode add_and_work(const fem_elements *elements, const fem_system *system,
                                   const fem_beside *beside, const fem_sums *sums) {
  const int      threads = omp_get_max_threads(), levels = omp_get_max_active_levels();
  PetscErrorCode error = 0;
  PetscFunctionBeginUser;
  if (beside && threads > 1) {
    omp_set_max_active_levels(2);
#pragma omp parallel num_threads(2)
    {
      if (omp_get_thread_num() == 0) error = beside->run(system, beside->context);
      if (omp_get_thread_num() == omp_get_num_threads() - 1)
        fem_element_sums_add(elements, threads - 1, sums);
    }
    omp_set_max_active_levels(levels);
  } else {
    if (beside) error = beside->run(system, beside->context);
    fem_element_sums_add(elements, threads, sums);
  }
  PetscCall(error);
  PetscFunctionReturn(0);
}

/* On one rank. */
static PetscErrorCode add_on_threads(const source *from, const fem_beside *beside, Mat mass) {
  const fem_system  *system   = from->system;
  const mesh_fe     *mesh     = from->mesh;
  const fem_elements elements = {mesh->n_elements, from->element->n, mesh->connectivity,
                                 system->row,      compute,          from};
  fem_sums           sums     = {.blocks = system->turned != NULL};
  PetscFunctionBeginUser;
  PetscCall(borrow(system->K, true, &sums.stiffness));
  PetscCall(borrow(mass, sums.blocks, &sums.mass));
  PetscCall(add_and_work(&elements, system, beside, &sums));
  PetscCall(give_back(mass, sums.blocks, &sums.mass));
  PetscCall(give_back(system->K, true, &sums.stiffness));
  PetscFunctionReturn(0);
}

static PetscErrorCode finish(Mat A) {
  PetscFunctionBeginUser;
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_create_beside(MPI_Comm comm, const mesh_fe *mesh,
                                        const fem_material *material, fem_rules rules,
                                        const fem_beside *beside, fem_system *system) {
  fem_element *element;
  Mat          mass;
  int          ranks;

  PetscFunctionBeginUser;
  memset(system, 0, sizeof *system);
  system->comm    = comm;
  system->n_nodes = mesh->n_nodes;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(number_nodes(mesh, system));
  PetscCall(create_matrices(mesh, ranks == 1, system, &mass));
  PetscCall(PetscNew(&element));
  PetscCall(fem_element_create(mesh->kind, rules, element));
  const source from = {mesh, material, element, system};
  if (ranks == 1)
    PetscCall(add_on_threads(&from, beside, mass));
  else
    PetscCall(add_elements(&from, mass));
  PetscCall(PetscFree(element));
  PetscCall(finish(system->K));
  PetscCall(finish(mass));
  if (ranks > 1 && beside) PetscCall(beside->run(system, beside->context));
  if (system->turned) {
    system->M = mass;
    PetscFunctionReturn(0);
  }
  PetscCall(MatCreateMAIJ(mass, 3, &system->M));
  PetscCall(MatDestroy(&mass));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_create(MPI_Comm comm, const mesh_fe *mesh, const fem_material *material,
                                 fem_rules rules, fem_system *system) {
  PetscFunctionBeginUser;
  PetscCall(fem_system_create_beside(comm, mesh, material, rules, NULL, system));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_restore(const fem_source *from, fem_system *system) {
  fem_system again;
  PetscFunctionBeginUser;
  PetscCall(fem_system_create(system->comm, from->mesh, from->material, from->rules, &again));
  system->K = again.K;
  again.K   = NULL;
  PetscCall(fem_system_destroy(&again));
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

/* On several ranks.
 *   here  in  this rank wants the nodal values */
static PetscErrorCode scatter_to(const fem_system *system, VecScatter scatter, Vec x, Vec all,
                                 bool here, double *nodal) {
  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
  if (here) PetscCall(to_nodes(system, all, nodal));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_gather(const fem_system *system, Vec x, double *nodal) {
  Vec        all;
  VecScatter scatter;
  int        rank, ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(system->comm, &rank));
  PetscCallMPI(MPI_Comm_size(system->comm, &ranks));
  if (ranks == 1) {
    PetscCall(to_nodes(system, x, nodal));
    PetscFunctionReturn(0);
  }
  PetscCall(VecScatterCreateToZero(x, &scatter, &all));
  PetscCall(scatter_to(system, scatter, x, all, rank == 0, nodal));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_system_share(const fem_system *system, Vec x, double *nodal) {
  Vec        all;
  VecScatter scatter;
  int        ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(system->comm, &ranks));
  if (ranks == 1) {
    PetscCall(to_nodes(system, x, nodal));
    PetscFunctionReturn(0);
  }
  PetscCall(VecScatterCreateToAll(x, &scatter, &all));
  PetscCall(scatter_to(system, scatter, x, all, true, nodal));
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
