#include "tests/support/motion_suite.h"

#include <math.h>

#define QUARTER 1.57079632679489661923

enum { V, U, W, MAX_WAVES = 21 };

/* clang-format off */
#define ROUND 1e6, 0, 1e6
#define LAW(mu, n0, ...) {mu, 5e5, {__VA_ARGS__}, n0, 0}

static const struct {
  const char *name;
  mhb_law     law;
  struct { int axis, k; double a, phase; } wave[MAX_WAVES]; /* until a = 0 */
  double room;
} table[] = {
  {"one direction",   LAW(.4, 100, ROUND), {{U, 1, 2e-4, 0}}, 2e-7},
  {"circle",          LAW(.4, 100, ROUND), {{U, 1, 2e-4, 0}, {W, 1, 2e-4, -QUARTER}}, 2e-7},
  {"ellipse",         LAW(.4, 100, ROUND), {{U, 1, 2e-4, 0}, {W, 1, 1.1e-4, -1}}, 2e-7},
  {"in phase",        LAW(.4, 100, ROUND), {{V, 1, 1e-4, 0}, {U, 1, 2e-4, 0}}, 2e-7},
  {"quadrature",      LAW(.4, 100, ROUND), {{V, 1, 1e-4, -QUARTER}, {U, 1, 2e-4, 0}}, 2e-7},
  {"opening",         LAW(.4, 100, ROUND), {{V, 1, 3e-4, .9}, {U, 1, 2e-4, 0}, {W, 1, .7e-4, 2}},
    2e-7},
  {"gap",             LAW(.4, -60, ROUND), {{V, 1, 3e-4, -.4}, {U, 1, 2e-4, 0}, {W, 1, .9e-4, 2.4}},
    2e-7},
  {"three harmonics", LAW(.4, 100, ROUND), {{V, 1, 3e-4, .9}, {V, 3, 1.5e-4, .2}, {U, 1, 2e-4, 0},
    {U, 2, 1e-4, 2}, {W, 1, .7e-4, 2}, {W, 3, .3e-4, 1}}, 2e-7},
  {"grazing",         LAW(.4, 100, ROUND), {{V, 1, 1.9999e-4, .9}, {U, 1, 2e-4, 0},
    {W, 1, .7e-4, 2}}, 5e-9},
  {"skew Ku",         LAW(.4, 100, 1.2e6, .35e6, .6e6), {{V, 1, 1.5e-4, .9}, {U, 1, 2e-4, 0},
    {W, 1, 1.2e-4, 2}}, 2e-7},

  {"varying ellipse", LAW(.4, 100, ROUND), {{V, 1, 1e-4, .9}, {U, 1, 2e-4, .3}, {W, 1, .7e-4, 2}},
    2e-7},
  {"just opening",    LAW(.4, 100, ROUND), {{V, 1, 2.0001e-4, .9}, {U, 1, 2e-4, 0},
    {W, 1, .7e-4, 2}}, 5e-9},
  {"nearly opening",  LAW(.4, 100, ROUND), {{V, 1, 1.99e-4, .9}, {U, 1, 2e-4, .3},
    {W, 1, 1.2e-4, 2.3}}, 2e-7},
  {"skew, opening",   LAW(.4, 100, 1e6, .5e6, 1e6), {{V, 1, 3e-4, 2}, {V, 2, 1e-4, 0},
    {U, 1, 2e-4, .3}, {W, 1, 1.2e-4, 2.3}}, 2e-7},
  {"stick on closing", LAW(3, 100, ROUND), {{V, 1, 3e-4, .9}, {U, 1, 2e-4, .3}, {W, 1, .7e-4, 2}},
    2e-7},
  {"slippery",        LAW(.05, 100, ROUND), {{V, 1, 2.2e-4, .9}, {U, 1, 2e-4, .3},
    {W, 1, .7e-4, 2}}, 2e-7},
  {"slip just begun", LAW(.4, 100, ROUND), {{V, 1, 1e-4, .3}, {U, 1, .5e-4, .3}, {W, 1, .1e-4, 1}},
    2e-7},
  {"offset, ripple",  LAW(.4, 100, ROUND), {{V, 0, 1e-5, 0}, {U, 0, 3e-5, 0}, {V, 1, 1e-4, .9},
    {U, 1, 2e-4, .3}, {W, 1, .7e-4, 2}, {W, 2, 1.7e-4, 2}, {U, 7, .1e-4, 2}}, 2e-7},
  {"seven harmonics", LAW(.4, 100, 1.1e6, -.3e6, .7e6), {{V, 1, 2.6e-4, .71}, {V, 2, .65e-4, 2.03},
    {V, 3, .289e-4, -1.37}, {V, 4, .163e-4, 2.91}, {V, 5, .104e-4, -.59}, {V, 6, .072e-4, 1.19},
    {V, 7, .053e-4, -2.61}, {U, 1, 2e-4, -.43}, {U, 2, .5e-4, 1.61}, {U, 3, .222e-4, 2.57},
    {U, 4, .125e-4, -1.93}, {U, 5, .08e-4, .31}, {U, 6, .056e-4, -2.89}, {U, 7, .041e-4, 1.07},
    {W, 1, 1.3e-4, 1.37}, {W, 2, .325e-4, -.83}, {W, 3, .144e-4, .19}, {W, 4, .081e-4, 2.23},
    {W, 5, .052e-4, -2.11}, {W, 6, .036e-4, .97}, {W, 7, .027e-4, -.47}}, 2e-7},
  /* |f| touches mu n inside a stick phase, from either side; lambda touches zero inside a slip
   * phase */
  {"slip grazed",     LAW(.4, 100, ROUND), {{V, 1, 1e-4, .9}, {U, 1, 2e-4, 0},
    {U, 3, 1.08047302e-4, .5}, {W, 1, .7e-4, 2}}, 0},
  {"slip touched",    LAW(.4, 100, ROUND), {{V, 1, 1e-4, .9}, {U, 1, 2e-4, 0},
    {U, 3, 1.08047518e-4, .5}, {W, 1, .7e-4, 2}}, 0},
  {"stick touched",   LAW(.4, 100, ROUND), {{V, 1, 1e-4, .9}, {U, 1, 2e-4, 0},
    {U, 3, 3.22507047e-5, .5}, {W, 1, .7e-4, 2}}, 0},
  {"touched, opening", LAW(.4, 100, ROUND), {{V, 1, 3e-4, .9}, {U, 1, 2e-4, 0},
    {U, 3, 1.63444576e-4, .5}, {W, 1, .7e-4, 2}}, 0},
  /* closed for an eighth of the period, with friction driven far beyond its limit */
  {"short contact",   {6.1, 2.41e6, {1e6, .0218e6, 5.06e6}, -140, 0}, {{V, 1, .659e-4, 1.63},
    {V, 2, .0463e-4, -.109}, {V, 3, .0107e-4, -1.79}, {U, 1, 1.77e-4, 1.43}, {U, 2, 6.77e-4, .0984},
    {U, 3, 6.35e-4, 2.07}, {W, 1, 6.42e-4, 1.3}, {W, 2, .481e-4, -2.15}, {W, 3, .132e-4, .468}},
    2e-7},
};
/* clang-format on */

int suite_size(void) {
  return (int)(sizeof table / sizeof table[0]);
}

void suite_add(suite_motion *s, int axis, int k, double a, double phase) {
  s->motion[axis][k ? 2 * k - 1 : 0] += k ? a * cos(phase) : a;
  if (k) s->motion[axis][2 * k] += a * sin(phase);
}

suite_motion suite_at(int i) {
  suite_motion s = {.name = table[i].name, .law = table[i].law, .room = table[i].room};
  for (int j = 0; j < MAX_WAVES && table[i].wave[j].a != 0; j++)
    suite_add(&s, table[i].wave[j].axis, table[i].wave[j].k, table[i].wave[j].a,
              table[i].wave[j].phase);
  return s;
}
