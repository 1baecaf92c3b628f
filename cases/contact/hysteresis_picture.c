#include "cases/contact/hysteresis_picture.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { WIDTH = 1000, HEIGHT = 790, LEFT = 72, RIGHT = 978, MOST_PANELS = 3, MANY = 40 };

static const char *const state_name[] = {"stick", "slip", "open"};

/* Colours of the light page and, below, of the dark page. No CSS variables: some viewers lack
 * them. */
static const char style[] =
    "<style>svg{background:#fff}text{font:13px system-ui,'Helvetica "
    "Neue',Helvetica,Arial,sans-serif;fill:#56606c}"
    ".heading{font-size:20px;font-weight:600}.axis,.heading,.strong{fill:#1b2530}"
    ".warn{fill:#b3261e;font-weight:600}.tick{font-size:12px}.paper{fill:#fff}"
    ".grid{stroke:#e4e7ea}.base{stroke:#8c959f;fill:none}"
    ".line{fill:none;stroke:currentColor;stroke-width:2.2;stroke-linejoin:round}"
    ".stick{color:#1d4f91;stroke-linecap:round}.slip{color:#d9622b;stroke-dasharray:9 3.5}"
    ".open{color:#6b7480;stroke-width:2.6;stroke-dasharray:.1 5.2;stroke-linecap:round}"
    ".bar{stroke:none}.bar.stick{fill:#1d4f91}.bar.slip{fill:url(#hatch)}.bar.open{fill:url(#dots)}"
    ".edge{fill:none;stroke:#8c959f}.cut{stroke:#8c959f;stroke-dasharray:2 3;fill:none}"
    ".ground{fill:#fbe3d6}.stripe{stroke:#d9622b;stroke-width:5}.point{fill:#6b7480}"
    ".limit{fill:#f1f3f5;stroke:#8c959f;stroke-width:1.2}.inner{fill:none;stroke-dasharray:3 3}"
    ".plate{fill:#fff;fill-opacity:.86}.inside{font-size:12px;font-weight:600;fill:#1b2530}"
    ".mark{fill:#fff;stroke:#1b2530;stroke-width:1.4}.start{fill:#1b2530}.arrow{fill:#1b2530}"
    ".axis{paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}"
    "@media "
    "(prefers-color-scheme:dark){svg{background:#14181d}text{fill:#a9b3be}.axis,.heading,.strong{"
    "fill:#eef1f4}"
    ".warn{fill:#ff8a80}.paper{fill:#14181d}.grid{stroke:#2a3138}.base,.edge,.cut{stroke:#6b7682}"
    ".stick{color:#7cb5ff}.slip{color:#ff9f68}.open{color:#98a4b0}.bar.stick{fill:#7cb5ff}"
    ".ground{fill:#4a2a17}.stripe{stroke:#ff9f68}.point{fill:#98a4b0}"
    ".limit{fill:#1d232a;stroke:#6b7682}.inner{fill:none}.plate{fill:#14181d}"
    ".inside{fill:#eef1f4}.mark{fill:#14181d;stroke:#eef1f4}.start,.arrow{fill:#eef1f4}"
    ".axis{stroke:#14181d}}</style>\n"
    "<defs><pattern id=\"hatch\" width=\"9\" height=\"9\" patternUnits=\"userSpaceOnUse\" "
    "patternTransform=\"rotate(45)\"><rect class=\"ground\" width=\"9\" height=\"9\"/>"
    "<path class=\"stripe\" d=\"M2.5 0V9\"/></pattern>"
    "<pattern id=\"dots\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\">"
    "<circle class=\"point\" cx=\"3.5\" cy=\"3.5\" r=\"1.1\"/></pattern></defs>\n";

/* ---- units and ranges ---- */

static post_unit pick(const post_unit *unit, int n, double largest) {
  for (int i = 0; i < n; i++)
    if (fabs(largest) >= .9995 * unit[i].scale) return unit[i];
  return unit[n - 1];
}

/* Unit of forces: kN from 10 kN on; below 1 N the smaller units too. */
static post_unit force_unit(double largest) {
  static const post_unit small[] = {{"N", 1}, {"mN", 1e-3}, {"µN", 1e-6}, {"nN", 1e-9}};
  if (!(fabs(largest) > 0) || fabs(largest) >= 1) return post_unit_force(largest);
  return pick(small, 4, largest);
}

static post_unit stiffness_unit(double largest) {
  static const post_unit unit[] = {{"GN/m", 1e9}, {"MN/m", 1e6}, {"kN/m", 1e3}, {"N/m", 1}};
  return pick(unit, 4, largest);
}

typedef struct {
  double lo, hi;
} range;

static range range_of(int n, const double *x) {
  range r = {x[0], x[0]};
  for (int i = 1; i < n; i++) {
    r.lo = fmin(r.lo, x[i]);
    r.hi = fmax(r.hi, x[i]);
  }
  return r;
}

static double most(int n, const double *x) {
  range r = range_of(n, x);
  return fmax(fabs(r.lo), fabs(r.hi));
}

static double extent(int n, const double *x) {
  range r = range_of(n, x);
  return r.hi - r.lo;
}

/* Data that all panels use. */
typedef struct {
  const hysteresis_view *view;
  const sampled_period  *period;
  post_buffer           *out;
  post_unit              length, force, energy;
  double                 friction, limit; /* largest |f| and mu n */
} sheet;

/* ---- pieces of a panel ---- */

static void draw_states(const post_plot *plot, const sampled_period *p, const double *x,
                        const double *y) {
  static const char *const classes[] = {"line stick", "line slip", "line open"};
  for (int k = PERIOD_STATES - 1; k >= 0; k--)
    plot_line(plot, classes[k], p->n, x, y, p->during[k]);
}

/* An arrowhead at sample i that points towards a sample some pixels further on. */
static void put_arrow(const post_plot *plot, const sampled_period *p, const double *x,
                      const double *y, int i) {
  double at[2] = {plot_x(plot, x[i]), plot_y(plot, y[i])}, d[2] = {0, 0}, size = 0;
  for (int j = i + 1; j < p->n && size < 3; j++) {
    d[0] = plot_x(plot, x[j]) - at[0];
    d[1] = plot_y(plot, y[j]) - at[1];
    size = hypot(d[0], d[1]);
  }
  if (!(size >= 3)) return;
  double c = d[0] / size, s = d[1] / size;
  post_put(plot->out, "<path class=\"arrow\" d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\"/>\n",
           at[0] + 7 * c, at[1] + 7 * s, at[0] - 4 * c - 4.5 * s, at[1] - 4 * s + 4.5 * c,
           at[0] - 4 * c + 4.5 * s, at[1] - 4 * s - 4.5 * c);
}

/* Index of the sample of transition i. */
static int sample_of(const sheet *s, int i) {
  const sampled_period *p   = s->period;
  int                   low = 0, high = p->n - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (p->phase[middle] < s->view->info->transition[i].phase) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/* Would a mark cover an arrowhead at sample i? */
static bool near_mark(const sheet *s, const post_plot *plot, const double *x, const double *y,
                      int i) {
  int n = s->view->info->n_transitions <= MANY ? s->view->info->n_transitions : 0;
  for (int k = -1; k < n; k++) { /* time 0 and the transitions */
    int at = k < 0 ? 0 : sample_of(s, k);
    if (hypot(plot_x(plot, x[at]) - plot_x(plot, x[i]), plot_y(plot, y[at]) - plot_y(plot, y[i])) <
        15)
      return true;
  }
  return false;
}

/* The sense of rotation: arrowheads near one quarter and three quarters of the curve, clear of
 * marks. */
static void put_arrows(const sheet *s, const post_plot *plot, const double *x, const double *y) {
  double total = 0;
  for (int pass = 0; pass < 2; pass++) {
    double along = 0, next = .22 * total;
    for (int i = 1; i < s->period->n; i++) {
      along += hypot(plot_x(plot, x[i]) - plot_x(plot, x[i - 1]),
                     plot_y(plot, y[i]) - plot_y(plot, y[i - 1]));
      if (pass == 0 || along < next || near_mark(s, plot, x, y, i)) continue;
      put_arrow(plot, s->period, x, y, i);
      next += .5 * total;
    }
    if (!(along > 60)) return;
    total = along;
  }
}

/* Marks at time 0 and at the transitions. */
static void put_marks(const sheet *s, const post_plot *plot, const double *x, const double *y) {
  const mhb_contact_info *info = s->view->info;
  plot_dot(plot, "start", x[0], y[0], 3.6);
  for (int i = 0; i < info->n_transitions && info->n_transitions <= MANY; i++) {
    int at = sample_of(s, i);
    plot_dot(plot, "mark", x[at], y[at], 3.4);
  }
}

static void draw_curve(const sheet *s, const post_plot *plot, const double *x, const double *y) {
  plot_frame(plot);
  draw_states(plot, s->period, x, y);
  put_marks(s, plot, x, y);
}

/* ---- the panels ---- */

/* A note at the right above a panel. */
static void put_note(const post_plot *plot, const char *text, const char *number) {
  post_put(plot->out,
           "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s %s</text>\n",
           plot->left + plot->width, plot->top - 12, text, number);
}

typedef enum { LOOP_U, LOOP_W, PATH, APPROACH } panel;

static void draw_loop(const sheet *s, post_plot *plot, int k) {
  const sampled_period *p = s->period;
  const double         *x = p->motion[1 + k], *y = p->friction[k];
  range                 rx = range_of(p->n, x), ry = range_of(p->n, y);
  char                  lx[64], ly[64];
  snprintf(lx, sizeof lx, "motion %c, %s", k ? 'w' : 'u', s->length.name);
  snprintf(ly, sizeof ly, "friction f%c, %s", k ? 'w' : 'u', s->force.name);
  plot->x = plot_axis_around(rx.lo, rx.hi, false, s->length.scale, lx);
  plot->y = plot_axis_around(ry.lo, ry.hi, false, s->force.scale, ly);
  draw_curve(s, plot, x, y);
  put_arrows(s, plot, x, y);
  char number[POST_NUMBER];
  put_note(plot, "encloses", post_measure(number, p->work[k], s->energy, 4));
}

static void draw_approach(const sheet *s, post_plot *plot) {
  const sampled_period *p  = s->period;
  range                 rx = range_of(p->n, p->motion[0]), ry = range_of(p->n, p->load);
  post_unit             unit = force_unit(ry.hi);
  char                  lx[64], ly[64];
  snprintf(lx, sizeof lx, "approach v, %s", s->length.name);
  snprintf(ly, sizeof ly, "normal load n, %s", unit.name);
  plot->x = plot_axis_around(rx.lo, rx.hi, false, s->length.scale, lx);
  plot->y = plot_axis_around(ry.lo, ry.hi, false, unit.scale, ly);
  draw_curve(s, plot, p->motion[0], p->load);
}

static void put_circle(const post_plot *plot, const char *classes, double radius) {
  double px = plot_x(plot, radius) - plot_x(plot, 0);
  if (!(px > .5 && px < 5000)) return;
  post_put(
      plot->out,
      "<circle class=\"%s\" clip-path=\"url(#%s-clip)\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
      classes, plot->id, plot_x(plot, 0), plot_y(plot, 0), px);
}

/* The path (fu, fw) inside circles of the largest and smallest limit mu n; equal scales. */
static void draw_path(const sheet *s, post_plot *plot) {
  const sampled_period *p = s->period;
  double high = 1.1 * fmax(s->friction, fmin(s->limit, 2 * s->friction)), wide = high;
  wide *= plot->width / plot->height;
  char lx[64], ly[64];
  snprintf(lx, sizeof lx, "friction fu, %s", s->force.name);
  snprintf(ly, sizeof ly, "friction fw, %s", s->force.name);
  plot->x = (plot_axis){.lo = -wide, .hi = wide, .unit = s->force.scale, .label = lx};
  plot->y = (plot_axis){.lo = -high, .hi = high, .unit = s->force.scale, .label = ly};
  put_circle(plot, "limit", s->limit); /* below the grid; its clip path follows */
  range limit  = range_of(p->n, p->limit);
  bool  varies = limit.lo < .995 * limit.hi;
  if (varies) put_circle(plot, "limit inner", limit.lo);
  draw_curve(s, plot, p->friction[0], p->friction[1]);
  put_arrows(s, plot, p->friction[0], p->friction[1]);
  char number[POST_NUMBER];
  put_note(plot, varies ? "limit μn up to" : "limit μn",
           post_measure(number, s->limit, force_unit(s->limit), 4));
}

/* Chooses the panels with something to show; at least one. */
static int choose_panels(const sampled_period *p, panel chosen[MOST_PANELS]) {
  double v = extent(p->n, p->motion[0]), u = extent(p->n, p->motion[1]);
  double w = extent(p->n, p->motion[2]), least = 1e-12 * fmax(u, w);
  bool   fu = most(p->n, p->friction[0]) > 0, fw = most(p->n, p->friction[1]) > 0;
  int    n = 0;
  if (u > least || fu || !(w > least || fw)) chosen[n++] = LOOP_U;
  if (w > least || fw) chosen[n++] = LOOP_W;
  if (fu && fw) chosen[n++] = PATH;
  if (n < MOST_PANELS && v > 0) chosen[n++] = APPROACH;
  return n;
}

static void draw_panels(const sheet *s) {
  static const char *const id[MOST_PANELS] = {"first", "second", "third"};
  panel                    chosen[MOST_PANELS];
  int                      n     = choose_panels(s->period, chosen);
  double                   width = (RIGHT - LEFT - 84. * (n - 1)) / n;
  for (int i = 0; i < n; i++) {
    post_plot plot = {.out    = s->out,
                      .id     = id[i],
                      .left   = LEFT + i * (width + 84),
                      .top    = 158,
                      .width  = width,
                      .height = 250};
    if (chosen[i] == PATH) draw_path(s, &plot);
    if (chosen[i] == APPROACH) draw_approach(s, &plot);
    if (chosen[i] == LOOP_U || chosen[i] == LOOP_W) draw_loop(s, &plot, chosen[i] == LOOP_W);
  }
}

/* ---- time: state bar, friction and its limit ---- */

/* The area below mu n. */
static void put_limit_area(const post_plot *plot, const sampled_period *p) {
  double bottom = plot_y(plot, 0), last = NAN;
  post_put(plot->out, "<path class=\"limit\" clip-path=\"url(#%s-clip)\" d=\"M%.1f %.1f", plot->id,
           plot_x(plot, 0), bottom);
  for (int i = 0; i < p->n; i++) {
    double x = plot_x(plot, p->phase[i]), y = plot_y(plot, p->limit[i]);
    if (fabs(x - last) < .7 && i + 1 < p->n) continue;
    post_put(plot->out, "L%.1f %.1f", x, isfinite(y) ? y : bottom);
    last = x;
  }
  post_put(plot->out, "L%.1f %.1fZ\"/>\n", plot_x(plot, 1), bottom);
}

/* Percent with one decimal. */
static char *put_share(char out[POST_NUMBER], double share) {
  if (share > 0 && share < 5e-4) return strcpy(out, "&lt;0.1");
  return post_plain(out, round(1e3 * share) / 10, 4);
}

/* A segment of the bar, with its percentage if there is room. */
static void put_stretch(const post_plot *bar, int state, double from, double to) {
  static const char *const classes[] = {"bar stick", "bar slip", "bar open"};
  const double             x[2] = {from, to}, y[2] = {0, 1}, move[2] = {0, 4.5};
  char                     text[2 * POST_NUMBER], number[POST_NUMBER];
  double                   room = plot_x(bar, to) - plot_x(bar, from);
  plot_bar(bar, classes[state], x, y);
  put_share(number, to - from);
  snprintf(text, sizeof text, "%s %s\u00a0%%", state_name[state], number);
  if (room < 96) snprintf(text, sizeof text, "%s\u00a0%%", number);
  if (room < 56) return;
  double middle = .5 * (plot_x(bar, from) + plot_x(bar, to)), half = room < 96 ? 26 : 44;
  post_put(bar->out,
           "<rect class=\"plate\" x=\"%.1f\" y=\"%.1f\" width=\"%.0f\" height=\"18\" rx=\"3\"/>\n",
           middle - half, bar->top + .5 * bar->height - 9, 2 * half);
  plot_text(bar, "inside", .5 * (from + to), .5, move, "middle", text);
}

static void put_stretches(const post_plot *bar, const mhb_contact_info *info) {
  int n = info->n_transitions, state = 0;
  for (int k = 1; k < PERIOD_STATES; k++)
    if (info->share[k] > info->share[state]) state = k;
  /* the last state of the period still holds at its start */
  if (n > 0) state = info->transition[n - 1].state;
  double from = 0;
  for (int i = 0; i < n; i++) {
    put_stretch(bar, state, from, info->transition[i].phase);
    from  = info->transition[i].phase;
    state = info->transition[i].state;
  }
  put_stretch(bar, state, from, 1);
  post_put(bar->out,
           "<rect class=\"edge\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/>\n",
           bar->left, bar->top, bar->width, bar->height);
}

/* Times of the transitions: above the bar in up to two rows, with lines down to the curve. */
static void put_transitions(const post_plot *bar, const mhb_contact_info *info, double bottom) {
  double taken[2] = {-100, -100};
  for (int i = 0; i < info->n_transitions && info->n_transitions <= MANY; i++) {
    char   number[POST_NUMBER];
    double phase = info->transition[i].phase, x = plot_x(bar, phase);
    post_put(bar->out, "<path class=\"cut\" d=\"M%.1f %.1fV%.1f\"/>", x, bar->top + bar->height,
             bottom);
    int row = x - taken[0] >= 44 ? 0 : x - taken[1] >= 44 ? 1 : -1;
    if (row < 0) continue;
    taken[row]           = x;
    const double move[2] = {0, -6 - 15 * row};
    snprintf(number, sizeof number, "%.4f", phase);
    plot_text(bar, "tick", phase, 1, move, "middle", number);
  }
  post_put(bar->out, "\n");
}

/* The friction |f| and its limit mu n; the normal load n if there is no friction at all. */
static void draw_time(const sheet *s) {
  const sampled_period *p    = s->period;
  bool                  any  = s->limit > 0;
  const double         *y    = any ? p->size : p->load;
  post_unit             unit = any ? s->force : force_unit(most(p->n, y));
  double                top  = most(p->n, y);
  if (any) top = top > 0 ? fmax(top, fmin(s->limit, 2.5 * top)) : s->limit;
  char label[96];
  snprintf(label, sizeof label, any ? "friction |f| and its limit μn, %s" : "normal load n, %s",
           unit.name);
  post_plot plot = {
      .out = s->out, .id = "time", .left = LEFT, .top = 572, .width = RIGHT - LEFT, .height = 166};
  plot.x = (plot_axis){.lo = 0, .hi = 1, .unit = 1, .label = "time, periods"};
  plot.y = (plot_axis){
      .lo = 0, .hi = top > 0 ? 1.08 * top : 1.08 * unit.scale, .unit = unit.scale, .label = label};
  post_plot bar = plot;
  bar.top       = 506;
  bar.height    = 28;
  bar.y         = (plot_axis){.lo = 0, .hi = 1};
  put_stretches(&bar, s->view->info);
  if (any) put_limit_area(&plot, p);
  put_transitions(&bar, s->view->info, plot.top + plot.height);
  plot_frame(&plot);
  draw_states(&plot, p, p->phase, y);
}

/* ---- what is written above ---- */

static void put_heading(const sheet *s) {
  const mhb_contact_info *info = s->view->info;
  char   work[POST_NUMBER], force[POST_NUMBER], load[POST_NUMBER], error[POST_NUMBER];
  double n    = most(s->period->n, s->period->load);
  bool   none = s->period->work[0] == 0 && s->period->work[1] == 0;
  post_measure(work, none ? 0 : info->dissipation, s->energy, 4);
  post_measure(force, s->friction, s->force, 4);
  post_measure(load, n, force_unit(n), 4);
  post_plain(error, fmax(info->error, 1e-15), 2);
  post_put(s->out, "<text class=\"heading\" x=\"24\" y=\"36\">Contact over one period: ");
  post_put_escaped(s->out, s->view->name);
  post_put(
      s->out,
      "</text>\n<text x=\"24\" y=\"62\"><tspan class=\"strong\">dissipation %s a cycle</tspan>",
      work);
  post_put(s->out, " · friction up to %s · normal load up to %s", force, load);
  post_put(s->out, " · error estimate %s%s of the largest force</text>\n",
           info->error < 1e-15 ? "below " : "", error);
}

/* A remark that must be read before the curves. */
static const char *remark(const sheet *s) {
  const mhb_contact_info *info = s->view->info;
  if (info->lost) return "periodic state not reached: see the error estimate";
  if (info->share[MHB_SEPARATE] >= 1) return "open throughout: no force";
  if (s->view->law->mu == 0) return "no friction";
  return info->undetermined
             ? "stuck throughout: of all possible mean frictions the smallest is shown"
             : "";
}

static void put_law(const sheet *s) {
  const mhb_law *law = s->view->law;
  post_unit      k   = stiffness_unit(fmax(law->ku[0], law->ku[2]));
  char           mu[POST_NUMBER], kv[POST_NUMBER], n0[POST_NUMBER], ku[3][POST_NUMBER];
  for (int i = 0; i < 3; i++) post_plain(ku[i], law->ku[i] / k.scale, 5);
  post_plain(kv, law->kv / stiffness_unit(law->kv).scale, 5);
  post_plain(n0, law->n0 / force_unit(law->n0).scale, 5);
  post_put(s->out, "<text x=\"24\" y=\"82\">μ %s · ku ", post_plain(mu, law->mu, 5));
  if (law->ku[1] == 0 && law->ku[0] == law->ku[2]) {
    post_put(s->out, "%s", ku[0]);
  } else {
    post_put(s->out, "[%s, %s, %s]", ku[0], ku[1], ku[2]);
  }
  post_put(s->out, " %s · kv %s %s · n0 %s %s", k.name, kv, stiffness_unit(law->kv).name, n0,
           force_unit(law->n0).name);
  const char *words = remark(s);
  if (words[0])
    post_put(s->out, " · <tspan class=\"%s\">%s</tspan>", s->view->info->lost ? "warn" : "strong",
             words);
  post_put(s->out, "</text>\n");
}

static void put_legend(const sheet *s) {
  const mhb_contact_info *info = s->view->info;
  double                  x    = 24;
  for (int k = 0; k < PERIOD_STATES; k++, x += 152) {
    char number[POST_NUMBER];
    post_put(s->out,
             "<path class=\"line %s\" d=\"M%.0f 107h34\"/><text class=\"strong\" x=\"%.0f\" "
             "y=\"111.5\">%s "
             "%s\u00a0%%</text>\n",
             state_name[k], x, x + 42, state_name[k], put_share(number, info->share[k]));
  }
  post_put(s->out,
           "<circle class=\"start\" cx=\"%.0f\" cy=\"107\" r=\"3.6\"/><text x=\"%.0f\" "
           "y=\"111.5\">time 0</text>"
           "<circle class=\"mark\" cx=\"%.0f\" cy=\"107\" r=\"3.4\"/><text x=\"%.0f\" "
           "y=\"111.5\">state changes</text>\n",
           x + 6, x + 16, x + 80, x + 90);
}

void hysteresis_draw(const hysteresis_view *view, post_buffer *out) {
  const sampled_period *p = view->period;
  sheet                 s = {.view = view, .period = p, .out = out};
  double                path[3];
  for (int i = 0; i < 3; i++) path[i] = most(p->n, p->motion[i]);
  s.friction = most(p->n, p->size);
  s.limit    = most(p->n, p->limit);
  s.length   = post_unit_length(fmax(path[1], path[2]));
  s.energy   = post_unit_energy(fmax(fabs(p->work[0]), fabs(p->work[1])));
  s.force    = force_unit(s.friction > 0 ? s.friction : s.limit);
  post_put(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  plot_svg_open(out, "loops", WIDTH, HEIGHT, view->name,
                "Hysteresis loops of the contact, the friction within its limit, and its states "
                "over one period.");
  post_put(out, "%s<rect class=\"paper\" width=\"%d\" height=\"%d\"/>\n", style, WIDTH, HEIGHT);
  put_heading(&s);
  put_law(&s);
  put_legend(&s);
  draw_panels(&s);
  draw_time(&s);
  plot_svg_close(out);
}
