/* Two sampled contact laws, written to be fast, with which the contact law is compared:
 *
 *   BASELINE_RETURN  marching by radial return, the implicit step of eqs. 5-9: first order in slip
 *   BASELINE_CLOSED  slip in closed form between samples (Ku = k I, s and n linear between them);
 *                    slip begins and contacts close inside a step; the midpoint rule for other Ku:
 *                    second order
 *
 * The basis is tabulated once for a block of samples. Products with that table, rotated from block
 * to block, convert motion and force between harmonics and samples. Tangential quantities are in
 * the axes of Ku: x_i = k_i s_i, in N. A contact that opens is marched for one period from a
 * closing. Another one is marched until the slider changes by less than a tenth of the sampling
 * error. */
#ifndef TESTS_BASELINE_H
#define TESTS_BASELINE_H

#include "mesh/base/status.h"
#include "mhb/contact/contact.h"

/* Compiled for wide vectors too, chosen at run time, as the law is. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__)
#define BASELINE_HOT __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define BASELINE_HOT
#endif

typedef enum { BASELINE_RETURN, BASELINE_CLOSED } baseline_kind;

/* Workspace of one method: N samples a period, motions of up to m harmonics, forces of up to H. */
typedef struct {
  baseline_kind kind;
  int           N, m, H, block; /* block divides N */
  double       *table;          /* [2 max(m, H) + 1][block]: 1, cos kt, -sin kt at t = 2 pi s/N */
  double       *turn; /* [N / block][max(m, H) + 1][2]: cos kT, sin kT at the blocks' starts T */
  double       *n, *x[2], *f[2];           /* [N + 1]; n before clipping; entry N repeats entry 0 */
  double       *limit;                     /* [N + 1] mu max(n, 0) */
  double       *length, *d[2], *z, *decay; /* [N] of a step: |dx|, dx/|dx|, see march.c */
  double       *memory;
} baseline;

/* N a power of two from 8 on. SHB_ERR_IO: no memory. */
shb_status baseline_create(baseline_kind kind, int N, int m, int H, baseline *b);
void       baseline_destroy(baseline *b);

/* Force harmonics, as mhb_contact_force without derivative: motion [3][2m+1], force [3][2H+1]; mu >
 * 0. Returns the number of periods. */
int baseline_force(baseline *b, const mhb_law *law, const double *motion, double *force);

/* The law in the axes of Ku, as the marches use it. */
typedef struct {
  double mu, k[2];
  int    isotropic;
} baseline_law;

/* March from sample from to sample to <= N, reading f[.][from] and writing f[.][from + 1 .. to]. */
void baseline_march_return(const baseline *b, const baseline_law *law, int from, int to);
void baseline_march_closed(const baseline *b, const baseline_law *law, int from, int to,
                           int *sliding);

/* What the closed form knows of a step before the march; called once a force. */
void baseline_prepare_closed(const baseline *b, const baseline_law *law);

/* f with (1 + lambda k_i) f_i = g_i and |f| = limit, lambda > 0; |g| > limit. */
void baseline_return(const double k[2], const double g[2], double limit, double f[2]);

#endif
