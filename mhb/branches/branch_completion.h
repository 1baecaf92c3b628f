/* Completion of a branch whose segments are traced. They are joined, the stability of the points is
 * judged, and the reason of the end is noted. */
#ifndef MHB_BRANCHES_BRANCH_COMPLETION_H
#define MHB_BRANCHES_BRANCH_COMPLETION_H

#include "mhb/branches/tracer.h"

typedef struct {
  mhb_end     end;          /* why the branch ended */
  bool        by_folds;     /* without multipliers: stability by the folds, from stable_at on */
  int         stable_at;    /* point that is stable by assumption */
  int         n_gaps;       /* places jumped over; first_gap: the first of them */
  const char *first_gap;    /* if n_gaps > 0 */
  const char *other_reason; /* NULL; or a reason in place of the end's, of an incomplete branch */
  bool        interrupted;  /* out: the judging of stability was stopped, or the tracing before */
} mhb_completion;

/* Join a chain of the tracer's segments into a branch of a response, and complete it. */
shb_status mhb_branch_complete(mhb_tracer *tracer, const mhb_chain *chain, mhb_response *response,
                               int branch, mhb_completion *completion);

#endif
