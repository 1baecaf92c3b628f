/* The section of the report: the worst place of each curve with its numbers; nothing without kept
 * points; limits only where nothing else was kept. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "postproc/field/stress_section.h"
#include "tests/support/check.h"

enum { NODES = 3, LIMIT = 0, CURVE = 1, BRANCHES = 2 };

/* One mode with a pull along x of 1, 2 and 4 MPa at three nodes; two kept points, amplitudes 10 and
 * 30. Static stress: a pull of 90 MPa at node 1. */
typedef struct {
  double           nodes[3 * NODES], stress[6 * NODES], pull[6 * NODES];
  double           frequency[2], n0[2], scale[2];
  int              point[2], special[2], stable[2];
  double complex   amplitude[4], probe[2 * 3 * 2];
  mhb_branch       branch[BRANCHES];
  mhb_response     response;
  post_blade_field field;
} example;

static void make(example *e) {
  memset(e, 0, sizeof *e);
  for (int i = 0; i < NODES; i++) {
    e->nodes[3 * i + 2] = 0.3 + 0.1 * i;
    e->nodes[3 * i]     = -0.0123;
    e->stress[6 * i]    = 1e6 * (1 << i);
  }
  e->pull[6]      = 90e6;
  e->frequency[0] = 101.5;
  e->frequency[1] = 123.25;
  e->n0[0] = e->n0[1] = 25;
  e->scale[0] = e->scale[1] = 1;
  e->point[1]               = 1;
  e->stable[1]              = 1;
  e->amplitude[1]           = 10;
  e->amplitude[3]           = CMPLX(0, 30);
  e->probe[1]               = 1e-3; /* point 0, tangential, harmonic 1 */
  e->probe[6 + 1]           = 3e-3;
  for (int i = 0; i < BRANCHES; i++) {
    e->branch[i]           = (mhb_branch){.order = 1, .n_harmonics = 1, .main = i, .n_points = 2};
    e->branch[i].kind      = i == LIMIT ? MHB_BRANCH_OPEN : MHB_BRANCH_NONLINEAR;
    e->branch[i].frequency = e->frequency;
    e->branch[i].n0        = e->n0;
    e->branch[i].probe     = e->probe;
    e->branch[i].stable    = e->stable;
    e->branch[i].special   = e->special;
    e->branch[i].modal     = (mhb_modal_motion){2, 0, e->point, e->amplitude, NULL, e->scale};
  }
  e->response = (mhb_response){
      .n_branches = BRANCHES, .branch = e->branch, .n_modes = 1, .n_probes = 1, .n_harmonics = 1};
  e->field = (post_blade_field){.n_nodes       = NODES,
                                .n_modes       = 1,
                                .nodes         = e->nodes,
                                .stress        = e->stress,
                                .static_stress = e->pull};
}

static void has(const post_buffer *page, const char *text) {
  if (!strstr(page->text, text)) print_error("missing: %s\nin: %s\n", text, page->text);
  assert_non_null(strstr(page->text, text));
}

static void the_highest_point_of_a_curve_is_told(void **state) {
  (void)state;
  example            e;
  post_buffer        page    = {0};
  const post_fatigue goodman = {.endurance = 300e6, .ultimate = 900e6};
  make(&e);
  assert_ok(post_stress_section(&e.field, &e.response, &goodman, &page));
  has(&page, "<td>25\u00a0N</td><td class=\"num\">123.25</td><td>stable</td>");
  /* 30 times 4 MPa at the third node, without mean: 300/120 */
  has(&page,
      "<td class=\"num\">120</td><td class=\"num\">120</td><td class=\"num\">0</td>"
      "<td class=\"num\">−12.3, 0, 500</td><td class=\"num\">2.5</td>");
  /* 60/300 + 90/900 at the second */
  has(&page,
      "<td class=\"num\">60</td><td class=\"num\">60</td><td class=\"num\">90</td>"
      "<td class=\"num\">−12.3, 0, 400</td><td class=\"num\">3.333</td>");
  has(&page, "at most 90\u00a0MPa (von Mises) at −12.3, 0, 400\u00a0mm");
  has(&page, "The 3 worst places of 25\u00a0N");
  assert_null(strstr(page.text, "open"));
  post_buffer_free(&page);
}

static void without_fatigue_there_is_no_safety(void **state) {
  (void)state;
  example            e;
  post_buffer        page = {0};
  const post_fatigue none = {0};
  make(&e);
  e.branch[CURVE].modal.n = 0;
  e.field.static_stress   = NULL;
  assert_ok(post_stress_section(&e.field, &e.response, &none, &page));
  has(&page, "<tr><td>open</td>");
  assert_null(strstr(page.text, "Safety"));
  assert_null(strstr(page.text, "Static stress"));
  post_buffer_free(&page);
}

static void nothing_kept_gives_no_section(void **state) {
  (void)state;
  example            e;
  post_buffer        page = {0};
  const post_fatigue none = {0};
  make(&e);
  e.branch[LIMIT].modal.n = e.branch[CURVE].modal.n = 0;
  assert_ok(post_stress_section(&e.field, &e.response, &none, &page));
  assert_null(page.text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_highest_point_of_a_curve_is_told),
                                     cmocka_unit_test(without_fatigue_there_is_no_safety),
                                     cmocka_unit_test(nothing_kept_gives_no_section)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
