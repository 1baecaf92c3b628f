/* A case with another mesh size: the same text with two numbers replaced. */
#ifndef CASES_CONVERGE_RESIZED_CASE_H
#define CASES_CONVERGE_RESIZED_CASE_H

#include "cases/parse/case_file.h"

/* Write the case to path with mesh.blade.size and mesh.blade.shroud_size multiplied by factor. The
 * rest of the text stays as it is. Errors: SHB_ERR_INPUT a size is not plain text in the file;
 * SHB_ERR_IO. */
shb_status case_resize_mesh(const case_file *file, double factor, const char *path);

#endif
