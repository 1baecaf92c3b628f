/* The contact law of one pair, and the states it passes through. */
#ifndef MHB_CONTACT_LAW_H
#define MHB_CONTACT_LAW_H

typedef enum { MHB_STICK, MHB_SLIDE, MHB_SEPARATE } mhb_state;

/* n = max(n0 + kv v, 0); stick f = Ku (s - s0) + f0 while |f| < mu n; slip |f| = mu n. */
typedef struct {
  double mu;          /* friction coefficient, >= 0 */
  double kv;          /* normal stiffness, N/m, >= 0 */
  double ku[3];       /* tangential stiffness kuu, kuw, kww, N/m; positive definite */
  double n0;          /* preload, N; negative: initial gap -n0/kv */
  double mean_offset; /* N, subtracted from the mean of n: max(n0, 0) or 0, see mhb_preload */
} mhb_law;

typedef struct {
  double phase; /* t/2 pi, in [0, 1) */
  int    state; /* mhb_state that begins */
} mhb_transition;

#endif
