#include "postproc/analysis/stability_findings.h"
#include "postproc/report/picture.h"
#include "postproc/report/report.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

static char hostile[sizeof(char) * 2048];

static post_origin source(void) {
  static char text[] = "x", settings[] = "mhb.frequency = 92 138\ncontact.mu = 0.3 <&>\n",
              created[] = "2026-01-02T03:04:05Z";
  snprintf(hostile, sizeof hostile, "%s", fixture_hostile);
  return (post_origin){.format    = text,
                       .revision  = text,
                       .command   = text,
                       .created   = created,
                       .case_path = text,
                       .case_text = hostile,
                       .settings  = settings,
                       .version   = 1};
}

/* ---------------------------------------------------------------- reading tags */

static bool is_void(const char *name) {
  static const char *const known[] = {"meta", "br", "hr", "img", "input", "link"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (strcmp(name, known[i]) == 0) return true;
  return false;
}

/* Skip a tag's attributes; every value must be quoted. *closed: the tag ends in "/>". */
static const char *skip_tag(const char *c, bool *closed) {
  for (; *c != '>'; c++) {
    if (*c == '"') c = strchr(c + 1, '"');
    assert_non_null(c);
    assert_true(*c && *c != '<' && *c != '\'');
  }
  *closed = c[-1] == '/';
  return c + 1;
}

/* Check that every element is closed in order, without stray '<' or '&'. Returns the number of
 * elements. */
static int check_tags(const char *c) {
  char open[64][24];
  int  depth = 0, elements = 0;
  while (*c) {
    if (*c == '&') assert_true(strchr(c, ';') && strchr(c, ';') - c < 9);
    if (*c++ != '<') continue;
    if (*c == '!' || *c == '?') {
      c = strchr(c, '>') + 1;
      continue;
    }
    bool   closing = *c == '/', closed;
    char   name[24];
    size_t n;
    c += closing;
    n = strspn(c, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789");
    assert_true(n > 0 && n < sizeof name);
    snprintf(name, sizeof name, "%.*s", (int)n, c);
    c = skip_tag(c + n, &closed);
    if (closing) {
      assert_true(depth > 0);
      assert_string_equal(open[--depth], name);
    } else if (!closed && !is_void(name)) {
      assert_true(depth < 64);
      strcpy(open[depth++], name);
      elements++;
      char end[32];
      snprintf(end, sizeof end, "</%s", name);
      if (strcmp(name, "script") == 0 || strcmp(name, "style") == 0) c = strstr(c, end);
      assert_non_null(c);
    }
  }
  assert_int_equal(depth, 0);
  return elements;
}

static int count(const char *text, const char *part) {
  int n = 0;
  for (; (text = strstr(text, part)); text += strlen(part)) n++;
  return n;
}

/* Nothing is fetched: links stay inside the page, style and script are part of it. */
static void check_self_contained(const char *html) {
  static const char *const loads[] = {"src=",  "@import", "fetch(",  "XMLHttpRequest", "import(",
                                      "<link", "<iframe", "<object", "WebSocket"};
  for (size_t i = 0; i < sizeof loads / sizeof *loads; i++) assert_has_not(html, loads[i]);
  assert_int_equal(count(html, "href="), count(html, "href=\"#") + 1);
  assert_int_equal(count(html, ".csv\">the table"), 1); /* beside the page, opened by a click */
  assert_int_equal(count(html, "url("), count(html, "url(#"));
  assert_has(html, "default-src 'none'");
}

/* ---------------------------------------------------------------- pages */

/* The page of a response, which is destroyed. */
static char *page_of(mhb_response *r, const char *name) {
  post_analysis *analysis;
  post_buffer    html = {0};
  post_origin    s    = source();
  assert_non_null(r);
  assert_ok(post_analysis_create(r, &analysis));
  assert_ok(post_report(analysis, &s, name, NULL, &html));
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
  return html.text;
}

static char *page(const fixture_options *o, const char *name) {
  return page_of(fixture_response(o), name);
}

static void usual(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  char           *html = page(&o, "z_notch_blade");
  assert_true(check_tags(html) > 200);
  check_self_contained(html);
  static const char *const parts[] = {"id=\"response\"",   "id=\"tracking\"",
                                      "id=\"state\"",      "id=\"along\"",
                                      "id=\"harmonics\"",  "Peaks and folds",
                                      "Numerical quality", "322.2582",
                                      "incomplete",        "prefers-color-scheme: dark",
                                      "@media print",      "lang=\"en\"",
                                      "2026-01-02"};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) assert_has(html, parts[i]);
  assert_int_equal(count(html, "class=\"line limit open\""), 3); /* picture, its legend, key */
  assert_true(count(html, "line unstable c3") >= 1);
  free(html);
}

static void run_up(void **state) {
  (void)state;
  fixture_options o            = fixture_usual();
  char           *html         = page(&o, "plain");
  *strstr(html, "id=\"data\"") = '\0'; /* the script knows all words */
  assert_null(strstr(html, "run-up"));
  free(html);
  mhb_response *r = fixture_response(&o);
  assert_non_null(r);
  r->run_up = true;
  html      = page_of(r, "runs up");
  assert_has(html, "run-up: speed 1102.76 to 1656 rpm along E = 5");
  assert_has(html, "shrouds free, at the highest speed of the run-up.");
  free(html);
}

/* Flips and Neimark-Sacker points are drawn and reported apart from folds, with the number of
 * points whose stability was computed. */
static void turns(void **state) {
  (void)state;
  fixture_options o      = fixture_usual();
  char           *before = page(&o, "scene");
  mhb_response   *r      = fixture_response(&o);
  post_analysis  *analysis;
  post_buffer     html = {0};
  post_origin     s    = source();
  assert_has_not(before, "<b>Modulated</b>");
  assert_has_not(before, "class=\"bifurcation");
  free(before);
  for (int i = 10; i < 15; i++) {
    r->branch[3].stable[i] = 0;
    r->branch[3].judged[i] = MHB_BY_MULTIPLIERS;
    r->branch[3].loss[i]   = i < 12 ? MHB_LOSS_FLIP : MHB_LOSS_NEIMARK_SACKER;
  }
  r->branch[3].special[10] = MHB_FLIP;
  r->branch[3].special[14] = MHB_NEIMARK_SACKER;
  assert_ok(post_analysis_create(r, &analysis));
  assert_ok(post_report(analysis, &s, "scene", NULL, &html));
  check_tags(html.text);
  assert_has(html.text, "<b>Modulated</b> (dashed): at 5 of 1560 points, on 1 curve,");
  assert_int_equal(count(html.text, "class=\"bifurcation"), 2);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
  free(html.text);
}

/* Text of cases, names and reasons is escaped. */
static void escaping(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  char           *html = page(&o, "</title><script>alert(2)</script>");
  check_tags(html);
  assert_has_not(html, "<script>alert");
  assert_has_not(html, "<b>\"hostile");
  assert_int_equal(count(html, "</script>"), 2); /* data and program */
  assert_has(html, "&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt; &lt;!-- ]]&gt;");
  assert_has(html, "µm, ω², 叶片, \xf0\x9f\x94\xa7");
  assert_has(html, "&lt;after 12 halvings&gt;");
  assert_has(html, "\"shroud \\u003cedge> & \\\"co\\\"\"");
  assert_has(html, "0.3 &lt;&amp;&gt;");
  assert_has_not(html, "\x1b");
  assert_has_not(html, "\xff");
  free(html);
}

/* ---------------------------------------------------------------- the numbers behind the charts */

static int digit(char c) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const char       *at       = strchr(digits, c);
  assert_true(c && at);
  return (int)(at - digits);
}

/* Float number i of a base64 text, whose 4 bytes are spread over 3-byte groups. */
static float number(const char *text, size_t i) {
  uint32_t bits = 0;
  for (size_t k = 0; k < 4; k++) {
    size_t      byte  = 4 * i + k;
    const char *c     = text + byte / 3 * 4;
    uint32_t    three = (uint32_t)digit(c[0]) << 18 | (uint32_t)digit(c[1]) << 12 |
                     (uint32_t)(c[2] == '=' ? 0 : digit(c[2])) << 6 |
                     (uint32_t)(c[3] == '=' ? 0 : digit(c[3]));
    bits |= (three >> (16 - 8 * (byte % 3)) & 0xff) << (8 * k);
  }
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static void data(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  mhb_response   *r    = fixture_response(&o);
  char           *html = page(&o, "x");
  const char     *at   = strstr(html, "id=\"data\"");
  int             row;
  /* first output: motion of the tip, first harmonic */
  const char *output = strstr(at, "{\"place\":\"tip\",\"row\":");
  assert_int_equal(
      sscanf(output,
             "{\"place\":\"tip\",\"row\":%d,\"axis\":\"motion\",\"quantity\":\"first harmonic\"",
             &row),
      1);
  for (int b = 0; b < r->n_branches; b++) {
    at    = strstr(at + 1, "\"data\":\"");
    int n = r->branch[b].n_points;
    assert_non_null(at);
    for (int p = 0; p < n; p += 37) {
      double f = r->branch[b].frequency[p],
             a = post_amplitude(r, &r->branch[b], p, post_output_primary(r), 1);
      assert_near(number(at + 8, (size_t)p), f, 1e-7 * f);
      assert_near(number(at + 8, (size_t)(row * n + p)), a, 1e-7 * a);
      assert_near(number(at + 8, (size_t)(6 * n + p)), post_verdict_of(&r->branch[b], p), 0);
    }
  }
  mhb_response_destroy(r);
  free(html);
}

static void odd(void **state) {
  (void)state;
  static const double   one[] = {100}, gap[] = {-40, 0, 60};
  const fixture_options o[] = {
      {0, 50, NULL, 1, 1, 3, true, false, 1, MHB_IN_FREQUENCY}, /* limits only */
      {1, 1, one, 1, 1, 3, true, false, 1, MHB_IN_FREQUENCY},   /* a single point */
      {3, 40, gap, 1, 1, 3, true, true, 0, MHB_IN_FREQUENCY},   /* nothing moves */
      {3, 40, gap, 0, 1, 1, false, false, 1,
       MHB_IN_FREQUENCY}, /* no probe, no limit, one harmonic, a gap */
      {1, 30, one, 3, 0, 2, false, false, 1, MHB_IN_FREQUENCY},   /* no contact */
      {1, 1, one, 1, 1, 3, true, true, 1, MHB_IN_FREQUENCY},      /* a branch without any point */
      {2, 60, gap, 12, 30, 40, true, false, 1, MHB_IN_FREQUENCY}, /* many of everything */
  };
  for (size_t i = 0; i < sizeof o / sizeof *o; i++) {
    char *html = page(&o[i], "odd");
    check_tags(html);
    check_self_contained(html);
    static const char *const never[] = {"nan\"", "inf\"", ">nan", ">inf", ">-nan", "(nan",
                                        ":nan",  ",nan",  ",inf", ":inf", "Mnan",  "Lnan"};
    for (size_t k = 0; k < sizeof never / sizeof *never; k++) assert_has_not(html, never[k]);
    assert_int_equal(strstr(html, "id=\"tracking\"") != NULL, i == 3 || i == 6);
    assert_int_equal(strstr(html, "No nonlinear curve") != NULL, i == 0 || i == 5);
    assert_int_equal(strstr(html, "Nothing moves") != NULL, i == 2);
    assert_int_equal(strstr(html, "leave out") != NULL, i == 6);
    free(html);
  }
}

/* Curves over another parameter: it is on every axis, the frequency is stated, and no text mentions
 * a sweep. */
static void followed(void **state) {
  (void)state;
  static const struct {
    const char *label, *once, *fold, *json;
  } row[MHB_N_PARAMETERS] = {
      {"", "", "", ""},
      {">preload n₀, N<", "Preload n₀ −250 to 1000\u00a0N at 240\u00a0Hz", "at one n₀",
       "\"parameter\":\"n0\",\"name\":\"preload n₀\",\"unit\":\"N\",\"scale\":1,\"log\":false"},
      {">excitation level<", "excitation level 0.05 to 10 at 240\u00a0Hz", "at one level",
       "\"parameter\":\"scale\",\"name\":\"excitation "
       "level\",\"unit\":\"\",\"scale\":1,\"log\":true"},
      {">friction coefficient μ<", "friction coefficient μ 0 to 0.6 at 240\u00a0Hz", "at one μ",
       "\"log\":false,\"range\":[0,0.6]"},
      {">tangential stiffness kuu, MN/m<", "kuu 0.05 to 5\u00a0MN/m at 240\u00a0Hz", "at one kuu",
       "\"unit\":\"MN/m\",\"scale\":1e+06,\"log\":true,\"range\":[50000,5000000]"},
      {">normal stiffness kv, MN/m<", "kv 0.1 to 2\u00a0MN/m at 240\u00a0Hz", "at one kv",
       "\"log\":false,\"range\":[100000,2000000]"},
  };
  for (int p = MHB_IN_FREQUENCY + 1; p < MHB_N_PARAMETERS; p++) {
    fixture_options o = fixture_usual();
    o.parameter       = (mhb_parameter)p;
    char *html        = page(&o, "x");
    check_tags(html);
    assert_has(html, row[p].once);
    assert_has(html, row[p].fold);
    assert_has(html, row[p].json);
    assert_has(html, "<h2>Forced response at 240\u00a0Hz</h2>");
    static const char *const never[] = {"frequency, Hz</text>",
                                        "Half-power",
                                        "Equivalent damping",
                                        "Widen",
                                        "against frequency",
                                        ">nan",
                                        ":nan",
                                        "Mnan",
                                        "Lnan",
                                        ":inf"};
    *strstr(html, "<script>")        = '\0'; /* the program knows all words */
    for (size_t i = 0; i < sizeof never / sizeof *never; i++) assert_has_not(html, never[i]);
    assert_int_equal(count(html, row[p].label), 1); /* of the picture */
    assert_int_equal(strstr(html, "id=\"tracking\"") != NULL, p != MHB_IN_N0);
    free(html);
  }
}

/* Estimates that are no numbers print as dashes; a curve without any has no verdict. */
static void not_estimated(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  post_analysis  *analysis;
  post_buffer     html = {0};
  post_origin     s    = source();
  for (int b = 2; b < r->n_branches; b++)
    for (int p = 0; p < r->branch[b].n_points; p++)
      r->branch[b].error_newton[p]       = r->branch[b].error_truncation[p] =
          r->branch[b].error_sampling[p] = r->branch[b].error_modal[p] = NAN;
  assert_ok(post_analysis_create(r, &analysis));
  assert_ok(post_report(analysis, &s, "x", NULL, &html));
  check_tags(html.text);
  assert_int_equal(count(html.text, "<td>not estimated</td>"), 6); /* the seventh is incomplete */
  assert_has_not(html.text, "Estimated error");
  post_buffer_free(&html);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

/* 20 preloads of 500 points stay under 3 MB, 80 000 points too. */
static void size(void **state) {
  (void)state;
  double n0[40];
  for (int i = 0; i < 40; i++) n0[i] = 5 * pow(1.3, i);
  for (int big = 0; big <= 1; big++) {
    fixture_options o    = {big ? 40 : 20,   big ? 2000 : 500, n0, 2, 1, 3, true, false, 1,
                         MHB_IN_FREQUENCY};
    char           *html = page(&o, "big");
    assert_true(strlen(html) < 3000000);
    check_self_contained(html);
    free(html);
  }
}

static void picture(void **state) {
  (void)state;
  double n0[30];
  for (int i = 0; i < 30; i++) n0[i] = 5 * pow(1.3, i);
  fixture_options o = fixture_usual();
  for (int many = 0; many <= 1; many++) {
    if (many) o.n_preloads = 30, o.n0 = n0;
    mhb_response  *r = fixture_response(&o);
    post_analysis *analysis;
    post_buffer    svg = {0};
    assert_ok(post_analysis_create(r, &analysis));
    post_picture(analysis, "a <b> & \"c\"", &svg);
    check_tags(svg.text);
    assert_has(svg.text, "xmlns=\"http://www.w3.org/2000/svg\"");
    assert_has(svg.text, "a &lt;b&gt; &amp; &quot;c&quot;</text>");
    assert_has(svg.text, "fill=\"#fff\"");
    assert_has_not(svg.text, "var(");
    assert_int_equal(count(svg.text, "class=\"line c0\""), 2); /* curve and key */
    post_buffer_free(&svg);
    post_analysis_destroy(analysis);
    mhb_response_destroy(r);
  }
}

/* Left and right end and height of a limit's label, px, at 8 px per letter. */
static void place_of(const char *svg, const char *name, double box[3]) {
  char mark[32], anchor[16];
  snprintf(mark, sizeof mark, "class=\"mark %s\"", name);
  const char *at = strstr(svg, mark);
  double      x, width = 8 * (double)strlen(name);
  assert_non_null(at);
  assert_int_equal(
      sscanf(at + strlen(mark), " x=\"%lf\" y=\"%lf\" text-anchor=\"%15[a-z]", &x, &box[2], anchor),
      3);
  box[0] = x - (strcmp(anchor, "middle") == 0 ? width / 2 : strcmp(anchor, "end") == 0 ? width : 0);
  box[1] = box[0] + width;
}

/* The labels of the limits stay within the frame, 68 to 792 px, and apart, wherever the peaks
 * are. */
static void names_of_limits(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  post_analysis  *analysis;
  assert_ok(post_analysis_create(r, &analysis));
  const double *range = analysis->abscissa.range;
  for (int i = 0; i <= 40; i += 4)
    for (int j = 0; j <= 40; j++) {
      post_buffer svg = {0};
      double      open[3], stuck[3];
      analysis->tracking.open.at = range[0] + (range[1] - range[0]) * i / 40;
      analysis->tracking.stuck.at =
          range[0] + (range[1] - range[0]) * (j < 39 ? i + j - 20 : i) / 40;
      analysis->tracking.stuck.at = fmin(range[1], fmax(range[0], analysis->tracking.stuck.at));
      analysis->tracking.open.amplitude = analysis->tracking.stuck.amplitude =
          0.9 * analysis->largest;
      post_picture(analysis, "x", &svg);
      place_of(svg.text, "open", open);
      place_of(svg.text, "stuck", stuck);
      assert_true(fmin(open[0], stuck[0]) >= 68 && fmax(open[1], stuck[1]) <= 792);
      assert_true(open[1] <= stuck[0] || stuck[1] <= open[0] || fabs(open[2] - stuck[2]) >= 13);
      post_buffer_free(&svg);
    }
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(usual),   cmocka_unit_test(escaping),        cmocka_unit_test(data),
      cmocka_unit_test(odd),     cmocka_unit_test(not_estimated),   cmocka_unit_test(size),
      cmocka_unit_test(picture), cmocka_unit_test(names_of_limits), cmocka_unit_test(run_up),
      cmocka_unit_test(turns),   cmocka_unit_test(followed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
