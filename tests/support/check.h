/* Double comparison (cmocka's casts to float) and small helpers of the postproc tests. */
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

#define assert_near(value, wanted, tolerance)                                              \
  do {                                                                                     \
    double value_ = (value), wanted_ = (wanted), tolerance_ = (tolerance);                 \
    if (!(fabs(value_ - wanted_) <= tolerance_))                                           \
      fail_msg("%s = %.17g, wanted %.17g within %g", #value, value_, wanted_, tolerance_); \
  } while (0)

#define assert_ok(call)                                             \
  do {                                                              \
    if ((call) != SHB_OK) fail_msg("%s: %s", #call, shb_message()); \
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
