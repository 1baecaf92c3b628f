/* Which panels of a Hermitian factor are real up to the phases of their rows.
 *
 * Blocks of the matrix A(theta) are real, or a real block times e^(j theta e) with e = 1 or -1, or
 * any complex block. A panel of the factor is
 *
 *   L_rc = e^(j theta (g_r - g_c)) R_rc, R real and free of theta,
 *
 * unless the blocks of its nodes, and of those below it in the elimination tree, close a loop with
 * a phase. In a sector that meets itself at its sides only loops around the ring do.
 * Derivation: docs/theory/cyclic_sector.md. Free of PETSc. */
#ifndef FEM_SUPERNODAL_PANEL_TURNS_H
#define FEM_SUPERNODAL_PANEL_TURNS_H

#include "fem/supernodal/block_order.h"
#include "fem/supernodal/supernodes.h"

/* FEM_ANY_BLOCK: the exponent of a block that is no real block with a phase. FEM_MOST_TURN: |g| of
 * a panel, at most; a panel with more counts as complex. */
enum { FEM_ANY_BLOCK = 127, FEM_MOST_TURN = 3 };

typedef struct {
  bool        *is_real; /* [n_panels] */
  bool        *turns;   /* [n_panels] real, and some g are not 0 */
  signed char *g;       /* [n_rows/3] of the nodes of a panel's rows, from fem_panel.row/3 on */
} fem_panel_turns;

/*   lower     in  permuted lower triangle of the pattern
 *   exponent  in  [block] e of upper block (r, c), r <= c before the permutation */
void fem_panel_turns_create(const fem_supernodes *s, const fem_lower_pattern *lower,
                            const signed char *exponent, fem_panel_turns *out);
void fem_panel_turns_free(fem_panel_turns *turns); /* also of a zeroed struct */

#endif
