/* The contacts that the page's script gets. With "keep": pages for test_page_script.py. */
#include "postproc/report/contact_points.h"

#include "mhb/contact/contact.h"
#include "mhb/numerics/fourier.h"
#include "mhb/response/pair_law.h"
#include "postproc/report/report.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

static mhb_settings settings_of(const fixture_options *o) {
  mhb_settings s = {.engine_order = 5,
                    .blades       = 60,
                    .mu           = 0.3,
                    .kv           = 8e5,
                    .ku           = {4e5, 1e4, 5e5},
                    .tolerance    = 1e-8,
                    .n_preloads   = o->n_preloads,
                    .parameter    = o->parameter,
                    .scale        = 1};
  for (int i = 0; i < o->n_preloads; i++) s.n0[i] = o->n0[i];
  return s;
}

/* Forces, states and work of the motion in the response. */
static void obey(const mhb_settings *s, mhb_response *r) {
  double share[32], x[3 * 32], p[3 * 32];
  mhb_recorded_shares(r, NULL, share);
  for (int b = 0; b < r->n_branches; b++) {
    mhb_branch            *branch = &r->branch[b];
    const int              m = branch->n_harmonics, K = m + 1;
    mhb_contact_info      *info = calloc(1, sizeof *info);
    mhb_contact_evaluator *law;
    assert_ok(mhb_contact_evaluator_create(m, m, s->tolerance, &law));
    for (int i = 0; i < branch->n_points * r->n_pairs; i++) {
      const int     point = i / r->n_pairs, pair = i % r->n_pairs;
      const mhb_law own = mhb_recorded_law(s, r, branch, point, pair, share[pair]);
      mhb_recorded_pair_motion(r, branch, point, pair, x);
      mhb_contact_force(law, &own, x, p, NULL, info);
      for (int j = 0; j < 3 * K; j++) {
        const double *a              = p + j / K * mhb_real_size(m);
        const int     k              = j % K;
        branch->force[i * 3 * K + j] = k ? CMPLX(a[2 * k - 1], a[2 * k]) : a[0];
      }
      memcpy(branch->state + 3 * i, info->share, sizeof info->share);
      branch->dissipation[i] = info->dissipation;
    }
    mhb_contact_evaluator_destroy(law);
    free(info);
  }
}

/* ---------------------------------------------------------------- what is written */

static int first_curve(const mhb_response *r) {
  int first = 0;
  while (r->branch[first].kind != MHB_BRANCH_NONLINEAR) first++;
  return first;
}

/* The text of three points of the first curve. */
static char *three_points(const mhb_settings *s, const mhb_response *r, const double *area) {
  const int         kept[] = {0, 7, 9};
  post_analysis    *a;
  post_contact_plan plan;
  post_buffer       out = {0}, names = {0};
  assert_ok(post_analysis_create(r, &a));
  a->settings = s;
  a->area     = area;
  assert_ok(post_contact_points(a, &plan));
  assert_int_equal(plan.n, 2);
  assert_int_equal(plan.stride, 1);
  post_put_contacts(a, &plan, &names);
  assert_has(names.text, "\"names\":[\"contact 1\",\"contact 2\"]");
  for (int b = 0; b < r->n_branches; b++)
    if (r->branch[b].kind == MHB_BRANCH_OPEN)
      assert_ok(post_put_contact_points(a, &plan, b, 3, kept, &out));
  assert_null(out.text); /* a linear limit has no loop */
  assert_ok(post_put_contact_points(a, &plan, first_curve(r), 3, kept, &out));
  post_contact_plan_free(&plan);
  post_buffer_free(&names);
  post_analysis_destroy(a);
  return out.text;
}

static void every_point_has_its_period(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.n_pairs         = 2;
  o.n_points        = 40;
  mhb_settings  s   = settings_of(&o);
  mhb_response *r   = fixture_response(&o);
  int           n, samples = 0, loops = 0;
  obey(&s, r);
  char *text = three_points(&s, r, NULL), *at = strstr(text, "\"loops\":[[") + 9;
  assert_has(text, "\"at\":[0,1,2],\"loops\":[[");
  for (; loops < 6; loops++, at = strchr(at, ']') + 1) {
    n = atoi(strchr(at, '[') + 1);
    assert_in_range(n, 5, 200);
    samples += n;
  }
  assert_int_equal(*at, ']');
  /* 7 rows of two bytes, to whole floats, in base64 */
  const char *data = strstr(text, "\"data\":\"") + 8;
  assert_int_equal(strcspn(data, "\""), ((7 * samples + 1) / 2 * 4 + 2) / 3 * 4);
  free(text);
  mhb_response_destroy(r);
}

/* Other settings, or areas, than those of the response. */
static void a_law_that_is_not_the_files_draws_nothing(void **state) {
  (void)state;
  static const char none[]  = "\"loops\":[[0,";
  fixture_options   o       = fixture_usual();
  const double      area[2] = {1e-4, 3e-4};
  o.n_pairs                 = 2;
  o.n_points                = 40;
  mhb_settings  s           = settings_of(&o);
  mhb_response *r           = fixture_response(&o);
  obey(&s, r);
  char *text = three_points(&s, r, area);
  assert_has(text, none);
  free(text);
  s.mu *= 1.05;
  text = three_points(&s, r, NULL);
  assert_has(text, none);
  free(text);
  mhb_response_destroy(r);
}

static void without_settings_there_is_no_loop(void **state) {
  (void)state;
  fixture_options   o = fixture_usual();
  mhb_response     *r = fixture_response(&o);
  post_analysis    *a;
  post_contact_plan plan;
  assert_ok(post_analysis_create(r, &a));
  assert_ok(post_contact_points(a, &plan));
  assert_int_equal(plan.n, 0);
  post_contact_plan_free(&plan);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

static void large_responses_are_thinned(void **state) {
  (void)state;
  fixture_options o   = fixture_usual();
  o.n_pairs           = 22;
  o.n_points          = 300;
  o.n_harmonics       = 9;
  mhb_settings      s = settings_of(&o);
  mhb_response     *r = fixture_response(&o);
  post_analysis    *a;
  post_contact_plan plan;
  post_buffer       out  = {0};
  int              *kept = calloc(300, sizeof *kept);
  obey(&s, r);
  assert_ok(post_analysis_create(r, &a));
  a->settings = &s;
  assert_ok(post_contact_points(a, &plan));
  assert_int_equal(plan.n, POST_SHOWN_CONTACTS);
  assert_true(plan.stride > 5);
  for (int i = 0; i < 300; i++) kept[i] = i;
  for (int b = 0; b < r->n_branches; b++)
    assert_ok(post_put_contact_points(a, &plan, b, r->branch[b].n_points, kept, &out));
  print_message("stride %d, %.2f MB\n", plan.stride, 1e-6 * (double)out.length);
  assert_true(out.length < 1600000);
  free(kept);
  post_buffer_free(&out);
  post_contact_plan_free(&plan);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

/* ---------------------------------------------------------------- pages for a browser */

static void write_text(const char *path, const post_buffer *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_int_equal(fwrite(text->text, 1, text->length, file), text->length);
  assert_int_equal(fclose(file), 0);
}

static void write_page(const char *name, const fixture_options *o) {
  char           none[] = "";
  post_origin    source = {none, none, none, none, none, none, none, 1};
  mhb_settings   s      = settings_of(o);
  mhb_response  *r      = fixture_response(o);
  post_buffer    out    = {0};
  char           path[64];
  post_analysis *a;
  r->run_up = strcmp(name, "free") == 0;
  if (r->n_pairs > 0) obey(&s, r);
  assert_ok(post_analysis_create(r, &a));
  a->settings = &s;
  assert_ok(post_report(a, &source, name, NULL, &out));
  snprintf(path, sizeof path, "page_%s.html", name);
  write_text(path, &out);
  post_buffer_free(&out);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

static void keep_pages(void) {
  double          n0[36];
  fixture_options o = fixture_usual();
  write_page("usual", &o);
  o.n_pairs  = 5;
  o.n_probes = 0;
  write_page("contacts", &o);
  o           = fixture_usual();
  o.parameter = MHB_IN_MU;
  write_page("friction", &o);
  o         = fixture_usual();
  o.n_pairs = 0;
  write_page("free", &o);
  o = fixture_usual();
  for (int i = 0; i < 36; i++) n0[i] = 5 * exp(0.17 * i);
  o.n_preloads = 36;
  o.n0         = n0;
  o.n_points   = 600;
  write_page("many", &o);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_point_has_its_period),
      cmocka_unit_test(a_law_that_is_not_the_files_draws_nothing),
      cmocka_unit_test(without_settings_there_is_no_loop),
      cmocka_unit_test(large_responses_are_thinned),
  };
  if (argc > 1 && strcmp(argv[1], "keep") == 0) {
    keep_pages();
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
