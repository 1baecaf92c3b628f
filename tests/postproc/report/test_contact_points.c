/* The motion and the law that the page's script gets. With "keep": pages for test_page_script.py.
 */
#include "postproc/report/contact_points.h"

#include "postproc/report/page.h"
#include "postproc/report/report.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"
#include "tests/support/motion_suite.h"

static mhb_settings settings_of(const fixture_options *o) {
  mhb_settings s = {.engine_order = 5,
                    .blades       = 60,
                    .mu           = 0.3,
                    .kv           = 8e5,
                    .ku           = {4e5, 1e4, 5e5},
                    .n_preloads   = o->n_preloads,
                    .parameter    = o->parameter,
                    .scale        = 1};
  for (int i = 0; i < o->n_preloads; i++) s.n0[i] = o->n0[i];
  return s;
}

/* ---------------------------------------------------------------- what is written */

static void every_point_has_its_law(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.n_pairs         = 2;
  mhb_settings   s  = settings_of(&o);
  mhb_response  *r  = fixture_response(&o);
  post_analysis *a;
  post_buffer    out = {0}, names = {0};
  double         area[2] = {1e-4, 3e-4};
  assert_ok(post_analysis_create(r, &a));
  assert_int_equal(post_contact_points(a).n, 0); /* no settings: the law is not known */
  a->settings            = &s;
  a->area                = area;
  post_contact_plan plan = post_contact_points(a);
  assert_int_equal(plan.n, 2);
  assert_int_equal(plan.stride, 1);
  post_put_contact_names(a, &plan, &names);
  assert_string_equal(names.text, "[\"contact 1\",\"contact 2\"]");
  int kept[] = {0, 7, 9};
  int first  = 0;
  while (r->branch[first].kind != MHB_BRANCH_NONLINEAR) first++;
  post_put_contact_points(a, &plan, first, 3, kept, &out);
  assert_has(out.text, "\"at\":[0,1,2],\"k\":[3,3,3],\"data\":\"");
  /* 2 contacts of 6 numbers of the law and 3 axes of 7 coefficients, 4 bytes each, in base64 */
  const char *data = strstr(out.text, "\"data\":\"") + 8;
  assert_int_equal(strcspn(data, "\""), (3 * 2 * (6 + 21) * 4 + 2) / 3 * 4);
  post_buffer_free(&out);
  for (int b = 0; b < r->n_branches; b++)
    if (r->branch[b].kind == MHB_BRANCH_OPEN) post_put_contact_points(a, &plan, b, 3, kept, &out);
  assert_null(out.text); /* a linear limit has no loop */
  post_buffer_free(&names);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

static void large_responses_are_thinned(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.n_pairs         = 22;
  o.n_points        = 1500;
  o.n_harmonics     = 9;
  mhb_settings   s  = settings_of(&o);
  mhb_response  *r  = fixture_response(&o);
  post_analysis *a;
  post_buffer    out  = {0};
  int           *kept = calloc(1500, sizeof *kept);
  assert_ok(post_analysis_create(r, &a));
  a->settings            = &s;
  post_contact_plan plan = post_contact_points(a);
  assert_int_equal(plan.n, POST_SHOWN_CONTACTS);
  assert_true(plan.stride > 5);
  for (int i = 0; i < 1500; i++) kept[i] = i;
  for (int b = 0; b < r->n_branches; b++)
    post_put_contact_points(a, &plan, b, r->branch[b].n_points, kept, &out);
  print_message("stride %d, %.2f MB\n", plan.stride, 1e-6 * (double)out.length);
  assert_true(out.length < 1200000);
  free(kept);
  post_buffer_free(&out);
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

static void put_motion(const suite_motion *m, mhb_contact_evaluator *contact, post_buffer *out) {
  float            data[3 * SUITE_WIDTH];
  double           force[3 * (2 * 64 + 1)];
  mhb_contact_info info;
  for (int i = 0; i < 3 * SUITE_WIDTH; i++) { /* the page has sin, the law in C -sin */
    int j   = i % SUITE_WIDTH;
    data[i] = (float)(j > 0 && j % 2 == 0 ? -1 : 1) * (float)m->motion[i / SUITE_WIDTH][j];
  }
  mhb_contact_force(contact, &m->law, &m->motion[0][0], force, NULL, &info);
  post_put(out, "{\"name\":");
  post_put_json(out, m->name);
  post_put(out,
           ",\"law\":{\"mu\":%.9g,\"n0\":%.9g,\"kv\":%.9g,\"kuu\":%.9g,\"kuw\":%.9g,\"kww\":%.9g},"
           "\"work\":%.9g,\"share\":[%.9g,%.9g,%.9g],\"top\":%d,\"data\":\"",
           m->law.mu, m->law.n0, m->law.kv, m->law.ku[0], m->law.ku[1], m->law.ku[2],
           info.dissipation, info.share[0], info.share[1], info.share[2], SUITE_HARMONICS);
  post_put_base64(out, 3 * SUITE_WIDTH, data);
  post_put(out, "\"}");
}

/* The motions of the suite, with work and shares by the law in C. */
static void write_law(void) {
  post_buffer            out = {0};
  mhb_contact_evaluator *contact;
  assert_ok(mhb_contact_evaluator_create(SUITE_HARMONICS, 64, 1e-8, &contact));
  post_put(&out, "<!DOCTYPE html><html><head><title></title></head><body><script>\n");
  post_put_bytes(&out, post_contact_js, strlen(post_contact_js));
  post_put(&out, "const motions=[");
  for (int i = 0; i < suite_size(); i++) {
    suite_motion m = suite_at(i);
    post_put(&out, i ? "," : "");
    put_motion(&m, contact, &out);
  }
  post_put(&out, "];</script></body></html>");
  write_text("law.html", &out);
  mhb_contact_evaluator_destroy(contact);
  post_buffer_free(&out);
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
  write_law();
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
      cmocka_unit_test(every_point_has_its_law),
      cmocka_unit_test(large_responses_are_thinned),
  };
  if (argc > 1 && strcmp(argv[1], "keep") == 0) {
    keep_pages();
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
