/* Places of the small search for other branches that every run makes: at the lowest and the highest
 * peak of all preloads. The number of starts is a share of the run's Newton iterations. It is the
 * same on every machine, and no seconds decide. */
#ifndef MHB_BRANCHES_PEAK_SEARCH_H
#define MHB_BRANCHES_PEAK_SEARCH_H

#include "mhb/response/response.h"

enum { MHB_MAX_PEAK_PLACES = 6 };

/* Where to search beside one main branch. */
typedef struct {
  int    n;                          /* values; 0: nowhere */
  int    starts;                     /* at each of them */
  double value[MHB_MAX_PEAK_PLACES]; /* of the parameter, as mhb_branch.value */
} mhb_peak_places;

/* Choose the preloads and values: the preload of the lowest peak (the optimum) and that of the
 * highest. The first value is that of the branch's largest output. Over the frequency the others
 * are those of the peaks of both linear limits, and three between them. Along another parameter the
 * second value is that of the least output.
 *   limits  [2] linear limits: open, stuck; branches of response
 *   own     [n] the curves of each preload, branch 0 the main one; NULL: none
 *   places  out [n] */
void mhb_peak_places_choose(const mhb_response *limits, const mhb_response *const *own, int n,
                            mhb_peak_places *places);

#endif
