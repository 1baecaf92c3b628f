#include "summary.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

summary summary_of(int motions, const measurement (*measured)[METHOD_MAX], int i) {
  summary out = {{0, 0}, {0, 0}, 0, 0};
  double  value[3][motions];
  for (int s = 0; s < motions; s++) {
    const measurement *m = &measured[s][i];
    value[0][s]          = m->us[0];
    value[1][s]          = m->us[1];
    value[2][s]          = m->error;
  }
  for (int d = 0; d < 2; d++) {
    out.us[d]       = median_of(value[d], motions);
    out.us_worst[d] = value[d][motions - 1];
  }
  out.error       = median_of(value[2], motions);
  out.error_worst = value[2][motions - 1];
  return out;
}

work_precision work_precision_of(method_family family, const method *all, const summary *sum,
                                 int n) {
  work_precision c = {.n = 0};
  for (int i = 0; i < n; i++) {
    if (all[i].family != family || all[i].H != SUITE_HARMONICS) continue;
    int at = c.n++;
    /* coarse before fine: by samples or by tolerance */
    for (; at > 0 && all[i].tolerance > all[c.method[at - 1]].tolerance; at--)
      c.method[at] = c.method[at - 1];
    c.method[at] = i;
  }
  for (int j = 0; j < c.n; j++) {
    const summary *s   = &sum[c.method[j]];
    c.us[j]            = s->us[0];
    c.us_derivative[j] = s->us[1];
    c.error[j]         = s->error;
  }
  return c;
}

double order_of(const work_precision *curve, const method *all) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (int j = 0; j < curve->n; j++) {
    double x = log(all[curve->method[j]].N), y = log(curve->error[j]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    n++;
  }
  return -(n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/* Time at which a baseline reaches an error: between its points on straight lines in log-log,
 * beyond them by its order. */
static double baseline_time(const work_precision *c, const method *all, double error, int *beyond) {
  *beyond = 0;
  for (int j = 0; j < c->n; j++) {
    if (c->error[j] > error) continue;
    if (j == 0) return c->us[0];
    double share = log(c->error[j - 1] / error) / log(c->error[j - 1] / c->error[j]);
    return c->us[j - 1] * pow(c->us[j] / c->us[j - 1], share);
  }
  *beyond = 1;
  return c->us[c->n - 1] * pow(c->error[c->n - 1] / error, 1 / order_of(c, all));
}

/* The cheapest setting of the law that reaches an error; NAN if none does. */
static double law_time(const work_precision *c, double error) {
  double best = NAN;
  for (int j = 0; j < c->n; j++)
    if (c->error[j] <= error) best = fmin(best, c->us[j]);
  return best;
}

static void put_us(double us) {
  if (isnan(us))
    printf(" %9s", "-");
  else
    printf(" %9.1f", us);
}

static void print_medians(const method *all, const summary *sum, int n) {
  printf("\n%-20s %2s %9s %9s %9s %9s  %9s %9s\n", "over the suite", "H", "force us", "worst",
         "+deriv us", "worst", "error", "worst");
  for (int i = 0; i < n; i++) {
    printf("%-20s %2d", all[i].name, all[i].H);
    for (int d = 0; d < 2; d++) {
      put_us(sum[i].us[d]);
      put_us(sum[i].us_worst[d]);
    }
    printf("  %9.1e %9.1e\n", sum[i].error, sum[i].error_worst);
  }
}

static const summary *find(const char *accuracy, int H, const method *all, const summary *sum,
                           int n) {
  for (int i = 0; i < n; i++)
    if (all[i].accuracy && !strcmp(all[i].accuracy, accuracy) && all[i].H == H) return &sum[i];
  return NULL;
}

/* One goal: value <= bound, or value >= bound. Returns 1 if it is missed. */
static int goal(const char *what, double value, const char *relation, double bound,
                const char *note) {
  int holds = relation[0] == '<' ? value <= bound : value >= bound;
  printf("%-46s %9.3g %s %-6g %s%s\n", what, value, relation, bound, holds ? "PASS" : "FAIL", note);
  return !holds;
}

static int print_errors(const method *all, const summary *sum, int n) {
  static const struct {
    const char *accuracy;
    double      bound;
  } wanted[] = {{"fast", 1e-3}, {"balanced", 1e-5}, {"exact", 1e-8}};
  int failed = 0;
  for (int i = 0; i < 3; i++)
    for (int H = SUITE_HARMONICS; H <= METHOD_H; H += METHOD_H - SUITE_HARMONICS) {
      char           what[64];
      const summary *s = find(wanted[i].accuracy, H, all, sum, n);
      snprintf(what, sizeof what, "%s: worst error, harmonics 0-%d", wanted[i].accuracy, H);
      failed += goal(what, s->error_worst, "<=", wanted[i].bound, "");
    }
  for (method_family family = METHOD_RETURN; family <= METHOD_CLOSED; family++) {
    work_precision c = work_precision_of(family, all, sum, n);
    failed += goal(family == METHOD_RETURN ? "radial return: order" : "closed form: order",
                   order_of(&c, all), ">=", family == METHOD_RETURN ? .9 : 1.8, "");
  }
  return failed;
}

/* force, force with derivative: median, worst */
static void print_times(const method *all, const summary *sum, int n) {
  static const struct {
    const char *accuracy;
    double      median[2], worst[2];
  } wanted[]                       = {{"exact", {6, 20}, {50, 80}}, {"fast", {5, 12}, {0, 0}}};
  static const char *const what[2] = {"force", "force + derivative"};
  for (int i = 0; i < 2; i++)
    for (int H = SUITE_HARMONICS; H <= METHOD_H; H += METHOD_H - SUITE_HARMONICS)
      for (int d = 0; d < 2; d++) {
        char           text[64];
        const summary *s = find(wanted[i].accuracy, H, all, sum, n);
        snprintf(text, sizeof text, "%s: median us, %s, 0-%d", wanted[i].accuracy, what[d], H);
        goal(text, s->us[d], "<=", wanted[i].median[d], "");
        if (!(wanted[i].worst[d] > 0)) continue;
        snprintf(text, sizeof text, "%s: worst us, %s, 0-%d", wanted[i].accuracy, what[d], H);
        goal(text, s->us_worst[d], "<=", wanted[i].worst[d], "");
      }
}

static void print_ratios(const method *all, const summary *sum, int n) {
  static const struct {
    method_family family;
    double        error, bound;
  } wanted[] = {{METHOD_RETURN, 1e-5, 100}, {METHOD_CLOSED, 1e-6, 5}, {METHOD_CLOSED, 1e-7, 10}};
  work_precision law = work_precision_of(METHOD_LAW, all, sum, n);
  for (int i = 0; i < 3; i++) {
    work_precision c = work_precision_of(wanted[i].family, all, sum, n);
    int            beyond;
    double         own = law_time(&law, wanted[i].error);
    double         us  = baseline_time(&c, all, wanted[i].error, &beyond);
    char           what[64], note[96];
    snprintf(what, sizeof what, "times faster than %s at %.0e",
             wanted[i].family == METHOD_RETURN ? "radial return" : "closed form", wanted[i].error);
    int length = snprintf(note, sizeof note, "  %.3g us against %.3g", us, own);
    if (beyond)
      snprintf(note + length, sizeof note - (size_t)length, ", extrapolated by its order %.2f",
               order_of(&c, all));
    goal(what, us / own, ">=", wanted[i].bound, note);
  }
}

int summary_print(const method *all, const summary *sum, int n) {
  print_medians(all, sum, n);
  printf("\n%-46s %9s\n", "goal", "measured");
  int failed = print_errors(all, sum, n);
  if (!isnan(sum[0].us[0])) {
    print_times(all, sum, n);
    print_ratios(all, sum, n);
  }
  return failed;
}
