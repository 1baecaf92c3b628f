#include "mhb/branches/peak_search.h"

#include <math.h>

/* One start for so many Newton iterations of the run. A start takes some 25 (multistart.h). The
 * estimates, events and verdicts of the run are not counted, so its share is below a tenth. */
/* Places divide the way between the peaks of the linear limits into so many parts. */
enum { PARTS = 4 };

enum { ITERATIONS_A_START = 50, LEAST_STARTS = 1, MOST_STARTS = 20 };

/* Places nearer than this, relative to the range of the branch, are one. */
static const double SAME_PLACE = 0.01;

/* The point of the largest output (sign 1) or the least one (-1); -1: there are no points. */
static int extreme(const mhb_response *r, const mhb_branch *b, int sign) {
  int best = -1;
  for (int i = 0; i < b->n_points; i++)
    if (best < 0 || sign * mhb_response_output(r, b, i) > sign * mhb_response_output(r, b, best))
      best = i;
  return best;
}

static void add_place(mhb_peak_places *places, double value, double range) {
  for (int i = 0; i < places->n; i++)
    if (fabs(places->value[i] - value) <= SAME_PLACE * range) return;
  if (places->n < MHB_MAX_PEAK_PLACES) places->value[places->n++] = value;
}

static void fill(mhb_peak_places *places, const mhb_response *limits, const mhb_response *own) {
  const mhb_branch *main = &own->branch[0];
  double            low = INFINITY, high = -INFINITY;
  if (places->n > 0) return; /* lowest and highest peak are the same */
  for (int i = 0; i < main->n_points; i++) {
    low  = fmin(low, main->value[i]);
    high = fmax(high, main->value[i]);
  }
  add_place(places, main->value[extreme(own, main, 1)], high - low);
  if (own->parameter != MHB_IN_FREQUENCY) {
    add_place(places, main->value[extreme(own, main, -1)], high - low);
    return;
  }
  double peak[2];
  int    n = 0;
  for (int limit = 0; limit < 2 && limit < limits->n_branches; limit++) {
    const mhb_branch *b  = &limits->branch[limit];
    int               at = extreme(limits, b, 1);
    if (at > 0 && at < b->n_points - 1) add_place(places, peak[n++] = b->value[at], high - low);
  }
  for (int k = 1; k < PARTS && n == 2; k++)
    add_place(places, peak[0] + (peak[1] - peak[0]) * k / PARTS, high - low);
}

static int iterations(const mhb_response *own) {
  int sum = 0;
  for (int b = 0; b < own->n_branches; b++)
    for (int i = 0; i < own->branch[b].n_points; i++) sum += own->branch[b].iterations[i];
  return sum;
}

void mhb_peak_places_choose(const mhb_response *limits, const mhb_response *const *own, int n,
                            mhb_peak_places *places) {
  int    lowest = -1, highest = -1, n_places = 0, work = 0;
  double peak[n + 1];
  for (int i = 0; i < n; i++) {
    places[i] = (mhb_peak_places){0};
    int top   = own[i] ? extreme(own[i], &own[i]->branch[0], 1) : -1;
    if (top < 0) continue;
    peak[i] = mhb_response_output(own[i], &own[i]->branch[0], top);
    if (lowest < 0 || peak[i] < peak[lowest]) lowest = i;
    if (highest < 0 || peak[i] > peak[highest]) highest = i;
    work += iterations(own[i]);
  }
  if (lowest < 0) return;
  fill(&places[lowest], limits, own[lowest]);
  fill(&places[highest], limits, own[highest]);
  for (int i = 0; i < n; i++) n_places += places[i].n;
  int starts = work / ITERATIONS_A_START / n_places;
  starts     = starts < LEAST_STARTS ? LEAST_STARTS : starts > MOST_STARTS ? MOST_STARTS : starts;
  for (int i = 0; i < n; i++) places[i].starts = starts;
}
