#include <complex.h>

#include "mesh/base/constants.h"
#include "postproc/analysis/outputs.h"
#include "postproc/report/csv.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

enum { MOST = 200 };

/* One record of RFC 4180 from text into cells (pointers into room); returns what follows, NULL at
 * the end. */
static const char *record(const char *text, char *room, char *cell[MOST], int *n) {
  *n = 0;
  if (!*text) return NULL;
  for (;;) {
    assert_true(*n < MOST);
    cell[(*n)++] = room;
    if (*text == '"') {
      for (text++; *text != '"' || text[1] == '"'; text++) {
        assert_true(*text);
        text += *text == '"';
        *room++ = *text;
      }
      text++;
    } else {
      while (*text != ',' && *text != '\r') {
        assert_true(*text && *text != '"' && *text != '\n');
        *room++ = *text++;
      }
    }
    *room++ = '\0';
    if (*text == ',') {
      text++;
      continue;
    }
    assert_memory_equal(text, "\r\n", 2);
    return text + 2;
  }
}

static int column(char *const *name, int n, const char *wanted) {
  for (int i = 0; i < n; i++)
    if (strcmp(name[i], wanted) == 0) return i;
  fail_msg("no column %s", wanted);
  return -1;
}

static double value(const char *cell) {
  char  *end;
  double v = strtod(cell, &end);
  assert_true(*cell && !*end);
  return v;
}

static void check_point(const mhb_response *r, int b, int p, char *const *cell, char *const *name,
                        int n) {
  const mhb_branch     *branch = &r->branch[b];
  const double complex *u      = branch->motion + ((size_t)p * 3 + 1) * 4,
                       *tip    = branch->probe + (size_t)p * 2 * 3 * 4;
  assert_near(value(cell[column(name, n, "branch")]), b, 0);
  assert_string_equal(cell[column(name, n, "origin")], "end");
  assert_near(value(cell[column(name, n, "order")]), 1, 0);
  assert_near(value(cell[column(name, n, "frequency_Hz")]), branch->frequency[p],
              1e-11 * branch->frequency[p]);
  assert_near(value(cell[column(name, n, "contact_u_amplitude_m")]), cabs(u[1]),
              1e-11 * cabs(u[1]));
  assert_near(value(cell[column(name, n, "contact_u_phase_deg")]), carg(u[1]) * 180 / SHB_PI, 1e-9);
  assert_near(value(cell[column(name, n, "contact_u_peak_to_peak_m")]), post_peak_to_peak(1, 3, u),
              1e-11 * cabs(u[1]));
  assert_near(value(cell[column(name, n, "tip_motion_amplitude_m")]),
              post_semi_major_axis(3, tip + 1, 4), 1e-11 * cabs(tip[1]));
  assert_near(value(cell[column(name, n, "contact_open")]), branch->state[3 * p + 2], 1e-11);
  assert_near(value(cell[column(name, n, "contact_dissipation_J")]), branch->dissipation[p], 1e-11);
  assert_near(value(cell[column(name, n, "iterations")]), branch->iterations[p], 0);
}

static void whole(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  mhb_response   *r    = fixture_response(&o);
  post_buffer     text = {0};
  char           *name[MOST], *cell[MOST], names[8192], room[8192];
  int             n, m, rows = 0;
  assert_non_null(r);
  r->branch[2].error_modal[0]   = NAN;
  r->branch[2].error_spatial[0] = 0.0125;
  r->branch[2].error_spatial[1] = -1;
  r->branch[2].stable[0]        = -1;
  r->branch[2].special[0]       = 1;
  r->n_multipliers              = 2;
  for (int b = 2; b < r->n_branches; b++)
    r->branch[b].multipliers = calloc((size_t)r->branch[b].n_points * 2, sizeof(double complex));
  r->branch[3].special[5]        = MHB_NEIMARK_SACKER;
  r->branch[3].special[6]        = MHB_OPTIMUM;
  r->branch[3].judged[5]         = MHB_BY_MULTIPLIERS;
  r->branch[3].loss[5]           = MHB_LOSS_NEIMARK_SACKER;
  r->branch[3].multipliers[10]   = CMPLX(0.3, 1.4);
  r->branch[3].lasting_kind[5]   = MHB_LASTING_MODULATED;
  r->branch[3].lasting_mean[5]   = 0.93;
  r->branch[3].lasting_worst[5]  = 1.27;
  r->branch[3].lasting_side[5]   = 34;
  r->branch[3].lasting_offset[5] = -0.041;
  post_csv(r, &text);
  const char *at = record(text.text, names, name, &n);
  assert_int_equal(n, 4 + 2 * 11 + 15 + 20);
  for (int b = 0; b < r->n_branches; b++)
    for (int p = 0; p < r->branch[b].n_points; p++, rows++) {
      at = record(at, room, cell, &m);
      assert_int_equal(m, n);
      check_point(r, b, p, cell, name, n);
      bool nonlinear = r->branch[b].kind == MHB_BRANCH_NONLINEAR;
      assert_string_equal(cell[column(name, n, "kind")], nonlinear ? "nonlinear"
                                                         : b == 0  ? "open"
                                                                   : "stuck");
      if (nonlinear)
        assert_near(value(cell[column(name, n, "n0_N")]), r->branch[b].n0[p], 0);
      else
        assert_string_equal(cell[column(name, n, "n0_N")], ""); /* a limit has no preload */
      if (b == 2 && p < 2)                                      /* told; not judged */
        assert_string_equal(cell[column(name, n, "error_spatial")], p ? "" : "0.0125");
      if (b == 2 && p == 0) {
        assert_string_equal(cell[column(name, n, "error_modal")], "");
        assert_string_equal(cell[column(name, n, "stable")], "");
        assert_string_equal(cell[column(name, n, "special")], "fold");
      }
      if (b == 3 && p == 6) assert_string_equal(cell[column(name, n, "special")], "optimum");
      bool turn = b == 3 && p == 5;
      assert_string_equal(cell[column(name, n, "judged")], !nonlinear ? ""
                                                           : turn     ? "multipliers"
                                                                      : "no");
      assert_string_equal(cell[column(name, n, "loss")], turn ? "Neimark-Sacker" : "");
      assert_string_equal(cell[column(name, n, "lasting_kind")], turn ? "modulated" : "");
      if (turn) {
        assert_near(value(cell[column(name, n, "lasting_mean")]), 0.93, 1e-11);
        assert_near(value(cell[column(name, n, "lasting_worst")]), 1.27, 1e-11);
        assert_near(value(cell[column(name, n, "lasting_side")]), 34, 0);
        assert_near(value(cell[column(name, n, "lasting_offset")]), -0.041, 1e-11);
        assert_string_equal(cell[column(name, n, "special")], "Neimark-Sacker");
        assert_near(value(cell[column(name, n, "largest_multiplier")]), hypot(0.3, 1.4), 1e-11);
      } else {
        assert_string_equal(cell[column(name, n, "largest_multiplier")], "");
      }
    }
  assert_null(record(at, room, cell, &m));
  assert_int_equal(rows, 2 * 240 + 6 * 240 + 120);
  column(name, n, "shroud <edge> & \"co\"_axial_phase_deg"); /* quotes survive */
  assert_has(text.text, ",\"shroud <edge> & \"\"co\"\"_axial_phase_deg\",");
  post_buffer_free(&text);
  mhb_response_destroy(r);
}

/* One more column, in this case only. */
static void run_up(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  mhb_response   *r    = fixture_response(&o);
  post_buffer     text = {0};
  char           *name[MOST], *cell[MOST], names[8192], room[8192];
  int             n, m;
  assert_non_null(r);
  r->run_up = true;
  post_csv(r, &text);
  const char *at = record(text.text, names, name, &n);
  record(at, room, cell, &m);
  assert_int_equal(n, 5 + 2 * 11 + 15 + 20);
  assert_near(value(cell[column(name, n, "speed_rpm")]), 60 * r->branch[0].frequency[0] / 5, 1e-8);
  post_buffer_free(&text);
  mhb_response_destroy(r);
}

static void many_contacts(void **state) {
  (void)state;
  static const double n0[] = {40};
  fixture_options     o    = {1, 3, n0, 0, 3, 1, false, false, 1, MHB_IN_FREQUENCY};
  mhb_response       *r    = fixture_response(&o);
  post_buffer         text = {0};
  char               *name[MOST], names[8192];
  int                 n;
  assert_non_null(r);
  post_csv(r, &text);
  record(text.text, names, name, &n);
  assert_int_equal(n, 4 + 3 * 15 + 20);
  column(name, n, "contact3_w_peak_to_peak_m");
  post_buffer_free(&text);
  mhb_response_destroy(r);
}

/* A followed parameter has a column after the frequency; frequency and n0 always have theirs. */
static void parameter(void **state) {
  (void)state;
  static const char *const wanted[MHB_N_PARAMETERS] = {NULL, "n0_N",   "scale",
                                                       "mu", "ku_N_m", "kv_N_m"};
  static const double      n0[]                     = {40};
  for (int k = 1; k < MHB_N_PARAMETERS; k++) {
    fixture_options o    = {1, 5, n0, 0, 1, 1, true, false, 1, (mhb_parameter)k};
    mhb_response   *r    = fixture_response(&o);
    post_buffer     text = {0};
    char           *name[MOST], *cell[MOST], names[8192], room[8192];
    int             n, m;
    assert_non_null(r);
    post_csv(r, &text);
    const char *at  = record(text.text, names, name, &n);
    bool        own = k != MHB_IN_N0;
    assert_string_equal(name[4], own ? wanted[k] : "contact_v_amplitude_m");
    for (int b = 0; b < r->n_branches; b++)
      for (int p = 0; p < 5; p++) { /* the linear limits too */
        double x = r->branch[b].value[p];
        at       = record(at, room, cell, &m);
        assert_int_equal(m, n);
        assert_near(value(cell[column(name, n, wanted[k])]), x, 1e-11 * fabs(x));
        assert_near(value(cell[column(name, n, "frequency_Hz")]), 240, 0);
        if (own && r->branch[b].kind != MHB_BRANCH_NONLINEAR)
          assert_string_equal(cell[column(name, n, "n0_N")], "");
      }
    post_buffer_free(&text);
    mhb_response_destroy(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(whole), cmocka_unit_test(run_up),
                                     cmocka_unit_test(many_contacts), cmocka_unit_test(parameter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
