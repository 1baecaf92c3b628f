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

/* Order and structure. Returns false where the factor is too large for CHOLMOD's indices. */
static bool analyse(fem_hermitian_order *order) {
  cholmod_common common;
  fem_cholmod_start(&common);
  cholmod_factor *L    = fem_block_analyse(&order->A.pattern, &common, order->place);
  const bool      fits = L != NULL;
  if (fits) fem_supernodes_create(L, &order->panels);
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  if (fits) fem_lower_pattern_create(&order->A.pattern, order->place, &order->lower);
  return fits;
}

/* Which panels are real, and the place of each panel's numbers. */
static void part_panels(fem_hermitian_order *order) {
  const fem_hermitian_matrix *A        = &order->A;
  const size_t                count    = (size_t)A->pattern.start[A->pattern.n] + 1;
  signed char                *exponent = shb_alloc_zeroed(count, 1);
  order->coupled_at                    = shb_alloc(count, sizeof *order->coupled_at);
  for (size_t q = 0; q < count; q++) order->coupled_at[q] = -1;
  for (int i = 0; i < A->n_coupled; i++) {
    exponent[A->coupled[i]]          = A->exponent[i];
    order->coupled_at[A->coupled[i]] = i;
  }
  fem_panel_turns_create(&order->panels, &order->lower, exponent, &order->turns);
  free(exponent);
  for (int k = 0; k < order->panels.n_panels; k++) {
    fem_panel   *p    = &order->panels.panel[k];
    const size_t size = (size_t)p->columns * (size_t)p->rows;
    p->value          = order->turns.is_real[k] ? order->n_real : order->n_other;
    if (order->turns.is_real[k])
      order->n_real += size;
    else
      order->n_other += 2 * size;
  }
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
  order->real     = fem_large_alloc(order->n_real + 1, sizeof *order->real);
  order->definite = fem_supernodal_factorise(&order->panels, &order->lower, order->A.real,
                                             order->turns.is_real, order->real);
  return SHB_OK;
}

static shb_status prepare(const fem_hermitian_matrix *A, fem_hermitian_order *order) {
  order->A     = *A;
  order->place = shb_alloc((size_t)A->pattern.n + 1, sizeof *order->place);
  SHB_CHECK(analyse(order), SHB_ERR_INPUT,
            "the factor of %d nodes is too large; make a coarser mesh", A->pattern.n);
  part_panels(order);
  return factorise_real(order);
}

shb_status fem_hermitian_analyse(const fem_hermitian_matrix *A, fem_hermitian_order **out) {
  fem_hermitian_order *order = shb_alloc_zeroed(1, sizeof *order);
  *out                       = NULL;
  const shb_status status    = prepare(A, order);
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

fem_hermitian *fem_hermitian_create(const fem_hermitian_order *order, double complex turn,
                                    const double complex (*value)[9]) {
  const fem_hermitian_blocks A = {&order->lower, order->A.real, order->coupled_at, value};
  if (!order->definite) return NULL;
  fem_hermitian *factor = shb_alloc_zeroed(1, sizeof *factor);
  factor->order         = order;
  factor->panels =
      (fem_hermitian_panels){.s     = &order->panels,
                             .turns = &order->turns,
                             .real  = order->real,
                             .other = fem_large_alloc(order->n_other + 1, sizeof(double))};
  fem_hermitian_set_phase(turn, &factor->panels);
  if (fem_hermitian_factorise(&A, &factor->panels)) return factor;
  fem_hermitian_free(factor);
  return NULL;
}

/* Workspace for four right-hand sides, kept between solves. */
static void make_room(fem_hermitian *factor) {
  const size_t alignment = sizeof(fem_complex_lanes), each = sizeof(fem_complex_lanes);
  const size_t n = (size_t)factor->order->panels.n, rows = (size_t)factor->order->panels.most_rows;
  if (!factor->x)
    factor->x = n * each < FEM_LARGE_PAGE ? shb_alloc_aligned(alignment, n, each)
                                          : fem_large_alloc(n, each);
  if (!factor->work) factor->work = shb_alloc_aligned(alignment, rows, each);
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

void fem_hermitian_solve(fem_hermitian *factor, int count, const double complex *b,
                         double complex *x) {
  const size_t all = (size_t)count, order = 3 * (size_t)factor->order->A.pattern.n;
  make_room(factor);
  for (size_t c = 0; c < all; c += FEM_LANES)
    solve_few(factor, all - c < FEM_LANES ? all - c : FEM_LANES, b + c * order, x + c * order);
}

void fem_hermitian_free(fem_hermitian *factor) {
  if (!factor) return;
  free(factor->panels.other);
  free(factor->x);
  free(factor->work);
  free(factor);
}
