/* A CSV table as JSON: {"columns": ["a", ...], "rows": [[1, null, "text"], ...]}. */
#ifndef POSTPROC_SUMMARY_TABLE_JSON_H
#define POSTPROC_SUMMARY_TABLE_JSON_H

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"

/* Convert a table as of post_put_csv, first row the columns. A field that is a number becomes one,
 * an empty one null, others are text. SHB_ERR_IO: no memory. */
shb_status post_table_json(const char *csv, post_buffer *out);

#endif
