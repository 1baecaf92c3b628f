/* A case with another mesh size: the same text, two numbers replaced. */
#ifndef CASES_CONVERGE_RESIZED_CASE_H
#define CASES_CONVERGE_RESIZED_CASE_H

#include "cases/parse/case_file.h"

/* Write to path the text of a case with a parametric blade whose mesh.blade.size and shroud_size are factor times those of the case;
 * all else stays as it is. Errors: SHB_ERR_INPUT a size that is not plain text in the file; SHB_ERR_IO. */
shb_status case_resize_mesh(const case_file *file, double factor, const char *path);

#endif
