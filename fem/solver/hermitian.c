#include "fem/solver/hermitian.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/hermitian_factor.h"
#include "fem/supernodal/large_pages.h"
#include "mesh/base/memory.h"

struct fem_hermitian_order {
  fem_hermitian_matrix A;
  int                 *place;      /* [n] index of a block row in the factor */
  int                 *coupled_at; /* [block] index among the coupled ones, or -1 */
  fem_lower_pattern    lower;
  fem_supernodes       panels;
  fem_panel_turns      turns;
  size_t               n_real, n_other; /* numbers of the real and of the complex panels */
  double              *real;            /* [n_real] */
  bool                 definite;        /* the real panels are there */
};

struct fem_hermitian {
  const fem_hermitian_order *order;
  fem_hermitian_panels       panels;
  fem_complex_lanes         *x, *work; /* right-hand sides in the factor's order; a panel */
};

/* ------------------------------------------------------------------ analysis */

/* Order and structure. *too_large: CHOLMOD cannot index the factor. */
static bool analyse(fem_hermitian_order *order, bool *too_large) {
  cholmod_common common;
  fem_cholmod_start(&common);
  cholmod_factor *L    = fem_block_analyse(&order->A.pattern, &common, order->place);
  const bool      good = L && fem_supernodes_create(L, &order->panels);
  *too_large           = common.status == CHOLMOD_TOO_LARGE;
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  return good && fem_lower_pattern_create(&order->A.pattern, order->place, &order->lower);
}

/* Which panels are real, and the place of each panel's numbers. */
static bool part_panels(fem_hermitian_order *order) {
  const fem_hermitian_matrix *A        = &order->A;
  const size_t                count    = (size_t)A->pattern.start[A->pattern.n] + 1;
  signed char                *exponent = calloc(count, 1);
  order->coupled_at                    = malloc(count * sizeof *order->coupled_at);
  bool good                            = exponent && order->coupled_at;
  for (size_t q = 0; good && q < count; q++) order->coupled_at[q] = -1;
  for (int i = 0; good && i < A->n_coupled; i++) {
    exponent[A->coupled[i]]          = A->exponent[i];
    order->coupled_at[A->coupled[i]] = i;
  }
  good = good && fem_panel_turns_create(&order->panels, &order->lower, exponent, &order->turns);
  free(exponent);
  for (int k = 0; good && k < order->panels.n_panels; k++) {
    fem_panel   *p    = &order->panels.panel[k];
    const size_t size = (size_t)p->columns * (size_t)p->rows;
    p->value          = order->turns.is_real[k] ? order->n_real : order->n_other;
    if (order->turns.is_real[k])
      order->n_real += size;
    else
      order->n_other += 2 * size;
  }
  return good;
}

static shb_status factorise_real(fem_hermitian_order *order) {
  const int    n = order->A.pattern.n;
  const double bytes =
      8. * (double)order->n_real + fem_supernodal_workspace(&order->panels, omp_get_max_threads());
  const double left = shb_memory_available();
  SHB_CHECK(bytes <= left, SHB_ERR_INPUT,
            "the factor of %d nodes needs %.3g GB more memory, and %.3g GB are left; make a "
            "coarser mesh",
            n, 1e-9 * bytes, 1e-9 * left);
  order->real = fem_large_malloc((order->n_real + 1) * sizeof *order->real);
  SHB_CHECK(order->real, SHB_ERR_IO, "out of memory for the factor of %d nodes", n);
  const fem_factorised end = fem_supernodal_factorise(&order->panels, &order->lower, order->A.real,
                                                      order->turns.is_real, order->real);
  SHB_CHECK(end != FEM_NO_MEMORY, SHB_ERR_IO, "out of memory for the factor of %d nodes", n);
  order->definite = end == FEM_FACTORISED;
  return SHB_OK;
}

static shb_status prepare(const fem_hermitian_matrix *A, fem_hermitian_order *order) {
  bool too_large  = false;
  order->A        = *A;
  order->place    = malloc(((size_t)A->pattern.n + 1) * sizeof *order->place);
  const bool good = order->place && analyse(order, &too_large) && part_panels(order);
  SHB_CHECK(!too_large, SHB_ERR_INPUT, "the factor of %d nodes is too large; make a coarser mesh",
            A->pattern.n);
  SHB_CHECK(good, SHB_ERR_IO, "out of memory for the factor of %d nodes", A->pattern.n);
  return factorise_real(order);
}

shb_status fem_hermitian_analyse(const fem_hermitian_matrix *A, fem_hermitian_order **out) {
  fem_hermitian_order *order = calloc(1, sizeof *order);
  *out                       = NULL;
  SHB_CHECK(order, SHB_ERR_IO, "out of memory for a factor");
  const shb_status status = prepare(A, order);
  if (status == SHB_OK)
    *out = order;
  else
    fem_hermitian_order_free(order);
  return status;
}

void fem_hermitian_order_free(fem_hermitian_order *order) {
  if (!order) return;
  fem_panel_turns_free(&order->turns);
  fem_supernodes_free(&order->panels);
  fem_lower_pattern_free(&order->lower);
  free(order->place);
  free(order->coupled_at);
  free(order->real);
  free(order);
}

double fem_hermitian_bytes(const fem_hermitian_order *order) {
  return 8. * (double)order->n_other + fem_hermitian_workspace(&order->panels);
}

/* ------------------------------------------------------------------ one theta */

shb_status fem_hermitian_create(const fem_hermitian_order *order, double complex turn,
                                const double complex (*value)[9], bool *definite,
                                fem_hermitian **out) {
  const fem_hermitian_blocks A      = {&order->lower, order->A.real, order->coupled_at, value};
  fem_hermitian             *factor = calloc(1, sizeof *factor);
  fem_factorised             end    = FEM_NO_MEMORY;
  *out                              = NULL;
  *definite                         = order->definite;
  SHB_CHECK(factor, SHB_ERR_IO, "out of memory for a factor");
  factor->order = order;
  factor->panels =
      (fem_hermitian_panels){.s     = &order->panels,
                             .turns = &order->turns,
                             .real  = order->real,
                             .other = fem_large_malloc((order->n_other + 1) * sizeof(double))};
  fem_hermitian_set_phase(turn, &factor->panels);
  if (factor->panels.other && *definite) end = fem_hermitian_factorise(&A, &factor->panels);
  *definite = end == FEM_FACTORISED;
  if (*definite)
    *out = factor;
  else
    fem_hermitian_free(factor);
  SHB_CHECK(end != FEM_NO_MEMORY || !order->definite, SHB_ERR_IO,
            "out of memory for the factor of %d nodes", order->A.pattern.n);
  return SHB_OK;
}

/* Workspace for four right-hand sides, kept between solves. */
static bool make_room(fem_hermitian *factor) {
  const size_t alignment = sizeof(fem_complex_lanes), each = sizeof(fem_complex_lanes);
  const size_t n = (size_t)factor->order->panels.n, rows = (size_t)factor->order->panels.most_rows;
  if (!factor->x)
    factor->x =
        n * each < FEM_LARGE_PAGE ? aligned_alloc(alignment, n * each) : fem_large_malloc(n * each);
  if (!factor->work) factor->work = aligned_alloc(alignment, rows * each);
  return factor->x && factor->work;
}

/* Solve for count <= FEM_LANES columns; unused lanes are zero. */
static void solve_few(fem_hermitian *factor, size_t count, const double complex *b,
                      double complex *x) {
  const size_t n     = (size_t)factor->order->A.pattern.n;
  const int   *place = factor->order->place;
  for (size_t i = 0; i < 3 * n; i++) {
    fem_complex_lanes *at = factor->x + 3 * (size_t)place[i / 3] + i % 3;
    for (size_t c = 0; c < FEM_LANES; c++) {
      at->re[c] = c < count ? creal(b[3 * n * c + i]) : 0;
      at->im[c] = c < count ? cimag(b[3 * n * c + i]) : 0;
    }
  }
  fem_supernodal_solve_hermitian(&factor->panels, factor->x, factor->work);
  for (size_t i = 0; i < 3 * n; i++) {
    const fem_complex_lanes *at = factor->x + 3 * (size_t)place[i / 3] + i % 3;
    for (size_t c = 0; c < count; c++) x[3 * n * c + i] = CMPLX(at->re[c], at->im[c]);
  }
}

shb_status fem_hermitian_solve(fem_hermitian *factor, int count, const double complex *b,
                               double complex *x) {
  const size_t all = (size_t)count, order = 3 * (size_t)factor->order->A.pattern.n;
  SHB_CHECK(make_room(factor), SHB_ERR_IO, "out of memory for %d solutions", count);
  for (size_t c = 0; c < all; c += FEM_LANES)
    solve_few(factor, all - c < FEM_LANES ? all - c : FEM_LANES, b + c * order, x + c * order);
  return SHB_OK;
}

void fem_hermitian_free(fem_hermitian *factor) {
  if (!factor) return;
  free(factor->panels.other);
  free(factor->x);
  free(factor->work);
  free(factor);
}
