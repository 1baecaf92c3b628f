/* The wave in which equal blades answer the excitation (eq. 16). */
#ifndef MHB_PROBLEM_WAVE_H
#define MHB_PROBLEM_WAVE_H

#include "mesh/base/constants.h"
#include "mhb/problem/settings.h"

/* The wave of a rotor that turns to the left, in which the right neighbour lags; mirrored: it leads
 * by as much. periods: nu, of the excitation in one of the motion. */
typedef struct {
  int  engine_order, blades, periods;
  bool mirrored;
} mhb_driven_wave;

static inline mhb_driven_wave mhb_driven_wave_of(int engine_order, bool turns_right, int blades,
                                                 int periods) {
  return (mhb_driven_wave){engine_order, blades, periods, turns_right && blades > 0};
}

static inline mhb_driven_wave mhb_settings_wave(const mhb_settings *s) {
  return mhb_driven_wave_of(s->engine_order, s->turns_right, s->blades, s->subharmonics);
}

/* A number of waves that run to the right, as that of the same sense: N - n (mod N) if mirrored. */
static inline long mhb_driven_wave_turned(mhb_driven_wave w, long n) {
  return w.mirrored ? (w.blades - n % w.blades) % w.blades : n;
}

/* Waves of the excitation around the ring: the right neighbour lags by 2 pi order/N. */
static inline int mhb_driven_wave_order(mhb_driven_wave w) {
  return (int)mhb_driven_wave_turned(w, w.engine_order);
}

/* A neighbour lags in the fundamental by (2 pi/nu)(E/N + l), l any whole number of periods. The
 * least l for which the wave closes around the ring: nu divides E + N l. -1: none does. */
static inline int mhb_driven_wave_shift(mhb_driven_wave w) {
  for (int l = 0; l < w.periods; l++)
    if ((w.engine_order + (long)w.blades * l) % w.periods == 0) return l;
  return -1;
}

/* Waves of the fundamental around the ring, (E + N l)/nu; -1: none closes. */
static inline long mhb_driven_wave_number(mhb_driven_wave w) {
  const int l = mhb_driven_wave_shift(w);
  if (l < 0) return -1;
  return mhb_driven_wave_turned(w, (w.engine_order + (long)w.blades * l) / w.periods);
}

/* The same around a ring of that many sectors, which settings to ground need not give. */
static inline long mhb_settings_wave_number(const mhb_settings *s, int blades) {
  return mhb_driven_wave_number(
      mhb_driven_wave_of(s->engine_order, s->turns_right, blades, s->subharmonics));
}

/* rad, by which the right neighbour lags in the fundamental with l periods more. */
static inline double mhb_driven_wave_lag_of(mhb_driven_wave w, int l) {
  const double lag = SHB_TWO_PI / w.periods * ((double)w.engine_order / w.blades + l);
  return w.mirrored ? -lag : lag;
}

static inline double mhb_driven_wave_lag(mhb_driven_wave w) {
  return mhb_driven_wave_lag_of(w, mhb_driven_wave_shift(w));
}

#endif
