/* The values of a dataset in one phrase. */
#ifndef POSTPROC_INSPECT_VALUE_RANGE_H
#define POSTPROC_INSPECT_VALUE_RANGE_H

#include <hdf5.h>

enum { POST_VALUE_RANGE = 160 };

/* "float64", "int32", "complex", "string", "compound {a, b}", "reference". Returns out. */
char *post_type_name(hid_t type, char out[POST_VALUE_RANGE]);

/* Numbers: "103.6 … 2310", one value if all are equal, magnitudes as "|…|" for complex {r, i}, ", 2 NaN" when some are not
 * numbers; strings: the first few. "empty", "unreadable" where so; "" for other types. Returns out. */
char *post_value_range(hid_t dataset, char out[POST_VALUE_RANGE]);

#endif
