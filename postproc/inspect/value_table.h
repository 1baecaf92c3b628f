/* shroudhb inspect FILE PATH: the values of a dataset, or of all columns of a group. */
#ifndef POSTPROC_INSPECT_VALUE_TABLE_H
#define POSTPROC_INSPECT_VALUE_TABLE_H

#include <stdbool.h>

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"

/* Write values as a table: a row for each first index, a column for all others.
 *
 *   place  PATH or PATH[selection, ...] with one selection a dimension. A selection is i, from:to
 *          (to left out), or ":"; -1 is the last index. The first one may also be "peak" or "fold":
 *          the points so marked in the dataset "special" beside. Missing ones are ":".
 *          A group gives those of its datasets that hold one number for each point.
 *   csv    columns separated by commas, all digits; else aligned columns of nine digits
 *
 * Complex values take two columns, NAME.re and NAME.im. The head of a column names its unit.
 * Errors: SHB_ERR_INPUT no such object, an index out of range, a type without numbers or text;
 * SHB_ERR_IO the file cannot be read, no memory. */
shb_status post_value_table(const char *file, const char *place, bool csv, post_buffer *out);

#endif
