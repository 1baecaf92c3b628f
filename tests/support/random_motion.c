#include "tests/support/random_motion.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"

const int random_size[RANDOM_SIZES] = {1, 3, 7, RANDOM_HARMONICS};

/* splitmix64 */
double random_uniform(unsigned long *state) {
  unsigned long z = *state += 0x9e3779b97f4a7c15ul;
  z               = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ul;
  z               = (z ^ (z >> 27)) * 0x94d049bb133111ebul;
  return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.;
}

static int one_in(int n, unsigned long *state) {
  return random_uniform(state) * n < 1;
}

static double between(double low, double high, unsigned long *state) {
  return low + (high - low) * random_uniform(state);
}

static double log_between(double low, double high, unsigned long *state) {
  return pow(10, between(low, high, state));
}

/* A signal whose strongest harmonic has an amplitude of about 1. */
static void draw_signal(int m, int top, int aligned, double *a, unsigned long *state) {
  int decay = (int)between(0, 4, state), sparse = one_in(3, state);
  memset(a, 0, sizeof(double) * (size_t)(2 * m + 1));
  a[0] = one_in(2, state) ? between(-1, 1, state) : 0;
  for (int k = 1; k <= top; k++) {
    if (k > 1 && sparse && one_in(2, state)) continue;
    double size = between(.1, 1, state) / pow(k, decay), phase = between(0, SHB_TWO_PI, state);
    if (aligned) phase = .5 * SHB_PI * floor(between(0, 4, state));
    a[2 * k - 1] = size * cos(phase);
    a[2 * k]     = size * sin(phase);
  }
}

static double size_of(const double *a, int m) {
  double sum = 0;
  for (int k = 1; k <= m; k++) sum += hypot(a[2 * k - 1], a[2 * k]);
  return sum;
}

static void draw_law(int mild, mhb_law *law, unsigned long *state) {
  double range = mild ? 1 : 6, k = log_between(mild ? 0 : -3, mild ? 2 : 9, state);
  law->mu = mild ? log_between(-1, 1, state) : log_between(-3, 6, state);
  if (!mild && one_in(20, state)) law->mu = 0;
  law->kv     = k * log_between(-range, range, state);
  law->ku[0]  = k;
  law->ku[2]  = one_in(4, state) ? k : k * log_between(-range, range, state);
  double skew = mild ? between(0, .8, state) : 1 - log_between(-3, 0, state);
  if (one_in(2, state)) skew = 0;
  law->ku[1] = (one_in(2, state) ? -1 : 1) * skew * sqrt(law->ku[0]) * sqrt(law->ku[2]);
}

/* Scales the preload, then the tangential motion so that friction reaches about `reach` times its
 * limit. */
static void draw_scales(int mild, int m, random_motion *r, unsigned long *state) {
  int     width = 2 * m + 1;
  double *v = r->motion, *u = v + width, *w = u + width, wave = r->law.kv * size_of(v, m);
  double  unit = wave > 0 ? wave : r->law.kv;
  r->law.n0    = unit * between(-1.2, 1.2, state);
  if (!mild && one_in(2, state)) r->law.n0 = unit * log_between(-1, 4, state);
  if (!mild && one_in(8, state)) r->law.n0 *= -1;
  double limit = r->law.mu * (fabs(r->law.n0) + wave);
  double pull  = hypot(r->law.ku[0], r->law.ku[1]) * size_of(u, m) +
                hypot(r->law.ku[1], r->law.ku[2]) * size_of(w, m);
  double reach = mild ? log_between(-.3, 1, state) : log_between(-1.5, 1.5, state);
  double scale = limit > 0 && pull > 0 ? reach * limit / pull : 1;
  if (!mild && one_in(2, state)) scale = log_between(-3, 3, state);
  for (int i = 0; i < width; i++) {
    u[i] *= scale;
    w[i] *= scale;
  }
  r->law.mean_offset = one_in(2, state) ? fmax(r->law.n0, 0) : 0;
}

random_motion random_motion_of(unsigned long seed, unsigned long index, int mild) {
  random_motion r     = {.seed = seed, .index = index};
  unsigned long state = seed * 1000003ul + index * 0xd1342543de82ef95ul + (unsigned long)mild;
  for (int i = 0; i < 4; i++) random_uniform(&state);
  double size = random_uniform(&state);
  r.size      = mild ? (size < .5 ? 1 : 2) : size < .2 ? 0 : size < .5 ? 1 : size < .9 ? 2 : 3;
  int m = random_size[r.size], width = 2 * m + 1, top = 1 + (int)between(0, m, &state);
  int aligned = !mild && one_in(10, &state);
  draw_law(mild, &r.law, &state);
  for (int i = 0; i < 3; i++) draw_signal(m, top, aligned, r.motion + i * width, &state);
  if (one_in(20, &state)) memset(r.motion, 0, sizeof(double) * (size_t)width);
  if (one_in(20, &state)) memset(r.motion + 2 * width, 0, sizeof(double) * (size_t)width);
  if (one_in(20, &state)) /* one direction */
    for (int i = 1; i < width; i++) r.motion[2 * width + i] = .6 * r.motion[width + i];
  draw_scales(mild, m, &r, &state);
  return r;
}
