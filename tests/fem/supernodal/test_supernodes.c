/* Panels, updates and subtrees of a factor: against elimination of the dense graph. */
#include "fem/supernodal/supernodes.h"

#include "tests/support/block_grid.h"
#include "tests/support/check.h"

/* A grid with its factor, and L_ij != 0 of the nodes. */
typedef struct {
  block_grid   grid;
  block_factor f;
  bool        *fill;
} scene;

static scene *make(block_grid grid) {
  scene *s = malloc(sizeof *s);
  assert_non_null(s);
  s->grid = grid;
  block_factor_make(&s->grid, &s->f);
  s->fill = block_grid_fill(&s->grid, s->f.place);
  return s;
}

static void drop(scene *s) {
  free(s->fill);
  block_factor_free(&s->f);
  block_grid_free(&s->grid);
  free(s);
}

static bool entry(const scene *s, int row, int column) {
  return s->fill[(size_t)(column / 3) * (size_t)s->grid.blocks.n + (size_t)(row / 3)];
}

/* The first entry of L below a column: its parent in the elimination tree; n at a root. */
static int parent_of(const scene *s, int column) {
  int row = 3 * (column / 3) + 3;
  while (row < s->f.n && !entry(s, row, column)) row += 3;
  return row < s->f.n ? row : s->f.n;
}

static scene *two_bodies(void) {
  return make(block_grid_make((const int[]){12, 4, 3}, 1, 2));
}

static void panels_cover_each_column_once(void **state) {
  (void)state;
  scene                *s      = two_bodies();
  const fem_supernodes *p      = &s->f.panels;
  int                   column = 0, most = 0;
  size_t                value = 0, row = 0;
  assert_int_equal(p->n, s->f.n);
  for (int k = 0; k < p->n_panels; k++) {
    const fem_panel *own = &p->panel[k];
    assert_int_equal(own->first, column);
    assert_int_equal(own->row, row);
    assert_int_equal(own->value, value);
    assert_in_range(own->columns, 1, FEM_PANEL_COLUMNS);
    for (int i = 0; i < own->rows; i++) {
      const int at = block_factor_row(&s->f, k, i);
      assert_true(i < own->columns ? at == column + i : at > block_factor_row(&s->f, k, i - 1));
    }
    column += own->columns;
    row += (size_t)own->rows;
    value += (size_t)own->columns * (size_t)own->rows;
    if (own->rows > most) most = own->rows;
  }
  assert_int_equal(column, p->n);
  assert_int_equal(row, p->n_rows);
  assert_int_equal(value, p->n_values);
  assert_int_equal(most, p->most_rows);
  drop(s);
}

static void panels_hold_every_entry(void **state) {
  (void)state;
  scene *s    = two_bodies();
  int    held = 0, all = 0;
  for (int k = 0; k < s->f.panels.n_panels; k++)
    for (int c = 0; c < s->f.panels.panel[k].columns; c++)
      for (int i = c; i < s->f.panels.panel[k].rows; i++)
        held += entry(s, block_factor_row(&s->f, k, i), s->f.panels.panel[k].first + c);
  for (int c = 0; c < s->f.n; c++)
    for (int r = c; r < s->f.n; r++) all += entry(s, r, c);
  print_message("%d entries in %zu numbers\n", all, s->f.panels.n_values);
  assert_int_equal(held, all);
  drop(s);
}

static void a_wide_supernode_is_cut(void **state) {
  (void)state;
  scene                *s = make(block_grid_line(100, 100, false));
  const fem_supernodes *p = &s->f.panels;
  assert_int_equal(p->n_panels, 3);
  for (int k = 0; k < 3; k++) assert_int_equal(p->panel[k].columns, k < 2 ? 120 : 60);
  for (int k = 0; k < 3; k++) assert_int_equal(p->panel[k].rows, 300 - 120 * k);
  assert_int_equal(p->n_values, 120 * 300 + 120 * 180 + 60 * 60);
  drop(s);
}

/* The first row beyond a panel is the parent of its last column. */
static void the_tree_is_the_elimination_tree(void **state) {
  (void)state;
  scene                *s     = two_bodies();
  const fem_supernodes *p     = &s->f.panels;
  int                   roots = 0;
  for (int k = 0; k < p->n_panels; k++) {
    const fem_panel *own  = &p->panel[k];
    const int        last = own->first + own->columns - 1;
    const int up = own->rows > own->columns ? block_factor_row(&s->f, k, own->columns) : p->n;
    assert_int_equal(up, parent_of(s, last));
    roots += up == p->n;
  }
  assert_int_equal(roots, 2);
  drop(s);
}

/* A panel is changed by each earlier one that has rows among its columns, in order. */
static void updates_are_the_rows_of_earlier_panels(void **state) {
  (void)state;
  scene                *s  = two_bodies();
  const fem_supernodes *p  = &s->f.panels;
  int                   at = 0;
  for (int k = 0; k < p->n_panels; k++) {
    const int first = p->panel[k].first, end = first + p->panel[k].columns;
    assert_int_equal(p->update_start[k], at);
    for (int d = 0; d < k; d++) {
      int begin = p->panel[d].columns, stop;
      while (begin < p->panel[d].rows && block_factor_row(&s->f, d, begin) < first) begin++;
      for (stop = begin; stop < p->panel[d].rows && block_factor_row(&s->f, d, stop) < end;) stop++;
      if (begin == stop) continue;
      assert_int_equal(p->update[at].from, d);
      assert_int_equal(p->update[at].begin, begin);
      assert_int_equal(p->update[at++].end, stop);
    }
  }
  assert_int_equal(p->update_start[p->n_panels], at);
  print_message("%d updates of %d panels\n", at, p->n_panels);
  assert_true(at > p->n_panels);
  drop(s);
}

static double cost_of(const fem_supernodes *p, int first, int last) {
  double cost = 0;
  for (int k = first; k < last; k++)
    cost += (double)p->panel[k].columns * p->panel[k].rows * p->panel[k].rows;
  return cost;
}

/* A subtree is a range of panels that change no other one but through its copies. The most costly
 * is first, at most a sixteenth of the whole. */
static void subtrees_do_not_depend_on_each_other(void **state) {
  (void)state;
  scene                *s     = two_bodies();
  const fem_supernodes *p     = &s->f.panels;
  int                   copy  = p->n;
  bool                 *in    = calloc((size_t)p->n_panels, sizeof *in);
  const double          whole = cost_of(p, 0, p->n_panels);
  double                last  = whole / 16;
  assert_true(p->n_subtrees > 2);
  for (int i = 0; i < p->n_subtrees; i++) {
    const fem_subtree *t = &p->subtree[i];
    assert_int_equal(t->copy, copy);
    const double cost = cost_of(p, t->first, t->last);
    assert_below(cost, last * (1 + 1e-12));
    last = cost;
    copy += t->n_copies;
    for (int k = t->first; k < t->last; k++) {
      assert_false(in[k]);
      in[k] = true;
      for (int r = 0; r < p->panel[k].rows; r++) {
        const int at = p->row[p->panel[k].row + (size_t)r];
        assert_true(at < p->n ? s->f.owner[at] >= t->first && s->f.owner[at] < t->last
                              : at >= t->copy && at < t->copy + t->n_copies);
      }
    }
    for (int c = 0; c < t->n_copies; c++)
      assert_true(s->f.owner[p->original[t->copy + c - p->n]] >= t->last);
  }
  assert_int_equal(copy, p->n_extended);
  for (int k = 0; k < p->n_panels; k++) assert_true(p->is_top[k] == !in[k]);
  free(in);
  drop(s);
}

/* Wanted rows need their panels and all panels on the way to the root. */
static void needed_panels_are_the_ancestors(void **state) {
  (void)state;
  scene                *s   = two_bodies();
  const fem_supernodes *p   = &s->f.panels;
  bool                 *row = malloc((size_t)p->n), *needed = malloc((size_t)p->n_panels);
  bool                 *wanted = malloc((size_t)p->n_panels);
  for (int pick = 1; pick < p->n; pick += 97) {
    memset(row, 0, (size_t)p->n);
    memset(wanted, 0, (size_t)p->n_panels);
    row[pick] = row[(pick * 31) % p->n] = true;
    for (int r = 0; r < p->n; r++)
      for (int at = row[r] ? r : p->n; at < p->n; at = parent_of(s, at))
        wanted[s->f.owner[at]] = true;
    fem_supernodes_needed(p, row, needed);
    assert_memory_equal(needed, wanted, (size_t)p->n_panels);
  }
  free(row);
  free(needed);
  free(wanted);
  drop(s);
}

static void no_node_and_one_node(void **state) {
  (void)state;
  for (int n = 0; n <= 1; n++) {
    scene *s = make(block_grid_line(n, 1, false));
    assert_int_equal(s->f.panels.n, 3 * n);
    assert_int_equal(s->f.panels.n_panels, n);
    assert_int_equal(s->f.panels.n_values, 9 * n);
    assert_int_equal(s->f.panels.update_start[n], 0);
    drop(s);
  }
  fem_supernodes none = {0};
  fem_supernodes_free(&none);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(panels_cover_each_column_once),
      cmocka_unit_test(panels_hold_every_entry),
      cmocka_unit_test(a_wide_supernode_is_cut),
      cmocka_unit_test(the_tree_is_the_elimination_tree),
      cmocka_unit_test(updates_are_the_rows_of_earlier_panels),
      cmocka_unit_test(subtrees_do_not_depend_on_each_other),
      cmocka_unit_test(needed_panels_are_the_ancestors),
      cmocka_unit_test(no_node_and_one_node),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
