/* Assertions on numbers, statuses and texts; includes cmocka.
 *
 * cmocka's assert_float_equal compares in single precision; these compare in double precision.
 * Every argument is evaluated once. A NaN fails.
 *
 *   assert_near(value, wanted, tolerance)   |value - wanted| <= tolerance
 *   assert_within(value, wanted, relative)  |value - wanted| <= relative |wanted|
 *   assert_below(value, bound)              value <= bound
 *   assert_below_at(value, bound, where)    the same; the message names the place
 *   assert_small(value, bound)              |value| <= bound
 *   assert_ok(call)                         call returns SHB_OK
 *   assert_refused(call, code, part)        call returns code; its message is one line and has part
 *   assert_has(text, part)                  part is in text
 *   assert_has_not(text, part)              part is not in text */
#ifndef TESTS_SUPPORT_CHECK_H
#define TESTS_SUPPORT_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/status.h"

#define assert_near(value, wanted, tolerance)                                              \
  do {                                                                                     \
    double value_ = (value), wanted_ = (wanted), tolerance_ = (tolerance);                 \
    if (!(fabs(value_ - wanted_) <= tolerance_))                                           \
      fail_msg("%s = %.17g, wanted %.17g within %g, off by %.2e", #value, value_, wanted_, \
               tolerance_, fabs(value_ - wanted_));                                        \
  } while (0)

#define assert_within(value, wanted, relative)                                               \
  do {                                                                                       \
    double value_ = (value), wanted_ = (wanted), relative_ = (relative);                     \
    if (!(fabs(value_ - wanted_) <= relative_ * fabs(wanted_)))                              \
      fail_msg("%s = %.9g, wanted %.9g within %.1e, off by %.2e (relative)", #value, value_, \
               wanted_, relative_, fabs(value_ / wanted_ - 1));                              \
  } while (0)

#define assert_below_at(value, bound, where)                                               \
  do {                                                                                     \
    double      value_ = (value), bound_ = (bound);                                        \
    const char *where_ = (where);                                                          \
    if (!(value_ <= bound_))                                                               \
      fail_msg("%s = %.3e, above %.3e%s%s", #value, value_, bound_, where_[0] ? ", " : "", \
               where_);                                                                    \
  } while (0)

#define assert_below(value, bound) assert_below_at(value, bound, "")

#define assert_small(value, bound)                                       \
  do {                                                                   \
    double value_ = (value), bound_ = (bound);                           \
    if (!(fabs(value_) <= bound_))                                       \
      fail_msg("|%s| = %.3e, above %.3e", #value, fabs(value_), bound_); \
  } while (0)

#define assert_ok(call)                                                                \
  do {                                                                                 \
    shb_status status_ = (call);                                                       \
    if (status_ != SHB_OK) fail_msg("%s: %d: %s", #call, (int)status_, shb_message()); \
  } while (0)

#define assert_refused(call, code, part)                                                     \
  do {                                                                                       \
    shb_status status_ = (call);                                                             \
    if (status_ != (code)) fail_msg("%s gave %d, not %d", #call, (int)status_, (int)(code)); \
    if (!strstr(shb_message(), (part)) || strchr(shb_message(), '\n'))                       \
      fail_msg("\"%s\" does not say \"%s\"", shb_message(), (part));                         \
  } while (0)

#define assert_has(text, part)                                                        \
  do {                                                                                \
    if (!strstr((text), (part))) fail_msg("'%s' is not in: %.2000s", (part), (text)); \
  } while (0)

#define assert_has_not(text, part)                                          \
  do {                                                                      \
    if (strstr((text), (part))) fail_msg("'%s' must not be there", (part)); \
  } while (0)

#endif
