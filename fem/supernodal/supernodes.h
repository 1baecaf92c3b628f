/* Structure of a sparse Cholesky factor L: dense panels of columns, and what can be done at the
 * same time.
 *
 * The supernodes are CHOLMOD's; wide ones are cut into panels. Subtrees of the elimination tree do
 * not depend on each other. They are chosen by cost alone, so results do not depend on the number
 * of threads. Free of PETSc. */
#ifndef FEM_SUPERNODAL_SUPERNODES_H
#define FEM_SUPERNODAL_SUPERNODES_H

#include <stdbool.h>
#include <stddef.h>
#include <suitesparse/cholmod.h>

/* Columns of a panel, at most: several threads work at the wide supernodes near the root. */
enum { FEM_PANEL_COLUMNS = 120 };

/* Columns first .. first + columns - 1 of L, dense from the diagonal down. */
typedef struct {
  int    first, columns, rows;
  size_t row;   /* its rows begin here in fem_supernodes.row; the first ones are its columns */
  size_t value; /* its numbers begin here, [columns][rows] */
} fem_panel;

/* The rows of an earlier panel from the begin-th on change a panel. */
typedef struct {
  int from, begin, end; /* rows begin .. end - 1 are columns of the changed panel */
} fem_update;

/* Panels first .. last - 1. Outside, they change only rows that the last of them has. Their sums
 * for these rows are the n_copies numbers from copy on. */
typedef struct {
  int first, last, copy, n_copies;
} fem_subtree;

typedef struct {
  int          n, n_panels, n_subtrees;
  int          most_rows;    /* of a panel */
  int          n_extended;   /* n, and all copies */
  size_t       n_values;     /* numbers of the factor */
  size_t       n_rows;       /* of all panels */
  fem_panel   *panel;        /* [n_panels] in the order of elimination */
  int         *row;          /* [n_rows] ascending in a panel; n or more: a copy */
  int         *original;     /* [n_extended - n] row of each copy */
  fem_update  *update;       /* by panels: update_start[s] .. update_start[s + 1] - 1 */
  int         *update_start; /* [n_panels + 1] */
  fem_subtree *subtree;      /* [n_subtrees] most costly first */
  bool        *is_top;       /* [n_panels] in no subtree */
} fem_supernodes;

/* From CHOLMOD's symbolic factor of the nodes (block_order.h). */
void fem_supernodes_create(const cholmod_factor *L, fem_supernodes *out);
void fem_supernodes_free(fem_supernodes *s); /* also of a zeroed struct */

/* Panels that a backward solution for some rows needs: those that hold a row, and all above them.
 *   row     in/out  [n] true: the row is wanted; a row of each panel above is marked too
 *   needed  out     [n_panels] */
void fem_supernodes_needed(const fem_supernodes *s, bool *row, bool *needed);

/* The row itself where the entry of fem_supernodes.row is a copy. */
static inline int fem_supernodes_row(const fem_supernodes *s, size_t at) {
  return s->row[at] < s->n ? s->row[at] : s->original[s->row[at] - s->n];
}

#endif
