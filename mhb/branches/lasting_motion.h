/* The motion that lasts, on main branches. Where a wave is unstable other than by a fold, the whole
 * ring is integrated (mhb/ring).
 *
 *   auto    a slow sweep over the points that are modulated or not judged, where the wave exceeds
 *           0.4 of its peak; then points: of the wave's largest output, at the sweep's largest, one
 *           between
 *   always  the sweep, and every modulated point
 *   never   nothing
 * A point is modulated if it slips or opens, is unstable, and lost stability by a flip or a pair of
 * multipliers. Each branch gets a text that says what was computed, or why not. Threads share
 * the branches and then the points. No result depends on their number. */
#ifndef MHB_BRANCHES_LASTING_MOTION_H
#define MHB_BRANCHES_LASTING_MOTION_H

#include "mhb/response/response.h"
#include "modal/model/model.h"

/* Its functions are called from any thread. */
typedef struct {
  void *context;
  bool (*go_on)(void *context); /* false: stop; called often, without the lock */
  void (*lock)(void *context, bool locked);
  /* A result was stored in a curve; share: of the work that is done. With the lock held. */
  shb_status (*stored)(void *context, double share, double n0, double frequency);
  int threads; /* that memory allows */
} mhb_lasting_host;

/* Why no motion that lasts is computed for the whole case; NULL: it may be. */
const char *mhb_lasting_refusal(const modal_model *model, const mhb_settings *settings);

/* Fill the lasting motion of branch 0 of curves[n] (NULL: left out). Branches with a text are done.
 * Branches change under the lock only. If stopped, a branch keeps its text NULL.
 * Errors: as mhb_ring_model_create, and of stored. */
shb_status mhb_lasting_motion(const modal_model *model, const mhb_settings *settings, int n,
                              mhb_response *const *curves, const mhb_lasting_host *host);

#endif
