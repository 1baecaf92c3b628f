/* Range of the values of a dataset as text. */
#ifndef POSTPROC_INSPECT_VALUE_RANGE_H
#define POSTPROC_INSPECT_VALUE_RANGE_H

#include <hdf5.h>

enum { POST_VALUE_RANGE = 160 };

/* Type as text: "float64", "int32", "complex", "string", "compound {a, b}", "reference". Returns
 * out. */
char *post_type_name(hid_t type, char out[POST_VALUE_RANGE]);

/* Range as text. Numbers: "103.6 … 2310", or one value if all are equal; magnitudes "|…|" of
 * complex {r, i}; ", 2 NaN" if some are no numbers. Strings: the first few. "empty", "unreadable",
 * "not written" if the file holds none of the values; "" for other types. Returns out.
 *   seconds  in  the most that reading may take; then ", first 0.12 % read" follows */
char *post_value_range(hid_t dataset, double seconds, char out[POST_VALUE_RANGE]);

#endif
