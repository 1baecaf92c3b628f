/* The wave in which equal blades answer the excitation (eq. 16). */
#ifndef MHB_PROBLEM_WAVE_H
#define MHB_PROBLEM_WAVE_H

#include "mesh/base/constants.h"
#include "mhb/problem/settings.h"

/* order: the right neighbour lags by 2 pi order/blades. periods: nu, of the excitation in one of
 * the motion. */
typedef struct {
  int order, blades, periods;
} mhb_driven_wave;

/* A rotor that turns to the right meets a flow of E lobes as one of N - E lobes turning left. */
static inline mhb_driven_wave mhb_driven_wave_of(int engine_order, bool turns_right, int blades,
                                                 int periods) {
  const int order =
      turns_right && blades > 0 ? (blades - engine_order % blades) % blades : engine_order;
  return (mhb_driven_wave){order, blades, periods};
}

static inline mhb_driven_wave mhb_settings_wave(const mhb_settings *s) {
  return mhb_driven_wave_of(s->engine_order, s->turns_right, s->blades, s->subharmonics);
}

/* A neighbour lags in the fundamental by (2 pi/nu)(order/N + l), l any whole number of periods. The
 * least l for which the wave closes around the ring: nu divides order + N l. -1: none does. */
static inline int mhb_driven_wave_shift(mhb_driven_wave w) {
  for (int l = 0; l < w.periods; l++)
    if ((w.order + (long)w.blades * l) % w.periods == 0) return l;
  return -1;
}

/* Waves of the fundamental around the ring, (order + N l)/nu; -1: none closes. */
static inline long mhb_driven_wave_number(mhb_driven_wave w) {
  const int l = mhb_driven_wave_shift(w);
  return l < 0 ? -1 : (w.order + (long)w.blades * l) / w.periods;
}

/* The same around a ring of that many sectors, which settings to ground need not give. */
static inline long mhb_settings_wave_number(const mhb_settings *s, int blades) {
  return mhb_driven_wave_number(
      mhb_driven_wave_of(s->engine_order, s->turns_right, blades, s->subharmonics));
}

/* rad, by which the right neighbour lags in the fundamental. */
static inline double mhb_driven_wave_lag(mhb_driven_wave w) {
  return SHB_TWO_PI / w.periods * ((double)w.order / w.blades + mhb_driven_wave_shift(w));
}

#endif
