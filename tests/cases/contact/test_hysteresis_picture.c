/* The sampled period and its picture: shares, work, contents, and a valid file for every motion. */
#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cases/contact/hysteresis_picture.h"
#include "mesh/base/constants.h"
#include "mhb/numerics/fourier.h"

enum { M = 3, NB = 2 * M + 1, SCENES = 12 };

typedef struct {
  const char *name;
  mhb_law     law;
  double      motion[3][NB];
  int         curves; /* panels, including friction over time */
} scene;

typedef struct {
  mhb_contact_info info;
  sampled_period   period;
  post_buffer      svg;
} picture;

static void set(scene *s, int i, int k, double a, double phase) {
  s->motion[i][k ? 2 * k - 1 : 0] = k ? a * cos(phase) : a;
  if (k) s->motion[i][2 * k] = a * sin(phase);
}

static scene scene_of(int i) {
  static const char *const names[SCENES] = {
      "opening", "one direction", "w alone", "stuck",      "skew & <bold> \"name\"",
      "open",    "no friction",   "at rest", "no contact", "tiny",
      "huge",    "gummy"};
  scene s = {
      .name = names[i], .law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}, .curves = 4};
  set(&s, 0, 1, 3e-4, .9);
  set(&s, 1, 1, 2e-4, 0);
  set(&s, 2, 1, .7e-4, 2);
  double unit = i == 9 ? 1e-13 : i == 10 ? 1e12 : 1;
  switch (i) {
    case 1: /* constant load: a loop, and friction in time */
    case 2:
      s = (scene){.name = names[i], .law = s.law, .curves = 2};
      set(&s, i, 1, 2e-4, 0);
      break;
    case 3:
      s.law.n0 = 1000;
      break;
    case 4:
      s.law.ku[1] = 3e5;
      set(&s, 1, 2, 1e-4, 1);
      set(&s, 0, 3, 2e-4, 1);
      break;
    case 5:
      s.law.n0 = -1000;
      break;
    case 6:
      s.law.mu = 0;
      break;
    case 7:
    case 8:
      s = (scene){.name = names[i], .law = s.law, .curves = 2};
      if (i == 8) s.law.n0 = 0;
      break;
    case 9:
    case 10:
      for (int a = 0; a < 3; a++)
        for (int j = 0; j < NB; j++) s.motion[a][j] *= unit;
      s.law.n0 *= unit;
      break;
    case 11:
      s.law.mu = 1e6;
      set(&s, 0, 1, 1e-4, .9);
      break;
    default:
      break;
  }
  return s;
}

static void draw(const scene *s, picture *p) {
  double                 force[3 * NB];
  mhb_contact_evaluator *contact;
  assert_int_equal(mhb_contact_evaluator_create(M, M, 1e-10, &contact), SHB_OK);
  mhb_contact_force(contact, &s->law, &s->motion[0][0], force, NULL, &p->info);
  assert_int_equal(
      sampled_period_create(contact, &s->law, M, &s->motion[0][0], &p->info, &p->period), SHB_OK);
  p->svg = (post_buffer){0};
  hysteresis_draw(
      &(hysteresis_view){.name = s->name, .law = &s->law, .info = &p->info, .period = &p->period},
      &p->svg);
  assert_false(p->svg.failed);
  mhb_contact_evaluator_destroy(contact);
}

static void clear(picture *p) {
  sampled_period_free(&p->period);
  post_buffer_free(&p->svg);
}

static int count(const char *text, const char *word) {
  int n = 0;
  for (; (text = strstr(text, word)) != NULL; text += strlen(word)) n++;
  return n;
}

/* The pieces of the period in one state last as long as the law says; transitions are samples. */
static void states_fill_the_period(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    scene   s = scene_of(i);
    picture p;
    draw(&s, &p);
    double share[PERIOD_STATES] = {0};
    assert_true(p.period.phase[0] == 0 && p.period.phase[p.period.n - 1] == 1);
    for (int j = 1; j < p.period.n; j++) {
      int n = 0;
      for (int k = 0; k < PERIOD_STATES; k++) {
        n += p.period.during[k][j];
        if (p.period.during[k][j]) share[k] += p.period.phase[j] - p.period.phase[j - 1];
      }
      assert_int_equal(n, 1);
      assert_true(p.period.phase[j] > p.period.phase[j - 1]);
    }
    for (int k = 0; k < PERIOD_STATES; k++)
      if (!(fabs(share[k] - p.info.share[k]) < 1e-12))
        fail_msg("%s: state %d for %.15g of the period, not %.15g", s.name, k, share[k],
                 p.info.share[k]);
    clear(&p);
  }
}

/* The loops enclose the dissipation; the polygon drawn does so to second order. */
static void loops_enclose_the_dissipation(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    scene   s = scene_of(i);
    picture p;
    draw(&s, &p);
    double area[2] = {0, 0}, size = 0;
    for (int j = 1; j < p.period.n; j++)
      for (int k = 0; k < 2; k++) {
        double f = .5 * (p.period.friction[k][j] + p.period.friction[k][j - 1]);
        double d = f * (p.period.motion[1 + k][j] - p.period.motion[1 + k][j - 1]);
        area[k] += d;
        size += fabs(d);
      }
    double work = p.period.work[0] + p.period.work[1];
    if (!(fabs(work - p.info.dissipation) <= 1e-9 * size))
      fail_msg("%s: %.12g J, not %.12g", s.name, work, p.info.dissipation);
    for (int k = 0; k < 2; k++)
      if (!(fabs(area[k] - p.period.work[k]) <= 2e-5 * size))
        fail_msg("%s: loop %d encloses %.9g J, not %.9g", s.name, k, area[k], p.period.work[k]);
    if (p.info.undetermined && s.law.ku[1] == 0)
      assert_true(p.period.work[0] == 0 && p.period.work[1] == 0); /* a line has no area */
    clear(&p);
  }
}

/* Each state of a curve is one path; the legend has one entry. */
static void every_state_is_drawn_once_a_curve(void **state) {
  (void)state;
  static const char *const word[PERIOD_STATES] = {
      "<path class=\"line stick\"", "<path class=\"line slip\"", "<path class=\"line open\""};
  for (int i = 0; i < SCENES; i++) {
    scene   s = scene_of(i);
    picture p;
    draw(&s, &p);
    for (int k = 0; k < PERIOD_STATES; k++) {
      int n = count(p.svg.text, word[k]), wanted = 1 + (p.info.share[k] > 0 ? s.curves : 0);
      if (n != wanted) fail_msg("%s: state %d in %d paths, not %d", s.name, k, n, wanted);
    }
    clear(&p);
  }
}

/* The percentage in the legend. */
static double legend(const char *svg, const char *name) {
  char word[32];
  snprintf(word, sizeof word, "y=\"111.5\">%s ", name);
  const char *at = strstr(svg, word);
  assert_non_null(at);
  return strtod(at + strlen(word), NULL);
}

static void figures_are_those_of_the_law(void **state) {
  (void)state;
  scene   s = scene_of(1);
  picture p;
  draw(&s, &p);
  assert_non_null(strstr(p.svg.text, ">dissipation 25.60\u00a0mJ a cycle<")); /* 4 S (A - S/k) */
  assert_non_null(strstr(p.svg.text, "encloses 25.60\u00a0mJ<"));
  assert_non_null(strstr(p.svg.text, "friction up to 40.00\u00a0N"));
  double stick = 100 * acos(1 - 2 * 40 / 200.) / SHB_PI;
  assert_true(fabs(legend(p.svg.text, "stick") - stick) < .0501);
  assert_true(fabs(legend(p.svg.text, "slip") - (100 - stick)) < .0501);
  assert_non_null(strstr(p.svg.text, ">0.1476<")); /* acos(.6)/2 pi */
  assert_non_null(strstr(p.svg.text, ">motion u, µm<"));
  clear(&p);
  s = scene_of(3);
  draw(&s, &p);
  assert_non_null(strstr(p.svg.text, "dissipation 0\u00a0"));
  assert_non_null(strstr(p.svg.text, "stuck throughout"));
  clear(&p);
}

/* Tags nest and close, attributes are quoted, & begins an entity, and every number is complete. */
static void check_markup(const char *name, const char *text) {
  char        open[64][32];
  int         depth = 0;
  const char *at    = strstr(text, "?>") + 2;
  for (; *at; at++) {
    if (*at == '&') assert_true(strchr("alqg#", at[1]) && memchr(at, ';', 8));
    if (*at != '<') continue;
    bool   closes = at[1] == '/';
    size_t n      = strcspn(at + 1 + closes, " >/");
    assert_true(n > 0 && n < sizeof open[0] && depth < 63);
    const char *end = at;
    for (bool quoted = false; *end != '>' || quoted; end++) {
      assert_true(*end != '\0' && (end == at || *end != '<'));
      if (*end == '"') quoted = !quoted;
    }
    if (closes) {
      if (depth == 0 || strncmp(open[depth - 1], at + 2, n) != 0 || open[depth - 1][n])
        fail_msg("%s: '%.*s' closes nothing", name, (int)(end - at + 1), at);
      depth--;
    } else if (end[-1] != '/') {
      snprintf(open[depth++], sizeof open[0], "%.*s", (int)n, at + 1);
    }
    at = end;
  }
  assert_int_equal(depth, 0);
  static const char *const broken[] = {"nan", "inf", "NaN"};
  for (int i = 0; i < 3; i++)
    for (const char *w = text; (w = strstr(w, broken[i])) != NULL; w++)
      if (!isalpha((unsigned char)w[-1]) && !isalpha((unsigned char)w[3]))
        fail_msg("%s: '%.20s'", name, w - 5);
}

static void every_picture_is_sound(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    scene   s = scene_of(i);
    picture p;
    draw(&s, &p);
    check_markup(s.name, p.svg.text);
    clear(&p);
  }
  scene   s = scene_of(4);
  picture p;
  draw(&s, &p);
  assert_non_null(strstr(p.svg.text, "skew &amp; &lt;bold&gt; &quot;name&quot;"));
  assert_null(strstr(p.svg.text, "<bold>"));
  assert_non_null(strstr(p.svg.text, "prefers-color-scheme:dark"));
  assert_null(strstr(p.svg.text, "url(http"));
  clear(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(states_fill_the_period), cmocka_unit_test(loops_enclose_the_dissipation),
      cmocka_unit_test(every_state_is_drawn_once_a_curve),
      cmocka_unit_test(figures_are_those_of_the_law), cmocka_unit_test(every_picture_is_sound)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
