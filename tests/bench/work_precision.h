/* Error against microseconds as a picture: one line a family, the three accuracies marked. */
#ifndef TESTS_WORK_PRECISION_H
#define TESTS_WORK_PRECISION_H

#include "summary.h"

/* Self-contained SVG for light and dark pages. Errors: SHB_ERR_IO. */
shb_status work_precision_svg(const method *all, const summary *sum, int n, int motions,
                              const char *path);

#endif
